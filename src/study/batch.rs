//! Stretches of work between two moments at which what is done can be saved.

use std::time::Duration;

/// How many shares of a picture are rendered at once: as many as take a part of the time between two
/// saves.
#[derive(Clone, Copy, Debug)]
pub struct WorkBatch {
    shards: u32,
    /// With fewer, threads would have no work.
    least: u32,
    time: Duration,
}

impl WorkBatch {
    /// Longer ones save no more work, and lose more of it.
    const LONGEST: Duration = Duration::from_secs(10);

    /// The first stretch of work for so many threads that is saved so often.
    #[must_use]
    pub fn new(every: Duration, threads: usize) -> Self {
        let least = u32::try_from(2 * threads).unwrap_or(u32::MAX).max(1);
        Self {
            shards: least,
            least,
            time: (every / 4).min(Self::LONGEST),
        }
    }

    /// How many shares come next.
    #[must_use]
    pub fn shards(&self) -> u32 {
        self.shards
    }

    /// So many shares took so long.
    pub fn adapt(&mut self, shards: u32, took: Duration) {
        let ratio = self.time.as_secs_f64() / took.as_secs_f64().max(1e-6);
        let wanted = f64::from(shards) * ratio.clamp(0.25, 4.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a positive number, saturated"
        )]
        let wanted = wanted as u32;
        self.shards = wanted.max(self.least);
    }
}
