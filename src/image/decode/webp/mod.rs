//! WebP pictures, lossy and lossless. Of an animation the first picture is decoded.

mod lossless;
mod parts;
mod prefix;

use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use image_webp::{DecodingError, WebPDecoder};
use parts::CodedStreams;
use std::io::Cursor;

pub(super) struct WebP<'a> {
    decoder: WebPDecoder<Cursor<&'a [u8]>>,
    pub(super) layout: PixelLayout,
    /// The memory of the decoder for each pixel, in bytes.
    pixel: u64,
    /// Its memory for the prefix codes, in bytes.
    codes: u64,
    /// An error before the pixels. It is reported after the memory for the pixels is granted.
    fault: Option<DecodeError>,
}

/// Reads everything before the pixels.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(ImageSize, WebP<'_>), DecodeError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(fault_of)?;
    let (width, height) = decoder.dimensions();
    let size = ImageSize::within(most_pixels, width, height)?;
    let layout = PixelLayout {
        channels: if decoder.has_alpha() { 4 } else { 3 },
        is_wide: false,
    };
    // A lossy picture takes 1.5 bytes per pixel, a lossless one 4, and up to 1 more for its
    // transforms. A plane of opacity is lossless. An animation also has a canvas.
    let pixel = match bytes.get(12..16) {
        Some(b"VP8 ") => 2,
        Some(b"VP8L") => 5,
        _ if decoder.is_animated() => 16,
        _ => 8,
    };
    let (codes, fault) = match CodedStreams::of(bytes, size, decoder.is_animated()).and_then(codes)
    {
        Ok(codes) => (codes, None),
        Err(fault) => (0, Some(fault)),
    };
    let webp = WebP {
        decoder,
        layout,
        pixel,
        codes,
        fault,
    };
    Ok((size, webp))
}

fn fault_of(error: DecodingError) -> DecodeError {
    if let DecodingError::IoError(error) = error {
        return DecodeError::damaged(error);
    }
    DecodeError::damaged(error)
}

/// The memory for the prefix codes of all parts. Each part must have the size of the picture.
fn codes(parts: CodedStreams<'_>) -> Result<u64, DecodeError> {
    let CodedStreams {
        size,
        lossy,
        lossless,
        opacity,
    } = parts;
    // The decoder takes the memory for a lossy picture before it compares the sizes, if it compares
    // them at all.
    if lossy.is_some_and(|lossy| parts::lossy_sides(lossy) != Some([size.width, size.height])) {
        let words = "the size of the picture inside differs";
        return Err(DecodeError::Damaged(words.to_owned()));
    }
    let picture = lossless.map(|stream| lossless::codes(stream, size, true));
    // The first byte of a plane of opacity is its compression method.
    let plane = match opacity.and_then(<[u8]>::split_first) {
        Some((first, stream)) if first & 3 == 1 => Some(lossless::codes(stream, size, false)),
        Some(_) | None => None,
    };
    Ok(u64::max(
        picture.transpose()?.unwrap_or(0),
        plane.transpose()?.unwrap_or(0),
    ))
}

impl WebP<'_> {
    pub(super) fn scratch(&self, size: ImageSize) -> u64 {
        size.pixels()
            .saturating_mul(self.pixel)
            .saturating_add(self.codes)
    }

    pub(super) fn decode(mut self, into: &mut [u8]) -> Result<(), DecodeError> {
        match self.fault {
            Some(fault) => Err(fault),
            None => self.decoder.read_image(into).map_err(fault_of),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::codecs::webp::WebPEncoder;
    use ::image::{ExtendedColorType, ImageEncoder};

    #[test]
    fn codes_of_a_sound_picture_take_little() {
        let pixels: Vec<u8> = (0..48 * 64 * 4_u32)
            .map(|k| (k.wrapping_mul(k).wrapping_mul(2_654_435_761) >> 24) as u8)
            .collect();
        let mut file = Vec::new();
        WebPEncoder::new_lossless(&mut file)
            .write_image(&pixels, 48, 64, ExtendedColorType::Rgba8)
            .unwrap();
        let (size, webp) = open(&file, 1 << 12).unwrap();
        // Four codes of about 256 symbols that are as likely: each a table of 2⁸ to 2¹⁰ entries.
        assert!((4 << 10..32 << 10).contains(&webp.codes), "{}", webp.codes);
        assert_eq!(webp.scratch(size), 48 * 64 * 5 + webp.codes);
        let mut decoded = vec![0; pixels.len()];
        webp.decode(&mut decoded).unwrap();
        assert_eq!(decoded, pixels);
    }
}
