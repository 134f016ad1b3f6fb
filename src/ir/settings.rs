//! The settings: what a pixel shows and how much work goes into it.

use super::standard::is_default;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// By which rules the picture is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Settings {
    /// What a pixel shows.
    pub mode: Mode,
    /// Whether surfaces hide lights from each other.
    pub shadows: bool,
    /// How many mirror or refraction bounces follow the first hit.
    pub max_depth: u32,
    /// Sub-samples along each side of a pixel, at least 1.
    #[schemars(range(min = 1))]
    pub supersampling: u32,
    /// Where in its cell each sub-sample lies.
    #[serde(default, skip_serializing_if = "Pattern::is_grid")]
    pub pattern: Pattern,
    /// How many points of each soft light are asked, at least 1; 1 asks its centre.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    #[schemars(range(min = 1))]
    pub light_samples: u32,
    /// Whether Phong's terms of the first hit fall in steps, and what the viewer grazes is dark, as
    /// in a cartoon; of no meaning in other modes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub toon: bool,
    /// How often Phong's ambient term is added.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ambient: Ambient,
}

/// How often Phong's ambient term, ka·C, is added at a point.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Ambient {
    /// Once for each light, times the colour of the light.
    #[default]
    PerLight,
    /// Once, whatever lights there are.
    Once,
}

fn one() -> u32 {
    1
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_one(count: &u32) -> bool {
    *count == 1
}

/// Where in its cell of the pixel each sub-sample lies.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Pattern {
    /// In the middle.
    #[default]
    Grid,
    /// Anywhere in its cell, seeded by pixel and sample.
    Jitter,
    /// Anywhere in the pixel, seeded by pixel and sample.
    Random,
}

impl Pattern {
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_grid(&self) -> bool {
        *self == Self::Grid
    }
}

/// What a pixel shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Mode {
    /// Phong's model with shadows, mirrors and refraction.
    Phong,
    /// The distance of the first hit: near is white, far is black.
    Zbuffer,
    /// The normal of the first hit, (N + 1)/2 per component.
    Normal,
    /// Gooch's cool-to-warm shading.
    Gooch(Gooch),
    /// The light that arrives along all paths, from the materials and lights in physical units.
    Path(PathSettings),
}

/// How paths are traced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
#[schemars(rename = "Path")]
pub struct PathSettings {
    /// Paths a pixel, at least 1.
    #[schemars(range(min = 1))]
    pub samples: u32,
    /// Whether rough surfaces keep the light that bounces between their facets.
    pub multiple_scattering: bool,
}

impl PathSettings {
    /// Bounces of a path, where nobody says how many.
    pub const DEPTH: u32 = 16;
}

impl Default for PathSettings {
    /// What is good for a look.
    fn default() -> Self {
        Self {
            samples: 64,
            multiple_scattering: true,
        }
    }
}

/// The parameters of Gooch shading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Gooch {
    /// The blue of the cool colour.
    pub b: f64,
    /// The yellow of the warm colour.
    pub y: f64,
    /// How much of the surface's colour the cool tone takes.
    pub alpha: f64,
    /// How much of the surface's colour the warm tone takes.
    pub beta: f64,
}
