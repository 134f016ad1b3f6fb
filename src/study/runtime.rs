//! The runtime of a study: thread pools, clocks, a stop callback, and the journal.

use super::denoised::film;
use super::journal::{Journal, JournalEntry};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_plan::Plan;
use rtc_render::{AnyWorld, Film, PixelObserver, RenderSelection, RenderStep, SimdLevel};
use rtc_valid::ValidScene;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The clocks, read before and after a piece of work. Their origin does not matter.
#[derive(Clone, Copy)]
pub struct WorkClock<'a> {
    /// The processor time that the calling thread has used.
    pub cpu: &'a (dyn Fn() -> Duration + Sync),
    /// The wall-clock time.
    pub wall: &'a (dyn Fn() -> Duration + Sync),
}

/// The duration of a piece of work in seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Time {
    pub(super) cpu: f64,
    pub(super) wall: f64,
}

impl Time {
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            cpu: self.cpu + other.cpu,
            wall: self.wall + other.wall,
        }
    }

    pub(super) fn over(self, count: f64) -> Self {
        Self {
            cpu: self.cpu / count,
            wall: self.wall / count,
        }
    }
}

impl WorkClock<'_> {
    /// Runs work on the calling thread; also returns its duration in seconds.
    fn measure<T>(&self, work: impl FnOnce() -> T) -> (T, Time) {
        let (cpu, wall) = ((self.cpu)(), (self.wall)());
        let done = work();
        let since =
            |clock: &dyn Fn() -> Duration, start| clock().saturating_sub(start).as_secs_f64();
        (
            done,
            Time {
                cpu: since(self.cpu, cpu),
                wall: since(self.wall, wall),
            },
        )
    }
}

/// Thread pools, clocks, a stop callback, and the journal.
pub struct StudyRuntime<'a> {
    clock: WorkClock<'a>,
    on_pixel: &'a PixelObserver<'a>,
    /// The pool for work that is not timed.
    all_threads: ThreadPool,
    /// A pool of one thread for timed work: its processor time does not depend on other load.
    one_thread: ThreadPool,
    /// The SIMD level for rendering.
    simd: SimdLevel,
    /// The journal, if renders are recorded.
    journal_state: Option<Mutex<JournalState>>,
    /// Saves the journal.
    save: &'a (dyn Fn(&Journal) + Sync),
    /// Receives the approximate number of rays of the whole study, once it is known.
    on_budget: &'a (dyn Fn(u64) + Sync),
}

/// The journal, and when it is saved.
struct JournalState {
    journal: Journal,
    every: Duration,
    /// The time of the last save.
    saved: Duration,
}

impl<'a> StudyRuntime<'a> {
    /// A runtime with `threads` threads, 0 for one per core. All of them call `on_pixel` after each
    /// pixel and within long ones.
    ///
    /// # Errors
    /// If the system cannot create threads.
    pub fn new(
        threads: usize,
        clock: WorkClock<'a>,
        on_pixel: &'a PixelObserver<'a>,
    ) -> Result<Self, ThreadPoolBuildError> {
        let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Self {
            clock,
            on_pixel,
            all_threads: pool(threads)?,
            one_thread: pool(1)?,
            simd: SimdLevel::best(),
            journal_state: None,
            save: &|_| (),
            on_budget: &|_| (),
        })
    }

    /// Sets the SIMD level for rendering. Only the times depend on it.
    #[must_use]
    pub fn with_simd(self, simd: SimdLevel) -> Self {
        Self { simd, ..self }
    }

    /// Sets the journal: renders that are in it are replayed; it is passed to `save` each time
    /// `every` has passed.
    #[must_use]
    pub fn with_journal(
        mut self,
        journal: Journal,
        every: Duration,
        save: &'a (dyn Fn(&Journal) + Sync),
    ) -> Self {
        self.journal_state = Some(Mutex::new(JournalState {
            journal,
            every,
            saved: (self.clock.wall)(),
        }));
        self.save = save;
        self
    }

    /// Sets what receives the approximate number of rays of the whole study, once it is known.
    #[must_use]
    pub fn with_budget_report(self, on_budget: &'a (dyn Fn(u64) + Sync)) -> Self {
        Self { on_budget, ..self }
    }

    /// Reports the approximate number of rays of the whole study.
    pub(super) fn report_budget(&self, rays: u64) {
        (self.on_budget)(rays);
    }

    /// Saves the journal.
    pub fn save(&self) {
        if let Some(journal_state) = self.journal_state() {
            (self.save)(&journal_state.journal);
        }
    }

    fn journal_state(&self) -> Option<MutexGuard<'_, JournalState>> {
        let journal_state = self.journal_state.as_ref()?;
        Some(journal_state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The next render, if it is in the journal.
    pub(super) fn replay(&self, key: u64) -> Option<JournalEntry> {
        self.journal_state()?.journal.replay(key)
    }

    /// Records a render, if there is a journal.
    pub(super) fn record(&self, entry: impl FnOnce() -> JournalEntry) {
        let Some(mut journal_state) = self.journal_state() else {
            return;
        };
        journal_state.journal.record(entry());
        let now = (self.clock.wall)();
        if now.saturating_sub(journal_state.saved) >= journal_state.every {
            (self.save)(&journal_state.journal);
            journal_state.saved = (self.clock.wall)();
        }
    }

    /// Renders a scene as planned, and denoises it if requested; `None` if it was stopped.
    pub(super) fn render(
        &self,
        (scene, plan): (&ValidScene, &Plan),
        job: &RenderSelection,
        denoise: bool,
    ) -> Option<Film> {
        let world = AnyWorld::prepare_at(scene, plan, self.simd);
        film(&world, job, denoise, self.on_pixel)
    }

    /// The number of rays of each pixel of the whole picture, row by row, for [`Self::render`].
    pub(super) fn rays_of_pixels(
        &self,
        (scene, plan): (&ValidScene, &Plan),
        job: &RenderSelection,
        denoise: bool,
    ) -> Option<Vec<u64>> {
        let [width, height] =
            [scene.camera().width, scene.camera().height].map(|side| side.get() as usize);
        let rays: Vec<_> = (0..width * height).map(|_| AtomicU64::new(0)).collect();
        let on_pixel = |step: RenderStep| {
            let [x, y] = step.pixel.map(|at| at as usize);
            rays[y * width + x].fetch_add(step.rays, Relaxed);
            (self.on_pixel)(step)
        };
        let world = AnyWorld::prepare_at(scene, plan, self.simd);
        film(&world, job, denoise, &on_pixel)?;
        Some(rays.into_iter().map(AtomicU64::into_inner).collect())
    }

    /// Runs work on all threads.
    pub(super) fn in_parallel<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.all_threads.install(work)
    }

    /// Runs work on one thread; also returns its duration.
    pub(super) fn measure<T: Send>(&self, work: impl FnOnce() -> T + Send) -> (T, Time) {
        self.one_thread.install(|| self.clock.measure(work))
    }
}
