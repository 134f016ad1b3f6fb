//! Images in memory, and image files.
//!
//! # Reading
//!
//! [`PixelFile`] reads PNG, JPEG, WebP and KTX2 (Basis Universal) to 8 bits per channel.
//! [`RadianceFile`] reads Radiance HDR and OpenEXR to 32-bit floats. Both read the header first and
//! report what decoding costs ([`DecodeCost`]); the caller charges its budget and then decodes.
//! Files are not trusted: a damaged file is a [`DecodeError`], never a panic.
//!
//! # Writing
//!
//! [`DisplayTransform`] turns a film of linear values into a [`Picture`]: exposure, tone map,
//! background. [`Picture::encode`] writes PNG (8 or 16 bits), JPEG, lossless WebP, OpenEXR (16 or
//! 32 bits), or Radiance HDR. [`StripSource`] and `file` write the same bytes strip by strip, so a
//! large picture need not be in memory. [`AnimatedPng`] and `AnimatedGif` write animations. The
//! same picture gives the same bytes on each platform. [`RangeClipping`] counts the values that a
//! format can't hold. A [`MerkleTree`] commits a file to the film that it shows; [`WrittenPicture`]
//! reads a file back as it was written.
//!
//! # Images in between
//!
//! [`denoise()`] filters noise with feature buffers, [`LayerPicture`] shows a layer as colors, and
//! `contact_sheet` puts several pictures on one sheet. [`Texels`] are the pixels of a texture.

mod animation;
mod compressed;
mod decode;
mod denoise;
mod display;
mod exr;
mod file;
mod format;
#[cfg(feature = "cli")]
mod gif;
mod hdr;
mod layer;
mod merkle;
mod png;
mod radiance;
mod range;
mod rgbe;
#[cfg(feature = "cli")]
mod sheet;
mod shown;
mod texels;
mod written;
mod xmp;

pub use animation::AnimatedPng;
pub use decode::{DecodeCost, DecodeError, OpacityUse, PixelFile, Pixels, is_picture};
pub use denoise::{DenoisedImage, DenoisingGuide, GUIDES, NoisyHalf, around, blend, denoise};
pub use display::{AlphaAssociation, BackgroundFill, DisplayTransform, exposure};
pub use file::{BLOCK_ROWS, PictureHeader, StripSource};
#[cfg(feature = "cli")]
pub use gif::AnimatedGif;
pub use layer::LayerPicture;
pub use merkle::{MerkleTree, TILE, TileHash, tile_count, tile_hashes};
pub use png::png_bytes;
pub use radiance::{Radiance, RadianceFile, is_radiance};
pub use range::RangeClipping;
#[cfg(feature = "cli")]
pub use sheet::{contact_sheet, for_sheet, shrunk};
pub use shown::{DisplayedFile, DisplayedPicture};
pub use texels::{Texel, Texels};
pub use written::{WrittenFile, WrittenPicture, samples};

use serde::{Deserialize, Serialize};
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

/// The contents of a pixel file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// The colours.
    pub image: Image,
    /// The opacity of each pixel in [0, 1], if not all are opaque.
    pub alpha: Option<Vec<f32>>,
    /// The additional channels of an EXR; other formats have none.
    pub layers: PixelLayers,
    /// The hashes of the tiles of the film that it shows, which its file keeps; none, if the file
    /// is to keep none.
    pub tiles: Vec<TileHash>,
}

/// Further numbers of each pixel of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelLayers {
    /// The name of each channel, layer and channel separated by a dot, as `normal.X`; all are
    /// distinct.
    pub names: Vec<&'static str>,
    /// The values of all channels, pixel after pixel.
    pub values: Vec<f32>,
}

/// A form of pixel file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum FileFormat {
    /// PNG with ⌊255·v⌋ per channel, no gamma.
    Png8,
    /// PNG with ⌊65535·v⌋ per channel, no gamma.
    Png16,
    /// JPEG with ⌊255·v⌋ per channel before its losses, opaque.
    Jpeg,
    /// WebP with ⌊255·v⌋ per channel, lossless.
    Webp,
    /// EXR with 32-bit floats per channel, clamped to their range: all are finite.
    Exr,
    /// EXR with 16-bit floats for colours, opacity, albedo, normals and texture coordinates, and
    /// 32-bit floats for distances, positions and numbers of surfaces; clamped alike.
    ExrHalf,
    /// Radiance HDR: three mantissas of 8 bits that share an exponent, opaque, at least 0.
    Hdr,
}

/// The properties of a file format.
#[derive(Clone, Copy, Debug)]
pub struct FormatTraits {
    /// Its name.
    pub name: &'static str,
    /// The extensions of its files, the usual one first.
    pub extensions: &'static [&'static str],
    /// The bits of a channel of a colour.
    pub bits: u32,
    /// Whether it has linear values of any size; otherwise display values.
    pub is_linear: bool,
    /// Whether it has an alpha channel.
    pub has_alpha: bool,
    /// Whether it has metadata about the program and scene.
    pub has_metadata: bool,
    /// Whether it has layers, or files of this format beside it have them.
    pub has_layers: bool,
    /// Whether it is compressed as a whole, so that its strips are kept until the last.
    pub is_whole: bool,
}

impl FileFormat {
    /// All formats. Of those with the same extension the first is the usual one.
    pub const ALL: [Self; 7] = [
        Self::Png8,
        Self::Png16,
        Self::Jpeg,
        Self::Webp,
        Self::Exr,
        Self::ExrHalf,
        Self::Hdr,
    ];

    /// Its properties.
    #[must_use]
    pub const fn traits(self) -> FormatTraits {
        // The traits of PNG and EXR are the base of the others.
        const PNG: FormatTraits = FormatTraits {
            name: "PNG",
            extensions: &["png"],
            bits: 8,
            is_linear: false,
            has_alpha: true,
            has_metadata: true,
            has_layers: true,
            is_whole: false,
        };
        const EXR: FormatTraits = FormatTraits {
            name: "EXR",
            extensions: &["exr"],
            bits: 32,
            is_linear: true,
            ..PNG
        };
        match self {
            Self::Png8 => PNG,
            Self::Png16 => FormatTraits { bits: 16, ..PNG },
            Self::Jpeg => FormatTraits {
                name: "JPEG",
                extensions: &["jpg", "jpeg"],
                has_alpha: false,
                has_metadata: false,
                has_layers: false,
                is_whole: true,
                ..PNG
            },
            Self::Webp => FormatTraits {
                name: "WebP",
                extensions: &["webp"],
                has_layers: false,
                is_whole: true,
                ..PNG
            },
            Self::Exr => EXR,
            Self::ExrHalf => FormatTraits { bits: 16, ..EXR },
            Self::Hdr => FormatTraits {
                name: "Radiance HDR",
                extensions: &["hdr"],
                has_alpha: false,
                has_metadata: false,
                has_layers: false,
                ..EXR
            },
        }
    }

    /// Whether it has linear values of any size; otherwise display values.
    #[must_use]
    pub fn is_linear(self) -> bool {
        self.traits().is_linear
    }
}

/// The provenance in a file: in a PNG as international text (`iTXt`), in an EXR as text attributes,
/// in a WebP as XMP.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureMetadata {
    /// The program and its version: `Software` in a PNG, the standard attribute `software`.
    pub software: String,
    /// The hash of the scene: `rtc:scene`.
    pub scene: String,
    /// The settings of the render that decide the pixels: `rtc:settings`.
    pub settings: String,
    /// The view, of an EXR alone: the standard attribute `worldToCamera`.
    pub world_to_camera: Option<WorldToCamera>,
    /// The layer of a PNG, and the meaning of its values: `rtc:layer`; empty for colours.
    pub layer: String,
}

impl PictureMetadata {
    /// The meaning of the pixels, without their provenance.
    #[must_use]
    pub fn meaning(self) -> Self {
        Self {
            world_to_camera: self.world_to_camera,
            layer: self.layer,
            ..Self::default()
        }
    }

    /// The texts that are present, by name.
    fn texts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let texts = [
            ("Software", &self.software),
            ("rtc:scene", &self.scene),
            ("rtc:settings", &self.settings),
            ("rtc:layer", &self.layer),
        ];
        let texts = texts.into_iter().filter(|(_, text)| !text.is_empty());
        texts.map(|(name, text)| (name, text.as_str()))
    }
}

/// From world to camera coordinates (the camera looks along -z, y up): a row-major matrix for row
/// vectors, as in EXR.
pub type WorldToCamera = [f32; 16];

/// Why a picture has no pixel file, with the message of the encoder; a width or height of 0 is a
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
            layers: PixelLayers::default(),
            tiles: Vec::new(),
        }
    }

    /// The bytes of the pixel file.
    ///
    /// # Errors
    /// If the picture is empty or larger than the format can hold.
    pub fn encode(&self, form: FileFormat) -> Result<Vec<u8>, EncodeError> {
        PictureHeader::of(self, form).encode(self)
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
        for form in [FileFormat::Png8, FileFormat::Png16, FileFormat::Exr] {
            assert!(empty.encode(form).is_err());
        }
    }
}
