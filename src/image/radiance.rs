//! Readers of linear pictures: Radiance HDR and OpenEXR, detected by content, to 32-bit floats. A
//! file is opened first, as a [`super::PixelFile`] is.

use super::decode::{DecodeCost, DecodeError, ImageSize};
use super::format::PictureFormat;
use super::hdr::Hdr;
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, Vec2, read};
use std::io::Cursor;

/// Bytes of a pixel.
const PIXEL: usize = 12;

/// A picture of linear values.
#[derive(Clone, Debug, PartialEq)]
pub struct Radiance {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Rows from the top; red, green and blue as little-endian 32-bit floats, finite and at least
    /// 0.
    pub bytes: Vec<u8>,
}

/// A linear picture whose header was read.
pub struct RadianceFile<'a> {
    size: ImageSize,
    /// The bytes that the decoder has read and not yet returned.
    block: u64,
    decoder: RowDecoder<'a>,
}

enum RowDecoder<'a> {
    Hdr(Hdr<'a>),
    Exr(&'a [u8]),
}

impl<'a> RadianceFile<'a> {
    /// Reads the header of a Radiance HDR or OpenEXR file.
    ///
    /// # Errors
    /// If the bytes are no such file, the header is damaged, or it has more pixels than are
    /// allowed.
    pub fn open(bytes: &'a [u8], most_pixels: u64) -> Result<Self, DecodeError> {
        match (is_exr(bytes), is_hdr(bytes)) {
            (true, _) => open_exr(bytes, most_pixels),
            (false, true) => open_hdr(bytes, most_pixels),
            (false, false) => {
                let format = PictureFormat::of(bytes);
                Err(DecodeError::Format(format.map(PictureFormat::name)))
            }
        }
    }

    /// Its width and height in pixels, of an EXR those of the largest layer.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.size.width, self.size.height]
    }

    /// What decoding it will take, and the table by which its light is found: eight bytes a pixel.
    #[must_use]
    pub fn cost(&self) -> DecodeCost {
        let pixels = self.size.pixels();
        DecodeCost {
            pixels,
            memory: pixels.saturating_mul(PIXEL as u64 + 8),
            scratch: self.block,
        }
    }

    /// Decodes it; of an EXR the first layer with red, green and blue. Negative values, which
    /// filters leave behind, become 0.
    ///
    /// # Errors
    /// If the file is damaged or has a value that is not finite, or there is no memory for it.
    pub fn decode(self) -> Result<Radiance, DecodeError> {
        let Self {
            mut size,
            block: _,
            decoder,
        } = self;
        let mut bytes = size.buffer(PIXEL)?;
        match decoder {
            RowDecoder::Hdr(decoder) => decoder.decode(&mut bytes)?,
            RowDecoder::Exr(file) => (size, bytes) = decode_exr(file, bytes)?,
        }
        let mut is_finite = true;
        for channel in bytes.as_chunks_mut::<4>().0 {
            let value = f32::from_ne_bytes(*channel);
            is_finite &= value.is_finite();
            *channel = value.max(0.0).to_le_bytes();
        }
        if !is_finite {
            return Err(DecodeError::Damaged("a pixel is not finite".to_owned()));
        }
        Ok(Radiance {
            width: size.width,
            height: size.height,
            bytes,
        })
    }
}

/// Whether a file that begins so is one that [`RadianceFile`] reads.
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

fn open_hdr(bytes: &[u8], most_pixels: u64) -> Result<RadianceFile<'_>, DecodeError> {
    let decoder = Hdr::open(bytes, most_pixels)?;
    Ok(RadianceFile {
        size: decoder.size,
        block: decoder.scratch(),
        decoder: RowDecoder::Hdr(decoder),
    })
}

fn open_exr(bytes: &[u8], most_pixels: u64) -> Result<RadianceFile<'_>, DecodeError> {
    let meta =
        MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(DecodeError::damaged)?;
    let (mut largest, mut block) = (None::<ImageSize>, 0);
    for header in &meta.headers {
        let size = size_of(most_pixels, header.layer_size)?;
        largest = largest
            .filter(|largest| largest.pixels() >= size.pixels())
            .or(Some(size));
        block += scratch(header);
    }
    let size = largest.ok_or_else(|| DecodeError::Damaged("it has no layers".to_owned()))?;
    Ok(RadianceFile {
        size,
        block,
        decoder: RowDecoder::Exr(bytes),
    })
}

/// The table of the blocks of a layer, and a block packed and unpacked.
fn scratch(header: &Header) -> u64 {
    (header.chunk_count as u64)
        .saturating_mul(16)
        .saturating_add((header.max_block_byte_size() as u64).saturating_mul(3))
}

/// Decodes into the buffer, which has room for the largest layer, and returns the size of the
/// decoded layer.
fn decode_exr(file: &[u8], buffer: Vec<u8>) -> Result<(ImageSize, Vec<u8>), DecodeError> {
    let buffer = std::cell::Cell::new(buffer);
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| {
                let mut bytes = buffer.take();
                bytes.resize(size.area() * PIXEL, 0);
                (size.width(), bytes)
            },
            |(width, bytes): &mut (usize, Vec<u8>), at: Vec2<usize>, (r, g, b): (f32, f32, f32)| {
                let start = (at.y() * *width + at.x()) * PIXEL;
                let pixel = bytes[start..start + PIXEL].as_chunks_mut::<4>().0;
                pixel
                    .iter_mut()
                    .zip([r, g, b])
                    .for_each(|(bytes, channel)| *bytes = channel.to_ne_bytes());
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file));
    let layer = image.map_err(DecodeError::damaged)?.layer_data;
    Ok((size_of(u64::MAX, layer.size)?, layer.channel_data.pixels.1))
}

fn size_of(most_pixels: u64, size: Vec2<usize>) -> Result<ImageSize, DecodeError> {
    let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    ImageSize::within(most_pixels, side(size.width()), side(size.height()))
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, Picture};
    use super::*;
    use ::exr::prelude::{SpecificChannels, WritableImage};

    /// Two by one pixels: (1, 0.5, 0.25) and black, in exponents of 129 and 0.
    const HDR: &[u8] =
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x00\x00\x00\x00";

    fn read(bytes: &[u8]) -> Result<Radiance, DecodeError> {
        RadianceFile::open(bytes, 1 << 25)?.decode()
    }

    #[test]
    fn both_formats_are_read() {
        let bytes = [1.0_f32, 0.5, 0.25, 0.0, 0.0, 0.0]
            .into_iter()
            .flat_map(f32::to_le_bytes)
            .collect();
        let expected = Radiance {
            width: 2,
            height: 1,
            bytes,
        };
        assert_eq!(read(HDR).unwrap(), expected);
        let named = [b"#?RGBE".as_slice(), &HDR[10..]].concat();
        assert_eq!(read(&named).unwrap(), expected);
        let image = Image {
            width: 2,
            height: 1,
            pixels: vec![[1.0, 0.5, 0.25], [-1.0, 0.0, 0.0]],
        };
        assert_eq!(
            read(&Picture::opaque(image).encode(FileFormat::Exr).unwrap()).unwrap(),
            expected
        );
    }

    #[test]
    fn what_is_no_light_is_refused() {
        let infinite = SpecificChannels::rgb(|_| (1.0_f32, f32::INFINITY, 1.0_f32));
        let mut bytes = Cursor::new(Vec::new());
        ::exr::prelude::Image::from_channels((1, 1), infinite)
            .write()
            .to_buffered(&mut bytes)
            .unwrap();
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
            let fault = read(bytes).unwrap_err().to_string();
            assert!(fault.starts_with(words), "{fault}");
        }
    }
}
