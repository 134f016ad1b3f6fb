//! Pixels and pixel files, in memory: a film developed into a picture; a picture written as PNG (8
//! or 16 bit), JPEG, WebP or EXR, the same bytes every time; PNG, JPEG and WebP read, and pictures of light
//! from HDR and EXR.

mod animation;
mod compressed;
mod decode;
mod exr;
mod file;
#[cfg(feature = "cli")]
mod gif;
mod look;
mod png;
mod radiance;
mod range;
#[cfg(feature = "cli")]
mod sheet;
mod shown;
mod texels;

pub use animation::AnimatedPng;
pub use decode::{DecodeCost, DecodeError, Opacity, PixelFile, Pixels, is_picture};
pub use file::{BLOCK_ROWS, PictureHead, StripSource};
#[cfg(feature = "cli")]
pub use gif::AnimatedGif;
pub use look::{Association, BackgroundFill, Look, exposure};
pub use png::png_bytes;
pub use radiance::{Radiance, RadianceFile, is_radiance};
pub use range::Lost;
#[cfg(feature = "cli")]
pub use sheet::{contact_sheet, for_sheet, shrunk};
pub use shown::ShownPicture;
pub use texels::{Texel, Texels};

use std::fmt;

/// A picture: rows from the top, each from the left; red, green, blue.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` values.
    pub pixels: Vec<[f64; 3]>,
}

/// A picture as a file holds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// The colours.
    pub image: Image,
    /// The opacity of each pixel in [0, 1], if not all are opaque.
    pub alpha: Option<Vec<f32>>,
    /// What an EXR holds beside the colours; no other form does.
    pub layers: Layers,
}

/// Further numbers of each pixel of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// The name of each channel, layer and channel apart by a dot, as `normal.X`; none of them
    /// twice.
    pub names: Vec<&'static str>,
    /// The values of all channels, pixel after pixel.
    pub values: Vec<f32>,
}

/// A form of pixel file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// PNG with ⌊255·v⌋ per channel, no gamma.
    Png8,
    /// PNG with ⌊65535·v⌋ per channel, no gamma.
    Png16,
    /// JPEG with ⌊255·v⌋ per channel before its losses, opaque.
    Jpeg,
    /// WebP with ⌊255·v⌋ per channel, lossless.
    Webp,
    /// EXR with 32-bit floats per channel, clamped only to what those hold: all are finite.
    Exr(Origin),
}

/// What an EXR says about where it came from, as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// The program and its version: the standard attribute `software`.
    pub software: String,
    /// The hash of the scene: the attribute `rtc:scene`.
    pub scene: String,
    /// The settings of the render: the attribute `rtc:settings`.
    pub settings: String,
}

/// Why a picture has no pixel file, in the encoder's words; a width or height of 0 is such a
/// reason.
#[derive(Debug)]
pub struct EncodeError(String);

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Picture {
    /// A picture of colours alone.
    #[must_use]
    pub fn opaque(image: Image) -> Self {
        Self {
            image,
            alpha: None,
            layers: Layers::default(),
        }
    }

    /// The bytes of the pixel file.
    ///
    /// # Errors
    /// If the picture is empty or larger than the format can hold.
    pub fn encode(&self, form: &FileFormat) -> Result<Vec<u8>, EncodeError> {
        PictureHead::of(self, form.clone()).encode(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_picture_is_refused() {
        let empty = Picture::opaque(Image {
            width: 0,
            height: 3,
            pixels: Vec::new(),
        });
        for form in [
            FileFormat::Png8,
            FileFormat::Png16,
            FileFormat::Exr(Origin::default()),
        ] {
            assert!(empty.encode(&form).is_err());
        }
    }
}
