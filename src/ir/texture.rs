//! Textures: functions of the texture coordinates of a surface point.

use super::ImageId;
use arbitrary::Arbitrary;
use rtc_math::{Positive, SolidTexture, TextureMapping, TexturePattern, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a texture in [`super::Scene::textures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct TextureId(pub u32);

/// A texture of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Texture {
    /// The colour (u, 0, v), which shows the parametrisation of a surface.
    Uv,
    /// An image over the unit square, v = 1 at its top row, repeated outside; bilinear, with the
    /// outermost texel centres on the edges: u = 0 is the centre of the first column, u = 1 that of
    /// the last.
    Image(ImageId),
    /// An image as glTF samples it: v = 0 at its top row, texel centres half a texel inside.
    Sampled(Sampled),
    /// A pattern in closed form, without an image.
    Procedural(Procedural),
}

/// A pattern in closed form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Procedural {
    /// The pattern.
    pub pattern: TexturePattern,
    /// The colours where the pattern is 0 and 1, linear RGB, each channel at least 0; blended
    /// between.
    #[schemars(inner(inner(range(min = 0.0))))]
    pub colors: [[f64; 3]; 2],
    /// The number of cells of the pattern per unit of its coordinates, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: f64,
    /// The coordinates of the pattern.
    #[serde(default)]
    pub mapping: TextureMapping,
}

impl Procedural {
    /// The pattern with its colours; `None` if its scale is not above 0.
    #[must_use]
    pub fn solid(&self) -> Option<SolidTexture> {
        Some(SolidTexture {
            pattern: self.pattern,
            colors: self.colors.map(Vec3::from_array),
            scale: Positive::new(self.scale)?,
            mapping: self.mapping,
        })
    }
}

/// An image with its sampler.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Sampled {
    /// The image.
    pub image: ImageId,
    /// How the image continues outside the unit square, along u and v.
    pub wrap: [Wrap; 2],
    /// How texels are interpolated.
    pub filter: Filter,
}

/// How an image continues outside the unit square.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Wrap {
    /// It repeats.
    #[default]
    Repeat,
    /// It repeats, mirrored at each edge.
    Mirror,
    /// With the texels of the edge.
    Clamp,
}

/// How texels are interpolated.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Filter {
    /// Bilinearly, between the four nearest.
    #[default]
    Linear,
    /// By the nearest texel.
    Nearest,
}
