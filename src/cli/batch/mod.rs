//! `rtc farm`: a picture in parts as a job for an engine that runs jobs on many machines. The scene
//! is compiled first, so that workers need no assets. The job is written, never run.

mod commands;
mod frames;
mod jobs;

use super::Failure;
use super::args::{FarmArgs, ReadArgs};
use super::input;
use super::interrupt::Interrupt;
use super::project;
use super::render::{refuse_layers, set_stage, wanted};
use super::reporter::{self, Reporter};
use frames::JobFrames;
use jobs::FarmJob;
use rtc_codec as codec;
use rtc_pipeline::{AtomicFolder, Input, RenderSubject, hash};
use rtc_study::RenderGoal;
use std::ffi::OsStr;
use std::io;
use std::path::Path;

/// Compiles the scene, at each moment of an animation, and writes the folder.
pub(super) fn run(args: &FarmArgs) -> Result<(), Failure> {
    // Check the names, and read the first scene, before anything is written.
    refuse_name(&args.picture)?;
    let frames = JobFrames::new(args)?;
    let mut first = Some(staged(args, frames.first_time())?);
    let folder = AtomicFolder::at(&args.output).map_err(|error| failure(args, &error))?;
    let interrupt = Interrupt::listen()?;
    let mut reporter = Reporter::beside_result(&args.reporter);
    // Write one scene per frame.
    let mut hashes = Vec::new();
    for (name, time) in frames.scenes() {
        let input = first.take().map_or_else(|| staged(args, time), Ok);
        let subject = input.and_then(|input| settled(args, input, &mut reporter, &interrupt));
        let written = subject.and_then(|subject| {
            let scene = &subject.validated.lowered.scene;
            hashes.push(hash(scene));
            let written = codec::prepare_with_trees(scene)
                .map_err(|codec::NonFiniteNumber| io::Error::other("a number is not finite"))
                .and_then(|scene| folder.put(&name, &|out| scene.write(out), &interrupt));
            written.map_err(|error| stopped_or(args, &error, &interrupt))
        });
        if written.is_err() {
            reporter.finish()?;
            return written;
        }
    }
    reporter.finish()?;
    // Write the descriptions of the job.
    let job = FarmJob::new(args, &frames, &hashes);
    let mut files = job.files().into_iter();
    let written = files.try_for_each(|(name, text)| {
        folder.put(name, &|out| out.write_all(text.as_bytes()), &interrupt)
    });
    // The folder appears under its name when it is complete.
    let placed = written.and_then(|()| folder.place(&interrupt));
    placed.map_err(|error| stopped_or(args, &error, &interrupt))?;
    if !args.reporter.quiet {
        let (folder, picture, run) = (args.output.display(), &args.picture, job.how_to_run());
        let parts = args.parts;
        reporter::print_message(&format!(
            "{folder}: {picture} in {parts} parts; in the folder, `{run}` runs them"
        ));
    }
    Ok(())
}

/// The scene to be read, at a moment of its animation if one is given.
fn staged(args: &FarmArgs, time: Option<f64>) -> Result<Input, Failure> {
    let reading = ReadArgs {
        time: time.or(args.reading.time),
        ..args.reading.clone()
    };
    let mut input = input::staged(&args.file, &reading, &args.stage)?;
    set_stage(&mut input, &args.look, args.turntable);
    Ok(input)
}

/// The scene with all settings of the pictures in it, and for a PNG how it is shown.
fn settled(
    args: &FarmArgs,
    mut input: Input,
    reporter: &mut Reporter,
    interrupt: &Interrupt,
) -> Result<RenderSubject, Failure> {
    let mut setup = wanted(&args.wanted, &args.look, Path::new(&args.picture))?;
    refuse_layers(&setup)?;
    let settled = project::picture(&args.file, &args.reading, RenderGoal::default())?;
    setup.overrides = setup.overrides.or(settled);
    let mut subject = input::subject(&mut setup, &mut input, reporter)?;
    let scene = &subject.validated.lowered.scene;
    setup.window(scene)?;
    setup.separable(scene, args.parts_by.into())?;
    input::light(&mut setup, &mut subject, &mut input, interrupt, reporter)?;
    if !setup.look.kind.is_linear() {
        subject.validated.lowered.scene.display = setup.look.as_display();
    }
    // Each part would build the same hierarchy.
    setup.store_tree(&mut subject)?;
    Ok(subject)
}

/// Refuses a name that a job of some engine would read as more than a name.
fn refuse_name(picture: &str) -> Result<(), Failure> {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
    let is_name = Path::new(picture).file_name() == Some(OsStr::new(picture));
    let is_taken = picture.starts_with(['-', '.']);
    if is_name && !is_taken && picture.len() <= 100 && picture.chars().all(is_plain) {
        return Ok(());
    }
    Err(Failure::Failed(
        "the picture of a job has a name of at most 100 letters, digits, `-`, `_` and `.`, as picture.exr"
            .to_owned(),
    ))
}

fn stopped_or(args: &FarmArgs, error: &io::Error, interrupt: &Interrupt) -> Failure {
    match interrupt.is_raised() {
        true => Failure::Interrupted,
        false => failure(args, error),
    }
}

fn failure(args: &FarmArgs, error: &io::Error) -> Failure {
    Failure::Failed(format!("can't make `{}`: {error}", args.output.display()))
}
