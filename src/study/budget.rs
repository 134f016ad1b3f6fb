//! Rendering within a time budget: first a coarse picture, then a complete one, then samples where
//! they reduce the error most. A pass that the time interrupts leaves complete tiles.

use super::noise::{ErrorBound, FilmNoise};
use super::progressive::ProgressiveRender;
use super::rounds::next_round;
use super::subject::Stopped;
use super::target::{
    Progress, RenderCallbacks, RenderRequest, TAIL, TargetResult, first_round, light_samples,
    new_render,
};
use super::target::{set_sampling, tail_of};
use rayon::prelude::*;
use rtc_color::Tone;
use rtc_ir::{Mode, Scene};
use rtc_render::{AnyWorld, Crop, ProgressiveFilm, RenderStep};
use std::time::Duration;

/// The block sizes of the coarse passes: one pixel of each block is sampled. A size of 1 is the
/// complete picture.
const BLOCKS: [usize; 4] = [8, 4, 2, 1];

/// A coarse picture: the time was too short for a sample in each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoarsePicture {
    /// The size of the largest blocks in which only one pixel was sampled; all pixels of a block
    /// have its value.
    pub block: u32,
    /// The estimated time after which each pixel would have a sample.
    pub complete_after: Duration,
}

/// The end of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PassEnd {
    Done,
    /// The time or the ray budget is used up.
    Interrupted,
}

/// A render with a time budget.
struct TimedRender<'run, 'watch> {
    world: &'run mut AnyWorld,
    watch: &'run RenderCallbacks<'watch>,
    progressive: ProgressiveRender,
    time: Duration,
}

/// Like [`super::approach`], with a time budget in wall-clock time, so the picture depends on the
/// machine. The coarsest pass is always completed.
pub(super) fn render_within(
    world: &mut AnyWorld,
    scene: &Scene,
    order: &RenderRequest,
    watch: &RenderCallbacks<'_>,
    time: Duration,
) -> Result<TargetResult, Stopped> {
    let progressive = new_render(scene.settings.light_samples, order);
    set_sampling(world, scene, progressive.light_samples);
    let mut timed = TimedRender {
        world,
        watch,
        progressive,
        time,
    };
    let is_toned = matches!(scene.settings.mode, Mode::Path(_));
    timed.reserve_output_time(order, is_toned.then_some(order.display));
    if let Some(complete_after) = timed.coarse_pass()? {
        return Ok(timed.coarse(order, complete_after));
    }
    timed.choose_lights(scene, order)?;
    timed.rounds(scene, order)
}

impl TimedRender<'_, '_> {
    fn elapsed(&self) -> Duration {
        (self.watch.elapsed)()
    }

    /// Takes the requested samples of all pixels; if the pass is timed and the time ends, of
    /// complete tiles only.
    fn pass(&mut self, is_timed: bool) -> Result<PassEnd, Stopped> {
        let (watch, time) = (self.watch, self.time);
        let is_late = || is_timed && (watch.elapsed)() > time;
        let on_pixel = |step: RenderStep| (watch.on_pixel)(step) && !is_late();
        match self.progressive.refine(self.world, &on_pixel, None) {
            true => Ok(PassEnd::Done),
            false if (watch.is_stopped)() => Err(Stopped),
            false => Ok(PassEnd::Interrupted),
        }
    }

    /// Takes one sample per replicate for one pixel of each block, with decreasing block sizes. If
    /// the time ends first, returns when the picture would be complete.
    fn coarse_pass(&mut self) -> Result<Option<Duration>, Stopped> {
        let (start, width) = (self.elapsed(), self.progressive.film.crop().width as usize);
        for block in BLOCKS {
            let is_one = |index: usize| {
                (index % width).is_multiple_of(block) && (index / width).is_multiple_of(block)
            };
            let all = 0..self.progressive.film.len();
            self.progressive.requested = all.map(|index| [u32::from(is_one(index)), 0]).collect();
            let is_coarsest = block == BLOCKS[0];
            let end = self.pass(!is_coarsest)?;
            if is_coarsest && end == PassEnd::Interrupted {
                // The ray budget is used up.
                return Err(Stopped);
            }
            let is_late = block > 1 && self.elapsed() > self.time;
            if end == PassEnd::Interrupted || is_late {
                let took = self.elapsed().saturating_sub(start).as_secs_f64();
                let pixels = self
                    .progressive
                    .film
                    .pixels()
                    .filter(|pixel| pixel.samples() > 0);
                let fraction = pixels.count() as f64 / self.progressive.film.len() as f64;
                return Ok(Some(start + Duration::from_secs_f64(took / fraction)));
            }
        }
        Ok(None)
    }

    /// Finds the best number of light samples, if that takes a small fraction of the time.
    fn choose_lights(&mut self, scene: &Scene, order: &RenderRequest) -> Result<(), Stopped> {
        /// The maximum number of samples for this search, at one light sample each.
        const SAMPLES: f64 = 1e5;
        const MAX_FRACTION: f64 = 0.1;
        let passed = self.elapsed();
        let remaining = self.time.saturating_sub(passed).as_secs_f64();
        let seconds_per_sample = passed.as_secs_f64() / self.progressive.film.samples() as f64;
        if seconds_per_sample * SAMPLES < MAX_FRACTION * remaining {
            let (count, tried) = light_samples(self.world, scene, order, self.watch)?;
            self.progressive.light_samples = count;
            self.progressive.film.counts = self.progressive.film.counts.plus(tried);
            set_sampling(self.world, scene, count);
        }
        Ok(())
    }

    /// Reserves the time that the output of the picture takes after the last sample, by a few
    /// grey rows.
    fn reserve_output_time(&mut self, order: &RenderRequest, tone: Option<(Tone, f64)>) {
        const ROWS: u32 = 32;
        // Make the rows.
        let rows = Crop {
            height: order.crop.height.min(ROWS),
            ..order.crop
        };
        let trial = ProgressiveRender {
            film: ProgressiveFilm::grey(rows, tone),
            requested: Vec::new(),
            rounds: 0,
            light_samples: 1,
            keeps_lights: order.keep_lights,
        };
        // Develop them.
        let start = self.elapsed();
        let undersampled = order.undersampled(self.world);
        let noise = FilmNoise::of(&trial.film, &undersampled);
        let bound = noise.bound(TAIL, order.goal.error);
        drop(trial.result(bound, &undersampled, order.values));
        let took = self.elapsed().saturating_sub(start);
        // The picture takes as much longer as it has more rows.
        let all = f64::from(order.crop.height) / f64::from(rows.height.max(1));
        self.time = self.time.saturating_sub(took.mul_f64(all));
    }

    /// Doubles the samples of all pixels until each has those of a first round, then adds samples
    /// where they reduce the error most, until the error or the time is reached.
    fn rounds(&mut self, scene: &Scene, order: &RenderRequest) -> Result<TargetResult, Stopped> {
        // Set up the round sizes.
        let [first, pilot] = first_round(scene, order, self.world);
        let (start, before) = (self.elapsed(), self.progressive.film.samples());
        let undersampled = order.undersampled(self.world);
        // If only the time ends the render, no early stop biases the error bound.
        let tail = |rounds| order.goal.error.map_or(TAIL, |_| tail_of(rounds));
        let (mut replicate, mut error) = (1, None);
        // Refine until the error or the time is reached.
        loop {
            let requested = if replicate < first || self.progressive.requested[0][1] == 0 {
                replicate = first.min(2 * replicate);
                vec![[replicate, pilot.min(replicate.max(2))]; self.progressive.film.len()]
            } else {
                let noise = FilmNoise::of(&self.progressive.film, &undersampled);
                let tail = tail(self.progressive.rounds);
                error = Some(noise.bound(tail, order.goal.error).error);
                let took = self.elapsed().saturating_sub(start).as_secs_f64();
                let remaining = self.time.saturating_sub(self.elapsed()).as_secs_f64();
                let samples = (self.progressive.film.samples() - before) as f64;
                let most = samples * remaining / took.max(1e-9);
                match next_round(&self.progressive.film, &noise, tail, order.goal.error, most) {
                    Some(requested) => requested,
                    None => break,
                }
            };
            self.progressive.requested = requested;
            self.progressive.rounds += 1;
            let pixels = self.progressive.film.len() as u64;
            (self.watch.round)(Progress { pixels, error });
            if self.pass(true)? == PassEnd::Interrupted {
                break;
            }
        }
        let noise = FilmNoise::of(&self.progressive.film, &undersampled);
        let bound = noise.bound(tail(self.progressive.rounds), order.goal.error);
        Ok(self.progressive.result(bound, &undersampled, order.values))
    }

    /// The coarse picture: pixels without a sample get the value of the sampled pixel of their
    /// block, above and to the left.
    fn coarse(&self, order: &RenderRequest, complete_after: Duration) -> TargetResult {
        let film = &self.progressive.film;
        let width = film.crop().width as usize;
        // Find the finest complete block of each pixel.
        let has_samples = |index: usize| film.pixel(index).samples() > 0;
        let corner = |index: usize, block: usize| {
            let (x, y) = (index % width, index / width);
            (y - y % block) * width + x - x % block
        };
        let finest = |index: usize| {
            let mut blocks = BLOCKS.into_iter().rev();
            blocks
                .find(|block| has_samples(corner(index, *block)))
                .unwrap_or(BLOCKS[0])
        };
        let blocks: Vec<_> = (0..film.len()).into_par_iter().map(finest).collect();
        // Without an estimate, the error is unbounded.
        let nothing = ErrorBound {
            error: f64::INFINITY,
            estimate: f64::INFINITY,
            undersampled: None,
        };
        let undersampled = order.undersampled(self.world);
        let mut reached = self
            .progressive
            .result(nothing, &undersampled, order.values);
        // Copy the corner of a block to its pixels.
        for (index, block) in blocks.iter().enumerate() {
            reached.image.pixels[index] = reached.image.pixels[corner(index, *block)];
            reached.coverage[index] = reached.coverage[corner(index, *block)];
            if *block > 1 {
                let quality = &mut reached.quality[index];
                (quality.error, quality.undersampled) = ([1.0; 3], 1.0);
            }
        }
        let block = blocks.into_iter().max().unwrap_or(1);
        reached.coarse = Some(CoarsePicture {
            block: u32::try_from(block).unwrap_or(u32::MAX),
            complete_after,
        });
        reached
    }
}
