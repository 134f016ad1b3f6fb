//! JPEG. A file that ends before its last pixel is damaged, however much of it could be shown.

use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

pub(super) struct Jpeg<'a> {
    decoder: JpegDecoder<ZCursor<&'a [u8]>>,
    pub(super) layout: PixelLayout,
    scratch: u64,
    is_whole: bool,
}

/// Reads the markers before the pixels.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(ImageSize, Jpeg<'_>), DecodeError> {
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(DecodeError::damaged)?;
    let (Some((width, height)), Some(coded)) = (decoder.dimensions(), decoder.input_colorspace())
    else {
        return Err(DecodeError::Damaged("it has no header".to_owned()));
    };
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    let size = ImageSize::within(most_pixels, side(width), side(height))?;
    let is_kept = matches!(
        coded,
        ColorSpace::Luma | ColorSpace::LumaA | ColorSpace::RGBA
    );
    let color = if is_kept { coded } else { ColorSpace::RGB };
    // Odd headers are forgiven, pixels that are missing are not.
    decoder.set_options(options.jpeg_set_out_colorspace(color).set_strict_mode(true));
    let frame = Frame::of(bytes);
    let jpeg = Jpeg {
        decoder,
        layout: PixelLayout {
            channels: color.num_components(),
            is_wide: false,
        },
        scratch: frame.scratch(size),
        is_whole: frame.is_whole,
    };
    Ok((size, jpeg))
}

impl Jpeg<'_> {
    pub(super) fn scratch(&self) -> u64 {
        self.scratch
    }

    pub(super) fn decode(mut self, into: &mut [u8]) -> Result<(), DecodeError> {
        if !self.is_whole {
            return Err(DecodeError::Damaged(
                "it ends before its last pixel".to_owned(),
            ));
        }
        self.decoder.decode_into(into).map_err(DecodeError::damaged)
    }
}

/// The contents of a file's markers.
#[derive(Default)]
struct Frame {
    components: u64,
    /// Whether coefficients of all pixels are kept until the last scan.
    comes_in_scans: bool,
    /// Whether the end of the image is marked.
    is_whole: bool,
}

impl Frame {
    /// Walks over the markers.
    fn of(bytes: &[u8]) -> Self {
        let mut frame = Self::default();
        let mut at = 0;
        while let Some(marker) = next_marker(bytes, &mut at) {
            let segment = bytes.get(at..).unwrap_or_default();
            match marker {
                0xd9 => {
                    return Self {
                        is_whole: true,
                        ..frame
                    };
                }
                // Alone: they have no length.
                0x01 | 0xd0..=0xd8 => continue,
                0xc0..=0xc3 => {
                    frame.components = segment.get(7).copied().unwrap_or_default().into();
                    frame.comes_in_scans |= marker == 0xc2;
                }
                0xda => {
                    let components: u64 = segment.get(2).copied().unwrap_or_default().into();
                    frame.comes_in_scans |= components < frame.components;
                }
                _ => {}
            }
            let length = segment
                .first_chunk()
                .map_or(2, |length| u16::from_be_bytes(*length));
            at += usize::from(length).max(2);
        }
        frame
    }

    /// The memory of the decoder: some rows of blocks, and two bytes per coefficient where all are
    /// kept.
    fn scratch(&self, size: ImageSize) -> u64 {
        let rows = u64::from(size.width) * 256 * self.components.max(1);
        let blocks = |side: u32| u64::from(side.div_ceil(32)) * 32;
        let coefficients = blocks(size.width)
            .saturating_mul(blocks(size.height))
            .saturating_mul(2 * self.components);
        rows + if self.comes_in_scans { coefficients } else { 0 }
    }
}

/// The next marker, and the position `at` after it; the bytes before it, such as coded pixels, are
/// skipped.
fn next_marker(bytes: &[u8], at: &mut usize) -> Option<u8> {
    loop {
        let rest = bytes.get(*at..)?;
        *at += memchr::memchr(0xff, rest)? + 1;
        // 0 makes a byte of pixels of it, 255 is filling.
        if let marker @ 1..=0xfe = *bytes.get(*at)? {
            *at += 1;
            return Some(marker);
        }
    }
}
