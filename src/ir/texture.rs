//! The textures: what a point of a surface looks up by its uv.

use super::ImageId;
use arbitrary::Arbitrary;
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
    /// The colour (u, 0, v): shows how uv lies on a surface.
    Uv,
    /// An image over the unit square, v = 1 at its top row, repeated beyond; bilinear with the
    /// outer texels at the very edges: u = 0 is the middle of the first column, u = 1 that of
    /// the last.
    Image(ImageId),
    /// An image as glTF samples it: v = 0 at its top row, texel middles half a texel inside.
    Sampled(Sampled),
}

/// An image with the way it is sampled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Sampled {
    /// The image.
    pub image: ImageId,
    /// What lies beyond the unit square, along u and v.
    pub wrap: [Wrap; 2],
    /// How texels blend.
    pub filter: Filter,
}

/// What lies beyond the unit square.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image again, mirrored at each edge.
    Mirror,
    /// The texel at the edge.
    Clamp,
}

/// How texels blend.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Filter {
    /// The four nearest by their nearness.
    #[default]
    Linear,
    /// The nearest alone.
    Nearest,
}
