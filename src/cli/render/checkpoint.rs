//! A render with checkpoints: finished parts are saved in a `.rtp` file, and the same command
//! resumes, with the same bytes. Finished frames of a turntable are kept as well.

use super::super::merge::{read_part, unfit};
use super::super::output::Output;
use super::super::progress::RenderProgress;
use super::super::turntable::{self, Turntable, TurntableViews};
use super::super::{Failure, args, input, interrupt::Interrupt, reporter, reporter::Reporter};
use super::rendering::{ResumedRender, workers};
use super::{FinishedPicture, RenderSetup, halted};
use rtc_image::Picture;
use rtc_math::to_u32;
use rtc_pipeline::{
    AtomicFile, Input, MAX_SHARDS, RenderError, RenderObserver, RenderShard, RenderSubject,
    ShardDivision, ShardPlan, hash_of_file,
};
use rtc_render::{Crop, Tiles};
use rtc_source::{Loader, Resource, SourceMap};
use rtc_study::{RenderGoal, WorkBatch};
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Where and how often a render is saved.
pub(super) struct Checkpoint {
    file: PathBuf,
    every: Duration,
    restarts: bool,
}

/// The hint for a checkpoint that can't be resumed.
pub(crate) fn or_restart(failure: Failure) -> Failure {
    match failure {
        Failure::Input(message) => Failure::Input(format!("{message}; `--restart` starts over")),
        other @ (Failure::Reported
        | Failure::Unreadable
        | Failure::Failed(_)
        | Failure::Interrupted
        | Failure::ClosedPipe) => other,
    }
}

/// A picture that is saved on its way.
pub(super) struct CheckpointedRender<'c> {
    checkpoint: &'c Checkpoint,
    /// The destination of the picture.
    pub(super) output: PathBuf,
    /// The hashes of the pictures that were finished before it.
    pub(super) finished: Vec<String>,
    /// The saved state, until it is resumed.
    pub(super) saved: Option<RenderShard>,
}

/// Findings, talk, and whether to stop.
pub(super) type RunContext<'d> = (&'d mut Input, &'d mut Reporter, &'d Interrupt);

impl<'c> CheckpointedRender<'c> {
    /// Reads the checkpoint, and checks that the file can be written, before the render.
    pub(super) fn begin(
        checkpoint: &'c Checkpoint,
        output: &Path,
        input: &Input,
    ) -> Result<Self, Failure> {
        Output::open(&checkpoint.file, input).map(drop)?;
        let saved = checkpoint.read(input)?;
        Ok(Self {
            checkpoint,
            output: output.to_owned(),
            finished: saved
                .as_ref()
                .map_or_else(Vec::new, |saved| saved.finished().to_vec()),
            saved,
        })
    }

    /// The message for a checkpoint that can't be resumed.
    pub(super) fn refused(&self, error: &dyn fmt::Display) -> Failure {
        or_restart(unfit(&self.checkpoint.file, error))
    }
}

impl Checkpoint {
    /// The requested checkpoint, if any.
    pub(super) fn new(args: &args::RenderArgs) -> Option<Self> {
        Some(Self {
            file: args.checkpoint.clone()?,
            every: args.every,
            restarts: args.restart,
        })
    }

    /// The saved state, if the render resumes.
    fn read(&self, input: &Input) -> Result<Option<RenderShard>, Failure> {
        if self.restarts || !self.file.exists() {
            return Ok(None);
        }
        let max_pixels = input.map().budget().limit(Resource::Pixels);
        // Noted in no map that matters: the file is written again.
        let saved = read_part(&self.file, max_pixels, &SourceMap::default());
        saved.map(Some).map_err(or_restart)
    }

    /// Saves the state atomically, with a warning if that fails: the render continues.
    fn try_save(&self, part: &RenderShard) -> bool {
        try_save(&self.file, &part.save())
    }
}

impl RenderSetup {
    /// Renders the picture, saving it on its way, and writes it; its hash is noted.
    pub(super) fn shoot_saving(
        &self,
        saving: &mut CheckpointedRender<'_>,
        subject: &mut RenderSubject,
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(), Failure> {
        let (window, output) = self.ready(subject, &saving.output, input)?;
        let mut done = self.begun(saving, subject, window)?;
        if !saving.finished.is_empty() {
            saving.checkpoint.try_save(&done);
        }
        let order = (window, input.rays());
        let run_context = (&mut *input, &mut *reporter, interrupt);
        let (picture, made) = match has_goal(self.picture.goal) {
            false => self.share_by_share(saving, subject, &mut done, order, run_context)?,
            true => self.round_by_round(saving, subject, &mut done, order, run_context)?,
        };
        let bytes = self.picture.encode(&picture, subject)?;
        let written = output.commit(&bytes, interrupt);
        if interrupt.is_raised() {
            saving.checkpoint.end(&done);
        }
        written?;
        saving.finished.push(hash_of_file(&bytes));
        input::report_diagnostics(input, reporter)?;
        reporter.made(&made);
        Ok(())
    }

    /// The saved state of the picture; without finished shares if nothing was saved.
    pub(super) fn begun(
        &self,
        saving: &mut CheckpointedRender<'_>,
        subject: &mut RenderSubject,
        window: Crop,
    ) -> Result<RenderShard, Failure> {
        let nobody = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        let order = (shares(window, [1, 0]), window, u64::MAX);
        let done = self.picture.part(subject, order, &nobody)?;
        let mut done = done.after(saving.finished.clone());
        if let Some(saved) = saving.saved.take() {
            done.add(saved).map_err(|error| saving.refused(&error))?;
        }
        Ok(done)
    }

    /// The picture by shares, with its messages.
    fn share_by_share(
        &self,
        saving: &CheckpointedRender<'_>,
        subject: &mut RenderSubject,
        done: &mut RenderShard,
        (window, rays): (Crop, u64),
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(Picture, FinishedPicture), Failure> {
        let progress = RenderProgress::start(window.pixels() as u64, reporter.is_quiet());
        let watch = (interrupt, &progress);
        let traced = self.trace_saving(saving.checkpoint, subject, done, (window, rays), watch);
        let elapsed = progress.finish();
        if let Err(error) = traced {
            return Err(ended(error, input, reporter));
        }
        // Should the picture not be written, its samples are not lost.
        saving.checkpoint.try_save(done);
        let developed = done.develop();
        let (picture, counts, found) =
            developed.map_err(|error| Failure::Failed(error.to_string()))?;
        found
            .into_iter()
            .for_each(|diagnostic| input.push(diagnostic));
        let size = [picture.image.width, picture.image.height];
        let work = (counts, elapsed);
        let made = FinishedPicture::new(&saving.output, &self.picture, size, work);
        Ok((picture, made))
    }

    /// The picture rendered to its target, with its messages.
    fn round_by_round(
        &self,
        saving: &CheckpointedRender<'_>,
        subject: &mut RenderSubject,
        done: &mut RenderShard,
        order: (Crop, u64),
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(Picture, FinishedPicture), Failure> {
        // Save the film after rounds of samples.
        let begun = done.take_growth();
        let (checkpoint, is_saved) = (saving.checkpoint, AtomicBool::new(false));
        let save = |growth: Vec<u8>| {
            let mut part = done.clone();
            part.grow(growth);
            is_saved.store(checkpoint.try_save(&part), Ordering::Relaxed);
        };
        let kept = ResumedRender {
            begun: &begun,
            every: checkpoint.every,
            save: &save,
        };
        // Continue from the saved film until the goal is met.
        let rendering = self.approach(subject, order, interrupt, reporter.is_quiet(), Some(kept));
        // After an error, the last saved state remains.
        let rendering = match rendering {
            Ok(rendering) => rendering,
            Err(error) => {
                if is_saved.into_inner() {
                    checkpoint.report_saved("the state");
                }
                return Err(ended(error, input, reporter));
            }
        };
        // Develop the picture.
        let above_target = rendering.above_target(&self.picture);
        above_target.into_iter().for_each(|found| input.push(found));
        let size = [rendering.image.width, rendering.image.height];
        let work = (rendering.counts, rendering.elapsed);
        let made =
            FinishedPicture::new(&saving.output, &self.picture, size, work).with(rendering.quality);
        let film = (rendering.image, rendering.coverage, &rendering.counts);
        let is_stopped = || interrupt.is_raised();
        let picture = self
            .picture
            .develop(subject, film, &rendering.pixels, input, &is_stopped)?;
        Ok((picture, made))
    }

    /// Renders the missing shares of the picture, with checkpoints.
    fn trace_saving(
        &self,
        checkpoint: &Checkpoint,
        subject: &mut RenderSubject,
        done: &mut RenderShard,
        (window, rays): (Crop, u64),
        (interrupt, progress): (&Interrupt, &RenderProgress),
    ) -> Result<(), RenderError> {
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        let mut batch = WorkBatch::new(checkpoint.every, workers(self.picture.threads));
        let mut saved = progress.elapsed();
        while let Some(next) = next(done, batch.shards()) {
            let begun = progress.elapsed();
            let left = rays.saturating_sub(done.counts().rays());
            let order = (shares(window, next), window, left);
            let part = self.picture.part(subject, order, &observer);
            if let Err(RenderError::Stopped) = part {
                checkpoint.end(done);
            }
            let added = done.add(part?);
            added.map_err(|error| RenderError::Refused(error.to_string()))?;
            let now = progress.elapsed();
            batch.adapt(next[1] - next[0] + 1, now.saturating_sub(begun));
            if now.saturating_sub(saved) >= checkpoint.every {
                checkpoint.try_save(done);
                saved = progress.elapsed();
            }
        }
        Ok(())
    }
}

/// Why a command ends whose render came to no end.
pub(crate) fn ended(error: RenderError, input: &mut Input, reporter: &mut Reporter) -> Failure {
    halted(error, input, reporter)
        .err()
        .unwrap_or(Failure::Reported)
}

/// Whether the picture has a target instead of a number of samples.
fn has_goal(goal: RenderGoal) -> bool {
    goal != RenderGoal::default()
}

/// Shares of a picture of about one tile each.
fn shares(window: Crop, [first, last]: [u32; 2]) -> ShardPlan {
    let count = u32::try_from(Tiles::of(window).count()).unwrap_or(MAX_SHARDS);
    ShardPlan {
        by: ShardDivision::Tiles,
        first,
        last,
        count: count.clamp(1, MAX_SHARDS),
    }
}

impl Checkpoint {
    /// Saves before the end, and prints how to resume.
    fn end(&self, part: &RenderShard) {
        let (shares, count) = part.shares();
        let (shares, finished) = (shares.len(), part.finished().len());
        if shares + finished > 0 && self.try_save(part) {
            let frames = match finished {
                0 => String::new(),
                _ => format!("{finished} finished and of the next "),
            };
            self.report_saved(&format!("{frames}{shares} of {count} shares"));
        }
    }

    /// Prints how to resume.
    fn report_saved(&self, what: &str) {
        print_saved(&self.file, what);
    }
}

/// Prints the saved progress, and how to resume.
pub(crate) fn print_saved(file: &Path, what: &str) {
    let file = file.display();
    reporter::print_message(&format!(
        "saved {what} in `{file}`; the same command resumes"
    ));
}

/// Tells after an interrupt, unless there was a checkpoint, that one keeps the work.
pub(crate) fn or_unsaved(outcome: &Result<(), Failure>, checkpoint: Option<&Path>, quiet: bool) {
    if matches!(outcome, Err(Failure::Interrupted)) && checkpoint.is_none() && !quiet {
        reporter::print_message(
            "interrupted: nothing is saved; with `--checkpoint FILE` the same command resumes",
        );
    }
}

/// Saves the state atomically, with a warning if that fails: the work continues.
pub(crate) fn try_save(file: &Path, bytes: &[u8]) -> bool {
    let saved = AtomicFile::save(file, bytes);
    if let Err(error) = &saved {
        let file = file.display();
        reporter::print_message(&format!(
            "warning: `{file}` can't be written: {error}; the render continues, and the last \
            checkpoint stays"
        ));
    }
    saved.is_ok()
}

/// The first range of missing shares, at most of the given length.
fn next(done: &RenderShard, most: u32) -> Option<[u32; 2]> {
    let mut missing = done.missing();
    let first = missing.next()?;
    let last = missing
        .zip(first + 1..first.saturating_add(most))
        .take_while(|(share, expected)| share == expected)
        .last();
    Some([first, last.map_or(first, |(share, _)| share)])
}

/// The largest picture file whose hash is checked, in bytes.
const MAX_BYTES: u64 = 1 << 36;

impl RenderSetup {
    /// Renders the frames that are missing, and writes them.
    pub(super) fn turn_saving(
        &self,
        views: &TurntableViews,
        mut saving: CheckpointedRender<'_>,
        subject: &mut RenderSubject,
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(), Failure> {
        let table = Turntable::new(&subject.validated.lowered.scene, self.up, views.count);
        let path = |frame| turntable::name(&self.output, frame);
        let mut frames = views.shown.clone();
        let Range { start, end } = frames;
        frames.try_for_each(|frame| Output::open(&path(frame), input).map(drop))?;
        let turn = |subject: &mut RenderSubject, frame| {
            table.turn(&mut subject.validated, frame)?;
            subject.turn();
            Ok::<(), Failure>(())
        };
        let finished = saving.finished.clone();
        let begun = to_u32(finished.len());
        let begun = start.saturating_add(begun);
        if begun >= end {
            let count = end - start;
            return Err(saving.refused(&format!("it is of more than {count} frames")));
        }
        if saving.saved.is_some() {
            // The checkpoint is checked against the scene before any frame is rendered.
            turn(subject, begun)?;
            let window = self.picture.window(&subject.validated.lowered.scene)?;
            saving.saved = Some(self.begun(&mut saving, subject, window)?);
        }
        for (frame, hash) in
            (start..end).zip(finished.iter().map(Some).chain(std::iter::repeat(None)))
        {
            let output = path(frame);
            if hash.is_some_and(|hash| is_there(&output, hash)) {
                continue;
            }
            turn(subject, frame)?;
            if hash.is_some() {
                self.render_picture(subject, &output, input, reporter, interrupt)?;
            } else {
                saving.output = output;
                self.shoot_saving(
                    &mut saving,
                    subject,
                    (&mut *input, &mut *reporter, interrupt),
                )?;
            }
        }
        Ok(())
    }
}

/// Whether a file has this hash.
fn is_there(path: &Path, hash: &str) -> bool {
    let bytes = Loader.bytes(path, MAX_BYTES, &SourceMap::default());
    bytes.is_ok_and(|bytes| hash_of_file(&bytes) == hash)
}
