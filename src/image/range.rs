//! Values of a picture that a file can't represent: NaN, or beyond its floats.

use super::{FileFormat, Image, Picture, PixelLayers};

/// The values of a picture that its files change.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RangeClipping {
    /// The number of pixels with a NaN, which is 0 in every file.
    pub unnumbered: u64,
    /// The channels with values beyond the largest float that an EXR has for them, 3.4e38 in 32
    /// bits and 65 504 in 16, which replaces them.
    pub beyond: Vec<&'static str>,
}

impl Image {
    /// The number of pixels with a NaN.
    #[must_use]
    pub fn unnumbered(&self) -> u64 {
        self.pixels
            .iter()
            .filter(|pixel| pixel.iter().any(|value| value.is_nan()))
            .count() as u64
    }
}

impl Picture {
    /// The values of this picture that a file can't represent.
    #[must_use]
    pub fn lost(&self, form: FileFormat) -> RangeClipping {
        let Self {
            image: Image { pixels, .. },
            alpha: _,
            layers: PixelLayers { names, values },
            tiles: _,
        } = self;
        let width = names.len();
        let layer = |index: usize| &values[index * width..(index + 1) * width];
        let is_unnumbered = |(index, pixel): &(usize, &[f64; 3])| {
            pixel.iter().any(|value| value.is_nan())
                || layer(*index).iter().any(|value| value.is_nan())
        };
        let colors = ["R", "G", "B"].into_iter().enumerate();
        let most = |name: &str| largest(is_half(form, name));
        let colors = colors.filter(|(k, name)| {
            let most = most(name);
            pixels.iter().any(|pixel| pixel[*k].abs() > most)
        });
        let layers = names.iter().copied().enumerate();
        let layers = layers.filter(|(k, name)| {
            let most = most(name);
            let mut channel = values.iter().skip(*k).step_by(width);
            channel.any(|value| f64::from(*value).abs() > most)
        });
        RangeClipping {
            unnumbered: pixels.iter().enumerate().filter(is_unnumbered).count() as u64,
            beyond: colors.chain(layers).map(|(_, name)| name).collect(),
        }
    }
}

/// Whether a channel has 16-bit floats. Distances, positions and numbers of surfaces need more.
pub(super) fn is_half(form: FileFormat, channel: &str) -> bool {
    let layer = channel.split('.').next();
    form == FileFormat::ExrHalf
        && !matches!(layer, Some("depth" | "position" | "instance" | "samples"))
}

/// The largest float of 16 or 32 bits.
fn largest(is_half: bool) -> f64 {
    if is_half {
        65_504.0
    } else {
        f64::from(f32::MAX)
    }
}

/// The nearest finite float of 32 or 16 bits; 0 for NaN.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounds to the nearest float"
)]
pub(super) fn narrow(v: f64, is_half: bool) -> f32 {
    let largest = largest(is_half);
    if v.is_nan() {
        0.0
    } else {
        v.clamp(-largest, largest) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_cant_hold_is_counted() {
        let pixels = vec![
            [0.0, 1.0, 1e39],
            [f64::NAN, f64::INFINITY, 0.0],
            [0.0; 3],
            [f64::from(f32::MAX); 3],
        ];
        let mut picture = Picture::opaque(Image {
            width: 2,
            height: 2,
            pixels,
        });
        assert_eq!(
            picture.lost(FileFormat::Exr),
            RangeClipping {
                unnumbered: 1,
                beyond: vec!["G", "B"]
            }
        );
        let values = vec![
            1.0,
            f32::NEG_INFINITY,
            2.0,
            f32::NAN,
            f32::NAN,
            0.0,
            f32::MAX,
            3.0,
        ];
        picture.layers = PixelLayers {
            names: vec!["depth.Z", "uv.U"],
            values,
        };
        assert_eq!(
            picture.lost(FileFormat::Exr),
            RangeClipping {
                unnumbered: 2,
                beyond: vec!["G", "B", "uv.U"]
            }
        );
        picture.image.pixels[2] = [65_505.0, 0.0, 0.0];
        picture.layers.values[0] = 65_505.0;
        let lost = picture.lost(FileFormat::ExrHalf);
        assert_eq!(lost.beyond, ["R", "G", "B", "uv.U"]);
    }

    #[test]
    fn floats_are_finite() {
        assert_eq!(
            [1e39, -f64::INFINITY, f64::NAN, 0.1].map(|value| narrow(value, false)),
            [f32::MAX, f32::MIN, 0.0, 0.1]
        );
        assert_eq!(
            [65_505.0, -7e4].map(|value| narrow(value, true)),
            [65_504.0, -65_504.0]
        );
    }
}
