//! How far two pictures of one size are apart.

use super::flip::{PIXELS_PER_DEGREE, flip};
use super::metrics::{LEVELS, relative_mse, rmse};
use rtc_image::{Image, ShownPicture};
use serde::Serialize;

/// The difference of a picture from a reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Difference {
    /// The root of the mean square difference of all channels of all pixels, in grey levels of 8 bits.
    pub rmse: f64,
    /// The largest difference of a channel, or of the opacity, in grey levels.
    pub max: f64,
    /// The column and row of the first pixel with it; none if nothing differs.
    pub max_at: Option<[usize; 2]>,
    /// The mean of `(x − r)²/(r² + 0.01)`, of the values of light where both pictures hold them.
    #[serde(rename = "relMse")]
    pub relative_mse: f64,
    /// The mean of FLIP, from 0 to 1 (Andersson et al., "FLIP: A Difference Evaluator for Alternating
    /// Images", 2020).
    pub flip: f64,
    /// The fraction of pixels with a channel, or an opacity, off by more than so many grey levels.
    pub share: f64,
    /// So many.
    pub levels: f64,
}

impl Difference {
    /// The difference, and FLIP of each pixel, row by row. The pictures are of one size.
    #[must_use]
    pub fn of(test: &ShownPicture, reference: &ShownPicture, levels: f64) -> (Self, Vec<f64>) {
        let (a, b) = (&test.display, &reference.display);
        let flips = flip(b, a, PIXELS_PER_DEGREE);
        let count = flips.len().max(1) as f64;
        let offs = (0..flips.len()).map(|index| off(test, reference, index));
        let mut found = Self {
            rmse: rmse(std::slice::from_ref(a), std::slice::from_ref(b)),
            max: 0.0,
            max_at: None,
            relative_mse: match (&test.linear, &reference.linear) {
                (Some(a), Some(b)) => relative_mse(a, b),
                (Some(_), None) | (None, _) => relative_mse(a, b),
            },
            flip: flips.iter().sum::<f64>() / count,
            share: 0.0,
            levels,
        };
        let width = a.width as usize;
        let mut over = 0_u64;
        for (index, off) in offs.enumerate() {
            // What a file of 8 bits holds is no whole number of levels, by rounding.
            over += u64::from(off > levels + 1e-9);
            if off > found.max {
                (found.max, found.max_at) = (off, Some([index % width, index / width]));
            }
        }
        found.share = over as f64 / count;
        (found, flips)
    }

    /// Whether the pictures show the same.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.max_at.is_none() && self.relative_mse == 0.0
    }
}

/// The largest difference of a pixel, in grey levels.
fn off(test: &ShownPicture, reference: &ShownPicture, index: usize) -> f64 {
    let colors = |picture: &ShownPicture| picture.display.pixels[index];
    let opacity = |picture: &ShownPicture| picture.alpha.as_ref().map_or(1.0, |alpha| alpha[index]);
    let channels = colors(test).into_iter().zip(colors(reference));
    let apart = channels.map(|(x, r)| (x - r).abs());
    apart.fold((opacity(test) - opacity(reference)).abs(), f64::max) * LEVELS
}

/// FLIP of each pixel as a picture: from black for no difference to white for the largest.
#[must_use]
pub fn heat_map([width, height]: [u32; 2], flips: &[f64]) -> Image {
    Image {
        width,
        height,
        pixels: flips.iter().copied().map(glow).collect(),
    }
}

/// A colour that grows brighter from 0 to 1.
fn glow(value: f64) -> [f64; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [0.0, 0.0, 0.02],
        [0.32, 0.07, 0.48],
        [0.72, 0.21, 0.47],
        [0.99, 0.55, 0.38],
        [1.0, 1.0, 0.9],
    ];
    let place = value.clamp(0.0, 1.0) * 4.0;
    let below = (0..4)
        .rev()
        .find(|stop| f64::from(*stop) <= place)
        .unwrap_or(0);
    let fraction = place - f64::from(below);
    let (from, to) = (STOPS[below as usize], STOPS[below as usize + 1]);
    [0, 1, 2].map(|c| from[c] * (1.0 - fraction) + to[c] * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(values: &[f64]) -> ShownPicture {
        ShownPicture {
            display: Image {
                width: 2,
                height: u32::try_from(values.len() / 2).unwrap(),
                pixels: values.iter().map(|value| [0.5, *value, 0.5]).collect(),
            },
            linear: None,
            alpha: None,
        }
    }

    #[test]
    fn differences_by_hand() {
        let (a, b) = (shown(&[0.0, 0.2, 0.4, 1.0]), shown(&[0.0, 0.2, 0.6, 0.8]));
        let (found, flips) = Difference::of(&a, &b, 51.0);
        assert!((found.rmse - (2.0 * 51.0 * 51.0 / 12.0_f64).sqrt()).abs() < 1e-9);
        assert!((found.max - 51.0).abs() < 1e-9 && found.max_at == Some([0, 1]));
        assert!(found.share == 0.0 && found.flip == flips.iter().sum::<f64>() / 4.0);
        assert_eq!(Difference::of(&a, &b, 50.0).0.share, 0.5);
        let relative = (0.04 / 0.37 + 0.04 / 0.65) / 12.0;
        assert!((found.relative_mse - relative).abs() < 1e-12);
        assert!(Difference::of(&a, &a, 0.0).0.is_none() && !found.is_none());
    }

    #[test]
    fn opacity_counts_as_a_channel() {
        let (mut a, b) = (shown(&[0.0; 4]), shown(&[0.0; 4]));
        a.alpha = Some(vec![1.0, 1.0, 1.0, 0.8]);
        let (found, _) = Difference::of(&a, &b, 1.0);
        assert_eq!(
            (found.rmse, found.max_at, found.share),
            (0.0, Some([1, 1]), 0.25)
        );
    }
}
