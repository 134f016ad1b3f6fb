//! A job as the files of a folder, for each engine.

mod dask;
mod openjd;
mod slurm;

use super::super::args::{Engine, Farm};
use super::commands::Commands;
use super::frames::Frames;

/// A picture in parts, or some frames of them, for an engine.
pub(super) struct FarmJob<'a> {
    engine: Engine,
    commands: Commands<'a>,
    frames: &'a Frames,
    /// The description of the job, without quotes.
    title: String,
    picture: &'a str,
    parts: u32,
    threads: u16,
    memory: u32,
    retries: u32,
}

impl<'a> FarmJob<'a> {
    /// The job for scenes whose hashes are given.
    pub(super) fn new(args: &'a Farm, frames: &'a Frames, hashes: &[String]) -> Self {
        let (parts, picture) = (args.parts, &args.picture);
        let scene = frames.scene(&example(frames));
        let hash = hashes.first().map_or("", String::as_str);
        let more = match hashes.len() {
            0 | 1 => String::new(),
            all => format!(" and {} more", all - 1),
        };
        let version = env!("CARGO_PKG_VERSION");
        Self {
            engine: args.to,
            commands: Commands::new(args, frames),
            frames,
            title: format!(
                "{parts} parts of {picture}, of {scene} {hash}{more}, for rtc {version}"
            ),
            picture,
            parts,
            threads: args.threads,
            memory: args.memory,
            retries: args.retries,
        }
    }

    /// What starts it, typed in its folder.
    pub(super) fn how_to_run(&self) -> &'static str {
        match self.engine {
            Engine::OpenJd => "openjd run template.json",
            Engine::Slurm => "sh submit.sh",
            Engine::Dask => "python run.py",
        }
    }

    /// The names and texts of its files.
    pub(super) fn files(&self) -> Vec<(&'static str, String)> {
        let mut files = match self.engine {
            Engine::OpenJd => vec![("template.json", openjd::template(self))],
            Engine::Slurm => slurm::scripts(self).to_vec(),
            Engine::Dask => vec![("run.py", dask::driver(self))],
        };
        files.push(("README", self.readme()));
        files
    }

    /// A description, the commands that run it, and its result.
    fn readme(&self) -> String {
        let Self { title, retries, .. } = self;
        let whole = self.commands.whole(&example(self.frames)).join(" ");
        let run = match self.engine {
            Engine::OpenJd => format!(
                "`openjd run template.json` here; on Deadline Cloud `deadline bundle submit` with \
                `--max-retries-per-task {retries}`"
            ),
            Engine::Slurm => "`sh submit.sh` in this folder, which all nodes share".to_owned(),
            Engine::Dask => {
                "`python run.py [SCHEDULER]` in this folder, which all workers share; one \
                 thread a worker"
                    .to_owned()
            }
        };
        format!(
            "{title}, which all workers need: on their path, or where `RTC` points \
             (OpenJD: the parameter `Rtc`).\n\
             To run: {run}.\n\
             The first picture is that of `rtc {whole}`, byte for byte; parts that failed can be run again, one by one.\n"
        )
    }
}

/// The first frame, as it is in names.
fn example(frames: &Frames) -> String {
    frames.names().into_iter().next().unwrap_or_default()
}
