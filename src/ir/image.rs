//! The images: pixels, as textures look them up.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of an image in [`super::Scene::images`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct ImageId(pub u32);

/// A picture of 8 bits a channel.
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
    /// The pixels in rows from the top, three bytes each (red, green, blue), as Base64 with padding (RFC 4648, §4).
    pub pixels: String,
}
