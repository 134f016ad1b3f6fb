//! PNG of 8 and 16 bits per channel, red, green, blue. It carries no colour profile, no gamma and no time.

use super::{EncodeError, Image};
use crate::color;
use ::image::codecs::png::{CompressionType, FilterType, PngEncoder};
use ::image::{ExtendedColorType, ImageEncoder};

/// The picture in 8 bits per channel.
pub(super) fn eight_bit(image: &Image) -> Result<Vec<u8>, EncodeError> {
    let samples: Vec<u8> = image.pixels.iter().flatten().map(|&v| color::quantize8(v)).collect();
    encode(image, &samples, ExtendedColorType::Rgb8)
}

/// The picture in 16 bits per channel.
pub(super) fn sixteen_bit(image: &Image) -> Result<Vec<u8>, EncodeError> {
    // The encoder takes 16-bit samples in the order of the machine and turns them round itself.
    let samples: Vec<u8> = image.pixels.iter().flatten().flat_map(|&v| color::quantize16(v).to_ne_bytes()).collect();
    encode(image, &samples, ExtendedColorType::Rgb16)
}

fn encode(image: &Image, samples: &[u8], kind: ExtendedColorType) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(samples, image.width, image.height, kind)
        .map_err(|error| EncodeError(error.to_string()))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::Form;
    use super::*;

    fn ramp() -> Image {
        let pixels = (0..35).map(|i| [f64::from(i) / 34.0, 1.0 - f64::from(i) / 20.0, f64::NAN]).collect();
        Image { width: 7, height: 5, pixels }
    }

    #[test]
    fn eight_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(&Form::Png8).unwrap()).unwrap();
        let expected: Vec<u8> = ramp().pixels.iter().flatten().map(|&v| color::quantize8(v)).collect();
        assert_eq!(((read.width(), read.height()), read.as_rgb8().unwrap().as_raw()), ((7, 5), &expected));
    }

    #[test]
    fn sixteen_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(&Form::Png16).unwrap()).unwrap();
        let expected: Vec<u16> = ramp().pixels.iter().flatten().map(|&v| color::quantize16(v)).collect();
        assert_eq!(read.as_rgb16().unwrap().as_raw(), &expected);
    }

    #[test]
    fn only_the_three_chunks_that_are_needed() {
        let bytes = ramp().encode(&Form::Png8).unwrap();
        for chunk in ["gAMA", "sRGB", "iCCP", "tIME", "tEXt"] {
            assert!(!bytes.windows(4).any(|window| window == chunk.as_bytes()), "{chunk}");
        }
        assert_eq!(bytes, ramp().encode(&Form::Png8).unwrap());
    }
}
