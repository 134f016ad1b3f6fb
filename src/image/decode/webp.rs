//! WebP, lossy and lossless; of an animation the first picture.

use super::layout::Layout;
use super::{DecodeError, Size};
use ::image::ImageDecoder;
use ::image::codecs::webp::WebPDecoder;
use std::io::Cursor;

pub(super) struct WebP<'a> {
    decoder: WebPDecoder<Cursor<&'a [u8]>>,
    pub(super) layout: Layout,
    /// Bytes that the decoder takes for each pixel.
    passing: u64,
}

/// Reads all that stands before the pixels.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(Size, WebP<'_>), DecodeError> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(DecodeError::damaged)?;
    let (width, height) = decoder.dimensions();
    let size = Size::within(most_pixels, width, height)?;
    let layout = Layout {
        channels: usize::from(decoder.color_type().channel_count()),
        is_wide: false,
    };
    // Planes of a lossy picture take 1.5 bytes a pixel, a lossless one 4 and as much as 1 for its
    // transforms; a plane of opacity is lossless, and an animation has a canvas beside its
    // picture.
    let passing = match bytes.get(12..16) {
        Some(b"VP8 ") => 2,
        Some(b"VP8L") => 5,
        _ if decoder.has_animation() => 16,
        _ => 8,
    };
    Ok((
        size,
        WebP {
            decoder,
            layout,
            passing,
        },
    ))
}

impl WebP<'_> {
    pub(super) fn passing(&self, size: Size) -> u64 {
        size.pixels().saturating_mul(self.passing)
    }

    pub(super) fn decode(self, into: &mut [u8]) -> Result<(), DecodeError> {
        self.decoder.read_image(into).map_err(DecodeError::damaged)
    }
}
