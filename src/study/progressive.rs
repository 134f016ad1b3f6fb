//! Progressive refinement with checkpoints. A render that is resumed from a checkpoint gives the
//! same bytes: a round takes the samples that are missing.

use super::batch::WorkBatch;
use super::noise::ErrorBound;
use super::target::{RenderRequest, SampleStatistics, TargetResult};
use super::undersampled::UndersampledBound;
use rtc_render::{AnyWorld, FilmError, PixelObserver, ProgressiveFilm, Replicates, Tiles, Values};
use std::time::Duration;

/// The state of a progressive render.
pub struct ProgressiveRender {
    pub(super) film: ProgressiveFilm,
    /// For each pixel, the samples of each replicate and of the pilot after the current round.
    pub(super) requested: Vec<[u32; 2]>,
    /// The number of completed rounds.
    pub(super) rounds: u32,
    /// Samples of each area light at a hit.
    pub(super) light_samples: u32,
    /// Whether that number was requested.
    pub(super) keeps_lights: bool,
}

/// Saving and resuming of a progressive render.
pub struct CheckpointSink<'a> {
    /// The checkpoint to resume from.
    pub resumed_from: Option<ProgressiveRender>,
    /// The time between two saves.
    pub every: Duration,
    /// The number of threads.
    pub threads: usize,
    /// The time since the start.
    pub elapsed: &'a (dyn Fn() -> Duration + Sync),
    /// Saves the bytes of a checkpoint.
    pub save: &'a (dyn Fn(Vec<u8>) + Sync),
}

/// Saves checkpoints at intervals.
pub(super) struct Checkpointer<'a> {
    sink: CheckpointSink<'a>,
    batch: WorkBatch,
    saved: Duration,
}

impl<'a> Checkpointer<'a> {
    pub(super) fn new(sink: CheckpointSink<'a>) -> Self {
        Self {
            batch: WorkBatch::new(sink.every, sink.threads),
            saved: (sink.elapsed)(),
            sink,
        }
    }

    /// The checkpoint to resume from.
    pub(super) fn resumed_from(&mut self) -> Option<ProgressiveRender> {
        self.sink.resumed_from.take()
    }

    /// Saves a checkpoint now.
    pub(super) fn save(&self, progressive: &ProgressiveRender) {
        (self.sink.save)(progressive.save());
    }

    /// Adapts the batch size to the time of the last batch, and saves if it is time.
    fn record_batch(
        &mut self,
        progressive: &ProgressiveRender,
        tiles: u32,
        resumed_from: Duration,
    ) {
        let now = (self.sink.elapsed)();
        self.batch.adapt(tiles, now.saturating_sub(resumed_from));
        if now.saturating_sub(self.saved) >= self.sink.every {
            self.save(progressive);
            self.saved = (self.sink.elapsed)();
        }
    }
}

impl ProgressiveRender {
    /// The number of rays so far.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.film.counts.rays()
    }

    /// Takes the missing samples of the round and saves checkpoints; false if it was stopped.
    pub(super) fn refine(
        &mut self,
        world: &AnyWorld,
        on_pixel: &PixelObserver<'_>,
        checkpointer: Option<&mut Checkpointer<'_>>,
    ) -> bool {
        let Some(checkpointer) = checkpointer else {
            let requested = |index: usize| self.requested[index];
            return world.grow(&mut self.film, &requested, on_pixel);
        };
        let count = Tiles::of(self.film.crop()).count();
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        let mut done = 0;
        while done < count {
            let last = count.min(done.saturating_add(checkpointer.batch.shards()));
            let resumed_from = (checkpointer.sink.elapsed)();
            self.film.tiles = Some(Tiles::shares([done + 1, last], count));
            let requested = |index: usize| self.requested[index];
            let is_done = world.grow(&mut self.film, &requested, on_pixel);
            self.film.tiles = None;
            if !is_done {
                checkpointer.save(self);
                return false;
            }
            checkpointer.record_batch(self, last - done, resumed_from);
            done = last;
        }
        true
    }

    /// The current picture with a bound on its error.
    pub(super) fn result(
        &self,
        bound: ErrorBound,
        undersampled: &UndersampledBound,
        values: Values,
    ) -> TargetResult {
        TargetResult {
            image: self.film.image(values),
            coverage: self.film.coverage(),
            quality: self.film.map(|pixel| undersampled.quality(pixel)),
            counts: self.film.counts,
            error: bound.error,
            estimate: bound.estimate,
            undersampled: bound.undersampled,
            coarse: None,
            samples: samples_of(&self.film),
            light_samples: self.light_samples,
        }
    }

    /// The state as bytes: rounds, light samples and whether they were requested, the requested
    /// samples, the film.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let requested = self.requested.iter().flatten();
        let keeps = u32::from(self.keeps_lights);
        let numbers = [self.rounds, self.light_samples, keeps, 0].into_iter();
        let numbers = numbers.chain(requested.copied());
        let mut bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        bytes.extend(self.film.save());
        bytes
    }

    /// Loads the state of a render of an order.
    ///
    /// # Errors
    /// If the bytes belong to another render or version, or are corrupt.
    pub fn load(bytes: &[u8], order: &RenderRequest) -> Result<Self, FilmError> {
        /// The maximum number of rounds.
        const MAX_ROUNDS: u32 = 1 << 16;
        const MAX_LENGTH: u32 = 1 << 24;
        const SHORT: FilmError = FilmError::Corrupt("its end is missing");
        const WRONG: FilmError = FilmError::Corrupt("its number of rounds is invalid");
        // Split the bytes into numbers and film.
        let length = 8 * (order.crop.pixels() + 2);
        let (numbers, film) = bytes.split_at_checked(length).ok_or(SHORT)?;
        // The film checks its number of pixels.
        let film = order.film().load(film)?;
        // Read the numbers.
        let mut pairs = numbers.chunks_exact(8).map(|pair| {
            let (pair, _) = pair.as_chunks::<4>();
            [pair[0], pair[1]].map(u32::from_le_bytes)
        });
        let [rounds, light_samples] = pairs.next().ok_or(SHORT)?;
        if pairs.next() != Some([u32::from(order.keep_lights), 0]) {
            return Err(FilmError::OtherPicture);
        }
        let requested: Vec<[u32; 2]> = pairs.collect();
        // Check the numbers against the film.
        let is_consistent = |(requested, index): (&[u32; 2], usize)| {
            let counts = film.pixel(index).counts().into_iter().zip(requested);
            counts.into_iter().all(|(count, &requested)| {
                // A round doubles the samples; the first starts from none.
                let is_taken = count == requested || 2 * count == requested;
                (is_taken || (rounds == 0 && count == 0))
                    && requested.is_power_of_two()
                    && requested <= MAX_LENGTH
            })
        };
        let are_consistent = requested.iter().zip(0..).all(is_consistent);
        if rounds > MAX_ROUNDS || light_samples == 0 || !are_consistent {
            return Err(WRONG);
        }
        Ok(Self {
            film,
            requested,
            rounds,
            light_samples,
            keeps_lights: order.keep_lights,
        })
    }
}

fn samples_of(film: &ProgressiveFilm) -> SampleStatistics {
    let counts = film.map(Replicates::samples);
    SampleStatistics {
        min: counts.iter().copied().min().unwrap_or(0),
        mean: counts.iter().sum::<u64>() as f64 / film.len().max(1) as f64,
        most: counts.iter().copied().max().unwrap_or(0),
    }
}
