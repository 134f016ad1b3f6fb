//! A denoiser: each pixel becomes the value there of a local linear model of the colours around it,
//! over guides that camera rays gather (Bitterli et al., "Nonlinearly weighted first-order
//! regression for denoising Monte Carlo renderings", CGF 35(4), 2016). One half of the samples
//! chooses the weights for the other. Fixed order of operations.

mod solve;

use super::Image;
use rayon::prelude::*;
use rtc_math::exp;
use solve::{TERMS, Terms, solve};

/// The numbers of a guide: coverage, then albedo, normal and distance, each multiplied by it.
pub const GUIDES: usize = TERMS - 1;

/// The guide of a pixel, each number about in [−1, 1].
pub type Guide = [f64; GUIDES];

/// One half of the samples of a picture.
#[derive(Clone, Copy, Debug)]
pub struct NoisyHalf<'a> {
    /// The means of its samples, linear.
    pub image: &'a Image,
    /// The guides of the same camera rays.
    pub guides: &'a [Guide],
}

/// Pixels on each side of a pixel that its model is fitted to.
const REACH: usize = 3;
/// Pixels on each side that colours are compared over.
const PATCH: usize = 1;
/// How fast weights fall with the square of the distance of guides.
const GUIDE_FALL: f64 = 2.0;
/// Weights below this are left out.
const LEAST_WEIGHT: f64 = 1e-3;
/// The ridge on the slopes of a model.
const RIDGE: f64 = 1e-2;

/// The denoised picture of two halves with equal samples. `exact` has guides of more rays than
/// either half: models are evaluated there, which also smooths edges that the guides have. All have
/// the same pixels.
#[must_use]
pub fn denoise(halves: [NoisyHalf<'_>; 2], exact: &[Guide]) -> Image {
    let variance = variances(halves);
    let (width, height) = (halves[0].image.width, halves[0].image.height);
    let at = |index: usize| {
        let filtered = [[0, 1], [1, 0]].map(|[fitted, weighing]| {
            let model = LocalModel {
                fitted: halves[fitted],
                weighing: halves[weighing].image,
                variance: &variance,
                exact,
            };
            model.value(index)
        });
        let mean = |channel: usize| (filtered[0][channel] + filtered[1][channel]) / 2.0;
        [0, 1, 2].map(mean)
    };
    let pixels = (0..halves[0].image.pixels.len()).into_par_iter().map(at);
    Image {
        width,
        height,
        pixels: pixels.collect(),
    }
}

/// The variance of a half in each pixel, by the difference of both: a mean over 3 × 3 pixels.
fn variances([a, b]: [NoisyHalf<'_>; 2]) -> Vec<[f64; 3]> {
    let size = [a.image.width as usize, a.image.height as usize];
    let of = |index: usize| {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for near in around(index, size, PATCH) {
            let [a, b] = [a, b].map(|half| half.image.pixels[near]);
            count += 1.0;
            for c in 0..3 {
                sum[c] += (a[c] - b[c]) * (a[c] - b[c]) / 2.0;
            }
        }
        sum.map(|sum| sum / count)
    };
    (0..a.image.pixels.len()).into_par_iter().map(of).collect()
}

/// The pixels at most `reach` away from one, row by row, of a picture of this width and height.
pub fn around(
    index: usize,
    [width, height]: [usize; 2],
    reach: usize,
) -> impl Iterator<Item = usize> {
    let (x, y) = (index % width, index / width);
    let columns = x.saturating_sub(reach)..(x + reach + 1).min(width);
    let rows = y.saturating_sub(reach)..(y + reach + 1).min(height);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// The data that the models of one half are fitted to.
struct LocalModel<'a> {
    fitted: NoisyHalf<'a>,
    weighing: &'a Image,
    variance: &'a [[f64; 3]],
    exact: &'a [Guide],
}

impl LocalModel<'_> {
    /// The value of the model of a pixel there; its own if no model is finite.
    fn value(&self, index: usize) -> [f64; 3] {
        let size = [self.weighing.width as usize, self.weighing.height as usize];
        let mut terms = Terms::default();
        for near in around(index, size, REACH) {
            let weight = self.weight(index, near, size);
            if weight >= LEAST_WEIGHT {
                let guide = &self.fitted.guides[near];
                let pixel_at: Guide = std::array::from_fn(|k| guide[k] - self.exact[index][k]);
                terms.add(weight, &pixel_at, self.fitted.image.pixels[near]);
            }
        }
        let noisy = self.fitted.image.pixels[index];
        let value = solve(terms, RIDGE);
        if value.iter().all(|value| value.is_finite()) {
            // Radiance is not negative.
            value.map(|value| value.max(0.0))
        } else {
            noisy
        }
    }

    /// How much a pixel nearby counts.
    fn weight(&self, index: usize, near: usize, size: [usize; 2]) -> f64 {
        let (here, there) = (&self.exact[index], &self.exact[near]);
        let squares = here.iter().zip(there).map(|(a, b)| (a - b) * (a - b));
        let guide = squares.sum::<f64>() * GUIDE_FALL;
        exp(-guide - self.distance(index, near, size).max(0.0))
    }

    /// The distance of the colours around two pixels, beyond their noise (Rousselle et al.,
    /// "Adaptive rendering with non-local means filtering", 2012, equation 4).
    fn distance(&self, index: usize, near: usize, [width, height]: [usize; 2]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        let places = [index, near].map(|at| [at % width, at / width]);
        for step in 0..(2 * PATCH + 1) * (2 * PATCH + 1) {
            let step = [step % (2 * PATCH + 1), step / (2 * PATCH + 1)];
            let moved = places.map(|[x, y]| [x + step[0], y + step[1]]);
            let is_inside = |[x, y]: [usize; 2]| {
                (PATCH..width + PATCH).contains(&x) && (PATCH..height + PATCH).contains(&y)
            };
            if !moved.iter().all(|pixel_at| is_inside(*pixel_at)) {
                continue;
            }
            let [p, q] = moved.map(|[x, y]| (y - PATCH) * width + x - PATCH);
            for c in 0..3 {
                let difference = self.weighing.pixels[p][c] - self.weighing.pixels[q][c];
                let [value, other] = [p, q].map(|at| self.variance[at][c]);
                sum +=
                    (difference * difference - value - value.min(other)) / (1e-8 + value + other);
                count += 1.0;
            }
        }
        sum / count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::{fraction, mix};

    const SIDE: u32 = 24;

    /// A picture of a colour for each pixel.
    fn image(color: impl Fn(u32, u32) -> f64) -> Image {
        let pixel_at = |index: u32| (index % SIDE, index / SIDE);
        Image {
            width: SIDE,
            height: SIDE,
            pixels: (0..SIDE * SIDE)
                .map(|index| [color(pixel_at(index).0, pixel_at(index).1); 3])
                .collect(),
        }
    }

    /// Guides of the albedo of each pixel.
    fn guides(albedo: impl Fn(u32) -> f64) -> Vec<Guide> {
        let of = |index: u32| {
            let a = albedo(index % SIDE);
            [1.0, a, a, a, 0.0, 0.0, 1.0, 0.5]
        };
        (0..SIDE * SIDE).map(of).collect()
    }

    /// Noise of mean about 0, which differs from pixel to pixel and by a seed.
    fn noise(x: u32, y: u32, seed: u64) -> f64 {
        fraction(mix(u64::from(x) << 40 | u64::from(y) << 8 | seed)) - 0.5
    }

    fn denoised(color: impl Fn(u32, u32, u64) -> f64, guides: &[Guide]) -> Image {
        let [a, b] = [1, 2].map(|seed| image(|x, y| color(x, y, seed)));
        let half = |image| NoisyHalf { image, guides };
        denoise([half(&a), half(&b)], guides)
    }

    #[test]
    fn a_constant_picture_stays_constant() {
        for pixel in denoised(|_, _, _| 0.25, &guides(|_| 0.5)).pixels {
            assert!((pixel[0] - 0.25).abs() < 1e-9, "{pixel:?}");
        }
    }

    #[test]
    fn an_edge_of_albedo_stays_sharp_and_noise_goes() {
        let step = |x: u32| if x < SIDE / 2 { 0.2 } else { 0.8 };
        let shown = denoised(
            |x, y, seed| step(x) * (1.0 + noise(x, y, seed)),
            &guides(step),
        );
        let (mut square, mut before) = (0.0, 0.0);
        for (index, pixel) in shown.pixels.iter().enumerate() {
            let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
            assert!((pixel[0] - step(x)).abs() < 0.2, "{x} {y} {pixel:?}");
            let plain = step(x) * (noise(x, y, 1) + noise(x, y, 2)) / 2.0;
            square += (pixel[0] - step(x)) * (pixel[0] - step(x));
            before += plain * plain;
        }
        assert!(square < before / 4.0, "{square} {before}");
    }

    #[test]
    fn hostile_values_spread_no_further_than_a_model_reaches() {
        let hostile = [f64::NAN, f64::INFINITY, 1e300, f64::MAX];
        for value in hostile {
            let color = |x, y, _| if (x, y) == (12, 12) { value } else { 0.5 };
            let shown = denoised(color, &guides(|_| 0.5));
            for (index, pixel) in shown.pixels.iter().enumerate() {
                let is_hit = index == (12 * SIDE + 12) as usize;
                assert!(
                    is_hit || pixel.iter().all(|v| v.is_finite()),
                    "{index} {pixel:?}"
                );
            }
        }
    }

    #[test]
    fn one_thread_gives_the_bytes_of_many() {
        let shown = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let color = |x, y, seed| 0.5 + noise(x, y, seed);
            pool.unwrap().install(|| denoised(color, &guides(|_| 0.5)))
        };
        assert_eq!(shown(1), shown(3));
    }
}
