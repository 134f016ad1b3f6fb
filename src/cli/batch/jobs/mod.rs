//! A job as the files of a folder, for each engine.

mod array;
mod dask;
mod openjd;
mod slurm;

use super::super::args::{FarmArgs, FarmEngine};
use super::commands::JobCommands;
use super::frames::JobFrames;

/// A picture in parts, or some frames of them, for an engine.
pub(super) struct FarmJob<'a> {
    engine: FarmEngine,
    commands: JobCommands<'a>,
    frames: &'a JobFrames,
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
    pub(super) fn new(args: &'a FarmArgs, frames: &'a JobFrames, hashes: &[String]) -> Self {
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
            commands: JobCommands::new(args, frames),
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

    /// The number of parts of all frames.
    fn tasks(&self) -> u64 {
        u64::from(self.parts) * self.frames.names().len() as u64
    }

    /// What starts it, typed in its folder.
    pub(super) fn how_to_run(&self) -> &'static str {
        match self.engine {
            FarmEngine::OpenJd => "openjd run template.json",
            FarmEngine::Slurm => "sh submit.sh",
            FarmEngine::Dask => "python run.py",
            FarmEngine::Kubernetes => "kubectl apply -f job.json",
        }
    }

    /// The names and texts of its files.
    pub(super) fn files(&self) -> Vec<(&'static str, String)> {
        let mut files = match self.engine {
            FarmEngine::OpenJd => vec![("template.json", openjd::template(self))],
            FarmEngine::Slurm => slurm::scripts(self).to_vec(),
            FarmEngine::Dask => vec![("run.py", dask::driver(self))],
            FarmEngine::Kubernetes => array::kubernetes(self),
        };
        files.push(("README", self.readme()));
        files
    }

    /// A description, the commands that run it, and its result.
    fn readme(&self) -> String {
        let Self { title, retries, .. } = self;
        let whole = self.commands.whole(&example(self.frames)).join(" ");
        let run = match self.engine {
            FarmEngine::OpenJd => format!(
                "`openjd run template.json` here; on Deadline Cloud `deadline bundle submit` with \
                `--max-retries-per-task {retries}`"
            ),
            FarmEngine::Slurm => "`sh submit.sh` in this folder, which all nodes share".to_owned(),
            FarmEngine::Dask => {
                "`python run.py [SCHEDULER]` in this folder, which all workers share; one \
                 thread a worker"
                    .to_owned()
            }
            FarmEngine::Kubernetes => {
                "put this folder on the volume of the claim `rtc-job`, and `kubectl apply -f job.json`"
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
fn example(frames: &JobFrames) -> String {
    frames.names().into_iter().next().unwrap_or_default()
}
