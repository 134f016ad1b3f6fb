//! The forms of pixel files, and their properties.

use serde::{Deserialize, Serialize};

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
