//! Settings: the integrator and its sampling parameters.

use super::standard::is_default;
use arbitrary::Arbitrary;
use rtc_math::PixelFilter;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};

/// The integrator and its sampling parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Settings {
    /// The integrator.
    pub mode: Mode,
    /// Whether surfaces cast shadows.
    pub shadows: bool,
    /// The maximum number of reflections or refractions after the first hit.
    pub max_depth: u32,
    /// Sub-samples along each side of a pixel, at least 1.
    #[schemars(range(min = 1))]
    pub supersampling: u32,
    /// The position of each sub-sample in its cell.
    #[serde(default, skip_serializing_if = "Pattern::is_grid")]
    pub pattern: Pattern,
    /// Samples per soft light, at least 1; with 1 the sample is its centre.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    #[schemars(range(min = 1))]
    pub light_samples: u32,
    /// Toon shading: the Phong terms of the first hit are quantised and silhouettes are black;
    /// without effect in other modes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub toon: bool,
    /// How often the ambient term of the Phong model is added.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ambient: Ambient,
    /// The colour of the ambient light, which multiplies an ambient term that is added once.
    #[serde(default = "white", skip_serializing_if = "is_white")]
    #[schemars(inner(range(min = 0.0)))]
    pub ambient_light: [f64; 3],
    /// The colour of pixels where the camera sees nothing, in the values of the picture file; if
    /// absent, the environment or black.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(inner(range(min = 0.0))))]
    pub background: Option<[f64; 3]>,
    /// The distance between two eyes of a perspective camera in scene units; 0 for one eye.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(min = 0.0))]
    pub stereo: f64,
    /// How the picture shows what two eyes see.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stereo_view: StereoView,
    /// When the shutter of the camera opens and closes, in seconds: in between surfaces with a
    /// velocity move.
    #[serde(default = "one_second", skip_serializing_if = "is_one_second")]
    pub shutter: [f64; 2],
}

impl Default for Settings {
    /// Phong shading without shadows and reflections, one sub-sample per pixel.
    fn default() -> Self {
        Self {
            mode: Mode::Phong,
            shadows: false,
            max_depth: 0,
            supersampling: 1,
            pattern: Pattern::Grid,
            light_samples: 1,
            toon: false,
            ambient: Ambient::PerLight,
            ambient_light: white(),
            background: None,
            stereo: 0.0,
            stereo_view: StereoView::SideBySide,
            shutter: one_second(),
        }
    }
}

impl Settings {
    /// The settings of an asset that has none: path tracing.
    #[must_use]
    pub fn paths() -> Self {
        Self {
            mode: Mode::Path(PathSettings::default()),
            shadows: true,
            max_depth: PathSettings::DEPTH,
            ..Self::default()
        }
    }

    /// The schema of the text form.
    #[must_use]
    pub fn schema() -> Schema {
        schemars::schema_for!(Self)
    }

    /// The names of the fields in the text form, in order.
    #[must_use]
    pub fn names() -> Vec<String> {
        names(&Self::schema())
    }
}

/// The names of the fields in a schema, in order.
fn names(schema: &Schema) -> Vec<String> {
    let properties = schema.get("properties").and_then(|all| all.as_object());
    properties.map_or_else(Vec::new, |all| all.keys().cloned().collect())
}

/// How often the ambient term of the Phong model, ka·C, is added at a point.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Ambient {
    /// Once per light, multiplied by the colour of the light.
    #[default]
    PerLight,
    /// Once, independent of the number of lights.
    Once,
}

/// How a picture shows what two eyes see.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum StereoView {
    /// The left half of the picture is what the left eye sees of the image, the right half what
    /// the right eye sees.
    #[default]
    SideBySide,
    /// Both eyes see the whole image: one picture for glasses with a red filter on the left and a
    /// cyan one on the right.
    Anaglyph,
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn one_second() -> [f64; 2] {
    [0.0, 1.0]
}

fn is_one_second(shutter: &[f64; 2]) -> bool {
    shutter.map(f64::to_bits) == one_second().map(f64::to_bits)
}

fn is_white(color: &[f64; 3]) -> bool {
    *color == white()
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

/// The position of each sub-sample in its cell of the pixel.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Pattern {
    /// At the centre of the cell.
    #[default]
    Grid,
    /// Uniformly in the cell (stratified), seeded by pixel and sample.
    Jitter,
    /// Uniformly in the pixel, seeded by pixel and sample.
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

/// The integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Mode {
    /// Whitted ray tracing with the Phong model: shadows, reflection and refraction.
    Phong,
    /// The distance of the first hit: near is white, far is black.
    #[serde(rename = "zbuffer")]
    Depth,
    /// The normal of the first hit, (N + 1)/2 per component.
    Normal,
    /// Gooch's cool-to-warm shading.
    Gooch(Gooch),
    /// Path tracing with physical materials and lights.
    Path(PathSettings),
}

/// Parameters of path tracing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
#[schemars(rename = "Path")]
pub struct PathSettings {
    /// Paths per pixel, at least 1.
    #[schemars(range(min = 1))]
    pub samples: u32,
    /// Whether rough surfaces keep the light that is scattered several times between microfacets.
    pub multiple_scattering: bool,
    /// Whether the caustics of small lights are estimated by manifold sampling. Otherwise paths
    /// find them by chance, and those of point lights not at all.
    #[serde(default, skip_serializing_if = "is_default")]
    pub caustics: bool,
    /// The reconstruction filter of the pixels.
    #[serde(default, skip_serializing_if = "PixelFilter::is_pixel")]
    pub filter: PixelFilter,
}

impl PathSettings {
    /// The default number of bounces of a path.
    pub const DEPTH: u32 = 16;

    /// The names of the fields in the text form, in order.
    #[must_use]
    pub fn names() -> Vec<String> {
        names(&schemars::schema_for!(Self))
    }
}

impl Default for PathSettings {
    /// The defaults: 64 paths per pixel, with multiple scattering.
    fn default() -> Self {
        Self {
            samples: 64,
            multiple_scattering: true,
            caustics: false,
            filter: PixelFilter::PIXEL,
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
    /// The weight of the surface colour in the cool tone.
    pub alpha: f64,
    /// The weight of the surface colour in the warm tone.
    pub beta: f64,
}
