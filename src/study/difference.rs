//! The difference of two pictures of the same size.

use super::flip::{PIXELS_PER_DEGREE, REACH, flip};
use super::metrics::{LEVELS, relative};
use rtc_image::{DisplayedPicture, Image};
use schemars::JsonSchema;
use serde::Serialize;

/// The difference of a picture from a reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Difference {
    /// The root of the mean square difference of all channels of all pixels, in grey levels of 8
    /// bits.
    pub rmse: f64,
    /// The largest difference of a channel, or of the opacity, in grey levels.
    pub max: f64,
    /// The column and row of the first pixel with this difference; `None` if nothing differs.
    pub max_at: Option<[usize; 2]>,
    /// The mean of `(x − r)²/(r² + 0.01)`, of linear values where both pictures have them.
    #[serde(rename = "relMse")]
    pub relative_mse: f64,
    /// The mean of FLIP, from 0 to 1 (Andersson et al., "FLIP: A Difference Evaluator for
    /// Alternating Images", 2020).
    pub flip: f64,
    /// The fraction of pixels with a channel, or an opacity, that differs by more than `levels`
    /// grey levels.
    #[serde(rename = "share")]
    pub fraction: f64,
    /// The threshold for `fraction`, in grey levels.
    pub levels: f64,
}

impl Difference {
    /// The difference of two pictures of the same size.
    #[must_use]
    pub fn of(test: &DisplayedPicture, reference: &DisplayedPicture, levels: f64) -> Self {
        Self::compute(test, reference, levels, &mut |_, _| ())
    }

    /// The difference, and FLIP of each pixel, row by row.
    #[must_use]
    pub fn mapped(
        test: &DisplayedPicture,
        reference: &DisplayedPicture,
        levels: f64,
    ) -> (Self, Vec<f64>) {
        let mut flips = vec![0.0; test.pixels()];
        let found = Self::compute(test, reference, levels, &mut |index, flip| {
            flips[index] = flip;
        });
        (found, flips)
    }

    /// No difference.
    #[must_use]
    pub fn none(levels: f64) -> Self {
        Self {
            rmse: 0.0,
            max: 0.0,
            max_at: None,
            relative_mse: 0.0,
            flip: 0.0,
            fraction: 0.0,
            levels,
        }
    }

    /// Computes the difference; `on_flip` is called for each pixel of a tile that differs.
    fn compute(
        test: &DisplayedPicture,
        reference: &DisplayedPicture,
        levels: f64,
        on_flip: &mut dyn FnMut(usize, f64),
    ) -> Self {
        let (mut found, mut square, mut over) = (Self::none(levels), 0.0, 0_u64);
        let width = test.size()[0] as usize;
        // Sum the differences of all pixels.
        for index in 0..test.pixels() {
            let [displayed, expected] = [test, reference].map(|picture| picture.display(index));
            square += channel_pairs(displayed, expected)
                .map(|(x, r)| (x - r) * (x - r))
                .sum::<f64>();
            let light = test.light(index).zip(reference.light(index));
            let (value, other) = light.unwrap_or((displayed, expected));
            found.relative_mse += channel_pairs(value, other).map(relative).sum::<f64>();
            let opacity = (test.opacity(index) - reference.opacity(index)).abs();
            let off = channel_pairs(displayed, expected).map(|(x, r)| (x - r).abs());
            let off = off.fold(opacity, f64::max) * LEVELS;
            // By rounding, values of an 8-bit file are not exact multiples of a grey level.
            over += u64::from(off > levels + 1e-9);
            if off > found.max {
                (found.max, found.max_at) = (off, Some([index % width, index / width]));
            }
        }
        // Normalise the sums.
        let count = test.pixels().max(1) as f64;
        found.rmse = (square / (3.0 * count)).sqrt() * LEVELS;
        found.relative_mse /= 3.0 * count;
        found.fraction = over as f64 / count;
        // Add FLIP.
        let mut sum = 0.0;
        by_tiles(test, reference, &mut |index, flip| {
            sum += flip;
            on_flip(index, flip);
        });
        found.flip = sum / count;
        found
    }

    /// Whether the pictures are equal.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.max_at.is_none() && self.relative_mse == 0.0
    }
}

/// The pairs of channels of two colours.
fn channel_pairs(test: [f64; 3], reference: [f64; 3]) -> impl Iterator<Item = (f64, f64)> {
    test.into_iter().zip(reference)
}

/// FLIP of each pixel in the tiles that differ. Each tile is filtered with a border of the filter
/// radius, so that the result equals that of the whole picture.
fn by_tiles(
    test: &DisplayedPicture,
    reference: &DisplayedPicture,
    on_flip: &mut dyn FnMut(usize, f64),
) {
    /// Pixels along each side.
    const TILE: u32 = 256;
    let [width, height] = test.size();
    let starts = |length: u32| (0..length).step_by(TILE as usize);
    for [left, top] in starts(height).flat_map(|y| starts(width).map(move |x| [x, y])) {
        let around = |start: u32, length: u32| {
            let first = start.saturating_sub(REACH);
            let end = start.saturating_add(TILE + REACH).min(length);
            [first, end - first]
        };
        let ([x, across], [y, down]) = (around(left, width), around(top, height));
        let [a, b] = [reference, test].map(|picture| picture.part([x, y], [across, down]));
        if a == b {
            continue;
        }
        let flips = flip(&a, &b, PIXELS_PER_DEGREE);
        for row in top..(top + TILE).min(height) {
            for column in left..(left + TILE).min(width) {
                let value = (row - y) as usize * across as usize + (column - x) as usize;
                on_flip(
                    row as usize * width as usize + column as usize,
                    flips[value],
                );
            }
        }
    }
}

/// FLIP of each pixel as a heat map: from black for no difference to white for the largest.
#[must_use]
pub fn heat_map([width, height]: [u32; 2], flips: &[f64]) -> Image {
    Image {
        width,
        height,
        pixels: flips.iter().copied().map(heat_color).collect(),
    }
}

/// The heat-map colour of a value in [0, 1].
fn heat_color(value: f64) -> [f64; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [0.0, 0.0, 0.02],
        [0.32, 0.07, 0.48],
        [0.72, 0.21, 0.47],
        [0.99, 0.55, 0.38],
        [1.0, 1.0, 0.9],
    ];
    let scaled = value.clamp(0.0, 1.0) * 4.0;
    let below = (0..4)
        .rev()
        .find(|stop| f64::from(*stop) <= scaled)
        .unwrap_or(0);
    let fraction = scaled - f64::from(below);
    let (from, to) = (STOPS[below as usize], STOPS[below as usize + 1]);
    [0, 1, 2].map(|c| from[c] * (1.0 - fraction) + to[c] * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::{FileFormat, Picture};

    fn displayed(values: &[f64]) -> DisplayedPicture {
        DisplayedPicture::of(Image {
            width: 2,
            height: u32::try_from(values.len() / 2).unwrap(),
            pixels: values.iter().map(|value| [0.5, *value, 0.5]).collect(),
        })
    }

    #[test]
    fn differences_by_hand() {
        let (a, b) = (
            displayed(&[0.0, 0.2, 0.4, 1.0]),
            displayed(&[0.0, 0.2, 0.6, 0.8]),
        );
        let (found, flips) = Difference::mapped(&a, &b, 51.0);
        assert!((found.rmse - (2.0 * 51.0 * 51.0 / 12.0_f64).sqrt()).abs() < 1e-9);
        assert!((found.max - 51.0).abs() < 1e-9 && found.max_at == Some([0, 1]));
        assert!(found.fraction == 0.0 && found.flip == flips.iter().sum::<f64>() / 4.0);
        assert_eq!(Difference::of(&a, &b, 50.0).fraction, 0.5);
        let relative = (0.04 / 0.37 + 0.04 / 0.65) / 12.0;
        assert!((found.relative_mse - relative).abs() < 1e-12);
        assert_eq!(Difference::of(&a, &a, 0.0), Difference::none(0.0));
        assert!(!found.is_none());
    }

    #[test]
    fn opacity_counts_as_a_channel() {
        let file = |alpha: f32| {
            let picture = Picture {
                image: Image {
                    width: 2,
                    height: 2,
                    pixels: vec![[0.0; 3]; 4],
                },
                alpha: Some(vec![1.0, 1.0, 1.0, alpha]),
                ..Picture::default()
            };
            let bytes = picture.encode(FileFormat::Png8).unwrap();
            DisplayedPicture::read(&bytes, 4).unwrap()
        };
        let found = Difference::of(&file(0.8), &file(1.0), 1.0);
        assert_eq!(
            (found.rmse, found.max_at, found.fraction),
            (0.0, Some([1, 1]), 0.25)
        );
    }

    #[test]
    fn tiles_give_the_same_flip_as_the_whole_picture() {
        let picture = |seed: u32| {
            let mut state = seed;
            let mut next = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 24)
            };
            Image {
                width: 300,
                height: 270,
                pixels: (0..300 * 270).map(|_| [next(), next(), next()]).collect(),
            }
        };
        let (a, mut b) = (picture(1), picture(1));
        // A difference at the border of a tile affects its neighbours, too.
        b.pixels[100 * 300 + 255] = [1.0, 0.0, 0.5];
        b.pixels[255 * 300 + 7] = [0.0, 1.0, 0.5];
        let whole = flip(&b, &a, PIXELS_PER_DEGREE);
        let (_, by_tiles) =
            Difference::mapped(&DisplayedPicture::of(a), &DisplayedPicture::of(b), 1.0);
        assert!(whole == by_tiles, "to the last bit");
    }
}
