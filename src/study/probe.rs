//! The error of a denoised picture, estimated from independent samples of some of its pixels.
//!
//! Half buffers do not give it: parts of one stratified sequence are not independent, and a
//! denoised picture of half the samples is another one (decision 15). Two independent means of a
//! pixel give an unbiased estimate for any value: the expected product of its differences from both
//! is its squared error.

use super::metrics::LEVELS;
use super::statistics::fisher_quantile;
use super::target::{RenderRequest, TAIL};
use rtc_image::around;
use rtc_math::{GAMMA, fraction, mix};
use rtc_render::{AnyWorld, DenoisedFilm, Film, PixelObserver, ProgressiveFilm};

/// The estimated error of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbedError {
    /// The best estimate of the root mean square error in grey levels, of the sampled part.
    pub estimate: f64,
    /// The bound that holds in 90 % of all renders; if there is no bound, that of the sampled part.
    pub error: f64,
    /// If there is no bound: the possible brightness, in multiples of white, of light that no
    /// sample has hit.
    pub undersampled: Option<f64>,
    /// The bound of the plain picture, of the sampled part.
    pub plain: f64,
    /// The number of probes; a pixel that was chosen twice counts twice.
    pub probes: usize,
    /// The samples of each probe.
    pub samples: u32,
}

/// The number of pixels per probe. A probe takes two means of as many samples as a pixel has,
/// rounded up to a power of two, so the cost is an eighth to a quarter of that of the picture.
const SPACING: usize = 16;

/// The minimum number of probes for a picture of at least four times as many pixels, and for
/// smaller pictures (with fewer probes the bound holds too rarely), and the maximum.
const MIN_PROBES: usize = 1024;
const MIN_PROBES_SMALL: usize = 256;
const MAX_PROBES: usize = 1 << 14;

/// The maximum number of samples of a mean.
const MAX_LENGTH: u32 = 1 << 20;

/// The fraction of probes with uniform density; the others are placed where denoising changed much.
const UNIFORM_FRACTION: f64 = 0.5;

/// The steps between the plain picture and the denoised one that are compared.
const STEPS: u32 = 4;

/// A step towards the plain picture has to reduce the square error by so many of the standard
/// errors of that.
const CAUTION: f64 = 0.5;

/// The minimum number of degrees of freedom: with fewer, the quantile is infinite.
const MIN_FREEDOM: f64 = 8.0;

/// Blends a denoised picture with `samples` samples per pixel and the plain one, as brings it
/// nearest to independent samples of some pixels, and estimates its error from them; `None` if
/// `on_pixel` stopped it. The seed of the order is that of the probes.
#[must_use]
pub fn probe(
    world: &AnyWorld,
    order: &RenderRequest,
    mut picture: DenoisedFilm,
    samples: u32,
    on_pixel: &PixelObserver<'_>,
) -> Option<(Film, ProbedError)> {
    let probabilities = probabilities(&picture, order);
    let probes = ProbedPixels::spread(&probabilities, order.seed);
    // Replicates of a power of two are stratified.
    let length = samples.min(MAX_LENGTH).next_power_of_two();
    let mut film = ProgressiveFilm::new(order.crop, order.seed);
    (film.background, film.display) = (order.background, order.display);
    let requested = |index: usize| [if probes.hits[index] > 0 { length } else { 0 }, 0];
    if !world.grow(&mut film, &requested, on_pixel) {
        return None;
    }
    let found = |step: u32| probes.found(&film, &picture, step, &probabilities);
    let (step, best) = best(STEPS, found);
    let ([square, most], plain) = (mean_and_bound(&best), mean_and_bound(&found(0))[1]);
    let undersampled = order.undersampled(world).within(samples / 2);
    let is_whole = undersampled.is_included(most, None);
    let all = |most: f64| most + if is_whole { undersampled.square } else { 0.0 };
    for index in 0..picture.plain.pixels.len() {
        picture.film.image.pixels[index] = blended(&picture, index, step);
    }
    picture.film.counts = picture.film.counts.plus(film.counts);
    let probed = ProbedError {
        estimate: square.max(0.0).sqrt() * LEVELS,
        error: all(most).sqrt() * LEVELS,
        undersampled: (!is_whole).then_some(undersampled.source.brightest),
        plain: all(plain).sqrt() * LEVELS,
        probes: probes.count,
        samples: 2 * length,
    };
    Some((picture.film, probed))
}

/// A pixel so many steps from the plain picture to the denoised one.
fn blended(picture: &DenoisedFilm, index: usize, step: u32) -> [f64; 3] {
    let [plain, denoised] = [&picture.plain, &picture.film.image].map(|image| image.pixels[index]);
    match step {
        STEPS => denoised,
        0 => plain,
        _ => {
            let share = f64::from(step) / f64::from(STEPS);
            [0, 1, 2].map(|c: usize| plain[c] + share * (denoised[c] - plain[c]))
        }
    }
}

/// The step of least error, the last if in doubt, and the results of its probes.
fn best(last: u32, found: impl Fn(u32) -> Vec<ProbeResult>) -> (u32, Vec<ProbeResult>) {
    let whole = found(last);
    let mut best = (last, 0.0);
    for step in (0..last).rev() {
        let pairs = whole.iter().zip(found(step));
        let less = pairs.map(|(whole, other)| ProbeResult {
            square: whole.square - other.square,
            ..other
        });
        let (mean, variance) = mean_and_variance(&less.collect::<Vec<_>>());
        let gain = mean - CAUTION * variance.sqrt();
        if gain > best.1 {
            best = (step, gain);
        }
    }
    match best.0 == last {
        true => (last, whole),
        false => (best.0, found(best.0)),
    }
}

/// The probability of each pixel to be probed: a mixture of uniform and of the squared change of
/// the displayed value by denoising, summed over 3 × 3 pixels.
fn probabilities(picture: &DenoisedFilm, order: &RenderRequest) -> Vec<f64> {
    let (tone, exposure) = order.display;
    let shown = |pixel: &[f64; 3]| tone.display(pixel.map(|value| value * exposure));
    let Film { image, .. } = &picture.film;
    let pixels = image.pixels.iter().zip(&picture.plain.pixels);
    let squares = pixels.map(|(denoised, plain)| {
        let [denoised, plain] = [denoised, plain].map(shown);
        let squares = denoised.iter().zip(plain).map(|(a, b)| (a - b) * (a - b));
        let sum = squares.sum::<f64>();
        if sum.is_finite() { sum } else { 0.0 }
    });
    let squares: Vec<f64> = squares.collect();
    let size = [image.width as usize, image.height as usize];
    let changed = |index: usize| {
        around(index, size, 1)
            .map(|near| squares[near])
            .sum::<f64>()
    };
    let changed: Vec<_> = (0..squares.len()).map(changed).collect();
    let (all, even) = (
        changed.iter().sum::<f64>(),
        1.0 / changed.len().max(1) as f64,
    );
    let probability = |changed: f64| match all > 0.0 {
        true => UNIFORM_FRACTION * even + (1.0 - UNIFORM_FRACTION) * changed / all,
        false => even,
    };
    changed.into_iter().map(probability).collect()
}

/// The probed pixels.
struct ProbedPixels {
    /// The number of probes of each pixel.
    hits: Vec<u32>,
    count: usize,
}

impl ProbedPixels {
    /// Chooses pixels in proportion to their probabilities, by stratified sampling of the
    /// cumulative distribution over the pixels in row order.
    fn spread(probabilities: &[f64], seed: u64) -> Self {
        let pixels = probabilities.len();
        let least = MIN_PROBES.min(pixels / 4).max(MIN_PROBES_SMALL.min(pixels));
        let count = (pixels / SPACING).clamp(least, MAX_PROBES);
        let mut hits = vec![0; pixels];
        let (mut index, mut sum) = (0, probabilities[0]);
        for probe in 0..count {
            let within = fraction(mix((seed << 32 | probe as u64).wrapping_mul(GAMMA)));
            let place = (probe as f64 + within) / count as f64;
            while sum < place && index + 1 < pixels {
                index += 1;
                sum += probabilities[index];
            }
            hits[index] += 1;
        }
        Self { hits, count }
    }

    /// The results of the probes of pixels, each so many steps to the denoised picture.
    fn found(
        &self,
        film: &ProgressiveFilm,
        picture: &DenoisedFilm,
        step: u32,
        probabilities: &[f64],
    ) -> Vec<ProbeResult> {
        let pixels = self.hits.len() as f64;
        let hit = self.hits.iter().enumerate().filter(|(_, hits)| **hits > 0);
        hit.map(|(index, hits)| {
            let value = blended(picture, index, step);
            ProbeResult {
                square: film.pixel(index).square_error(value) / (pixels * probabilities[index]),
                hits: f64::from(*hits),
            }
        })
        .collect()
    }
}

/// The result of the probes of one pixel; all have the same value.
struct ProbeResult {
    /// Its squared error, weighted by the inverse probability.
    square: f64,
    hits: f64,
}

/// The mean of the results, and its variance.
fn mean_and_variance(found: &[ProbeResult]) -> (f64, f64) {
    let probes: f64 = found.iter().map(|one| one.hits).sum();
    let mean = found.iter().map(|one| one.square * one.hits).sum::<f64>() / probes;
    let squares = found.iter().map(|one| {
        let deviation = one.hits * (one.square - mean);
        deviation * deviation
    });
    // Pixels are independent, but probes of the same pixel are not.
    let pixels = found.len() as f64;
    let variance = squares.sum::<f64>() / (probes * probes) * pixels / (pixels - 1.0).max(1.0);
    (mean, variance)
}

/// The mean of the results, and its upper bound with confidence 1 − [`TAIL`]. The mean is treated
/// as a χ² variable whose degrees of freedom match its variance: squared errors are closer to that
/// than to a normal variable.
fn mean_and_bound(found: &[ProbeResult]) -> [f64; 2] {
    let (mean, variance) = mean_and_variance(found);
    // Probes of a single pixel have no variance.
    let variance = if variance > 0.0 {
        variance
    } else {
        mean * mean * 2.0 / MIN_FREEDOM
    };
    let freedom = (2.0 * mean * mean / variance.max(f64::MIN_POSITIVE)).max(MIN_FREEDOM);
    let factor = fisher_quantile(TAIL, 1e12, freedom);
    let deviations = (factor - 1.0) * (freedom / 2.0).sqrt();
    [mean, mean.max(0.0) + deviations * variance.sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SplitMix64;

    fn uniform(rng: &mut SplitMix64) -> f64 {
        (rng.below(1 << 30) as f64 + 0.5) / f64::from(1 << 30)
    }

    /// A typical squared error: most are small, some are a hundred times as large.
    fn square(rng: &mut SplitMix64) -> f64 {
        let size = if rng.below(20) == 0 { 100.0 } else { 1.0 };
        -size * rtc_math::ln(uniform(rng))
    }

    fn once(square: f64) -> ProbeResult {
        ProbeResult { square, hits: 1.0 }
    }

    #[test]
    fn probes_of_the_same_pixel_count_as_one() {
        let (one, two) = ([1.0, 4.0].map(once), [1.0, 1.0, 4.0, 4.0].map(once));
        let twice = [1.0, 4.0].map(|square| ProbeResult { square, hits: 2.0 });
        assert_eq!(mean_and_bound(&one), mean_and_bound(&twice));
        assert!(mean_and_bound(&two)[1] < mean_and_bound(&twice)[1]);
    }

    #[test]
    fn the_bound_holds_as_often_as_it_says_where_few_pixels_have_most_of_the_error() {
        let reference = 0.95 + 0.05 * 100.0;
        for count in [MIN_PROBES_SMALL, MIN_PROBES] {
            let mut rng = SplitMix64::new(count as u64);
            let held = (0..400).filter(|_| {
                let found: Vec<_> = (0..count).map(|_| once(square(&mut rng))).collect();
                mean_and_bound(&found)[1] >= reference
            });
            let held = held.count();
            // The bound promises 0.9; one that always holds would be useless.
            assert!((360..=396).contains(&held), "{held} of 400 by {count}");
        }
    }

    #[test]
    fn a_negative_estimate_has_a_positive_bound() {
        let [mean, most] = mean_and_bound(&[-1.0, 0.5, -0.5, 0.0].map(once));
        assert!(
            mean < 0.0 && most > 0.0 && most.is_finite(),
            "{mean} {most}"
        );
        assert_eq!(mean_and_bound(&[0.0; 9].map(once)), [0.0, 0.0]);
    }

    #[test]
    fn the_step_of_least_error_is_taken_and_the_last_if_in_doubt() {
        let mut rng = SplitMix64::new(1);
        let noise: Vec<_> = (0..256).map(|_| uniform(&mut rng) - 0.5).collect();
        let of = |errors: [f64; 3]| {
            let found = |step: u32| {
                let square = |(k, common): (usize, &f64)| {
                    // Half of the noise is common to all steps.
                    let own = noise[(k * 7 + step as usize * 31) % 256];
                    once(errors[step as usize] + common + own)
                };
                noise.iter().enumerate().map(square).collect()
            };
            best(2, found).0
        };
        assert_eq!(of([3.0, 2.0, 1.0]), 2);
        assert_eq!(of([1.0, 2.0, 3.0]), 0);
        assert_eq!(of([2.0, 1.0, 3.0]), 1);
        assert_eq!(of([1.0, 1.0, 1.0]), 2);
    }

    #[test]
    fn probabilities_are_the_frequencies_of_probes() {
        let probabilities: Vec<_> = (0..4096)
            .map(|index| if index % 64 == 0 { 32.5 } else { 0.5 } / 4096.0)
            .collect();
        let mut hits = vec![0_u32; 4096];
        for seed in 0..200 {
            let probes = ProbedPixels::spread(&probabilities, seed);
            assert_eq!(probes.hits.iter().sum::<u32>() as usize, probes.count);
            hits.iter_mut()
                .zip(probes.hits)
                .for_each(|(sum, hit)| *sum += hit);
        }
        let often: u32 = hits.iter().step_by(64).sum();
        let part = f64::from(often) / f64::from(hits.iter().sum::<u32>());
        assert!((part - 32.5 / 64.0).abs() < 0.02, "{part}");
    }
}
