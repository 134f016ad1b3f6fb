//! A denoiser: each pixel becomes the value there of a local linear model of the colours around it,
//! over guides that camera rays gather (Bitterli et al., "Nonlinearly weighted first-order
//! regression for denoising Monte Carlo renderings", CGF 35(4), 2016). One half of the samples
//! chooses the weights for the other. Then each neighbourhood keeps as much of that as brings one
//! half nearer to the other.
//!
//! Colours are compared and blended after a bounded curve: a firefly is no farther from its
//! neighbours than white is from black, and its noise cannot make them near. All is done in one
//! order of operations, in lanes of pixels.

mod curve;
mod planes;
mod share;
mod solve;
mod tile;

use super::Image;
pub use curve::blend;
use planes::ValuePlanes;
use rayon::prelude::*;
use solve::TERMS;

/// The numbers of a guide: coverage, then albedo, normal and distance, each multiplied by it.
pub const GUIDES: usize = TERMS - 1;

/// The guide of a pixel, each number about in [−1, 1].
pub type DenoisingGuide = [f64; GUIDES];

/// One half of the samples of a picture.
#[derive(Clone, Copy, Debug)]
pub struct NoisyHalf<'a> {
    /// The means of its samples, linear.
    pub image: &'a Image,
    /// The guides of the same camera rays.
    pub guides: &'a [DenoisingGuide],
}

/// A denoised picture.
#[derive(Clone, Debug)]
pub struct DenoisedImage {
    /// The picture, linear.
    pub image: Image,
    /// For each pixel about how large its squared error is, relative to its brightness: for the
    /// choice of pixels that need more samples.
    pub doubts: Vec<f64>,
}

/// The denoised picture of two halves of as many samples. `exact` has guides of more rays than
/// either half: models are read off there, which also takes off noise of edges that the guides
/// know. All have the same pixels.
#[must_use]
pub fn denoise(halves: [NoisyHalf<'_>; 2], exact: &[DenoisingGuide]) -> DenoisedImage {
    let [a, b] = halves.map(|half| half.image);
    let models = tile::models(&ValuePlanes::new(halves, exact));
    let shares = share::shares([a, b], &models);
    // The value of a pixel, and how much is in doubt.
    let at = |index: usize| {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        let (mut pixel, mut doubt) = ([0.0; 3], PixelDoubt::default());
        for (c, value) in pixel.iter_mut().enumerate() {
            let [p, q] = [a, b].map(|image| image.pixels[index][c]);
            let [x, y] = [0, 1].map(|half: usize| f64::from(models[half][index][c]));
            *value = curve::blend(mean(p, q), mean(x, y), shares[index]);
            doubt.add([p, q, x, y, mean(p, q), *value], shares[index]);
        }
        (pixel, doubt)
    };
    let found: Vec<_> = (0..a.pixels.len()).into_par_iter().map(at).collect();
    let size = [a.width as usize, a.height as usize];
    let doubt = |index: usize| {
        let near: f64 = around(index, size, 1)
            .map(|near| found[near].1.square)
            .sum();
        near / found[index].1.brightness()
    };
    DenoisedImage {
        doubts: (0..found.len()).map(doubt).collect(),
        image: Image {
            width: a.width,
            height: a.height,
            pixels: found.into_iter().map(|(pixel, _)| pixel).collect(),
        },
    }
}

/// How much of a pixel is in doubt, after the curve.
#[derive(Clone, Copy, Debug, Default)]
struct PixelDoubt {
    /// About its squared error.
    square: f64,
    /// The sum of its channels.
    sum: f64,
}

impl PixelDoubt {
    /// Adds a channel by the values of both halves, of their models, and of the plain and the
    /// denoised picture.
    fn add(&mut self, values: [f64; 6], share: f64) {
        /// The part of the squared change by denoising that may be an error, as of eight scenes.
        const CHANGE: f64 = 0.1;
        let [a, b, x, y, plain, denoised] = values.map(curve::compress);
        // A quarter of the squared difference of halves estimates the variance of their mean.
        let noise = (1.0 - share) * (1.0 - share) * (a - b) * (a - b);
        let models = share * share * (x - y) * (x - y);
        let change = (denoised - plain) * (denoised - plain);
        self.square += 0.25 * (noise + models) + CHANGE * change;
        self.sum += denoised;
    }

    /// What errors are divided by, so that those of dark pixels count, too.
    fn brightness(&self) -> f64 {
        let mean = self.sum / 3.0;
        mean * mean + 0.01
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::{fraction, mix};

    const SIDE: u32 = 24;

    /// A picture of a colour for each pixel.
    fn image(color: impl Fn(u32, u32) -> f64) -> Image {
        let place = |index: u32| (index % SIDE, index / SIDE);
        Image {
            width: SIDE,
            height: SIDE,
            pixels: (0..SIDE * SIDE)
                .map(|index| [color(place(index).0, place(index).1); 3])
                .collect(),
        }
    }

    /// Guides of the albedo of each pixel.
    fn guides(albedo: impl Fn(u32) -> f64) -> Vec<DenoisingGuide> {
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

    fn denoised(color: impl Fn(u32, u32, u64) -> f64, guides: &[DenoisingGuide]) -> Image {
        let [a, b] = [1, 2].map(|seed| image(|x, y| color(x, y, seed)));
        let half = |image| NoisyHalf { image, guides };
        denoise([half(&a), half(&b)], guides).image
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
