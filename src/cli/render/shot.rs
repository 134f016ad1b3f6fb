//! One render: as the scene says or until a goal is reached, or where its rays ran out.

use super::super::Failure;
use super::super::interrupt::Interrupt;
use super::super::progress::{self, RenderProgress};
use super::{RenderSetup, Subject, no_threads};
use crate::diag::Diagnostic;
use crate::image::Image;
use crate::pipeline::{self, Meter};
use crate::plan::{Effect, Rule};
use crate::render::{Counts, Crop, Film, Job, Mismatch};
use crate::study::{Order, Reached, Samples, Stopped, Watch};
use indicatif::HumanCount;
use std::path::Path;
use std::time::Duration;

/// What was rendered, and what is said of it.
pub(super) struct Rendered {
    pub(super) image: Image,
    pub(super) coverage: Vec<f32>,
    pub(super) counts: Counts,
    pub(super) elapsed: Duration,
    /// How good it is, if that was asked.
    pub(super) quality: Option<String>,
}

impl Rendered {
    /// What is said of it, with what is told of its light; if `verbose`, with how often each effect was
    /// simulated.
    pub(super) fn summary(&self, path: &Path, light: &str, verbose: bool) -> String {
        let Self {
            image,
            counts,
            elapsed,
            quality,
            coverage: _,
        } = self;
        let work = progress::summary(counts.rays(), *elapsed);
        let line = format!(
            "{}: {}×{}, {light}{work}",
            path.display(),
            image.width,
            image.height
        );
        let effects = verbose.then(|| simulated(counts));
        let lines = [Some(line), effects, quality.clone()];
        lines.into_iter().flatten().collect::<Vec<_>>().join("\n")
    }
}

/// How often each effect was simulated: its rays, or its evaluations.
fn simulated(counts: &Counts) -> String {
    let effects = Effect::OF_PATHS.into_iter().chain(Effect::OF_THE_COURSE);
    let counted = effects.map(|effect| (effect.name(), counts.of(effect)));
    let some = counted.filter(|(_, count)| *count > 0);
    let words = some.map(|(name, count)| format!("{name} {}", HumanCount(count)));
    format!("simulated: {}", words.collect::<Vec<_>>().join("; "))
}

impl RenderSetup {
    /// The picture in the setting of the scene, or where its rays ran out, of which there may be so
    /// many.
    pub(super) fn trace(
        &self,
        subject: &mut Subject,
        (window, rays): (Crop, u64),
        interrupt: &Interrupt,
        quiet: bool,
    ) -> Result<Result<Rendered, Box<Diagnostic>>, Failure> {
        let scene = &subject.proven.scene;
        let values = self.look.values(&scene.settings().mode);
        let job = Job {
            crop: Some(window),
            values,
            background: self.look.background(),
            ..Job::default()
        };
        let progress =
            RenderProgress::start(u64::from(window.width) * u64::from(window.height), quiet);
        let renders = if self.verify { 2 } else { 1 };
        let meter = Meter::of_each(rays, window, renders);
        let on_pixel = |step| {
            progress.step(step);
            !interrupt.is_raised() && meter.step(step)
        };
        let film = if self.verify {
            pipeline::verify(scene, &self.plan(scene), &job, self.threads, &on_pixel)
        } else {
            self.renderer(subject)
                .map(|(_, renderer)| renderer.render(&job, &on_pixel).map(Ok))
        };
        let elapsed = progress.finish();
        let film = film.map_err(no_threads)?;
        if let Some(finding) = ran_out(&meter, subject, interrupt) {
            return Ok(Err(finding));
        }
        let film = film.ok_or(Failure::Interrupted)?;
        let Film {
            image,
            coverage,
            counts,
        } = film.map_err(|mismatch| Failure::Trouble(left_out(&mismatch)))?;
        Ok(Ok(Rendered {
            image,
            coverage,
            counts,
            elapsed,
            quality: None,
        }))
    }

    /// The picture with the samples that its goal takes, or where its rays ran out.
    pub(super) fn approach(
        &self,
        subject: &mut Subject,
        (window, rays): (Crop, u64),
        interrupt: &Interrupt,
        quiet: bool,
    ) -> Result<Result<Rendered, Box<Diagnostic>>, Failure> {
        let order = Order {
            goal: self.goal,
            crop: window,
            background: self.look.background(),
            values: self.look.values(&subject.proven.scene.settings().mode),
            display: self.look.display(&subject.proven.scene.settings().mode),
            keep_lights: self.overrides.light_samples.is_some(),
            seed: 0,
        };
        let progress = RenderProgress::start(0, quiet);
        let meter = Meter::new(rays, window);
        let watch = Watch {
            on_pixel: &|step| {
                progress.step(step);
                !interrupt.is_raised() && meter.step(step)
            },
            is_stopped: &|| interrupt.is_raised(),
            elapsed: &|| progress.elapsed(),
            round: &|state| {
                meter.begin_round();
                progress.round(state.pixels, state.error.map_or_else(String::new, error));
            },
        };
        let reached = self.renderer(subject);
        let reached = reached
            .map(|(proven, renderer)| renderer.approach(&proven.lowered.scene, &order, &watch));
        let elapsed = progress.finish();
        let ran_out = ran_out(&meter, subject, interrupt);
        let (reached, end) = match (reached.map_err(no_threads)?, ran_out) {
            (Ok(reached), None) => (reached, ""),
            (Ok(reached), Some(_)) => (reached, ", ended by `--limit rays`"),
            (Err(Stopped), Some(finding)) => return Ok(Err(finding)),
            (Err(Stopped), None) => return Err(Failure::Interrupted),
        };
        let Reached {
            image,
            coverage,
            counts,
            samples: Samples { min, mean, most },
            ..
        } = reached;
        let quality = format!(
            "{} (90 %), {mean:.0} samples a pixel on the mean, {min} … {most}{end}",
            error(reached.error)
        );
        Ok(Ok(Rendered {
            image,
            coverage,
            counts,
            elapsed,
            quality: Some(quality),
        }))
    }
}

/// What to say if the rays ran out, unless a signal ended the render.
fn ran_out(meter: &Meter, subject: &Subject, interrupt: &Interrupt) -> Option<Box<Diagnostic>> {
    let pixel = meter.ran_out().filter(|_| !interrupt.is_raised())?;
    Some(Box::new(meter.finding(&subject.proven.lowered, pixel)))
}

/// What to say of a rule that was wrong.
fn left_out(mismatch: &Mismatch) -> String {
    let Mismatch {
        pixel: [x, y],
        effect,
        rule,
        what,
    } = mismatch;
    let rule = rule.map_or("no rule", Rule::name);
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "internal error: {}, left out by {rule}: {what} at pixel {x}, {y}\n\
         This is a fault of rtc {version}, please report it with the scene.",
        effect.name()
    )
}

/// An error in grey levels, in words.
fn error(levels: f64) -> String {
    // Rounded up, so that the words promise no more than was measured.
    format!("error ≤ {:.2} grey levels", (levels * 100.0).ceil() / 100.0)
}
