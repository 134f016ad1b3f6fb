//! The progress of a render.

use super::Picture;
use super::clock::Stopwatch;
use rtc_render::RenderStep;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The progress of a render, as [`Options::on_progress`](super::Options::on_progress) reports it.
///
/// It tells the share, and shows the picture so far if it is asked for:
///
/// ```
/// use rtc::{Camera, Options, Phong, SceneBuilder, Shape};
/// use std::sync::{Arc, Mutex};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 5.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let last = Arc::new(Mutex::new(0.0));
/// let seen = Arc::clone(&last);
/// let options = Options::new().on_progress(move |progress| {
///     *seen.lock().unwrap() = progress.done;
///     if let Some(picture) = progress.picture() {
///         assert_eq!(picture.rgba8().len(), 8 * 8 * 4);
///     }
/// });
/// builder.build().unwrap().render(&options)?;
/// assert_eq!(*last.lock().unwrap(), 1.0);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Progress<'a> {
    /// The share that is done, from 0 to 1; it never falls, and is 1 once. With a target error it
    /// is an estimate: the square of the target over the square of the bound so far.
    pub done: f64,
    /// The rays so far, also those of rounds that a time budget ends.
    pub rays: u64,
    picture: PictureSoFar<'a>,
}

/// Makes the picture so far, if there is one.
pub(super) type PictureSoFar<'a> = &'a (dyn Fn() -> Option<Picture> + Sync);

impl Progress<'_> {
    /// The picture so far: each finished tile of 16 × 16 pixels is as it will be in the end, all
    /// other pixels are transparent. It has no layers, diagnostics or statistics. It costs as much
    /// as the end of a render, and the render nothing if it is not called.
    ///
    /// `None` if no pixel is final before the end: in a depth buffer, with a target error, a time
    /// budget or a denoiser, with layers of samples; at the end, when the render returns it; and if
    /// there is no memory for it.
    #[must_use]
    pub fn picture(&self) -> Option<Picture> {
        (self.picture)()
    }
}

impl fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut progress = f.debug_struct("Progress");
        progress.field("done", &self.done).field("rays", &self.rays);
        progress.finish_non_exhaustive()
    }
}

/// The callback of [`Options::on_progress`](super::Options::on_progress).
#[derive(Clone)]
pub(super) struct ProgressCallback(pub(super) Arc<dyn Fn(Progress<'_>) + Send + Sync>);

impl fmt::Debug for ProgressCallback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OnProgress")
    }
}

/// The number of reports of a render, or of each of its rounds.
const REPORTS: u64 = 100;

/// The measure of progress.
pub(super) enum ProgressMeasure<'a> {
    /// Pixels.
    Pixels,
    /// The bound on the error after each round.
    Error,
    /// Also the time.
    Time(&'a Stopwatch, Duration),
}

/// Counts the steps of one render and reports them.
pub(super) struct ProgressReporter<'a> {
    on_progress: Option<&'a ProgressCallback>,
    /// The pixels of the picture.
    pixels: u64,
    measure: ProgressMeasure<'a>,
    picture: PictureSoFar<'a>,
    done: AtomicU64,
    rays: AtomicU64,
    share: Mutex<f64>,
}

impl<'a> ProgressReporter<'a> {
    pub(super) fn new(
        on_progress: Option<&'a ProgressCallback>,
        pixels: u64,
        measure: ProgressMeasure<'a>,
        picture: PictureSoFar<'a>,
    ) -> Self {
        Self {
            on_progress,
            pixels: pixels.max(1),
            measure,
            picture,
            done: AtomicU64::new(0),
            rays: AtomicU64::new(0),
            share: Mutex::new(0.0),
        }
    }

    /// A step of the render, from any of its threads.
    pub(super) fn step(&self, step: RenderStep) {
        let rays = self.rays.fetch_add(step.rays, Relaxed) + step.rays;
        if self.on_progress.is_none() || !step.is_done {
            return;
        }
        let done = self.done.fetch_add(1, Relaxed) + 1;
        if done.is_multiple_of(self.pixels.div_ceil(REPORTS)) {
            self.report(self.share(done), rays);
        }
    }

    /// The share that is done, by pixels or by time.
    fn share(&self, done: u64) -> f64 {
        match self.measure {
            ProgressMeasure::Pixels => done as f64 / self.pixels as f64,
            ProgressMeasure::Error => 0.0,
            ProgressMeasure::Time(stopwatch, time) => {
                stopwatch.elapsed().as_secs_f64() / time.as_secs_f64()
            }
        }
    }

    /// A new share that is done, if it is larger than that before.
    pub(super) fn reach(&self, share: f64) {
        self.report(share, self.rays.load(Relaxed));
    }

    /// The end of the render.
    pub(super) fn finish(&self, rays: u64) {
        if let Some(ProgressCallback(on_progress)) = self.on_progress {
            let rays = rays.max(self.rays.load(Relaxed));
            on_progress(Progress {
                done: 1.0,
                rays,
                picture: self.picture,
            });
        }
    }

    /// Reports a share below 1; one thread at a time, so that shares and rays never fall.
    fn report(&self, share: f64, rays: u64) {
        /// The largest progress before the end.
        const MOST: f64 = 0.999;
        let Some(ProgressCallback(on_progress)) = self.on_progress else {
            return;
        };
        let mut last = self.share.lock().unwrap_or_else(PoisonError::into_inner);
        *last = share.min(MOST).max(*last);
        on_progress(Progress {
            done: *last,
            rays: rays.max(self.rays.load(Relaxed)),
            picture: self.picture,
        });
    }
}
