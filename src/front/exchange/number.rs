//! Images of numbers: opacities, weights and heights, which other renderers take from the colours
//! of a picture. The IR reads them from the red channel, without a transfer function.

use rtc_color::srgb_decoded;
use rtc_ir::{Image, Pixels};
use rtc_source::{Budget, LimitExceeded, Resource};

/// How the texels of an image become numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NumberSource {
    /// The relative luminance.
    Luminance,
    /// Alpha, or without it the mean of red, green and blue.
    AlphaOrMean,
}

/// How an image is read as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NumberCoding {
    pub(crate) source: NumberSource,
    /// Whether bytes are linear, not sRGB. Alpha always is.
    pub(crate) is_linear: bool,
    /// Whether a number x counts as 1 − x.
    pub(crate) is_inverted: bool,
    /// The only channel that has the number, where the others are 1; `None` for all.
    pub(crate) channel: Option<usize>,
}

/// A number as a colour, in one channel or in all.
pub(crate) fn in_channel(number: f64, channel: Option<usize>) -> [f64; 3] {
    std::array::from_fn(|at| match channel {
        Some(only) if only != at => 1.0,
        Some(_) | None => number,
    })
}

impl NumberCoding {
    /// The number of a texel, whose red, green and blue are decoded.
    fn number(self, [r, g, b, a]: [f64; 4], has_alpha: bool) -> f64 {
        let number = match self.source {
            NumberSource::AlphaOrMean if has_alpha => a,
            // Equal channels keep their value to the last bit.
            _ if r == g && g == b => r,
            NumberSource::Luminance => rtc_color::luminance([r, g, b]),
            NumberSource::AlphaOrMean => (r + g + b) / 3.0,
        };
        if self.is_inverted {
            1.0 - number
        } else {
            number
        }
    }

    /// The image of numbers of an image: in bytes if these are exact, else in floats.
    ///
    /// # Errors
    /// If its memory exceeds the budget.
    pub(crate) fn image(self, image: &Image, budget: &Budget) -> Result<Image, LimitExceeded> {
        charge_floats(image, budget)?;
        let numbers = self.numbers(image);
        let byte = |number: f64| rtc_color::nearest8(number);
        let is_exact = |number: &f64| f64::from(byte(*number)) / 255.0 == *number;
        let (kind, pixels) = if numbers.iter().all(is_exact) {
            let color = |number: &f64| in_channel(*number, self.channel).map(byte);
            let bytes = numbers.iter().flat_map(color);
            (Pixels::Rgb8, bytes.collect::<Vec<u8>>())
        } else {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "rounded to what the IR stores"
            )]
            let bytes = |number: &f64| {
                let color = in_channel(*number, self.channel);
                color
                    .map(|part| (part as f32).to_le_bytes())
                    .into_iter()
                    .flatten()
            };
            (Pixels::Rgb32f, numbers.iter().flat_map(bytes).collect())
        };
        Ok(Image {
            name: image.name.clone(),
            width: image.width,
            height: image.height,
            kind,
            pixels: pixels.into(),
        })
    }

    fn numbers(self, image: &Image) -> Vec<f64> {
        let unit = |byte: u8| f64::from(byte) / 255.0;
        let color = |byte: u8| {
            if self.is_linear {
                unit(byte)
            } else {
                srgb_decoded(unit(byte))
            }
        };
        match image.kind {
            Pixels::Rgb8 => {
                let (texels, _) = image.pixels.as_chunks();
                let number = |[r, g, b]: &[u8; 3]| {
                    self.number([color(*r), color(*g), color(*b), 1.0], false)
                };
                texels.iter().map(number).collect()
            }
            Pixels::Rgba8 => {
                let (texels, _) = image.pixels.as_chunks();
                let number = |[r, g, b, a]: &[u8; 4]| {
                    self.number([color(*r), color(*g), color(*b), unit(*a)], true)
                };
                texels.iter().map(number).collect()
            }
            Pixels::Rgb32f => {
                let (channels, _) = image.pixels.as_chunks();
                let (texels, _) = channels.as_chunks();
                let number = |texel: &[[u8; 4]; 3]| {
                    let [r, g, b] = texel.map(|channel| f64::from(f32::from_le_bytes(channel)));
                    self.number([r, g, b, 1.0], false)
                };
                texels.iter().map(number).collect()
            }
        }
    }
}

/// Charges the memory of an image in floats.
fn charge_floats(image: &Image, budget: &Budget) -> Result<(), LimitExceeded> {
    /// The bytes of a texel.
    const TEXEL: u64 = 12;
    let texels = u64::from(image.width) * u64::from(image.height);
    budget.charge(Resource::Textures, texels.saturating_mul(TEXEL))
}

/// An image of bytes whose colours are linear, as floats; `None` for one of floats.
///
/// # Errors
/// If its memory exceeds the budget.
pub(crate) fn linear_colors(
    image: &Image,
    budget: &Budget,
) -> Result<Option<Image>, LimitExceeded> {
    let per_texel = match image.kind {
        Pixels::Rgb8 => 3,
        Pixels::Rgba8 => 4,
        Pixels::Rgb32f => return Ok(None),
    };
    charge_floats(image, budget)?;
    let colors = image.pixels.chunks(per_texel).flat_map(|texel| &texel[..3]);
    let bytes = colors.flat_map(|byte| (f32::from(*byte) / 255.0).to_le_bytes());
    Ok(Some(Image {
        name: image.name.clone(),
        width: image.width,
        height: image.height,
        kind: Pixels::Rgb32f,
        pixels: bytes.collect::<Vec<u8>>().into(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(kind: Pixels, pixels: &[u8]) -> Image {
        Image {
            name: String::new(),
            width: 2,
            height: 1,
            kind,
            pixels: pixels.to_vec().into(),
        }
    }

    fn coding(source: NumberSource, is_linear: bool) -> NumberCoding {
        NumberCoding {
            source,
            is_linear,
            is_inverted: false,
            channel: None,
        }
    }

    #[test]
    fn a_number_is_the_luminance_of_its_texel_or_its_alpha() {
        let colors = image(Pixels::Rgb8, &[255, 0, 0, 128, 128, 128]);
        let [red, grey] = coding(NumberSource::Luminance, false).numbers(&colors)[..] else {
            panic!("two texels");
        };
        assert!((red - 0.2126).abs() < 1e-3 && (grey - 0.215_86).abs() < 1e-5);
        let means = coding(NumberSource::AlphaOrMean, true).numbers(&colors);
        assert_eq!(means, [1.0 / 3.0, 128.0 / 255.0]);
        let covering = image(Pixels::Rgba8, &[9, 9, 9, 51, 9, 9, 9, 255]);
        let alphas = coding(NumberSource::AlphaOrMean, false).numbers(&covering);
        assert_eq!(alphas, [0.2, 1.0]);
    }

    #[test]
    fn exact_numbers_are_bytes_and_others_floats() {
        let budget = Budget::default();
        let greys = image(Pixels::Rgb8, &[7, 7, 7, 128, 128, 128]);
        let raw = coding(NumberSource::Luminance, true);
        let bytes = raw.image(&greys, &budget).unwrap();
        assert_eq!((bytes.kind, &bytes.pixels), (Pixels::Rgb8, &greys.pixels));
        let inverted = NumberCoding {
            is_inverted: true,
            ..raw
        };
        let bytes = inverted.image(&greys, &budget).unwrap();
        assert_eq!(bytes.pixels[..], [248, 248, 248, 127, 127, 127]);
        let decoded = coding(NumberSource::Luminance, false).image(&greys, &budget);
        assert_eq!(decoded.unwrap().kind, Pixels::Rgb32f);
    }
}
