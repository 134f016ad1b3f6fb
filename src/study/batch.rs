//! The batch size between two checkpoints.

use std::time::Duration;

/// The number of shards of a picture that are rendered in one batch, adapted to a fraction of the
/// time between two checkpoints.
#[derive(Clone, Copy, Debug)]
pub struct WorkBatch {
    shards: u32,
    /// With fewer shards, threads would be idle.
    least: u32,
    time: Duration,
}

impl WorkBatch {
    /// The maximum duration of a batch: longer ones lose more work and gain nothing.
    const MAX_DURATION: Duration = Duration::from_secs(10);

    /// The first batch for a number of threads and a checkpoint interval.
    #[must_use]
    pub fn new(every: Duration, threads: usize) -> Self {
        let least = u32::try_from(2 * threads).unwrap_or(u32::MAX).max(1);
        Self {
            shards: least,
            least,
            time: (every / 4).min(Self::MAX_DURATION),
        }
    }

    /// The number of shards of the next batch.
    #[must_use]
    pub fn shards(&self) -> u32 {
        self.shards
    }

    /// Adapts the size to the duration of the last batch.
    pub fn adapt(&mut self, shards: u32, took: Duration) {
        let ratio = self.time.as_secs_f64() / took.as_secs_f64().max(1e-6);
        let requested = f64::from(shards) * ratio.clamp(0.25, 4.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a positive number, saturated"
        )]
        let requested = requested as u32;
        self.shards = requested.max(self.least);
    }
}
