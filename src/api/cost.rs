//! What accuracy costs in a scene.

use super::clock::Stopwatch;
use super::scene::SceneRun;
use super::{Error, Options, Scene};
use cpu_time::ThreadTime;
use rtc_ir as ir;
use rtc_pipeline as pipeline;
use rtc_study::{
    self as study, Estimate, Stopped, Study, StudyProvenance, StudyRuntime, WorkClock,
};
use std::time::Duration;

/// How much a study of the cost renders.
///
/// ```
/// use rtc::Effort;
///
/// assert_eq!(Effort::default(), Effort::Normal);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Effort {
    /// At most 20 seconds of one processor of 2025, for most scenes.
    Quick,
    /// At most a minute.
    #[default]
    Normal,
    /// Ten minutes and more.
    Thorough,
}

/// What accuracy costs in a scene: many settings, each rendered and compared with a reference.
/// [`Scene::cost`] measures it.
///
/// ```no_run
/// use rtc::{Effort, Scene};
///
/// let scene = Scene::open("scene.yaml")?;
/// let cost = scene.cost(Effort::Quick)?;
/// println!("{}", cost.advice().join("\n"));
/// // The cheapest setting whose error is invisible.
/// if let Some(row) = cost.recommended() {
///     scene.render(&row.options)?.save("scene.png")?;
/// }
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cost {
    study: Study,
    rows: Vec<CostRow>,
    recommended: Option<usize>,
}

/// A setting with its error and its time; each number is a best estimate with the ends of its 95 %
/// confidence interval.
///
/// ```no_run
/// use rtc::{Effort, Scene};
///
/// for row in Scene::open("scene.yaml")?.cost(Effort::Quick)?.rows() {
///     println!("{}: {} grey levels in {} s", row.setting, row.error, row.seconds);
/// }
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CostRow {
    /// The options that render the scene in this setting.
    pub options: Options,
    /// The setting as text, for example `4×4, depth 3`.
    pub setting: String,
    /// Whether it is the scene's own setting.
    pub is_own: bool,
    /// Whether it is on the Pareto front: all cheaper settings certainly have a larger error.
    pub is_on_front: bool,
    /// The root mean square error against the reference, in grey levels of 8 bits.
    pub error: f64,
    /// Its interval.
    pub error_interval: [f64; 2],
    /// Processor seconds for the whole picture.
    pub seconds: f64,
    /// Their interval.
    pub seconds_interval: [f64; 2],
    /// The rays of the part of the picture that was rendered.
    pub rays: u64,
}

impl Scene {
    /// Studies the cost of accuracy in the scene, as `rtc cost` does: renders it in many settings,
    /// with all threads, or one where time is measured.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the scene has errors, [`Error::Refused`] if there are no threads.
    pub fn cost(&self, effort: Effort) -> Result<Cost, Error> {
        self.cost_until(effort, &|| false)
    }

    /// Studies the cost unless it is stopped, as in [`Scene::render_until`].
    ///
    /// # Errors
    /// As [`Scene::cost`], and [`Error::Stopped`].
    pub fn cost_until(
        &self,
        effort: Effort,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Cost, Error> {
        self.run().cost(effort, is_stopped)
    }
}

impl SceneRun<'_> {
    fn cost(
        mut self,
        effort: Effort,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Cost, Error> {
        // A study has a measure of work of its own.
        self.input.lift_rays();
        let options = Options::new();
        let subject = self.validate(&options, &mut options.setup()?)?;
        let scene = &subject.validated.lowered.scene;
        let about = StudyProvenance {
            scene: self.input.name().to_owned(),
            hash: pipeline::hash(scene),
            software: concat!("rtc ", env!("CARGO_PKG_VERSION")).to_owned(),
            processor: std::env::consts::ARCH.to_owned(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
        };
        let stopwatch = Stopwatch::start();
        let cpu = || ThreadTime::try_now().map_or(Duration::ZERO, |time| time.as_duration());
        let wall = || stopwatch.elapsed();
        let clock = WorkClock {
            cpu: &cpu,
            wall: &wall,
        };
        let on_pixel = |_| !is_stopped();
        let runtime = StudyRuntime::new(0, clock, &on_pixel);
        let runtime = runtime.map_err(|error| self.error(error.into()))?;
        let studied = study::study(scene, about, effort.into(), 0, &runtime);
        let study = studied.map_err(|Stopped| Error::Stopped)?;
        Ok(Cost::new(study, scene))
    }
}

impl Cost {
    fn new(study: Study, scene: &ir::Scene) -> Self {
        let used = study.used();
        let recommended = study::recommended(&study).map(|row| row.setting);
        let row = |row: &study::StudyRow| CostRow {
            options: Options::of_setting(&row.setting, scene),
            setting: row.setting.label(&used),
            is_own: row.is_scene_setting,
            is_on_front: row.front,
            error: row.errors.rmse,
            error_interval: [row.errors.rmse_low, row.errors.rmse_high],
            seconds: row.seconds.value,
            seconds_interval: interval(row.seconds),
            rays: row.rays.all(),
        };
        Self {
            rows: study.rows.iter().map(row).collect(),
            recommended: study
                .rows
                .iter()
                .position(|row| Some(row.setting) == recommended),
            study,
        }
    }

    /// The settings that were measured, in ascending order of cost.
    #[must_use]
    pub fn rows(&self) -> &[CostRow] {
        &self.rows
    }

    /// The cheapest setting on the Pareto front whose error is certainly invisible (at most 0.5
    /// grey levels), else the best one.
    #[must_use]
    pub fn recommended(&self) -> Option<&CostRow> {
        self.rows.get(self.recommended?)
    }

    /// The advice, as sentences, the main one first.
    #[must_use]
    pub fn advice(&self) -> &[String] {
        &self.study.advice
    }

    /// The whole study as JSON, with parameters, bounces, effects and arithmetics; its JSON Schema
    /// is that of `rtc schema cost`.
    #[must_use]
    pub fn json(&self) -> String {
        self.study.json()
    }
}

fn interval(estimate: Estimate) -> [f64; 2] {
    [estimate.low, estimate.high]
}

impl From<Effort> for study::Effort {
    fn from(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self::QUICK,
            Effort::Normal => Self::DEFAULT,
            Effort::Thorough => Self::THOROUGH,
        }
    }
}
