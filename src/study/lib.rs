//! The cost of accuracy: one scene in many settings, each with its error and its time, and the
//! settings on the Pareto front (`rtc cost`); rendering to a target error or within a time budget
//! (`rtc render --target-error`, `--time-budget`); comparison of pictures and scenes (`rtc diff`,
//! `rtc cost` with a reference scene).
//!
//! # A study
//!
//! [`study`] runs these steps, each with a fraction of the ray budget ([`Effort`]):
//!
//! 1. [`subject`]: choose random tiles of the picture, as many as the budget allows.
//! 2. [`mod@reference`]: compare path depths; render a reference twice, which gives its own error.
//! 3. [`mod@sweep`]: vary each [`Parameter`] alone and fit a power law to its error; the [`CostModel`]
//!    predicts the error and the rays of any [`Setting`].
//! 4. [`precision`]: measure the error and time of each arithmetic.
//! 5. [`pareto`], [`rows`]: choose candidates with the model, render and time them
//!    ([`benchmark`]), measure their [`PictureErrors`], and find the Pareto front.
//! 6. [`effects`], [`ablation`]: remove effects, lights, objects and materials one at a time.
//! 7. [`mod@advice`], [`mod@maps`], [`report`]: derive advice and maps, and write reports.
//!
//! Decisions depend on ray counts, never on time: the same study renders the same settings on every
//! machine, and an interrupted study resumes from its [`Journal`]. All errors are in grey levels of
//! 8 bits, of display values.
//!
//! # Rendering to a goal
//!
//! [`approach`] refines a progressive film in rounds ([`target`], [`rounds`]) until a bound on its
//! error ([`noise`], [`undersampled`]) meets the target, or until a time budget ends ([`budget`]).
//! [`progressive`] and [`batch`] save and resume checkpoints. [`probe()`] bounds the error of a
//! denoised picture.
//!
//! # Comparison
//!
//! [`Difference`] measures two pictures ([`metrics`], [`mod@flip`]); [`versus()`] compares two
//! scenes with a statistical test ([`statistics`]).
//!
//! # Certified pixels
//!
//! [`certify`](mod@certify) evaluates the Whitted integrator over intervals, and says of each 8-bit
//! value of a picture whether it is proven.
//!
//! # Guarantees
//!
//! Nothing here prints or reads files: clocks, thread pools and the functions that save come in
//! with the [`StudyRuntime`] or the [`RenderCallbacks`]. A picture with only a target error is the
//! same for any number of threads, and for a resumed render.

mod ablation;
mod advice;
mod batch;
mod benchmark;
mod budget;
mod certify;
mod denoised;
mod difference;
mod effects;
mod flip;
mod hypergeometric;
mod journal;
mod maps;
mod metrics;
mod noise;
mod outcome;
mod parameter;
mod pareto;
mod precision;
mod probe;
mod progressive;
mod quality;
mod reference;
#[cfg(feature = "cli")]
mod report;
mod rounds;
mod rows;
mod runtime;
mod setting;
mod spread;
mod statistics;
mod subject;
mod sweep;
mod target;
mod tile_errors;
mod undersampled;
mod versus;

pub use ablation::Ablation;
pub use advice::{advice, recommended};
pub use batch::WorkBatch;
pub use budget::CoarsePicture;
pub use certify::{
    Certainty, CertifiedNumber, DoubleDoubleBall, Doubts, Enclosure, PixelCertificate, certify,
    first_distance,
};
pub use difference::{Difference, heat_map};
pub use effects::EffectCost;
pub use flip::{PIXELS_PER_DEGREE, flip};
pub use hypergeometric::least_faults;
pub use journal::Journal;
pub use maps::{StudyMap, maps};
pub use metrics::{LEVELS, PictureErrors, rmse};
pub use outcome::{
    BounceCost, MoreBounces, ParameterReport, RayTotals, ReferenceReport, Study, StudyArea,
    StudyProvenance, StudyRow,
};
pub use parameter::{Parameter, arithmetic, not_applicable};
pub use precision::PrecisionCost;
pub use probe::{ProbedError, probe};
pub use progressive::{CheckpointSink, ProgressiveRender};
pub use quality::{PixelQuality, quality_of_halves, with_quality};
pub use reference::{DepthEnd, ParameterLevel};
#[cfg(feature = "cli")]
pub use report::{SliderPage, csv, html, maps_page, slider_page, table, value_text, versus_table};
pub use runtime::{StudyRuntime, WorkClock};
pub use setting::Setting;
pub use spread::ErrorSpread;
pub use statistics::{Estimate, PowerLaw, SplitMix64, median};
pub use subject::Stopped;
pub use target::{
    Progress, RenderCallbacks, RenderGoal, RenderRequest, SampleStatistics, TargetResult, approach,
    approach_keeping,
};
pub use versus::{DifferentTile, SceneComparison, versus};

use parameter::not_applicable_in;
use reference::{ComparedDepths, Reference};
use rtc_ir::{Mode, Scene, Shape, Surface};
use rtc_render::SamplingSeeds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use subject::StudySubject;
use sweep::{CostModel, sweep};

/// The ray budget of a study, in rays of a simple scene of a few spheres. Other scenes are weighted
/// by [`ray_cost`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Effort(pub u64);

impl Effort {
    /// Three seconds of one processor of 2025 for most scenes, or eight times the time of the
    /// picture if that is more. Rows have robust arithmetic, but for one in the setting of the
    /// scene.
    pub const QUICK: Self = Self(12_000_000);
    /// At most a minute.
    pub const DEFAULT: Self = Self(180_000_000);
    /// Ten minutes and more.
    pub const THOROUGH: Self = Self(3_000_000_000);

    /// Whether there are rows of cheaper arithmetic in all settings, not in that of the scene
    /// alone.
    fn has_arithmetics(self) -> bool {
        self > Self::QUICK
    }

    /// The ray budget for a scene.
    fn rays(self, scene: &Scene) -> u64 {
        self.0 / ray_cost(scene)
    }
}

/// The approximate cost of a ray of the scene, relative to a simple scene of a few spheres: rules
/// of thumb from processor times, so that the duration of a study does not depend much on the
/// scene.
fn ray_cost(scene: &Scene) -> u64 {
    let is_torus = |surface: &Surface| matches!(surface.shape, Shape::Torus(_));
    if matches!(scene.settings.mode, Mode::Path(_)) {
        return 8;
    }
    match scene.surfaces.iter().any(is_torus) {
        true => 3,
        false => 1,
    }
}

/// The shares of the ray budget, in percent.
const FOR_DEPTH: u64 = 5;
const FOR_REFERENCE: u64 = 36;
const FOR_SWEEPS: u64 = 15;
const FOR_ROWS: u64 = 30;
const FOR_EFFECTS: u64 = 10;
const FOR_PRECISION: u64 = 4;

/// The maximum error of a reference, as a fraction of an error that it resolves.
const MAX_REFERENCE_ERROR: f64 = 0.2;

/// Studies a validated scene.
///
/// # Errors
/// If it was stopped.
pub fn study(
    scene: &Scene,
    about: StudyProvenance,
    effort: Effort,
    seed: u64,
    runtime: &StudyRuntime<'_>,
) -> Result<Study, Stopped> {
    // Choose the tiles; render the reference and fit the model.
    let scope = StudyScope::new(scene, effort);
    let subject = scope.subject_within_budget(&StudySubject::new(scene, seed, runtime))?;
    let mut context = scope.context(&subject)?;
    let mut rng = SplitMix64::new(seed);
    // Measure the cost of each arithmetic.
    let precision = precision::costs(
        &subject,
        scope.scene_setting,
        scope.hundredths(FOR_PRECISION),
        &mut rng,
    )?;
    if scope.used.contains(&Parameter::Precision) {
        context.model.learn_precision(precision::levels(&precision));
    }
    // Measure the rows of the table and the ablations.
    let (rows, wall_over_cpu) = scope.rows(&subject, &context, &mut rng)?;
    let effects = effects::costs(
        &subject,
        scope.scene_setting,
        scope.hundredths(FOR_EFFECTS),
        &mut rng,
    )?;
    // Collect the report.
    let (model, is_whole) = (&context.model, subject.is_whole());
    let parameter =
        |parameter| model.report(parameter, not_applicable_in(parameter, scene, is_whole));
    let mut study = Study {
        schema: "rtc-cost/3".to_owned(),
        about,
        effort,
        seed,
        part: subject.area(),
        reference: context.report(),
        parameters: Parameter::ALL.map(parameter).to_vec(),
        bounces: context.depths.map(|depths| depths.more),
        rows,
        effects,
        precision,
        wall_over_cpu,
        advice: Vec::new(),
        command: None,
        reference_tiles: context.reference.tiles,
        areas: subject.areas(),
        mapped: Vec::new(),
    };
    // Derive advice and maps from it.
    study.advice = advice::advice(&study);
    study.command = advice::command(&study);
    study.mapped = maps::count(&study, &subject)?;
    Ok(study)
}

/// The parameters of a scene, and the ray budget of the study.
struct StudyScope {
    scene_setting: Setting,
    used: Vec<Parameter>,
    /// The parameters that are sample counts.
    sampling: Vec<Parameter>,
    /// The ray budget.
    rays: u64,
    /// Whether there are rows of cheaper arithmetic in all settings.
    has_arithmetics: bool,
}

/// The reference, against which rows are measured, and the model, by which rows are chosen.
struct StudyContext {
    reference: Reference,
    depths: Option<ComparedDepths>,
    model: CostModel,
}

impl StudyScope {
    fn new(scene: &Scene, effort: Effort) -> Self {
        let used: Vec<_> = Parameter::ALL
            .into_iter()
            .filter(|parameter| not_applicable(*parameter, scene).is_none())
            .collect();
        let sampling = used
            .iter()
            .copied()
            .filter(|parameter| parameter.samples_pixels())
            .collect();
        Self {
            scene_setting: Setting::of(scene),
            used,
            sampling,
            rays: effort.rays(scene),
            has_arithmetics: effort.has_arithmetics(),
        }
    }

    fn hundredths(&self, fraction: u64) -> u64 {
        self.rays / 100 * fraction
    }

    /// The scene's setting with estimated caustics, where there are such: that of the reference.
    fn complete(&self) -> Setting {
        let has_caustics = self.used.contains(&Parameter::Caustics);
        Setting {
            caustics: self.scene_setting.caustics || has_caustics,
            ..self.scene_setting
        }
    }

    /// That setting with all sample counts set to one value.
    fn at(&self, value: u32) -> Setting {
        self.sampling
            .iter()
            .fold(self.complete(), |setting, parameter| {
                setting.with(*parameter, value)
            })
    }

    /// Selects the tiles that the budget allows, with a good reference and in the scene's setting.
    fn subject_within_budget<'a>(
        &self,
        subject: &StudySubject<'a>,
    ) -> Result<StudySubject<'a>, Stopped> {
        /// The samples per pixel of a good reference, for a budget in rays.
        const GOOD_REFERENCE: [f64; 2] = [1024.0, 4e8];
        /// Fewer tiles do not represent a picture: this many are used, if the scene's setting can
        /// be afforded for them, even if the reference becomes worse.
        const MIN_REPRESENTATIVE: usize = 32;
        const MIN_TILES: usize = 4;
        subject.report_budget(self.rays);
        if self.sampling.is_empty() {
            return Ok(subject.clone());
        }
        let pilot = subject.keep(2 * MIN_TILES);
        let setting = self.at(2);
        let counts = pilot.render(setting, reference::independent(1))?.counts;
        let rays = counts.rays() as f64 / counts.camera.max(1) as f64;
        let samples = GOOD_REFERENCE[0] * (self.rays as f64 / GOOD_REFERENCE[1]).sqrt();
        let of_reference = self.hundredths(FOR_REFERENCE) as f64 / (3.0 * samples * rays);
        let of_own =
            self.hundredths(FOR_ROWS) as f64 / (6.0 * self.scene_setting.camera_rays() * rays);
        let tiles = |pixels: f64| pixels / pilot.pixels() as f64 * pilot.count() as f64;
        let fraction = tiles(of_reference)
            .max(MIN_REPRESENTATIVE as f64)
            .min(tiles(of_own));
        let enough = (0..subject.count())
            .take_while(|count| (*count as f64) < fraction)
            .count();
        Ok(if enough * 4 > subject.count() * 3 {
            subject.clone()
        } else {
            subject.keep(enough.max(MIN_TILES))
        })
    }

    /// The seeds for comparing depths: two if bounces are sampled at random.
    fn seeds_of_depths(&self) -> Vec<SamplingSeeds> {
        let count = if self.used.contains(&Parameter::Paths) {
            2
        } else {
            1
        };
        (1..=count).map(reference::independent).collect()
    }

    fn context(&self, subject: &StudySubject<'_>) -> Result<StudyContext, Stopped> {
        // Compare the path depths.
        let depths = match self.used.contains(&Parameter::Depth) {
            true => Some(reference::depths(
                subject,
                self.at(2),
                &self.seeds_of_depths(),
                self.hundredths(FOR_DEPTH),
            )?),
            false => None,
        };
        // Render the reference.
        let start = self.at(4);
        let budget = self.hundredths(FOR_REFERENCE);
        let reference = reference::reference(subject, start, &self.sampling, budget)?;
        // Vary each sampling parameter alone.
        let has_grid = self.used.contains(&Parameter::Supersampling);
        let base = if has_grid {
            start.with(Parameter::Supersampling, 2)
        } else {
            start
        };
        let fair = self.hundredths(FOR_SWEEPS) / self.sampling.len().max(1) as u64;
        let parameters = self
            .sampling
            .iter()
            .map(|parameter| sweep(subject, &reference, (*parameter, base), fair));
        let parameters = parameters.collect::<Result<Vec<_>, _>>()?;
        // Fit the model.
        let base_rays = subject
            .render(base, reference::independent(5))?
            .counts
            .rays();
        let mut model = CostModel::new(parameters, depths.as_ref(), base, base_rays);
        if self.used.contains(&Parameter::Aperture) {
            let coarse = base
                .with(Parameter::Supersampling, 1)
                .with(Parameter::Aperture, 1);
            let rendered = subject.render(coarse, SamplingSeeds::NONE)?;
            model.learn_interaction(coarse, rmse(&rendered.tiles, &reference.tiles));
        }
        Ok(StudyContext {
            reference,
            depths,
            model,
        })
    }
}

impl StudyContext {
    fn report(&self) -> ReferenceReport {
        ReferenceReport {
            setting: self.reference.setting,
            floor: self.reference.floor,
        }
    }
}
