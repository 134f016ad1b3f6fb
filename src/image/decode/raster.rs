//! BMP, TGA and PNM, by the crate `image`.

use super::super::format::RasterFormat;
use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use image::codecs::bmp::BmpDecoder;
use image::codecs::pnm::PnmDecoder;
use image::codecs::tga::TgaDecoder;
use image::{ImageDecoder, ImageResult};
use std::io::Cursor;

/// A file whose header was read.
pub(super) struct Raster<'a> {
    decoder: Box<dyn ImageDecoder + 'a>,
    pub(super) layout: PixelLayout,
    /// The bytes that the decoder takes beside the pixels, at most: a second copy.
    scratch: u64,
}

/// Reads the header of a file of the format.
pub(super) fn open(
    bytes: &[u8],
    format: RasterFormat,
    most_pixels: u64,
) -> Result<(ImageSize, Raster<'_>), DecodeError> {
    let reader = Cursor::new(bytes);
    let decoder = match format {
        RasterFormat::Bmp => boxed(BmpDecoder::new(reader)),
        RasterFormat::Tga => boxed(TgaDecoder::new(reader)),
        RasterFormat::Pnm => boxed(PnmDecoder::new(reader)),
    };
    let decoder = decoder.map_err(DecodeError::damaged)?;
    let (width, height) = decoder.dimensions();
    let size = ImageSize::within(most_pixels, width, height)?;
    let color = decoder.color_type();
    let is_wide = match color.bytes_per_pixel() / color.channel_count() {
        1 => false,
        2 => true,
        _ => {
            return Err(DecodeError::Unsupported(
                "picture of floating-point numbers",
            ));
        }
    };
    let layout = PixelLayout {
        channels: usize::from(color.channel_count()),
        is_wide,
    };
    let pixels = size.pixels().saturating_mul(layout.bytes() as u64);
    let raster = Raster {
        decoder,
        layout,
        scratch: pixels.saturating_add(bytes.len() as u64),
    };
    Ok((size, raster))
}

fn boxed<'a>(
    decoder: ImageResult<impl ImageDecoder + 'a>,
) -> ImageResult<Box<dyn ImageDecoder + 'a>> {
    decoder.map(|decoder| Box::new(decoder) as Box<dyn ImageDecoder + 'a>)
}

impl Raster<'_> {
    pub(super) fn scratch(&self) -> u64 {
        self.scratch
    }

    pub(super) fn decode(self, into: &mut [u8]) -> Result<(), DecodeError> {
        self.decoder
            .read_image_boxed(into)
            .map_err(DecodeError::damaged)?;
        // The crate writes 16 bits in the order of the machine; the layout has the high byte first.
        if self.layout.is_wide {
            for pair in into.as_chunks_mut::<2>().0 {
                *pair = u16::from_ne_bytes(*pair).to_be_bytes();
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{OpacityUse, PixelFile};
    use image::{DynamicImage, ImageFormat, RgbaImage};
    use std::io::Cursor;

    #[test]
    fn pictures_are_read_as_written_and_parts_of_them_are_no_pictures() {
        let pixels = (0..5 * 3 * 4).map(|byte: u8| byte.wrapping_mul(37));
        let picture = RgbaImage::from_raw(5, 3, pixels.collect()).unwrap();
        let opaque = DynamicImage::from(picture).into_rgb8();
        for format in [ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Pnm] {
            let mut file = Cursor::new(Vec::new());
            opaque.write_to(&mut file, format).unwrap();
            let file = file.into_inner();
            let open = |bytes| PixelFile::open(bytes, OpacityUse::Dropped, 15);
            let decoded = open(&file).unwrap().decode().unwrap();
            let size = [decoded.width, decoded.height];
            assert_eq!(
                (size, &decoded.bytes),
                ([5, 3], opaque.as_raw()),
                "{format:?}"
            );
            assert!(PixelFile::open(&file, OpacityUse::Dropped, 14).is_err());
            // TGA and BMP may end with what is no pixel.
            let end = file.len() - 5 * 3;
            for end in 0..end {
                let is_read = open(&file[..end]).and_then(PixelFile::decode).is_ok();
                assert!(!is_read, "{format:?} of {end} bytes");
            }
        }
    }
}
