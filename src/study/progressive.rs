//! A picture on its way to its goal, which can be saved between two stretches of a round and goes on from
//! there to the same bytes: a round takes the samples that are missing, whoever took the others.

use super::batch::WorkBatch;
use super::noise::Bound;
use super::target::{Order, Samples, TargetResult};
use rtc_render::{AnyWorld, FilmError, OnPixel, ProgressiveFilm, Replicates, Tiles, Values};
use std::time::Duration;

/// What is known of a picture that grows.
pub struct ProgressiveRender {
    pub(super) film: ProgressiveFilm,
    /// How many samples each replicate, and the pilot, of the pixels is to have after the round under
    /// way.
    pub(super) wanted: Vec<[u32; 2]>,
    /// The rounds that are done.
    pub(super) rounds: u32,
    /// Points of each soft light at a hit.
    pub(super) light_samples: u32,
    /// Whether those were asked for.
    pub(super) keeps_lights: bool,
}

/// How a growing picture is kept on its way.
pub struct CheckpointSink<'a> {
    /// What was kept before.
    pub resumed_from: Option<ProgressiveRender>,
    /// The time between two saves.
    pub every: Duration,
    /// How many threads are to have work.
    pub threads: usize,
    /// The time since the start.
    pub elapsed: &'a (dyn Fn() -> Duration + Sync),
    /// Takes the bytes of what is done.
    pub save: &'a (dyn Fn(Vec<u8>) + Sync),
}

/// Keeps what grows now and then.
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

    /// What was kept before.
    pub(super) fn resumed_from(&mut self) -> Option<ProgressiveRender> {
        self.sink.resumed_from.take()
    }

    /// Keeps it now.
    pub(super) fn save(&self, progressive: &ProgressiveRender) {
        (self.sink.save)(progressive.save());
    }

    /// So many tiles took since then.
    fn took(&mut self, progressive: &ProgressiveRender, tiles: u32, resumed_from: Duration) {
        let now = (self.sink.elapsed)();
        self.batch.adapt(tiles, now.saturating_sub(resumed_from));
        if now.saturating_sub(self.saved) >= self.sink.every {
            self.save(progressive);
            self.saved = (self.sink.elapsed)();
        }
    }
}

impl ProgressiveRender {
    /// The rays it took.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.film.counts.rays()
    }

    /// Takes the samples of the round that are missing, and keeps them on the way; false if someone said
    /// stop.
    pub(super) fn refine(
        &mut self,
        world: &AnyWorld,
        on_pixel: &OnPixel<'_>,
        checkpointer: Option<&mut Checkpointer<'_>>,
    ) -> bool {
        let Some(checkpointer) = checkpointer else {
            let wanted = |index: usize| self.wanted[index];
            return world.grow(&mut self.film, &wanted, on_pixel);
        };
        let count = Tiles::of(self.film.crop()).count();
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        let mut done = 0;
        while done < count {
            let last = count.min(done.saturating_add(checkpointer.batch.shards()));
            let resumed_from = (checkpointer.sink.elapsed)();
            self.film.tiles = Some(Tiles::shares([done + 1, last], count));
            let wanted = |index: usize| self.wanted[index];
            let is_done = world.grow(&mut self.film, &wanted, on_pixel);
            self.film.tiles = None;
            if !is_done {
                checkpointer.save(self);
                return false;
            }
            checkpointer.took(self, last - done, resumed_from);
            done = last;
        }
        true
    }

    /// The picture as far as it is, of a bound on its error.
    pub(super) fn result(&self, bound: Bound, values: Values) -> TargetResult {
        TargetResult {
            image: self.film.image(values),
            coverage: self.film.coverage(),
            counts: self.film.counts,
            error: bound.error,
            undersampled: bound.undersampled,
            coarse: None,
            samples: samples_of(&self.film),
            light_samples: self.light_samples,
        }
    }

    /// Rounds, points of lights and whether those were asked for, the samples wanted, and the film, as bytes.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let wanted = self.wanted.iter().flatten();
        let keeps = u32::from(self.keeps_lights);
        let numbers = [self.rounds, self.light_samples, keeps, 0].into_iter();
        let numbers = numbers.chain(wanted.copied());
        let mut bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        bytes.extend(self.film.save());
        bytes
    }

    /// What was kept in such bytes, of the picture of an order.
    ///
    /// # Errors
    /// If the bytes are of something else or of another version, or damaged.
    pub fn load(bytes: &[u8], order: &Order) -> Result<Self, FilmError> {
        /// More rounds than that no picture takes.
        const MOST: u32 = 1 << 16;
        const LONGEST: u32 = 1 << 24;
        const SHORT: FilmError = FilmError::Corrupt("its end is missing");
        const WRONG: FilmError = FilmError::Corrupt("its rounds can't be");
        let length = 8 * (order.crop.pixels() + 2);
        let (numbers, film) = bytes.split_at_checked(length).ok_or(SHORT)?;
        // As many pixels as there are numbers.
        let film = order.film().load(film)?;
        let mut pairs = numbers.chunks_exact(8).map(|pair| {
            let (pair, _) = pair.as_chunks::<4>();
            [pair[0], pair[1]].map(u32::from_le_bytes)
        });
        let [rounds, light_samples] = pairs.next().ok_or(SHORT)?;
        if pairs.next() != Some([u32::from(order.keep_lights), 0]) {
            return Err(FilmError::OtherPicture);
        }
        let wanted: Vec<[u32; 2]> = pairs.collect();
        let is_consistent = |(wanted, index): (&[u32; 2], usize)| {
            let counts = film.pixel(index).counts().into_iter().zip(wanted);
            counts.into_iter().all(|(count, &wanted)| {
                // A round doubles what is there; the first begins with none.
                let is_taken = count == wanted || 2 * count == wanted;
                (is_taken || (rounds == 0 && count == 0))
                    && wanted.is_power_of_two()
                    && wanted <= LONGEST
            })
        };
        let are_consistent = wanted.iter().zip(0..).all(is_consistent);
        if rounds > MOST || light_samples == 0 || !are_consistent {
            return Err(WRONG);
        }
        Ok(Self {
            film,
            wanted,
            rounds,
            light_samples,
            keeps_lights: order.keep_lights,
        })
    }
}

fn samples_of(film: &ProgressiveFilm) -> Samples {
    let counts = || film.pixels().map(Replicates::samples);
    Samples {
        min: counts().min().unwrap_or(0),
        mean: film.samples() as f64 / film.len().max(1) as f64,
        most: counts().max().unwrap_or(0),
    }
}
