//! The environment of a study: threads, a clock, and an observer who may say stop.

use super::denoised::film;
use super::journal::{Entry, Journal};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use rtc_plan::Plan;
use rtc_render::{AnyWorld, Film, Job, OnPixel, SimdLevel, Step};
use rtc_valid::ValidScene;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A clock, read before and after a piece of work. Its origin does not matter.
#[derive(Clone, Copy)]
pub struct Clock<'a> {
    /// The processor time that the calling thread has used.
    pub cpu: &'a (dyn Fn() -> Duration + Sync),
    /// The time of day.
    pub wall: &'a (dyn Fn() -> Duration + Sync),
}

/// How long a piece of work took.
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

impl Clock<'_> {
    /// Does a piece of work on the calling thread. Returns its duration in seconds, too.
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

/// Threads, a clock, and an observer who may say stop.
pub struct Bench<'a> {
    clock: Clock<'a>,
    on_pixel: &'a OnPixel<'a>,
    /// All threads, for work that is not timed.
    wide: ThreadPool,
    /// One thread, for timed work: its processor time does not depend on other load.
    narrow: ThreadPool,
    /// The vector instructions that scenes are rendered with.
    simd: SimdLevel,
    /// What was rendered, if that is kept.
    memory: Option<Mutex<Memory>>,
    /// Who saves it.
    save: &'a (dyn Fn(&Journal) + Sync),
}

/// What was rendered, and how it is kept.
struct Memory {
    journal: Journal,
    every: Duration,
    /// When it was kept last.
    saved: Duration,
}

impl<'a> Bench<'a> {
    /// A bench with `threads` threads, 0 for one per core. `on_pixel` is asked from all of them
    /// after each pixel and within long ones.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(
        threads: usize,
        clock: Clock<'a>,
        on_pixel: &'a OnPixel<'a>,
    ) -> Result<Self, ThreadPoolBuildError> {
        let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Self {
            clock,
            on_pixel,
            wide: pool(threads)?,
            narrow: pool(1)?,
            simd: SimdLevel::best(),
            memory: None,
            save: &|_| (),
        })
    }

    /// The same bench, where scenes are rendered with the vector instructions of a level: what is
    /// found is the same, but for the time it takes.
    #[must_use]
    pub fn at_level(self, simd: SimdLevel) -> Self {
        Self { simd, ..self }
    }

    /// The same bench, which renders nothing that is in the journal, and hands it to `save` with all renders that
    /// are done after so much time.
    #[must_use]
    pub fn keeping(
        mut self,
        journal: Journal,
        every: Duration,
        save: &'a (dyn Fn(&Journal) + Sync),
    ) -> Self {
        self.memory = Some(Mutex::new(Memory {
            journal,
            every,
            saved: (self.clock.wall)(),
        }));
        self.save = save;
        self
    }

    /// Hands the journal to whoever saves it.
    pub fn save(&self) {
        if let Some(memory) = self.memory() {
            (self.save)(&memory.journal);
        }
    }

    fn memory(&self) -> Option<MutexGuard<'_, Memory>> {
        let memory = self.memory.as_ref()?;
        Some(memory.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The next render, if it was done before.
    pub(super) fn recall(&self, key: u64) -> Option<Entry> {
        self.memory()?.journal.recall(key)
    }

    /// Takes down a render, if that is to be kept.
    pub(super) fn note(&self, entry: impl FnOnce() -> Entry) {
        let Some(mut memory) = self.memory() else {
            return;
        };
        memory.journal.note(entry());
        let now = (self.clock.wall)();
        if now.saturating_sub(memory.saved) >= memory.every {
            (self.save)(&memory.journal);
            memory.saved = (self.clock.wall)();
        }
    }

    /// Renders a scene as planned, denoised if that is asked for; `None` if the observer said stop.
    pub(super) fn render(
        &self,
        (scene, plan): (&ValidScene, &Plan),
        job: &Job,
        denoise: bool,
    ) -> Option<Film> {
        let world = AnyWorld::prepare_at(scene, plan, self.simd);
        film(&world, job, denoise, self.on_pixel)
    }

    /// The rays of each pixel of the whole picture, row by row, as [`Self::render`] takes them.
    pub(super) fn rays_of_pixels(
        &self,
        (scene, plan): (&ValidScene, &Plan),
        job: &Job,
        denoise: bool,
    ) -> Option<Vec<u64>> {
        let [width, height] =
            [scene.camera().width, scene.camera().height].map(|side| side.get() as usize);
        let rays: Vec<_> = (0..width * height).map(|_| AtomicU64::new(0)).collect();
        let on_pixel = |step: Step| {
            let [x, y] = step.pixel.map(|at| at as usize);
            rays[y * width + x].fetch_add(step.rays, Relaxed);
            (self.on_pixel)(step)
        };
        let world = AnyWorld::prepare_at(scene, plan, self.simd);
        film(&world, job, denoise, &on_pixel)?;
        Some(rays.into_iter().map(AtomicU64::into_inner).collect())
    }

    /// Does a piece of work on all threads.
    pub(super) fn work<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.wide.install(work)
    }

    /// Does a piece of work on one thread. Returns its duration, too.
    pub(super) fn measure<T: Send>(&self, work: impl FnOnce() -> T + Send) -> (T, Time) {
        self.narrow.install(|| self.clock.measure(work))
    }
}
