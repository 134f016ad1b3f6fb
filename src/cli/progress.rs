//! The progress of a long render: a bar on a terminal, nothing elsewhere; and the elapsed time.

use indicatif::{
    HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle,
};
use rtc_render::RenderStep;
use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Counts the finished pixels and their rays; all threads may report to it.
pub(super) struct RenderProgress {
    bar: ProgressBar,
    /// Nobody sees the bar, so it need not know how far the render is: it would look at the clock
    /// at every pixel.
    is_hidden: bool,
    rays: Arc<AtomicU64>,
}

impl RenderProgress {
    /// Starts to count `pixels`, or rays for [`Self::step_rays`]; `quiet` means no bar.
    pub(super) fn start(pixels: u64, quiet: bool) -> Self {
        let shown = !quiet && io::stderr().is_terminal();
        let target = if shown {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let rays = Arc::new(AtomicU64::new(0));
        let bar = ProgressBar::with_draw_target(Some(pixels), target)
            .with_style(style(Arc::clone(&rays)));
        let is_hidden = !shown;
        Self {
            bar,
            is_hidden,
            rays,
        }
    }

    /// A step of the work is done.
    pub(super) fn step(&self, step: RenderStep) {
        if self.is_hidden {
            return;
        }
        self.rays.fetch_add(step.rays, Ordering::Relaxed);
        self.bar.inc(u64::from(step.is_done));
    }

    /// Sets the number of rays of the whole work; it starts with an unknown one, 0.
    pub(super) fn set_rays(&self, rays: u64) {
        self.bar.set_length(rays);
    }

    /// A step of work that is measured in rays.
    pub(super) fn step_rays(&self, step: RenderStep) {
        if self.is_hidden {
            return;
        }
        self.rays.fetch_add(step.rays, Ordering::Relaxed);
        self.bar.inc(step.rays);
    }

    /// Begins a round of `pixels` more; `message` describe the quality reached.
    pub(super) fn round(&self, pixels: u64, message: String) {
        self.bar.set_length(self.bar.position() + pixels);
        self.bar.set_message(message);
    }

    /// The time since the start.
    pub(super) fn elapsed(&self) -> Duration {
        self.bar.elapsed()
    }

    /// Removes the bar and returns the elapsed time.
    pub(super) fn finish(self) -> Duration {
        let elapsed = self.bar.elapsed();
        self.bar.finish_and_clear();
        elapsed
    }
}

fn style(rays: Arc<AtomicU64>) -> ProgressStyle {
    let rate = move |state: &ProgressState, text: &mut dyn Write| {
        let rays = rays.load(Ordering::Relaxed);
        // A bar that can't be drawn is no failure of the render.
        let _ = write!(text, "{}", per_second(rays, state.elapsed()));
    };
    let left = |state: &ProgressState, text: &mut dyn Write| {
        let _ = write!(text, "{:#} left", HumanDuration(state.eta()));
    };
    // Short, as a line that is wider than the terminal is left there: the message is cut to it.
    ProgressStyle::with_template("{bar:12} {percent:>3} %  {left}  {rate}  {wide_msg}")
        .expect("the template is a constant and well formed")
        .with_key("rate", rate)
        .with_key("left", left)
}

/// `1,234,567 rays/s`.
pub(super) fn per_second(rays: u64, elapsed: Duration) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and rounded for people"
    )]
    let rate = (rays as f64 / elapsed.as_secs_f64().max(1e-9)) as u64;
    format!("{} rays/s", HumanCount(rate))
}

/// `1,234,567 rays`.
pub(super) fn rays(count: u64) -> String {
    format!("{} rays", HumanCount(count))
}

/// `1,234,567 rays, 0.52 s, 2,374,167 rays/s`.
pub(super) fn summary(count: u64, elapsed: Duration) -> String {
    format!(
        "{}, {:.2} s, {}",
        rays(count),
        elapsed.as_secs_f64(),
        per_second(count, elapsed)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_rays_and_seconds() {
        assert_eq!(
            summary(3_000_000, Duration::from_millis(1500)),
            "3,000,000 rays, 1.50 s, 2,000,000 rays/s"
        );
        assert!(summary(1, Duration::ZERO).starts_with("1 rays, 0.00 s, "));
    }
}
