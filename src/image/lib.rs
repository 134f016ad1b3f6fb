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
mod file_format;
mod format;
#[cfg(feature = "cli")]
mod gif;
mod hdr;
mod header;
mod layer;
mod merkle;
mod picture;
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
pub use file::EncodeError;
pub use file_format::{FileFormat, FormatTraits};
#[cfg(feature = "cli")]
pub use gif::AnimatedGif;
pub use header::{BLOCK_ROWS, PictureHeader, StripSource};
pub use layer::LayerPicture;
pub use merkle::{MerkleTree, TILE, TileHash, tile_count, tile_hashes};
pub use picture::{Image, Picture, PictureMetadata, PixelLayers, WorldToCamera};
pub use png::png_bytes;
pub use radiance::{Radiance, RadianceFile, is_radiance};
pub use range::RangeClipping;
#[cfg(feature = "cli")]
pub use sheet::{contact_sheet, for_sheet, shrunk};
pub use shown::{DisplayedFile, DisplayedPicture};
pub use texels::{Texel, Texels};
pub use written::{WrittenFile, WrittenPicture, samples};

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
