//! What a study finds: data alone, to be printed, kept and read again.

use super::knob::Knob;
use super::metrics::Errors;
use super::reference::{DepthEnd, Level};
use super::setting::Setting;
use super::statistics::{Estimate, PowerLaw};
use super::{EffectCost, Effort, PrecisionCost};
use crate::image::Image;
use crate::render::Counts;
use serde::{Deserialize, Serialize};

/// What a study is of, and where it ran.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct About {
    /// The name of the scene.
    pub scene: String,
    /// The hash of the scene's IR.
    pub hash: String,
    /// The program and its version.
    pub software: String,
    /// The processor, as far as it is known.
    pub processor: String,
    /// How many cores it has for us.
    pub cores: usize,
}

/// The part of the picture that was looked at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StudyArea {
    /// Width and height of the whole picture.
    pub size: [u32; 2],
    /// Tiles looked at, or 0 for the whole.
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
    /// How the search for enough depth ended; none if depth changes nothing.
    pub depth: Option<DepthEnd>,
}

/// A knob alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct KnobReport {
    /// The knob.
    pub knob: Knob,
    /// Why it is not turned in this scene, if so.
    pub idle: Option<String>,
    /// Its values, all others as good as the reference.
    #[serde(rename = "rungs")]
    pub levels: Vec<Level>,
    /// The law of its error in samples, if there is one.
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
    /// Whether nothing else has less error for no more time.
    pub front: bool,
    /// The rays of the part looked at.
    pub rays: Rays,
    /// Processor seconds for the whole picture.
    pub seconds: Estimate,
    /// Seconds over those of the scene's own setting.
    pub ratio: Estimate,
    /// How far it is off.
    pub errors: Errors,
    /// Whether the reference is good enough to judge: if not, the errors are upper limits.
    pub judged: bool,
    /// What the model expected `errors.rmse` to be.
    pub model: f64,
    /// The pixels.
    #[serde(skip)]
    pub(super) tiles: Vec<Image>,
}

/// What accuracy costs in a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Study {
    /// The form of this report: `rtc-cost/1`.
    pub schema: String,
    /// What it is of, and where it ran.
    pub about: About,
    /// The rays it was allowed.
    pub effort: Effort,
    /// The seed of its chances.
    pub seed: u64,
    /// The part of the picture that was looked at.
    pub part: StudyArea,
    /// What errors are measured against.
    pub reference: ReferenceReport,
    /// Each knob alone.
    pub knobs: Vec<KnobReport>,
    /// Settings as measured, from the cheapest up: by seconds where those tell, else by rays.
    pub rows: Vec<Row>,
    /// What each effect costs.
    pub effects: Vec<EffectCost>,
    /// What each arithmetic costs.
    pub precision: Vec<PrecisionCost>,
    /// Wall time over processor time: above 1.2 the machine was busy.
    pub wall_over_cpu: f64,
    /// What follows, in plain words.
    pub advice: Vec<String>,
    /// The pixels of the reference.
    #[serde(skip)]
    pub(super) truth: Vec<Image>,
}

impl Study {
    /// The knobs that change something.
    #[must_use]
    pub fn used(&self) -> Vec<Knob> {
        self.knobs
            .iter()
            .filter(|report| report.idle.is_none())
            .map(|report| report.knob)
            .collect()
    }

    /// The row of the scene's own setting.
    #[must_use]
    pub fn own(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.own)
    }
}
