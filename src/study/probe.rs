//! The error of a denoised picture, estimated from independent samples of some of its pixels, which
//! then make those pixels better.
//!
//! Half buffers do not give it: parts of one stratified sequence are not independent, and a
//! denoised picture of half the samples is another one (decision 15). Two independent means of a
//! pixel give an unbiased estimate for any value: the expected product of its differences from both
//! is its squared error.

use super::metrics::LEVELS;
use super::statistics::fisher_quantile;
use super::target::{RenderRequest, TAIL};
use rtc_image::blend;
use rtc_math::{GAMMA, fraction, mix};
use rtc_render::{AnyWorld, DenoisedFilm, Film, PixelObserver, ProgressiveFilm, Values};

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
    /// The number of probes; a pixel that was drawn twice counts twice.
    pub probes: usize,
    /// The samples of each probe.
    pub samples: u32,
}

/// The pixels for one of those in most doubt, all of which are probed, and for one of the others
/// that are drawn.
const SPACING: [usize; 2] = [16, 128];

/// The least number of those in doubt in a picture of at least four times as many pixels with those
/// drawn, and the least number of those drawn: with fewer the bound holds too rarely.
const MIN_PROBES: [usize; 2] = [768, 256];

/// The maximum number of samples of a mean.
const MAX_LENGTH: u32 = 1 << 20;

/// The fraction of drawn probes with uniform density; the others are placed where much is in doubt.
const UNIFORM_FRACTION: f64 = 0.5;

/// The steps between the plain picture and the denoised one that are compared.
const STEPS: u32 = 4;

/// A step towards the plain picture has to reduce the square error by so many of the standard
/// errors of that.
const CAUTION: f64 = 0.5;

/// The minimum number of degrees of freedom: with fewer, the quantile is infinite.
const MIN_FREEDOM: f64 = 8.0;

/// Blends a denoised picture with `samples` samples per pixel and the plain one, as brings it
/// nearest to independent samples of some pixels, and the pixels in most doubt with these samples;
/// estimates its error. `None` if `on_pixel` stopped it. The seed of the order is that of the
/// probes.
#[must_use]
pub fn probe(
    world: &AnyWorld,
    order: &RenderRequest,
    mut picture: DenoisedFilm,
    samples: u32,
    on_pixel: &PixelObserver<'_>,
) -> Option<(Film, ProbedError)> {
    // Sample some pixels anew.
    let probes = ProbedPixels::new(&picture.doubts, order.seed);
    let length = probes.length(samples);
    let mut film = ProgressiveFilm::new(order.crop, order.seed);
    (film.background, film.display) = (order.background, order.display);
    let requested = |index: usize| [if probes.is_probed(index) { length } else { 0 }, 0];
    if !world.grow(&mut film, &requested, on_pixel) {
        return None;
    }
    // Choose the step between the plain picture and the denoised one.
    let found = |step: u32| probes.found(&film, &picture, step);
    let (step, best) = best(STEPS, found);
    let plain = mean_and_bound(&found(0))[1];
    // Blend pixels in doubt with their new samples.
    let share = probes.share(&film, &best);
    let [square, most] = mean_and_bound(&probes.after(&film, best, share));
    for index in 0..picture.plain.pixels.len() {
        let value = blended(&picture, index, step);
        let new = film.pixel(index).mean(Values::Linear).to_array();
        picture.film.image.pixels[index] = match probes.in_doubt[index] {
            true => [0, 1, 2].map(|c: usize| blend(value[c], new[c], share)),
            false => value,
        };
    }
    picture.film.counts = picture.film.counts.plus(film.counts);
    // Add what no sample met.
    let undersampled = order.undersampled(world).within(samples / 2);
    let is_whole = undersampled.is_included(most, None);
    let all = |most: f64| (most + if is_whole { undersampled.square } else { 0.0 }).min(1.0);
    let probed = ProbedError {
        estimate: square.max(0.0).sqrt() * LEVELS,
        error: all(most).sqrt() * LEVELS,
        undersampled: (!is_whole).then_some(undersampled.source.brightest),
        plain: all(plain).sqrt() * LEVELS,
        probes: probes.count(),
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

/// The probed pixels: those in most doubt, and some that are drawn from the others.
struct ProbedPixels {
    in_doubt: Vec<bool>,
    /// The probability of each of the others to be drawn.
    probabilities: Vec<f64>,
    /// How often each of them was.
    hits: Vec<u32>,
}

impl ProbedPixels {
    /// Chooses pixels by how much is in doubt.
    fn new(doubts: &[f64], seed: u64) -> Self {
        // Take those in most doubt.
        let pixels = doubts.len();
        let drawn = (pixels / SPACING[1]).max(MIN_PROBES[1].min(pixels));
        let least = MIN_PROBES[0].min((pixels / 4).saturating_sub(drawn));
        let taken = (pixels / SPACING[0]).max(least).min(pixels - drawn);
        let doubt = |index: usize| {
            if doubts[index].is_finite() {
                doubts[index]
            } else {
                0.0
            }
        };
        let mut order: Vec<_> = (0..pixels).collect();
        order.sort_unstable_by(|a, b| doubt(*b).total_cmp(&doubt(*a)).then(a.cmp(b)));
        let mut in_doubt = vec![false; pixels];
        order[..taken]
            .iter()
            .for_each(|index| in_doubt[*index] = true);
        // Draw from the others: a mixture of uniform and of the doubts.
        let all: f64 = order[taken..].iter().map(|index| doubt(*index)).sum();
        let even = 1.0 / (pixels - taken).max(1) as f64;
        let probability = |index: usize| match (in_doubt[index], all > 0.0) {
            (true, _) => 0.0,
            (false, true) => {
                UNIFORM_FRACTION * even + (1.0 - UNIFORM_FRACTION) * doubt(index) / all
            }
            (false, false) => even,
        };
        let probabilities: Vec<_> = (0..pixels).map(probability).collect();
        Self {
            hits: spread(&probabilities, drawn, seed),
            in_doubt,
            probabilities,
        }
    }

    /// Whether a pixel is probed.
    fn is_probed(&self, index: usize) -> bool {
        self.in_doubt[index] || self.hits[index] > 0
    }

    /// The number of probes; a pixel that was drawn twice counts twice.
    fn count(&self) -> usize {
        let in_doubt = self.in_doubt.iter().filter(|is| **is).count();
        in_doubt + self.drawn() as usize
    }

    fn drawn(&self) -> u32 {
        self.hits.iter().sum()
    }

    /// The samples of each of two means, for a picture of `samples` per pixel: twice as many where
    /// that is a quarter of all samples, as many in small pictures. Replicates of a power of two
    /// are stratified.
    fn length(&self, samples: u32) -> u32 {
        let is_large = self.in_doubt.len() / SPACING[0] >= MIN_PROBES[0];
        let samples = samples.saturating_mul(1 + u32::from(is_large));
        samples.min(MAX_LENGTH).next_power_of_two()
    }

    /// The results of the probes of pixels, each so many steps to the denoised picture.
    fn found(&self, film: &ProgressiveFilm, picture: &DenoisedFilm, step: u32) -> Vec<ProbeResult> {
        let drawn = f64::from(self.drawn());
        let probed = (0..self.hits.len()).filter(|index| self.is_probed(*index));
        let result = |index: usize| {
            let square = film
                .pixel(index)
                .square_error(blended(picture, index, step));
            let hits = f64::from(self.hits[index]);
            let factor = match self.in_doubt[index] {
                true => 1.0,
                false => hits / (drawn * self.probabilities[index]),
            };
            ProbeResult {
                index,
                square: square * factor / self.hits.len() as f64,
                share: if self.in_doubt[index] {
                    0.0
                } else {
                    hits / drawn
                },
            }
        };
        probed.map(result).collect()
    }

    /// The part of their new samples in pixels in doubt that makes the error least: their squared
    /// error over that and the variance of the samples.
    fn share(&self, film: &ProgressiveFilm, found: &[ProbeResult]) -> f64 {
        let taken = || found.iter().filter(|one| self.in_doubt[one.index]);
        let square: f64 = taken().map(|one| one.square).sum();
        let variance = |one: &ProbeResult| film.pixel(one.index).variance();
        let noise = taken().map(variance).sum::<f64>() / self.hits.len() as f64;
        match square > 0.0 {
            true => square / (square + noise),
            false => 0.0,
        }
    }

    /// The results after pixels in doubt are blended with this share of their samples.
    fn after(
        &self,
        film: &ProgressiveFilm,
        found: Vec<ProbeResult>,
        share: f64,
    ) -> Vec<ProbeResult> {
        let (kept, pixels) = (1.0 - share, self.hits.len() as f64);
        let after = |one: ProbeResult| match self.in_doubt[one.index] {
            true => ProbeResult {
                square: kept * kept * one.square
                    + share * share * film.pixel(one.index).variance() / pixels,
                ..one
            },
            false => one,
        };
        found.into_iter().map(after).collect()
    }
}

/// How often each pixel is drawn in so many draws in proportion to probabilities, by stratified
/// sampling of the cumulative distribution over the pixels in row order.
fn spread(probabilities: &[f64], count: usize, seed: u64) -> Vec<u32> {
    let mut hits = vec![0; probabilities.len()];
    let (mut index, mut sum) = (0, probabilities[0]);
    for probe in 0..count {
        let within = fraction(mix((seed << 32 | probe as u64).wrapping_mul(GAMMA)));
        let place = (probe as f64 + within) / count as f64;
        while (sum < place || probabilities[index] == 0.0) && index + 1 < hits.len() {
            index += 1;
            sum += probabilities[index];
        }
        hits[index] += 1;
    }
    hits
}

/// The result of the probes of one pixel.
#[derive(Clone, Copy)]
struct ProbeResult {
    index: usize,
    /// What it adds to the estimated mean squared error.
    square: f64,
    /// The share of all draws that drew the pixel; 0 for a pixel that is probed in any case.
    share: f64,
}

/// The estimated mean, and its variance.
fn mean_and_variance(found: &[ProbeResult]) -> (f64, f64) {
    let mean: f64 = found.iter().map(|one| one.square).sum();
    // Pixels in doubt have the noise of their samples alone, of about their size. Those drawn
    // differ from their mean; draws of the same pixel are not independent.
    let drawn = || found.iter().filter(|one| one.share > 0.0);
    let of_drawn: f64 = drawn().map(|one| one.square).sum();
    let square = |one: &ProbeResult| {
        let deviation = one.square - of_drawn * one.share;
        deviation * deviation
    };
    let pixels = drawn().count() as f64;
    let variance = drawn().map(square).sum::<f64>() * pixels / (pixels - 1.0).max(1.0);
    let taken = found.iter().filter(|one| one.share == 0.0);
    (mean, variance + taken.map(square).sum::<f64>())
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

    /// Results of so many draws, each of another pixel.
    fn once(squares: &[f64]) -> Vec<ProbeResult> {
        let share = 1.0 / squares.len() as f64;
        let result = |(index, square): (usize, &f64)| ProbeResult {
            index,
            square: square * share,
            share,
        };
        squares.iter().enumerate().map(result).collect()
    }

    #[test]
    fn draws_of_the_same_pixel_count_as_one() {
        let (one, four) = (once(&[1.0, 4.0]), once(&[1.0, 4.0, 1.0, 4.0]));
        assert_eq!(mean_and_variance(&one).0, mean_and_variance(&four).0);
        assert!(mean_and_variance(&four).1 < mean_and_variance(&one).1);
    }

    #[test]
    fn the_bound_holds_as_often_as_it_says_where_few_pixels_have_most_of_the_error() {
        let reference = 0.95 + 0.05 * 100.0;
        for count in [256, 1024] {
            let mut rng = SplitMix64::new(count as u64);
            let held = (0..400).filter(|_| {
                let squares: Vec<_> = (0..count).map(|_| square(&mut rng)).collect();
                mean_and_bound(&once(&squares))[1] >= reference
            });
            let held = held.count();
            // The bound promises 0.9; one that always holds would be useless.
            assert!((360..=396).contains(&held), "{held} of 400 by {count}");
        }
    }

    #[test]
    fn a_negative_estimate_has_a_positive_bound() {
        let [mean, most] = mean_and_bound(&once(&[-1.0, 0.5, -0.5, 0.0]));
        assert!(
            mean < 0.0 && most > 0.0 && most.is_finite(),
            "{mean} {most}"
        );
        assert_eq!(mean_and_bound(&once(&[0.0; 9])), [0.0, 0.0]);
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
                    errors[step as usize] + common + own
                };
                once(&noise.iter().enumerate().map(square).collect::<Vec<_>>())
            };
            best(2, found).0
        };
        assert_eq!(of([3.0, 2.0, 1.0]), 2);
        assert_eq!(of([1.0, 2.0, 3.0]), 0);
        assert_eq!(of([2.0, 1.0, 3.0]), 1);
        assert_eq!(of([1.0, 1.0, 1.0]), 2);
    }

    #[test]
    fn probabilities_are_the_frequencies_of_draws() {
        let probabilities: Vec<_> = (0..4096)
            .map(|index| if index % 64 == 0 { 32.5 } else { 0.5 } / 4096.0)
            .collect();
        let mut often = 0;
        for seed in 0..200 {
            let hits = spread(&probabilities, 256, seed);
            assert_eq!(hits.iter().sum::<u32>(), 256);
            often += hits.iter().step_by(64).sum::<u32>();
        }
        let part = f64::from(often) / (200.0 * 256.0);
        assert!((part - 32.5 / 64.0).abs() < 0.02, "{part}");
    }

    #[test]
    fn pixels_in_most_doubt_are_all_probed_and_never_drawn() {
        let doubts: Vec<_> = (0..4096)
            .map(|index| f64::from(index * 37 % 4096))
            .collect();
        let probes = ProbedPixels::new(&doubts, 3);
        for (index, doubt) in doubts.iter().enumerate() {
            assert_eq!(probes.in_doubt[index], *doubt >= 4096.0 - 768.0);
            assert!(!probes.in_doubt[index] || probes.hits[index] == 0);
        }
        assert_eq!(probes.count(), 1024);
        // Of a picture of few pixels all may be drawn.
        assert_eq!(ProbedPixels::new(&[1.0, f64::NAN], 1).count(), 2);
    }
}
