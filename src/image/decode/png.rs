//! PNG. Other contents than pixels are skipped: profiles and texts are compressed, and may be
//! decompression bombs.

use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use ::png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Reader, Transformations};
use std::io::Cursor;

pub(super) struct Png<'a> {
    reader: Reader<Cursor<&'a [u8]>>,
    pub(super) layout: PixelLayout,
}

/// Reads the chunks before the pixels.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(ImageSize, Png<'_>), DecodeError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: usize::MAX });
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_ignore_text_chunk(true);
    // Indexed colours and fewer than 8 bits become bytes.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(DecodeError::damaged)?;
    let size = ImageSize::within(most_pixels, header.width, header.height)?;
    let reader = decoder.read_info().map_err(|error| fault(&error, size))?;
    let (color, depth) = reader.output_color_type();
    let channels = match color {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb | ColorType::Indexed => 3,
        ColorType::Rgba => 4,
    };
    Ok((
        size,
        Png {
            reader,
            layout: PixelLayout {
                channels,
                is_wide: depth == BitDepth::Sixteen,
            },
        },
    ))
}

fn fault(error: &DecodingError, size: ImageSize) -> DecodeError {
    match error {
        DecodingError::LimitsExceeded => size.too_large(),
        DecodingError::Format(_) | DecodingError::IoError(_) | DecodingError::Parameter(_) => {
            DecodeError::damaged(error)
        }
    }
}

impl Png<'_> {
    /// Some rows, and the inflated bytes that are not yet filtered.
    pub(super) fn scratch(&self) -> u64 {
        let row = u64::from(self.reader.info().width) * self.layout.bytes() as u64;
        (1 << 18) + 3 * row
    }

    pub(super) fn decode(mut self, into: &mut [u8]) -> Result<(), DecodeError> {
        self.reader
            .next_frame(into)
            .map(|_| ())
            .map_err(DecodeError::damaged)
    }
}
