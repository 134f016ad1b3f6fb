//! Progress reports of a thread. It calls an observer after each pixel, and inside long pixels
//! after every few thousand steps. The observer returns whether to continue.
//!
//! A stopped thread leaves a wrong value in its pixel. The caller then drops the film, so no
//! finished picture contains such a pixel.

use crate::film::RayCounts;

/// The work of a thread since its last call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderStep {
    /// The rays it traced.
    pub rays: u64,
    /// The pixel it works on, from the upper left.
    pub pixel: [u32; 2],
    /// That pixel is done.
    pub is_done: bool,
    /// The number of pending branches of its paths.
    pub open: usize,
}

/// The observer of a render, called from all its threads; false means stop.
pub type PixelObserver<'a> = dyn Fn(RenderStep) -> bool + Sync + 'a;

/// Steps of work between two calls: less than a millisecond in simple scenes.
const EVERY: u32 = 1 << 12;

/// The calls of one thread to the observer.
pub(crate) struct Heartbeat<'run> {
    on_pixel: &'run PixelObserver<'run>,
    pixel: [u32; 2],
    /// The rays of this thread reported so far.
    reported: u64,
    /// The rays since then that went on behind a surface, which no other count has.
    passed: u64,
    /// Steps until the next call.
    left: u32,
    should_continue: bool,
    /// As in [`RenderStep`].
    open: usize,
}

impl<'run> Heartbeat<'run> {
    pub(crate) fn new(on_pixel: &'run PixelObserver<'run>) -> Self {
        Self {
            on_pixel,
            pixel: [0; 2],
            reported: 0,
            passed: 0,
            left: EVERY,
            should_continue: true,
            open: 0,
        }
    }

    /// The pixel under way.
    pub(crate) fn pixel(&self) -> [u32; 2] {
        self.pixel
    }

    /// Begins another pixel.
    pub(crate) fn begin(&mut self, pixel: [u32; 2]) {
        self.pixel = pixel;
    }

    /// Records the number of pending branches.
    #[inline]
    pub(crate) fn defer(&mut self, open: usize) {
        self.open = open;
    }

    /// Whether to continue. Call it once per step of work: a path, a bounce, a sample, a point of a
    /// light.
    #[inline]
    pub(crate) fn should_continue(&mut self, counts: &RayCounts) -> bool {
        self.left -= 1;
        self.left > 0 || self.ask(counts.rays(), false)
    }

    /// As [`Self::should_continue`], for a ray that goes on behind a surface.
    #[inline]
    pub(crate) fn passes(&mut self, counts: &RayCounts) -> bool {
        self.passed += 1;
        self.should_continue(counts)
    }

    /// Reports the end of the pixel, given the rays traced so far. Returns whether to continue.
    pub(crate) fn done(&mut self, rays: u64) -> bool {
        self.ask(rays, true)
    }

    fn ask(&mut self, rays: u64, is_done: bool) -> bool {
        let step = RenderStep {
            rays: rays - self.reported + std::mem::take(&mut self.passed),
            pixel: self.pixel,
            is_done,
            open: self.open,
        };
        self.reported = rays;
        self.should_continue = self.should_continue && (self.on_pixel)(step);
        self.left = if self.should_continue { EVERY } else { 1 };
        self.should_continue
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn who_works_long_asks_within_a_pixel_and_hears_a_stop_for_ever() {
        let reported = Mutex::new(Vec::new());
        let on_pixel = |step: RenderStep| {
            reported.lock().unwrap().push(step);
            !(step.pixel == [1, 0] && step.rays > 0)
        };
        let mut heartbeat = Heartbeat::new(&on_pixel);
        let mut counts = RayCounts::default();
        counts.camera = 3;
        assert!(heartbeat.should_continue(&counts) && heartbeat.done(counts.rays()));
        heartbeat.begin([1, 0]);
        assert!((1..EVERY).all(|step| match step % 2 {
            0 => heartbeat.passes(&counts),
            _ => heartbeat.should_continue(&counts),
        }));
        counts.shadow = 9;
        assert!(
            !heartbeat.should_continue(&counts)
                && !heartbeat.should_continue(&counts)
                && !heartbeat.done(counts.rays())
        );
        let steps = [
            RenderStep {
                rays: 3,
                pixel: [0, 0],
                is_done: true,
                open: 0,
            },
            RenderStep {
                rays: 9 + u64::from(EVERY / 2 - 1),
                pixel: [1, 0],
                is_done: false,
                open: 0,
            },
        ];
        assert_eq!(*reported.lock().unwrap(), steps);
    }
}
