//! How a thread comes on: it tells an observer after each pixel, and within long ones every few
//! thousand steps of work, and is told whether to go on.
//!
//! A thread that is to stop gives its pixel up with whatever number it has; the film it belongs to
//! is thrown away, so a picture that is finished knows nothing of this.

use crate::render::film::Counts;

/// What a thread did since it told last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Step {
    /// The rays it traced.
    pub rays: u64,
    /// The pixel it works on, from the upper left.
    pub pixel: [u32; 2],
    /// That pixel is done.
    pub is_done: bool,
    /// How many branches of its paths are put off.
    pub open: usize,
}

/// The observer of a render, called from all its threads; false means stop.
pub type OnPixel<'a> = dyn Fn(Step) -> bool + Sync + 'a;

/// Steps of work between two questions: less than a millisecond where scenes are simple.
const EVERY: u32 = 1 << 12;

/// Asks the observer for one thread.
pub(in crate::render) struct Heartbeat<'run> {
    on_pixel: &'run OnPixel<'run>,
    pixel: [u32; 2],
    /// The rays of this thread that the observer knows of.
    told: u64,
    /// Steps until the next question.
    left: u32,
    goes_on: bool,
    /// As in [`Step`].
    open: usize,
}

impl<'run> Heartbeat<'run> {
    pub(in crate::render) fn new(on_pixel: &'run OnPixel<'run>) -> Self {
        Self {
            on_pixel,
            pixel: [0; 2],
            told: 0,
            left: EVERY,
            goes_on: true,
            open: 0,
        }
    }

    /// The pixel under way.
    pub(in crate::render) fn pixel(&self) -> [u32; 2] {
        self.pixel
    }

    /// Another pixel is begun.
    pub(in crate::render) fn begin(&mut self, pixel: [u32; 2]) {
        self.pixel = pixel;
    }

    /// Takes down how many branches are put off.
    #[inline]
    pub(in crate::render) fn put_off(&mut self, open: usize) {
        self.open = open;
    }

    /// Whether to go on; to be asked once a step of work: a path, a bounce, a sample, a point of a
    /// light.
    #[inline]
    pub(in crate::render) fn goes_on(&mut self, counts: &Counts) -> bool {
        self.left -= 1;
        self.left > 0 || self.ask(counts.rays(), false)
    }

    /// Tells that the pixel is done, given the rays traced so far; whether to go on.
    pub(in crate::render) fn done(&mut self, rays: u64) -> bool {
        self.ask(rays, true)
    }

    fn ask(&mut self, rays: u64, is_done: bool) -> bool {
        let step = Step {
            rays: rays - self.told,
            pixel: self.pixel,
            is_done,
            open: self.open,
        };
        self.told = rays;
        self.goes_on = self.goes_on && (self.on_pixel)(step);
        self.left = if self.goes_on { EVERY } else { 1 };
        self.goes_on
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn who_works_long_asks_within_a_pixel_and_hears_a_stop_for_ever() {
        let told = Mutex::new(Vec::new());
        let on_pixel = |step: Step| {
            told.lock().unwrap().push(step);
            !(step.pixel == [1, 0] && step.rays > 0)
        };
        let mut heartbeat = Heartbeat::new(&on_pixel);
        let mut counts = Counts::default();
        counts.camera = 3;
        assert!(heartbeat.goes_on(&counts) && heartbeat.done(counts.rays()));
        heartbeat.begin([1, 0]);
        assert!((1..EVERY).all(|_| heartbeat.goes_on(&counts)));
        counts.shadow = 9;
        assert!(
            !heartbeat.goes_on(&counts)
                && !heartbeat.goes_on(&counts)
                && !heartbeat.done(counts.rays())
        );
        let steps = [
            Step {
                rays: 3,
                pixel: [0, 0],
                is_done: true,
                open: 0,
            },
            Step {
                rays: 9,
                pixel: [1, 0],
                is_done: false,
                open: 0,
            },
        ];
        assert_eq!(*told.lock().unwrap(), steps);
    }
}
