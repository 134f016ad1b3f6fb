//! Measures of the difference of two pictures. All use display values: each sample was clamped to
//! [0, 1] before the mean, as in a picture file, without rounding.

use super::flip::{PIXELS_PER_DEGREE, delta_e, flip};
use super::tile_errors::TileErrors;
use rtc_image::Image;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The full brightness in grey levels of 8 bits.
pub const LEVELS: f64 = 255.0;

/// The errors of pictures against a reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct PictureErrors {
    /// The root of the mean square of all channels of all pixels, in grey levels.
    pub rmse: f64,
    /// The lower end of the interval for the `rmse` of the whole picture, of which tiles were
    /// chosen at random: with 95 % confidence, or less where a few tiles have most of the error.
    /// `rmse` itself if the whole picture was rendered.
    pub rmse_low: f64,
    /// The upper end.
    pub rmse_high: f64,
    /// The mean of `(x − r)²/(r² + 0.01)`, which weights dark regions more.
    pub relative_mse: f64,
    /// The largest difference of a channel, in grey levels.
    pub max: f64,
    /// The fraction of pixels with a channel off by more than one grey level.
    pub visible: f64,
    /// The mean of FLIP, from 0 to 1.
    pub flip: f64,
    /// The mean distance of pixels in CIELAB: ΔE*ab (CIE 1976).
    pub delta_e: f64,
}

impl PictureErrors {
    /// The errors of tiles that are a `fraction` of a picture. FLIP is computed for each tile
    /// separately.
    #[must_use]
    pub fn of(test: &[Image], reference: &[Image], fraction: f64) -> Self {
        let pairs = || test.iter().zip(reference);
        let rmse = rmse(test, reference);
        let interval = TileErrors::of(test, reference, fraction).interval();
        let [rmse_low, rmse_high] = if fraction < 1.0 {
            interval.map(|square| square.sqrt() * LEVELS)
        } else {
            [rmse; 2]
        };
        let channels = || pairs().flat_map(|(test, reference)| channels(test, reference));
        let pixels = pairs().map(|(test, _)| test.pixels.len()).sum::<usize>() as f64;
        let is_off = |(test, reference): (&[f64; 3], &[f64; 3])| {
            test.iter()
                .zip(reference)
                .any(|(x, r)| (x - r).abs() * LEVELS > 1.0)
        };
        let pixel_pairs =
            || pairs().flat_map(|(test, reference)| test.pixels.iter().zip(&reference.pixels));
        let off = pixel_pairs().filter(|pair| is_off(*pair));
        let distances = pixel_pairs().map(|(test, reference)| delta_e(*test, *reference));
        let flips = pairs().flat_map(|(test, reference)| flip(reference, test, PIXELS_PER_DEGREE));
        Self {
            rmse,
            rmse_low,
            rmse_high,
            relative_mse: channels().map(relative).sum::<f64>() / (3.0 * pixels),
            max: channels().map(|(x, r)| (x - r).abs()).fold(0.0, f64::max) * LEVELS,
            visible: off.count() as f64 / pixels,
            flip: flips.sum::<f64>() / pixels,
            delta_e: distances.sum::<f64>() / pixels,
        }
    }
}

/// `(x − r)²/(r² + 0.01)` of a channel.
pub(super) fn relative((x, r): (f64, f64)) -> f64 {
    (x - r) * (x - r) / (r * r + 0.01)
}

/// The root of the mean square difference, in grey levels.
#[must_use]
pub fn rmse(a: &[Image], b: &[Image]) -> f64 {
    mean_product([a, b], [a, b]).sqrt() * LEVELS
}

/// The mean of `(a₀ − b₀)·(a₁ − b₁)` over all channels. Independent noise of a₀ and a₁ cancels;
/// their common error stays.
#[must_use]
pub(super) fn mean_product(first: [&[Image]; 2], second: [&[Image]; 2]) -> f64 {
    let (count, sum) = products(first, second).fold((0_u64, 0.0), |(count, sum), product| {
        (count + 1, sum + product)
    });
    sum / count.max(1) as f64
}

/// `(a₀ − b₀)·(a₁ − b₁)` for each channel.
pub(super) fn products<'a>(
    [a0, b0]: [&'a [Image]; 2],
    [a1, b1]: [&'a [Image]; 2],
) -> impl Iterator<Item = f64> + 'a {
    let pairs = |a: &'a [Image], b: &'a [Image]| a.iter().zip(b).flat_map(|(a, b)| channels(a, b));
    pairs(a0, b0)
        .zip(pairs(a1, b1))
        .map(|((a0, b0), (a1, b1))| (a0 - b0) * (a1 - b1))
}

/// The mean square difference of two pictures.
pub(super) fn mean_square(a: &Image, b: &Image) -> f64 {
    channels(a, b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / (3 * a.pixels.len()).max(1) as f64
}

fn channels(a: &Image, b: &Image) -> impl Iterator<Item = (f64, f64)> {
    a.pixels
        .iter()
        .flatten()
        .copied()
        .zip(b.pixels.iter().flatten().copied())
}

/// The mean of two sets of pictures.
#[must_use]
pub(super) fn mean(a: &[Image], b: &[Image]) -> Vec<Image> {
    let mean = |(a, b): (&Image, &Image)| {
        let pixels = a
            .pixels
            .iter()
            .zip(&b.pixels)
            .map(|(a, b)| [0, 1, 2].map(|c| 0.5 * (a[c] + b[c])))
            .collect();
        Image { pixels, ..*a }
    };
    a.iter().zip(b).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: &[f64]) -> Image {
        Image {
            width: u32::try_from(values.len()).unwrap(),
            height: 1,
            pixels: values.iter().map(|v| [*v; 3]).collect(),
        }
    }

    #[test]
    fn errors_by_hand() {
        let reference = [row(&[0.0, 0.3, 0.5, 1.0])];
        let test = [row(&[0.0, 0.3, 0.5 + 3.0 / 255.0, 1.0 - 0.9 / 255.0])];
        let errors = PictureErrors::of(&test, &reference, 1.0);
        assert!(
            (errors.rmse - ((9.0 + 0.81_f64) / 4.0).sqrt()).abs() < 1e-12,
            "{errors:?}"
        );
        let relative = (9.0 / 0.26 + 0.81 / 1.01) / 4.0 / 255.0 / 255.0;
        assert!((errors.relative_mse - relative).abs() < 1e-15, "{errors:?}");
        assert!(
            (errors.max - 3.0).abs() < 1e-12 && errors.visible == 0.25,
            "one pixel is off by more than one level"
        );
        assert!([errors.rmse_low, errors.rmse_high] == [errors.rmse; 2] && errors.flip > 0.0);
        assert!(errors.delta_e > 0.1 && errors.delta_e < 1.0, "{errors:?}");
    }

    #[test]
    fn independent_noise_cancels_in_the_product() {
        let true_image = [row(&[0.5; 4])];
        let noisy = |signs: [f64; 4]| [row(&signs.map(|sign| 0.6 + 0.2 * sign))];
        let (a, b) = (noisy([1.0, 1.0, -1.0, -1.0]), noisy([1.0, -1.0, 1.0, -1.0]));
        let bias = mean_product([&a, &true_image], [&b, &true_image]).sqrt();
        assert!(
            (bias - 0.1).abs() < 1e-12 && rmse(&a, &true_image) > 2.0 * bias * LEVELS,
            "{bias}"
        );
    }
}
