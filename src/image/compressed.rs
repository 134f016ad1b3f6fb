//! Pictures as they are shown, of 8 bits a channel: JPEG without opacity, and WebP without loss.
//! They are compressed as a whole, so their strips are kept until the last.

use super::header::{PictureHeader, StripSource};
use super::png::pack;
use super::xmp;
use ::png::BitDepth;
use image_webp::WebPEncoder;
use jpeg_encoder::{Encoder, SamplingFactor};
use std::io::{self, Write};

/// The quality of a JPEG, of 100: the tables of ITU-T T.81, annex K, divided by 6.25.
const QUALITY: u8 = 92;

/// A form of file that shows a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CompressedForm {
    /// Lossy, and opaque.
    Jpeg,
    /// Lossless.
    Webp,
}

/// Writes a picture as its strips come.
pub(super) fn write(
    head: &PictureHeader,
    form: CompressedForm,
    mut out: impl Write,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    let [width, height] = head.size;
    // The encoders need the whole picture, so collect its strips.
    let (mut pixels, mut row) = (Vec::new(), Vec::new());
    let mut left = height;
    while left > 0 {
        let strip = strips.next_strip()?;
        left = left.saturating_sub(strip.image.height);
        for index in 0..strip.image.height as usize {
            pack(&strip, index, BitDepth::Eight, &mut row);
            pixels.extend_from_slice(&row);
        }
    }
    // Encode with the metadata that the format holds.
    let mut bytes = Vec::new();
    match form {
        CompressedForm::Jpeg if head.has_alpha => Err(io::Error::other("a JPEG has no opacity")),
        CompressedForm::Jpeg => jpeg(&mut bytes, &pixels, head.size),
        CompressedForm::Webp => {
            let color = match head.has_alpha {
                true => image_webp::ColorType::Rgba8,
                false => image_webp::ColorType::Rgb8,
            };
            let mut encoder = WebPEncoder::new(&mut bytes);
            if let Some(packet) = xmp::packet(&head.metadata, strips.tree(head)) {
                encoder.set_xmp_metadata(packet.into_bytes());
            }
            encoder
                .encode(&pixels, width, height, color)
                .map_err(io::Error::other)
        }
    }?;
    out.write_all(&bytes)
}

/// Writes a JPEG of opaque pixels, in which colour is as fine as brightness.
fn jpeg(bytes: &mut Vec<u8>, pixels: &[u8], size: [u32; 2]) -> io::Result<()> {
    let [Ok(width), Ok(height)] = size.map(u16::try_from) else {
        return Err(io::Error::other("a JPEG has at most 65535 pixels a side"));
    };
    let mut encoder = Encoder::new(bytes, QUALITY);
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    encoder
        .encode(pixels, width, height, jpeg_encoder::ColorType::Rgb)
        .map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, Picture};
    use rtc_color as color;

    /// A picture of smooth colours, optionally half transparent.
    fn picture(is_clear: bool) -> Picture {
        let at = |index: u32| f64::from(index) / 255.0;
        Picture {
            alpha: is_clear.then(|| {
                (0..256)
                    .map(|at| if at < 128 { 0.5 } else { 1.0 })
                    .collect()
            }),
            ..Picture::opaque(Image {
                width: 16,
                height: 16,
                pixels: (0..256)
                    .map(|index| [at(index), 0.5, 1.0 - at(index)])
                    .collect(),
            })
        }
    }

    #[test]
    fn webp_comes_back_and_jpeg_nearly() {
        let encoded = picture(false);
        let bytes: Vec<u8> = encoded
            .image
            .pixels
            .iter()
            .flatten()
            .map(|v| color::quantize8(*v))
            .collect();
        let read = |form| {
            let file = encoded.encode(form).unwrap();
            assert_eq!(
                file,
                encoded.encode(form).unwrap(),
                "the same bytes every time"
            );
            ::image::load_from_memory(&file)
                .unwrap()
                .to_rgb8()
                .into_raw()
        };
        assert_eq!(read(FileFormat::Webp), bytes);
        let jpeg = read(FileFormat::Jpeg);
        let difference = jpeg.iter().zip(&bytes).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(difference.unwrap() <= 12, "{difference:?}");
    }

    #[test]
    fn the_witness_writes_the_same_webp_and_nearly_the_same_jpeg() {
        use ::image::ExtendedColorType::{Rgb8, Rgba8};
        use ::image::codecs::{jpeg::JpegEncoder, webp::WebPEncoder};
        let (width, height) = (67, 41);
        let wave = |at: u32| (at * at / 7 % 256) as u8;
        let pixels: Vec<u8> = (0..width * height * 3).map(wave).collect();
        for (color, of) in [
            (Rgb8, image_webp::ColorType::Rgb8),
            (Rgba8, image_webp::ColorType::Rgba8),
        ] {
            let (mut encoded, mut witness) = (Vec::new(), Vec::new());
            let height = if color == Rgba8 { 30 } else { height };
            let bytes = &pixels[..(width * height) as usize * if color == Rgba8 { 4 } else { 3 }];
            super::WebPEncoder::new(&mut encoded)
                .encode(bytes, width, height, of)
                .unwrap();
            WebPEncoder::new_lossless(&mut witness)
                .encode(bytes, width, height, color)
                .unwrap();
            assert_eq!(encoded, witness);
        }
        let smooth = |at: u32| {
            ((at / 3 % width * 3 + at / 3 / width * 2) % 256 + at % 3 * 20).min(255) as u8
        };
        let pixels: Vec<u8> = (0..width * height * 3).map(smooth).collect();
        let (mut encoded, mut witness) = (Vec::new(), Vec::new());
        super::jpeg(&mut encoded, &pixels, [width, height]).unwrap();
        let mut encoder = JpegEncoder::new_with_quality(&mut witness, super::QUALITY);
        encoder.encode(&pixels, width, height, Rgb8).unwrap();
        let read = |file: &[u8]| {
            ::image::load_from_memory(file)
                .unwrap()
                .to_rgb8()
                .into_raw()
        };
        let error = |file: &[u8]| {
            let pairs = read(file).into_iter().zip(&pixels);
            pairs
                .map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2))
                .sum::<u64>()
        };
        assert!(
            error(&encoded) * 100 <= error(&witness) * 102,
            "it is as near"
        );
        assert!(encoded.len() * 100 <= witness.len() * 102, "it is as small");
    }

    #[test]
    fn a_jpeg_has_sides_of_16_bits() {
        let too_wide = super::jpeg(&mut Vec::new(), &[0; 65_536 * 3], [65_536, 1]);
        assert!(too_wide.unwrap_err().to_string().contains("65535"));
    }

    #[test]
    fn webp_has_opacity_and_jpeg_has_none() {
        let encoded = picture(true);
        let file = encoded.encode(FileFormat::Webp).unwrap();
        let read = ::image::load_from_memory(&file).unwrap().to_rgba8();
        assert_eq!(
            [read.get_pixel(0, 0).0[3], read.get_pixel(15, 15).0[3]],
            [127, 255]
        );
        assert!(encoded.encode(FileFormat::Jpeg).is_err());
    }
}
