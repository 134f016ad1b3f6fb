//! PNG of 8 and 16 bits per channel: red, green, blue, and opacity where there is one. It carries
//! no colour profile, no gamma and no time; a comment if there is one to make.

use super::{EncodeError, Picture};
use crate::color;
use ::image::codecs::png::{CompressionType, FilterType, PngEncoder};
use ::image::{ExtendedColorType, ImageEncoder};

/// The picture in 8 bits per channel.
pub(super) fn eight_bit(picture: &Picture) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::with_capacity(channels(picture));
    bytes.extend(samples(picture).map(color::quantize8));
    encode(
        picture,
        &bytes,
        [ExtendedColorType::Rgb8, ExtendedColorType::Rgba8],
    )
}

/// The picture in 16 bits per channel.
pub(super) fn sixteen_bit(picture: &Picture) -> Result<Vec<u8>, EncodeError> {
    // The encoder takes 16-bit samples in the order of the machine and turns them round itself.
    let mut bytes = Vec::with_capacity(2 * channels(picture));
    bytes.extend(samples(picture).flat_map(|v| color::quantize16(v).to_ne_bytes()));
    encode(
        picture,
        &bytes,
        [ExtendedColorType::Rgb16, ExtendedColorType::Rgba16],
    )
}

/// How many channels all pixels have.
fn channels(picture: &Picture) -> usize {
    picture.image.pixels.len() * if picture.alpha.is_some() { 4 } else { 3 }
}

/// The channels of all pixels.
fn samples(picture: &Picture) -> impl Iterator<Item = f64> {
    let alpha = |index: usize| picture.alpha.as_ref().map(|alpha| f64::from(alpha[index]));
    picture
        .image
        .pixels
        .iter()
        .enumerate()
        .flat_map(move |(index, pixel)| pixel.iter().copied().chain(alpha(index)))
}

fn encode(
    picture: &Picture,
    samples: &[u8],
    kinds: [ExtendedColorType; 2],
) -> Result<Vec<u8>, EncodeError> {
    let kind = kinds[usize::from(picture.alpha.is_some())];
    png([picture.image.width, picture.image.height], samples, kind)
}

/// Pixels of 8 bits a channel, in rows from the top, as they are: red, green, blue, and opacity if
/// there is one.
///
/// # Panics
/// If there are not as many as width and height say.
#[must_use]
pub fn png_bytes(size: [u32; 2], has_alpha: bool, pixels: &[u8]) -> Vec<u8> {
    let kind = [ExtendedColorType::Rgb8, ExtendedColorType::Rgba8][usize::from(has_alpha)];
    png(size, pixels, kind).expect("the pixels are as many as the size says")
}

fn png(
    [width, height]: [u32; 2],
    samples: &[u8],
    kind: ExtendedColorType,
) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(samples, width, height, kind)
        .map_err(|error| EncodeError(error.to_string()))?;
    Ok(bytes)
}

/// A PNG with a comment, in Latin-1 without control characters (PNG, third edition, section 11.3.3.2).
#[must_use]
pub fn commented(png: &[u8], comment: &str) -> Vec<u8> {
    /// The signature, and the header: length, type, 13 bytes, checksum.
    const HEAD: usize = 8 + 4 + 4 + 13 + 4;
    let body = [b"tEXtComment\0", comment.as_bytes()].concat();
    let length = u32::try_from(body.len() - 4).unwrap_or_default();
    let (head, rest) = png.split_at(HEAD);
    let checksum = crc32fast::hash(&body).to_be_bytes();
    [head, &length.to_be_bytes(), &body, &checksum, rest].concat()
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image};
    use super::*;

    fn ramp() -> Picture {
        let pixels = (0..35)
            .map(|i| [f64::from(i) / 34.0, 1.0 - f64::from(i) / 20.0, f64::NAN])
            .collect();
        Picture::opaque(Image {
            width: 7,
            height: 5,
            pixels,
        })
    }

    #[test]
    fn a_comment_is_read_and_changes_no_pixel() {
        let plain = ramp().encode(&FileFormat::Png8).unwrap();
        let commented = commented(&plain, "exposure -3.3333 stops");
        let read = |bytes: &[u8]| {
            let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes.to_vec()))
                .read_info()
                .unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            let texts = reader.info().uncompressed_latin1_text.clone();
            let texts = texts.into_iter().map(|text| (text.keyword, text.text));
            (pixels, texts.collect::<Vec<_>>())
        };
        let ((before, none), (after, texts)) = (read(&plain), read(&commented));
        assert_eq!((before, none.len()), (after, 0));
        let comment = ("Comment".to_owned(), "exposure -3.3333 stops".to_owned());
        assert_eq!(texts, [comment]);
    }

    #[test]
    fn eight_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(&FileFormat::Png8).unwrap()).unwrap();
        let expected: Vec<u8> = ramp()
            .image
            .pixels
            .iter()
            .flatten()
            .map(|&v| color::quantize8(v))
            .collect();
        assert_eq!(
            (
                (read.width(), read.height()),
                read.as_rgb8().unwrap().as_raw()
            ),
            ((7, 5), &expected)
        );
    }

    #[test]
    fn sixteen_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(&FileFormat::Png16).unwrap()).unwrap();
        let expected: Vec<u16> = ramp()
            .image
            .pixels
            .iter()
            .flatten()
            .map(|&v| color::quantize16(v))
            .collect();
        assert_eq!(read.as_rgb16().unwrap().as_raw(), &expected);
    }

    #[test]
    fn opacity_comes_back_beside_the_colours() {
        let pixels = vec![[1.0, 0.5, 0.0]; 3];
        let mut picture = Picture::opaque(Image {
            width: 3,
            height: 1,
            pixels,
        });
        picture.alpha = Some(vec![0.0, 0.5, 1.0]);
        let read = |form| ::image::load_from_memory(&picture.encode(&form).unwrap()).unwrap();
        let eight: Vec<u8> = [0, 127, 255]
            .into_iter()
            .flat_map(|alpha| [255, 127, 0, alpha])
            .collect();
        assert_eq!(read(FileFormat::Png8).as_rgba8().unwrap().as_raw(), &eight);
        let sixteen: Vec<u16> = [0, 32767, 65535]
            .into_iter()
            .flat_map(|alpha| [65535, 32767, 0, alpha])
            .collect();
        assert_eq!(
            read(FileFormat::Png16).as_rgba16().unwrap().as_raw(),
            &sixteen
        );
    }

    #[test]
    fn only_the_three_chunks_that_are_needed() {
        let bytes = ramp().encode(&FileFormat::Png8).unwrap();
        for chunk in ["gAMA", "sRGB", "iCCP", "tIME", "tEXt"] {
            assert!(
                !bytes.windows(4).any(|window| window == chunk.as_bytes()),
                "{chunk}"
            );
        }
        assert_eq!(bytes, ramp().encode(&FileFormat::Png8).unwrap());
    }
}
