//! One render: in the setting of the scene or to a target, up to the ray limit, as a
//! whole or strip by strip; with a bar that shows how far it is.

use super::super::progress::RenderProgress;
use super::super::{Failure, input, interrupt::Interrupt, output::Output, reporter::Reporter};
use super::budget::PictureClock;
use super::made::{EstimateSource, PictureQuality, error};
use super::{FinishedPicture, RenderSetup, halted};
use rtc_diag::Diagnostic;
use rtc_image::Image;
use rtc_pipeline::{
    Input, PictureSetup, RayCounter, RenderError, RenderObserver, RenderSubject, Traced,
};
use rtc_render::{Crop, Film, RayCounts};
use rtc_study::{
    CheckpointSink, CoarsePicture, PixelQuality, ProgressiveRender, RenderCallbacks, RenderGoal,
    RenderRequest, Stopped, TargetResult,
};
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;
use std::time::Duration;

/// A render, and its messages.
pub(super) struct RenderResult {
    pub(super) image: Image,
    pub(super) coverage: Vec<f32>,
    /// The quality of each pixel, if it grew towards a goal.
    pub(super) pixels: Vec<PixelQuality>,
    pub(super) counts: RayCounts,
    pub(super) elapsed: Duration,
    /// Its quality, if requested.
    pub(super) quality: Option<PictureQuality>,
}

impl RenderResult {
    /// A picture that grew towards a goal.
    fn reached(
        reached: TargetResult,
        goal: RenderGoal,
        elapsed: Duration,
        has_run_out: bool,
    ) -> Self {
        let TargetResult {
            image,
            coverage,
            quality: pixels,
            counts,
            samples,
            error,
            estimate,
            undersampled,
            coarse,
            light_samples: _,
        } = reached;
        let is_above = |target: &f64| undersampled.is_none() && coarse.is_none() && error > *target;
        let ends_above = goal
            .error
            .filter(|target| goal.time.is_none() && is_above(target));
        Self {
            image,
            coverage,
            pixels,
            counts,
            elapsed,
            quality: Some(PictureQuality {
                error,
                undersampled,
                known: EstimateSource::Growing {
                    estimate,
                    coarse,
                    samples,
                    has_run_out,
                    ends_above,
                },
            }),
        }
    }

    /// A warning if it ended above its target error.
    pub(super) fn above_target(&self, setup: &PictureSetup) -> Option<Diagnostic> {
        let PictureQuality {
            error,
            undersampled,
            ..
        } = self.quality.as_ref()?;
        setup.above_target(*error, *undersampled)
    }

    /// If the time was too short for it.
    pub(super) fn coarse(&self) -> Option<CoarsePicture> {
        self.quality.as_ref()?.coarse()
    }
}

/// The saved state of a picture with a target, and its checkpointer.
pub(super) struct ResumedRender<'a> {
    /// `None` if there is none.
    pub(super) begun: &'a [u8],
    pub(super) every: Duration,
    pub(super) save: &'a (dyn Fn(Vec<u8>) + Sync),
}

impl<'a> ResumedRender<'a> {
    fn into_keep(
        self,
        order: &RenderRequest,
        threads: usize,
        elapsed: &'a (dyn Fn() -> Duration + Sync),
    ) -> Result<CheckpointSink<'a>, RenderError> {
        let begun = (!self.begun.is_empty()).then(|| ProgressiveRender::load(self.begun, order));
        let begun = begun.transpose().map_err(|error| {
            RenderError::Refused(format!("the checkpoint can't be used: {error}"))
        })?;
        Ok(CheckpointSink {
            resumed_from: begun,
            every: self.every,
            threads: workers(threads),
            elapsed,
            save: self.save,
        })
    }
}

/// The number of threads, 0 for one per core.
pub(super) fn workers(threads: usize) -> usize {
    match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    }
}

impl RenderSetup {
    /// The picture in the setting of the scene, or the failure when it exceeds the ray limit.
    pub(super) fn trace(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        interrupt: &Interrupt,
        quiet: bool,
    ) -> Result<RenderResult, RenderError> {
        let progress = RenderProgress::start(window.pixels() as u64, quiet);
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        let traced = self.picture.trace(subject, (window, rays), &observer);
        let elapsed = progress.finish();
        let Traced {
            film,
            probed,
            quality: pixels,
        } = traced?;
        let Film {
            image,
            coverage,
            counts,
        } = film;
        Ok(RenderResult {
            image,
            coverage,
            pixels,
            counts,
            elapsed,
            quality: probed
                .as_ref()
                .map(|probed| PictureQuality::probed(probed, self.picture.goal.error)),
        })
    }

    /// The picture with the samples of its target, or the failure when it exceeds the ray limit;
    /// with checkpoints if requested.
    pub(super) fn approach(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        interrupt: &Interrupt,
        quiet: bool,
        kept: Option<ResumedRender<'_>>,
    ) -> Result<RenderResult, RenderError> {
        // Order the picture with what remains of the time.
        let setup = &self.picture;
        let time = setup
            .goal
            .time
            .map(|time| PictureClock::sampling(time, window));
        let order = setup.order(subject, window, time);
        let progress = RenderProgress::start(0, quiet);
        let begun = self.clock.begun();
        let elapsed = || begun.elapsed();
        // Resume from a saved state.
        let keep = kept.map(|kept| kept.into_keep(&order, setup.threads, &elapsed));
        let keep = keep.transpose()?;
        let begun = keep.as_ref().and_then(|keep| keep.resumed_from.as_ref());
        // Watch the limit of rays, the interrupt and the progress.
        let left = rays.saturating_sub(begun.map_or(0, ProgressiveRender::rays));
        let meter = RayCounter::new(left, window);
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        let watch = RenderCallbacks {
            on_pixel: &|step| {
                progress.step(step);
                !interrupt.is_raised() && meter.step(step)
            },
            is_stopped: observer.is_stopped,
            elapsed: &elapsed,
            round: &|state| {
                meter.begin_round();
                progress.round(state.pixels, state.error.map_or_else(String::new, error));
            },
        };
        // Sample until the goal is met.
        let reached = setup.renderer(subject);
        let reached = reached.map(|(validated, renderer)| {
            renderer.approach(&validated.lowered.scene, &order, &watch, keep)
        });
        let ran_out = subject.ran_out(&meter, &observer);
        let elapsed = progress.finish();
        // A limit ends the picture, or fails it if nothing is complete.
        let (reached, has_run_out) = match (reached?, ran_out) {
            (Ok(reached), None) => (reached, false),
            (Ok(reached), Some(_)) => (reached, true),
            (Err(Stopped), Some(diagnostic)) => return Err(RenderError::RanOut(diagnostic)),
            (Err(Stopped), None) => return Err(RenderError::Stopped),
        };
        Ok(RenderResult::reached(
            reached,
            order.goal,
            elapsed,
            has_run_out,
        ))
    }
}

impl RenderSetup {
    /// Renders one picture in strips of the given rows, and writes it.
    pub(super) fn shoot_strips(
        &self,
        rows: Option<u32>,
        (subject, path): (&mut RenderSubject, &Path),
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let setup = &self.picture;
        // Only one strip is in memory at a time.
        setup.check_strips(subject)?;
        let window = setup.window(&subject.validated.lowered.scene)?;
        let strip = PictureSetup::first_strip(window, rows);
        setup.check_memory(subject, strip)?;
        let output = Output::open(path, input)?;
        let progress = RenderProgress::start(window.pixels() as u64, reporter.is_quiet());
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        // Render strip by strip into the file.
        let order = (window, strip, input.rays());
        let mut rendered = None;
        let mut write = |file: &mut File| {
            let done = setup.render_strips(subject, order, input, &observer, file)?;
            let is_done = done.is_ok();
            rendered = Some(done);
            is_done.then_some(()).ok_or(ErrorKind::Other.into())
        };
        let written = output.commit_incrementally(&mut write, interrupt);
        let elapsed = progress.finish();
        // Report the end.
        let counts = match rendered {
            Some(Ok(counts)) => counts,
            Some(Err(error)) => return halted(error, input, reporter),
            None => return written,
        };
        written?;
        input::report_diagnostics(input, reporter)?;
        let size = [window.width, window.height];
        reporter.made(&FinishedPicture::new(path, setup, size, (counts, elapsed)));
        Ok(())
    }
}
