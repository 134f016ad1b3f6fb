//! Decoders of PNG, JPEG, WebP, KTX2, BMP, TGA and PNM, to 8 bits per channel. The content decides
//! the format.
//!
//! [`PixelFile::open`] reads the header only, and [`PixelFile::cost`] says how many pixels and how
//! much memory decoding takes. The caller charges this to its budget and then calls
//! [`PixelFile::decode`].
//!
//! Each format has a module that opens a file and decodes into a buffer: `png`, `jpeg`, `webp`,
//! [`ktx2`], and `raster` for the others. `layout` describes the channels that a decoder writes,
//! and converts them to bytes of red, green, blue and opacity in the same buffer, so pixels are not
//! copied.
//!
//! The modules check what the decoder crates do not check: memory that a forged header would make
//! them allocate, and data that would make them panic.

mod error;
mod jpeg;
pub(super) mod ktx2;
mod layout;
mod png;
mod raster;
mod size;
mod webp;

pub use error::DecodeError;
pub(super) use size::ImageSize;

use super::format::PictureFormat;
use layout::PixelLayout;

/// A picture of 8 bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Whether pixels have a fourth byte, their opacity.
    pub has_alpha: bool,
    /// Rows from the top; red, green, blue.
    pub bytes: Vec<u8>,
}

/// Pixels as a file codes them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CodedPixels {
    layout: PixelLayout,
    bytes: Vec<u8>,
}

impl CodedPixels {
    /// Red, green, blue and opacity of a pixel, from 0 to 1.
    pub(super) fn values(&self, index: usize) -> [f64; 4] {
        let size = self.layout.bytes();
        self.layout.values(&self.bytes[index * size..][..size])
    }
}

/// What becomes of the opacity of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpacityUse {
    /// It is dropped.
    Dropped,
    /// It is kept where there is one.
    Kept,
}

/// What decoding a picture takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DecodeCost {
    /// Its pixels.
    pub pixels: u64,
    /// Bytes of the buffer that is handed on.
    pub memory: u64,
    /// Bytes that the decoder takes beside it, until it is done.
    pub scratch: u64,
}

/// A pixel file whose header was read.
pub struct PixelFile<'a> {
    size: ImageSize,
    opacity: OpacityUse,
    decoder: Decoder<'a>,
}

enum Decoder<'a> {
    Png(Box<png::Png<'a>>),
    Jpeg(Box<jpeg::Jpeg<'a>>),
    WebP(Box<webp::WebP<'a>>),
    Ktx2(Box<ktx2::Ktx2<'a>>),
    Raster(raster::Raster<'a>),
}

/// Whether a file that begins so is one that [`PixelFile`] reads.
#[must_use]
pub fn is_picture(head: &[u8]) -> bool {
    match PictureFormat::of(head) {
        Some(
            PictureFormat::Png
            | PictureFormat::Jpeg
            | PictureFormat::WebP
            | PictureFormat::Ktx2
            | PictureFormat::Raster(_),
        ) => true,
        Some(PictureFormat::Other(_)) | None => false,
    }
}

impl<'a> PixelFile<'a> {
    /// Reads the header of a pixel file.
    ///
    /// # Errors
    /// If the bytes are no such file, the header is damaged, or it declares more pixels than are
    /// allowed.
    pub fn open(
        bytes: &'a [u8],
        opacity: OpacityUse,
        most_pixels: u64,
    ) -> Result<Self, DecodeError> {
        let (size, decoder) = match PictureFormat::of(bytes) {
            Some(PictureFormat::Png) => png::open(bytes, most_pixels)
                .map(|(size, png)| (size, Decoder::Png(Box::new(png))))?,
            Some(PictureFormat::Jpeg) => jpeg::open(bytes, most_pixels)
                .map(|(size, jpeg)| (size, Decoder::Jpeg(Box::new(jpeg))))?,
            Some(PictureFormat::WebP) => webp::open(bytes, most_pixels)
                .map(|(size, webp)| (size, Decoder::WebP(Box::new(webp))))?,
            Some(PictureFormat::Ktx2) => ktx2::open(bytes, most_pixels)
                .map(|(size, ktx2)| (size, Decoder::Ktx2(Box::new(ktx2))))?,
            Some(PictureFormat::Raster(format)) => raster::open(bytes, format, most_pixels)
                .map(|(size, raster)| (size, Decoder::Raster(raster)))?,
            other @ (Some(PictureFormat::Other(_)) | None) => {
                return Err(DecodeError::Format(other.map(PictureFormat::name)));
            }
        };
        Ok(Self {
            size,
            opacity,
            decoder,
        })
    }

    /// What decoding it will take.
    #[must_use]
    pub fn cost(&self) -> DecodeCost {
        let (pixels, scratch) = (
            self.size.pixels(),
            match &self.decoder {
                Decoder::Png(png) => png.scratch(),
                Decoder::Jpeg(jpeg) => jpeg.scratch(),
                Decoder::WebP(webp) => webp.scratch(self.size),
                Decoder::Ktx2(ktx2) => ktx2.scratch(),
                Decoder::Raster(raster) => raster.scratch(),
            },
        );
        let pixel = self.layout().bytes().max(self.channels()) as u64;
        DecodeCost {
            pixels,
            memory: pixels.saturating_mul(pixel),
            scratch,
        }
    }

    /// Decodes it. Colours stay as stored: profiles and gamma are not applied, 16 bits are rounded
    /// to 8.
    ///
    /// # Errors
    /// If the file is damaged or ends early, or there is no memory for it.
    pub fn decode(self) -> Result<Pixels, DecodeError> {
        let (layout, channels, size) = (self.layout(), self.channels(), self.size);
        let mut bytes = size.buffer(layout.bytes().max(channels))?;
        let coded = layout.place(&mut bytes, channels);
        match self.decoder {
            Decoder::Png(png) => png.decode(coded)?,
            Decoder::Jpeg(jpeg) => jpeg.decode(coded)?,
            Decoder::WebP(webp) => webp.decode(coded)?,
            Decoder::Ktx2(ktx2) => ktx2.decode(coded)?,
            Decoder::Raster(raster) => raster.decode(coded)?,
        }
        layout.convert(&mut bytes, channels);
        Ok(Pixels {
            width: size.width,
            height: size.height,
            has_alpha: channels == 4,
            bytes,
        })
    }

    /// Decodes it as it is coded, 16 bits where it has them.
    ///
    /// # Errors
    /// As of [`Self::decode`].
    pub(super) fn decode_coded(self) -> Result<CodedPixels, DecodeError> {
        let layout = self.layout();
        let mut bytes = self.size.buffer(layout.bytes())?;
        match self.decoder {
            Decoder::Png(png) => png.decode(&mut bytes)?,
            Decoder::Jpeg(jpeg) => jpeg.decode(&mut bytes)?,
            Decoder::WebP(webp) => webp.decode(&mut bytes)?,
            Decoder::Ktx2(ktx2) => ktx2.decode(&mut bytes)?,
            Decoder::Raster(raster) => raster.decode(&mut bytes)?,
        }
        Ok(CodedPixels { layout, bytes })
    }

    /// Its width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.size.width, self.size.height]
    }

    /// The pixel layout of the decoder.
    fn layout(&self) -> PixelLayout {
        match &self.decoder {
            Decoder::Png(png) => png.layout,
            Decoder::Jpeg(jpeg) => jpeg.layout,
            Decoder::WebP(webp) => webp.layout,
            Decoder::Ktx2(ktx2) => ktx2.layout,
            Decoder::Raster(raster) => raster.layout,
        }
    }

    /// The number of 8-bit channels of the pixels.
    fn channels(&self) -> usize {
        if self.opacity == OpacityUse::Kept && self.layout().has_alpha() {
            4
        } else {
            3
        }
    }
}
