//! The clock, for options in seconds.

use std::time::Duration;

/// The time since a start. A browser has no clock, and no time budgets.
pub(super) struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    start: std::time::Instant,
}

impl Stopwatch {
    #[cfg_attr(
        not(target_family = "wasm"),
        expect(
            clippy::disallowed_methods,
            reason = "a time budget and the seconds of a study are of the clock, and say so"
        )
    )]
    pub(super) fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            start: std::time::Instant::now(),
        }
    }

    #[cfg(not(target_family = "wasm"))]
    pub(super) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    #[cfg(target_family = "wasm")]
    #[expect(clippy::unused_self, reason = "elsewhere it has a start")]
    pub(super) fn elapsed(&self) -> Duration {
        Duration::ZERO
    }
}
