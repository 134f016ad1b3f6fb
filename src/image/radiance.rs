//! Pictures of light read: Radiance HDR and OpenEXR, told apart by content, to 32-bit floats. Nothing is allocated before
//! the size of the picture is known to be within limits.

use super::DecodeError;
use ::exr::meta::MetaData;
use ::exr::prelude::{ReadChannels, ReadLayers, Vec2, read};
use ::image::codecs::hdr::HdrDecoder;
use ::image::{DynamicImage, ImageDecoder};
use std::io::Cursor;

/// The most pixels of such a picture: 8192 × 4096.
const MAX_PIXELS: u64 = 1 << 25;

/// A picture of linear values.
#[derive(Clone, Debug, PartialEq)]
pub struct Radiance {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Rows from the top; red, green, blue, finite and at least 0.
    pub pixels: Vec<[f32; 3]>,
}

/// Decodes a Radiance HDR or OpenEXR file; of an EXR the first layer with red, green and blue. Negative values, which
/// filters leave behind, become 0.
///
/// # Errors
/// If the bytes are no such file, damaged, hold a value that is not finite, or ask for too much.
pub fn decode_radiance(bytes: &[u8]) -> Result<Radiance, DecodeError> {
    let mut radiance = match (is_exr(bytes), is_hdr(bytes)) {
        (true, _) => exr(bytes)?,
        (false, true) => hdr(bytes)?,
        (false, false) => {
            let format = ::image::guess_format(bytes).ok();
            return Err(DecodeError::Format(format.map(|format| format.to_mime_type().trim_start_matches("image/"))));
        }
    };
    if radiance.pixels.is_empty() {
        return Err(DecodeError::Damaged("it has no pixels".to_owned()));
    }
    if !radiance.pixels.as_flattened().iter().all(|channel| channel.is_finite()) {
        return Err(DecodeError::Damaged("a pixel is not finite".to_owned()));
    }
    radiance.pixels.as_flattened_mut().iter_mut().for_each(|channel| *channel = channel.max(0.0));
    Ok(radiance)
}

/// Whether a file that begins so is one that [`decode_radiance`] reads.
#[must_use]
pub fn is_radiance(head: &[u8]) -> bool {
    is_exr(head) || is_hdr(head)
}

fn is_exr(head: &[u8]) -> bool {
    head.starts_with(&::exr::meta::magic_number::BYTES)
}

fn is_hdr(head: &[u8]) -> bool {
    head.starts_with(b"#?RADIANCE") || head.starts_with(b"#?RGBE")
}

fn hdr(bytes: &[u8]) -> Result<Radiance, DecodeError> {
    let damaged = |error: ::image::ImageError| DecodeError::Damaged(error.to_string());
    // Only files that begin so pass the strict reader; the others differ in nothing else.
    let is_strict = bytes.starts_with(b"#?RADIANCE");
    let decoder = HdrDecoder::with_strictness(Cursor::new(bytes), is_strict).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    within(width, height)?;
    let pixels = DynamicImage::from_decoder(decoder).map_err(damaged)?.into_rgb32f().into_raw();
    Ok(Radiance { width, height, pixels: pixels.as_chunks().0.to_vec() })
}

fn exr(bytes: &[u8]) -> Result<Radiance, DecodeError> {
    let damaged = |error: ::exr::error::Error| DecodeError::Damaged(error.to_string());
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(damaged)?;
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    for header in &meta.headers {
        within(side(header.layer_size.width()), side(header.layer_size.height()))?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| Radiance {
                width: side(size.width()),
                height: side(size.height()),
                pixels: vec![[0.0; 3]; size.area()],
            },
            |radiance: &mut Radiance, at: Vec2<usize>, (r, g, b): (f32, f32, f32)| {
                radiance.pixels[at.y() * radiance.width as usize + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes));
    Ok(image.map_err(damaged)?.layer_data.channel_data.pixels)
}

fn within(width: u32, height: u32) -> Result<(), DecodeError> {
    let is_within = u64::from(width) * u64::from(height) <= MAX_PIXELS;
    is_within.then_some(()).ok_or(DecodeError::TooLarge { width, height })
}

#[cfg(test)]
mod tests {
    use super::super::{Form, Image, Origin, Picture};
    use super::*;
    use ::exr::prelude::{SpecificChannels, WritableImage};

    /// Two by one pixels: (1, 0.5, 0.25) and black, in exponents of 129 and 0.
    const HDR: &[u8] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x00\x00\x00\x00";

    #[test]
    fn both_formats_are_read() {
        let expected = Radiance { width: 2, height: 1, pixels: vec![[1.0, 0.5, 0.25], [0.0; 3]] };
        assert_eq!(decode_radiance(HDR).unwrap(), expected);
        let named = [b"#?RGBE".as_slice(), &HDR[10..]].concat();
        assert_eq!(decode_radiance(&named).unwrap(), expected);
        let image = Image { width: 2, height: 1, pixels: vec![[1.0, 0.5, 0.25], [-1.0, 0.0, 0.0]] };
        assert_eq!(
            decode_radiance(&Picture::opaque(image).encode(&Form::Exr(Origin::default())).unwrap()).unwrap(),
            expected
        );
    }

    #[test]
    fn what_is_no_light_is_refused() {
        let infinite = SpecificChannels::rgb(|_| (1.0_f32, f32::INFINITY, 1.0_f32));
        let mut bytes = Cursor::new(Vec::new());
        ::exr::prelude::Image::from_channels((1, 1), infinite).write().to_buffered(&mut bytes).unwrap();
        let infinite = bytes.into_inner();
        let huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65535 +X 65535\n";
        let cases: [(&[u8], &str); 6] = [
            (b"hello", "is not a picture"),
            (b"\x89PNG\r\n\x1a\n", "is a png file"),
            (&HDR[..HDR.len() - 1], "is damaged"),
            (&infinite, "is damaged: a pixel is not finite"),
            (&infinite[..infinite.len() / 2], "is damaged"),
            (huge, "has 65535 × 65535 pixels"),
        ];
        for (bytes, words) in cases {
            let fault = decode_radiance(bytes).unwrap_err().to_string();
            assert!(fault.starts_with(words), "{fault}");
        }
    }
}
