//! The result of a study, to be printed, kept and read again.

use super::maps::PixelRays;
use super::metrics::Errors;
use super::parameter::Parameter;
use super::reference::{DepthEnd, Level};
use super::setting::Setting;
use super::spread::ErrorSpread;
use super::statistics::{Estimate, PowerLaw};
use super::{EffectCost, Effort, PrecisionCost};
use rtc_image::Image;
use rtc_render::{Counts, Crop};
use serde::{Deserialize, Serialize};

/// The subject of a study, and the machine it ran on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct About {
    /// The name of the scene.
    pub scene: String,
    /// The hash of the scene's IR.
    pub hash: String,
    /// The program and its version.
    pub software: String,
    /// The processor, if it is known.
    pub processor: String,
    /// The number of cores available.
    pub cores: usize,
}

/// The part of the picture that was rendered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StudyArea {
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// The tiles rendered, or 0 for the whole picture.
    pub tiles: usize,
    /// Pixels looked at.
    pub pixels: u64,
    /// Their fraction of the picture.
    #[serde(rename = "share")]
    pub fraction: f64,
}

/// The reference of a study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ReferenceReport {
    /// Its setting, for each of its two halves.
    pub setting: Setting,
    /// Its own error, in grey levels: half the difference of the halves.
    pub floor: f64,
}

/// What more bounces than the scene's own would add to its picture. That is no error: the scene
/// asks for its own depth, and all errors are against the picture of that depth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct MoreBounces {
    /// The scene's own depth.
    pub own: u32,
    /// How the search for deeper paths ended.
    pub end: DepthEnd,
    /// Each greater depth that was tried.
    pub deeper: Vec<BounceCost>,
}

/// A depth greater than the scene's own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct BounceCost {
    /// The depth.
    pub depth: u32,
    /// The ratio of rays to those of the scene's own depth.
    pub ray_ratio: f64,
    /// The difference of the picture from that of the scene's own depth, in grey levels.
    pub difference: f64,
}

/// A knob alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ParameterReport {
    /// The knob.
    #[serde(rename = "knob")]
    pub parameter: Parameter,
    /// The reason to leave it alone in this scene, if there is one.
    #[serde(rename = "idle")]
    pub not_applicable: Option<String>,
    /// Its values, with all other knobs as in the reference.
    #[serde(rename = "rungs")]
    pub levels: Vec<Level>,
    /// The power law of its error in samples, if there is one.
    pub law: Option<PowerLaw>,
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rays {
    /// From the eye.
    pub camera: u64,
    /// To a light.
    pub shadow: u64,
    /// Mirrored, glossy ones too.
    pub mirror: u64,
    /// Refracted.
    pub refracted: u64,
}

impl Rays {
    /// All of them.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.camera + self.shadow + self.mirror + self.refracted
    }
}

impl From<Counts> for Rays {
    fn from(counts: Counts) -> Self {
        let Counts {
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

/// A setting as measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Row {
    /// The setting.
    pub setting: Setting,
    /// Whether it is that of the scene.
    pub own: bool,
    /// Whether it is on the front: it surely has less error than whatever is there and costs less.
    pub front: bool,
    /// The rays of the part rendered.
    pub rays: Rays,
    /// Processor seconds for the whole picture.
    pub seconds: Estimate,
    /// The ratio of its time to that of the scene's own setting.
    pub ratio: Estimate,
    /// Its errors.
    pub errors: Errors,
    /// The error over renders by other random numbers.
    pub spread: ErrorSpread,
    /// Whether the reference is accurate enough: if not, the errors are upper limits.
    #[serde(rename = "judged")]
    pub is_resolved: bool,
    /// Whether some of its seconds were measured before the study was interrupted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub resumed: bool,
    /// The `errors.rmse` that the model predicted; of a denoised row, that of the plain one.
    pub model: f64,
    /// The pixels.
    #[serde(skip)]
    pub(super) tiles: Vec<Image>,
}

/// What accuracy costs in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Study {
    /// The form of this report: `rtc-cost/3`.
    pub schema: String,
    /// The subject, and the machine.
    pub about: About,
    /// The budget in rays.
    pub effort: Effort,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The part of the picture that was rendered.
    pub part: StudyArea,
    /// The reference for all errors.
    pub reference: ReferenceReport,
    /// Each knob alone.
    #[serde(rename = "knobs")]
    pub parameters: Vec<ParameterReport>,
    /// What more bounces would add; none if depth changes nothing.
    pub bounces: Option<MoreBounces>,
    /// The measured settings in ascending order of cost: by seconds where those differ clearly, else by rays.
    pub rows: Vec<Row>,
    /// The cost of each effect.
    pub effects: Vec<EffectCost>,
    /// The cost of each arithmetic.
    pub precision: Vec<PrecisionCost>,
    /// Wall time over processor time: above 1.2 the machine was busy.
    pub wall_over_cpu: f64,
    /// The advice, in plain words.
    pub advice: Vec<String>,
    /// The command that renders the setting that is recommended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<String>,
    /// The pixels of the reference.
    #[serde(skip)]
    pub(super) reference_tiles: Vec<Image>,
    /// Where its pictures lie in the whole one.
    #[serde(skip)]
    pub(super) areas: Vec<Crop>,
    /// The rays of each pixel, for the maps.
    #[serde(skip)]
    pub(super) mapped: Vec<PixelRays>,
}

impl Study {
    /// The knobs that change something.
    #[must_use]
    pub fn used(&self) -> Vec<Parameter> {
        self.parameters
            .iter()
            .filter(|report| report.not_applicable.is_none())
            .map(|report| report.parameter)
            .collect()
    }

    /// The row of the scene's own setting.
    #[must_use]
    pub fn scene_row(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.own)
    }
}
