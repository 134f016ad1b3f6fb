//! WebP, lossy and lossless; of an animation the first picture.

mod lossless;
mod parts;
mod prefix;

use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use ::image::ImageDecoder;
use ::image::codecs::webp::WebPDecoder;
use parts::CodedStreams;
use std::io::Cursor;

pub(super) struct WebP<'a> {
    decoder: WebPDecoder<Cursor<&'a [u8]>>,
    pub(super) layout: PixelLayout,
    /// Bytes that the decoder takes for each pixel.
    pixel: u64,
    /// Bytes that it takes for the prefix codes.
    codes: u64,
    /// What is wrong before the pixels: told once the memory for them is granted.
    fault: Option<DecodeError>,
}

/// Reads all that stands before the pixels.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(ImageSize, WebP<'_>), DecodeError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(DecodeError::damaged)?;
    let (width, height) = decoder.dimensions();
    let size = ImageSize::within(most_pixels, width, height)?;
    let layout = PixelLayout {
        channels: usize::from(decoder.color_type().channel_count()),
        is_wide: false,
    };
    // Planes of a lossy picture take 1.5 bytes a pixel, a lossless one 4 and as much as 1 for its
    // transforms; a plane of opacity is lossless, and an animation has a canvas beside its
    // picture.
    let pixel = match bytes.get(12..16) {
        Some(b"VP8 ") => 2,
        Some(b"VP8L") => 5,
        _ if decoder.has_animation() => 16,
        _ => 8,
    };
    let (codes, fault) =
        match CodedStreams::of(bytes, size, decoder.has_animation()).and_then(codes) {
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

/// What the prefix codes of the parts take, each of which must be as large as the picture is.
fn codes(parts: CodedStreams<'_>) -> Result<u64, DecodeError> {
    let CodedStreams {
        size,
        lossy,
        lossless,
        opacity,
    } = parts;
    // The decoder takes the memory for a lossy picture before it compares the sizes, if it does.
    if lossy.is_some_and(|lossy| parts::lossy_sides(lossy) != Some([size.width, size.height])) {
        let words = "the picture in it is of another size";
        return Err(DecodeError::Damaged(words.to_owned()));
    }
    let picture = lossless.map(|stream| lossless::codes(stream, size, true));
    // The first byte of a plane of opacity tells how it is packed.
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

    pub(super) fn decode(self, into: &mut [u8]) -> Result<(), DecodeError> {
        match self.fault {
            Some(fault) => Err(fault),
            None => self.decoder.read_image(into).map_err(DecodeError::damaged),
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
