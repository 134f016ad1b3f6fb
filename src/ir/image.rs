//! Images: the pixels that textures sample.

use super::Scene;
use arbitrary::Arbitrary;
use rtc_math::{SharedList, to_u32};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of an image in [`super::Scene::images`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct ImageId(pub u32);

/// An image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Image {
    /// The name of its file as the scene writes it; empty if there is none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Width in pixels, at least 1.
    #[schemars(range(min = 1))]
    pub width: u32,
    /// Height in pixels, at least 1.
    #[schemars(range(min = 1))]
    pub height: u32,
    /// The pixel format.
    #[serde(default, skip_serializing_if = "Pixels::is_rgb8")]
    pub kind: Pixels,
    /// The pixels in rows from the top, as Base64 with padding (RFC 4648, §4).
    #[serde(with = "base64_text")]
    #[schemars(with = "String")]
    pub pixels: SharedList<u8>,
}

impl Scene {
    /// Adds an image and returns its index.
    pub fn add_image(&mut self, image: Image) -> ImageId {
        self.images.push(image);
        ImageId(to_u32(self.images.len() - 1))
    }
}

/// The format of a pixel.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
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
    /// Bytes per pixel.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::Rgb8 => 3,
            Self::Rgba8 => 4,
            Self::Rgb32f => 12,
        }
    }

    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_rgb8(&self) -> bool {
        *self == Self::Rgb8
    }
}

/// Bytes as a Base64 string with padding.
mod base64_text {
    use super::SharedList;
    use base64::Engine as _;
    use base64::display::Base64Display;
    use base64::engine::general_purpose::STANDARD;
    use serde::de::{Error, Visitor};
    use serde::{Deserializer, Serializer};
    use std::fmt;

    pub(super) fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&Base64Display::new(bytes, &STANDARD))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<SharedList<u8>, D::Error> {
        deserializer.deserialize_str(Base64Visitor)
    }

    struct Base64Visitor;

    impl Visitor<'_> for Base64Visitor {
        type Value = SharedList<u8>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("Base64 with padding")
        }

        fn visit_str<E: Error>(self, text: &str) -> Result<SharedList<u8>, E> {
            let bytes = STANDARD.decode(text);
            bytes
                .map(SharedList::from)
                .map_err(|error| E::custom(format_args!("this is not Base64: {error}")))
        }
    }
}
