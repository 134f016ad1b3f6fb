//! The result of a study, which can be printed, saved as JSON and read again.

use super::maps::PixelRays;
use super::metrics::PictureErrors;
use super::parameter::Parameter;
use super::reference::{DepthEnd, ParameterLevel};
use super::setting::Setting;
use super::spread::ErrorSpread;
use super::statistics::{Estimate, PowerLaw};
use super::{EffectCost, Effort, PrecisionCost};
use rtc_image::Image;
use rtc_render::{Crop, RayCounts};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The subject of a study, and the machine it ran on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct StudyProvenance {
    /// The name of the scene.
    pub scene: String,
    /// The hash of the scene's IR.
    pub hash: String,
    /// The program and its version.
    pub software: String,
    /// The processor, if known.
    pub processor: String,
    /// The number of cores available.
    pub cores: usize,
}

/// The part of the picture that was rendered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct StudyArea {
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// The tiles rendered, or 0 for the whole picture.
    pub tiles: usize,
    /// The number of rendered pixels.
    pub pixels: u64,
    /// Their fraction of the picture.
    #[serde(rename = "share")]
    pub fraction: f64,
}

/// The reference of a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct ReferenceReport {
    /// Its setting, for each of its two halves.
    pub setting: Setting,
    /// The error of the reference, in grey levels: half the difference of its halves.
    pub floor: f64,
}

/// The effect of more bounces than the scene has. It is not an error: all errors are measured
/// against a picture with the scene's depth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct MoreBounces {
    /// The depth of the scene.
    #[serde(rename = "own")]
    pub scene_depth: u32,
    /// The end of the search for deeper paths.
    pub end: DepthEnd,
    /// Each greater depth that was tried.
    pub deeper: Vec<BounceCost>,
}

/// A depth greater than that of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct BounceCost {
    /// The depth.
    pub depth: u32,
    /// The ratio of rays to those of the scene's depth.
    pub ray_ratio: f64,
    /// The difference from the picture of the scene's depth, in grey levels.
    pub difference: f64,
}

/// The study of one parameter, with all others fixed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct ParameterReport {
    /// The parameter.
    #[serde(rename = "knob")]
    pub parameter: Parameter,
    /// The reason why it does not apply to this scene, if it does not.
    #[serde(rename = "idle")]
    pub not_applicable: Option<String>,
    /// Its values, with all other parameters as in the reference.
    #[serde(rename = "rungs")]
    pub levels: Vec<ParameterLevel>,
    /// The power law of its error in samples, if there is one.
    pub law: Option<PowerLaw>,
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RayTotals {
    /// Camera rays.
    pub camera: u64,
    /// Shadow rays.
    pub shadow: u64,
    /// Reflected rays, including glossy ones.
    pub mirror: u64,
    /// Refracted rays.
    pub refracted: u64,
}

impl RayTotals {
    /// All variants.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.camera + self.shadow + self.mirror + self.refracted
    }
}

impl From<RayCounts> for RayTotals {
    fn from(counts: RayCounts) -> Self {
        let RayCounts {
            camera,
            shadow,
            mirror,
            refracted,
            hits: _,
            unnumbered: _,
            ..
        } = counts;
        Self {
            camera,
            shadow,
            mirror,
            refracted,
        }
    }
}

/// A measured setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct StudyRow {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the scene's setting.
    #[serde(rename = "own")]
    pub is_scene_setting: bool,
    /// Whether it is on the Pareto front: its error is certainly below that of all cheaper rows on
    /// the front.
    pub front: bool,
    /// The rays of the rendered part.
    pub rays: RayTotals,
    /// Processor seconds for the whole picture.
    pub seconds: Estimate,
    /// The ratio of its time to that of the scene's setting.
    pub ratio: Estimate,
    /// Its errors.
    pub errors: PictureErrors,
    /// The error over renders with other seeds.
    pub spread: ErrorSpread,
    /// Whether the reference resolves the error; if not, the errors are upper bounds.
    #[serde(rename = "judged")]
    pub is_resolved: bool,
    /// Whether some of its seconds were measured before the study was interrupted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub resumed: bool,
    /// The `errors.rmse` that the model predicted; for a denoised row, that without denoising.
    pub model: f64,
    /// The pixels.
    #[serde(skip)]
    pub(super) tiles: Vec<Image>,
}

/// The cost of accuracy in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Study {
    /// The schema of this report: `rtc-cost/3`.
    #[schemars(extend("const" = "rtc-cost/3"))]
    pub schema: String,
    /// The subject, and the machine.
    pub about: StudyProvenance,
    /// The budget in rays.
    pub effort: Effort,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The part of the picture that was rendered.
    pub part: StudyArea,
    /// The reference for all errors.
    pub reference: ReferenceReport,
    /// Each parameter alone.
    #[serde(rename = "knobs")]
    pub parameters: Vec<ParameterReport>,
    /// The effect of more bounces; `None` if the depth changes nothing.
    pub bounces: Option<MoreBounces>,
    /// The measured settings in ascending order of cost: by seconds where these differ clearly,
    /// otherwise by rays.
    pub rows: Vec<StudyRow>,
    /// The cost of each effect.
    pub effects: Vec<EffectCost>,
    /// The cost of each arithmetic.
    pub precision: Vec<PrecisionCost>,
    /// Wall time over processor time: above 1.2 the machine was busy.
    pub wall_over_cpu: f64,
    /// The advice, as sentences.
    pub advice: Vec<String>,
    /// The command that renders the recommended setting.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The pixels of the reference.
    #[serde(skip)]
    pub(super) reference_tiles: Vec<Image>,
    /// The positions of the reference tiles in the picture.
    #[serde(skip)]
    pub(super) areas: Vec<Crop>,
    /// The rays of each pixel, for the maps.
    #[serde(skip)]
    pub(super) mapped: Vec<PixelRays>,
}

impl Study {
    /// The parameters that apply.
    #[must_use]
    pub fn used(&self) -> Vec<Parameter> {
        self.parameters
            .iter()
            .filter(|report| report.not_applicable.is_none())
            .map(|report| report.parameter)
            .collect()
    }

    /// The row of the scene's setting.
    #[must_use]
    pub fn scene_row(&self) -> Option<&StudyRow> {
        self.rows.iter().find(|row| row.is_scene_setting)
    }

    /// The study as JSON, without its pictures.
    ///
    /// # Panics
    /// Never: a study can always be serialised.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a study holds names and numbers") + "\n"
    }
}
