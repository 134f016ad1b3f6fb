//! Pictures as they are shown, of 8 bits a channel: JPEG without opacity, and WebP without loss. They
//! are compressed as a whole, so their strips are kept until the last.

use super::file::{PictureHead, StripSource};
use super::png::pack;
use ::image::codecs::jpeg::JpegEncoder;
use ::image::codecs::webp::WebPEncoder;
use ::image::{ExtendedColorType, ImageError};
use ::png::BitDepth;
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
    head: &PictureHead,
    form: CompressedForm,
    mut out: impl Write,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    let [width, height] = head.size;
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
    let color = if head.has_alpha {
        ExtendedColorType::Rgba8
    } else {
        ExtendedColorType::Rgb8
    };
    let mut bytes = Vec::new();
    let encoded = match form {
        CompressedForm::Jpeg => {
            JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode(&pixels, width, height, color)
        }
        CompressedForm::Webp => {
            WebPEncoder::new_lossless(&mut bytes).encode(&pixels, width, height, color)
        }
    };
    encoded.map_err(|error: ImageError| io::Error::other(error.to_string()))?;
    out.write_all(&bytes)
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, Picture};
    use crate::color;

    /// A picture of smooth colours, half of it transparent if that is wanted.
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
        let own = picture(false);
        let bytes: Vec<u8> = own
            .image
            .pixels
            .iter()
            .flatten()
            .map(|v| color::quantize8(*v))
            .collect();
        let read = |form| {
            let file = own.encode(form).unwrap();
            assert_eq!(file, own.encode(form).unwrap(), "the same bytes every time");
            ::image::load_from_memory(&file)
                .unwrap()
                .to_rgb8()
                .into_raw()
        };
        assert_eq!(read(FileFormat::Webp), bytes);
        let jpeg = read(FileFormat::Jpeg);
        let apart = jpeg.iter().zip(&bytes).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(apart.unwrap() <= 12, "{apart:?}");
    }

    #[test]
    fn webp_has_opacity_and_jpeg_has_none() {
        let own = picture(true);
        let file = own.encode(FileFormat::Webp).unwrap();
        let read = ::image::load_from_memory(&file).unwrap().to_rgba8();
        assert_eq!(
            [read.get_pixel(0, 0).0[3], read.get_pixel(15, 15).0[3]],
            [127, 255]
        );
        assert!(own.encode(FileFormat::Jpeg).is_err());
    }
}
