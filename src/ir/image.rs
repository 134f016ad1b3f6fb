//! The images: pixels, as textures look them up.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of an image in [`super::Scene::images`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct ImageId(pub u32);

/// A picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Image {
    /// What its file was called, as the scene names it; empty if it has no name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Width in pixels, at least 1.
    #[schemars(range(min = 1))]
    pub width: u32,
    /// Height in pixels, at least 1.
    #[schemars(range(min = 1))]
    pub height: u32,
    /// What a pixel is made of.
    #[serde(default, skip_serializing_if = "Pixels::is_rgb8")]
    pub kind: Pixels,
    /// The pixels in rows from the top, as Base64 with padding (RFC 4648, §4).
    pub pixels: String,
}

/// What a pixel is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase")]
pub enum Pixels {
    /// Three bytes: red, green, blue.
    #[default]
    Rgb8,
    /// Four bytes: red, green, blue, alpha.
    Rgba8,
    /// Three little-endian 32-bit floats: red, green, blue, linear.
    Rgb32f,
}

impl Pixels {
    /// Bytes of one pixel.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::Rgb8 => 3,
            Self::Rgba8 => 4,
            Self::Rgb32f => 12,
        }
    }

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
    fn is_rgb8(&self) -> bool {
        *self == Self::Rgb8
    }
}
