//! The noise of a progressive film, the confidence of its estimate, and the sample allocation that
//! reduces it most.

use super::metrics::LEVELS;
use super::statistics::fisher_quantile;
use super::undersampled::{UndersampledBound, UndersampledError};
use rtc_render::{ProgressiveFilm, Replicates};

/// The noise of a whole film.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilmNoise {
    /// The expected mean square error of a channel, for a white of 1.
    pub(super) square: f64,
    /// The degrees of freedom of the error, and of the estimate `square`.
    freedom: f64,
    /// The error of features that no sample may have hit.
    pub(super) undersampled: UndersampledError,
}

impl FilmNoise {
    /// The noise of a film with samples in all pixels.
    pub(super) fn of(film: &ProgressiveFilm, undersampled: &UndersampledBound) -> Self {
        let (mut sum, mut squares) = (0.0, 0.0);
        for variance in film.map(Replicates::variance) {
            sum += variance;
            squares += variance * variance;
        }
        // The mean square error and its estimate, each of k degrees of freedom, are as far apart as
        // Fisher's F if their relative variances sum to 4/k (Satterthwaite, "An approximate
        // distribution of estimates of variance components", Biometrics Bulletin 2 (1946)). Each
        // pixel adds its squared error and its estimate, both of the square 3v² in the mean, less
        // 2v², if samples are normal; where features are rare both have the same square, far above
        // v². So twice the square of the estimate bounds the contribution of a pixel; three
        // channels count as one, as if grey.
        let freedom = if squares > 0.0 {
            2.0 * sum * sum / squares
        } else {
            f64::INFINITY
        };
        Self {
            square: sum / film.len().max(1) as f64,
            freedom,
            undersampled: undersampled.of(film),
        }
    }

    /// The factor on the square such that the error exceeds it only with the probability `tail`.
    pub(super) fn safety_factor(&self, tail: f64) -> f64 {
        if self.freedom.is_finite() {
            fisher_quantile(tail, self.freedom, self.freedom)
        } else {
            1.0
        }
    }

    /// The error bound: the sampled part exceeds it with probability `tail`, the unsampled part
    /// with 5 %. The unsampled part is included only if it is small against the target, in grey
    /// levels.
    pub(super) fn bound(&self, tail: f64, target: Option<f64>) -> ErrorBound {
        let sampled = if self.square == 0.0 {
            0.0
        } else {
            self.square * self.safety_factor(tail)
        };
        let is_whole = self.undersampled.is_included(sampled, target);
        let all = sampled
            + if is_whole {
                self.undersampled.square
            } else {
                0.0
            };
        // Display values differ by no more than white from black.
        let levels = |square: f64| square.sqrt().min(1.0) * LEVELS;
        ErrorBound {
            error: levels(all),
            estimate: levels(self.square),
            undersampled: (!is_whole).then_some(self.undersampled.source.brightest),
        }
    }

    /// The mean square error, for a white of 1, that a target in grey levels allows for the sampled
    /// part.
    pub(super) fn remaining(&self, tail: f64, target: f64) -> f64 {
        let square = target * target / (LEVELS * LEVELS);
        let undersampled =
            Some(self.undersampled.square).filter(|undersampled| *undersampled < square);
        (square - undersampled.unwrap_or(0.0)) / self.safety_factor(tail)
    }
}

/// A bound on the error of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ErrorBound {
    /// The root mean square error in grey levels.
    pub(super) error: f64,
    /// The likely error of the sampled part, in grey levels.
    pub(super) estimate: f64,
    /// If there is no bound: the possible brightness, in multiples of white, of light that no
    /// sample has hit. The error then covers only what samples hit.
    pub(super) undersampled: Option<f64>,
}

/// The maximum length of a replicate.
const MAX_LENGTH: u32 = 1 << 24;

/// The fraction of the mean deviation that is added to each pixel, so that features that the pilots
/// missed still get samples.
const MIN_DEVIATION: f64 = 0.125;

/// The maximum number of pilot samples, as a fraction of those of the pixel's replicates, or of the
/// mean over all pixels, after the next round.
const PILOT_FRACTION: f64 = 0.125;

/// The allocation of samples to pixels.
pub(super) struct SampleAllocation {
    /// The standard deviation of a single sample, estimated from the pilots of the pixel and its
    /// neighbours.
    deviations: Vec<f64>,
    /// The mean of all deviations.
    mean: f64,
    /// The ratio of the noise to that of independent samples; it is below 1 because replicates are
    /// stratified.
    gain: f64,
}

impl SampleAllocation {
    /// The allocation for a film with samples in all pixels.
    pub(super) fn of(film: &ProgressiveFilm, noise: &FilmNoise) -> Self {
        let variances = smoothed(film);
        let pixels = variances.len().max(1) as f64;
        let independent = |(pixel, variance): (&Replicates, &f64)| {
            let [replicate, _] = pixel.counts();
            0.5 * variance / f64::from(replicate)
        };
        let square = film.pixels().zip(&variances).map(independent).sum::<f64>() / pixels;
        let deviations: Vec<_> = variances.into_iter().map(f64::sqrt).collect();
        Self {
            mean: deviations.iter().sum::<f64>() / pixels,
            deviations,
            gain: if square > 0.0 {
                noise.square / square
            } else {
                1.0
            },
        }
    }

    /// The samples of each replicate and of the pilot of each pixel for a mean square error of
    /// `square`.
    pub(super) fn requested(&self, film: &ProgressiveFilm, square: f64) -> Vec<[u32; 2]> {
        let replicate: Vec<_> = (0..film.len())
            .map(|index| self.replicate(film, index, square))
            .collect();
        let mean =
            2.0 * replicate.iter().copied().map(f64::from).sum::<f64>() / replicate.len() as f64;
        // A pixel with many samples gets a long pilot, too: a short one with an outlier would
        // request ever more samples.
        let pilot = |replicate: u32, count: u32| {
            let samples = mean.max(2.0 * f64::from(replicate));
            let needs_more = self.mean == 0.0 || 2.0 * f64::from(count) <= PILOT_FRACTION * samples;
            doubled_if(count, needs_more)
        };
        let counts = film.pixels().map(Replicates::counts);
        replicate
            .iter()
            .zip(counts)
            .map(|(replicate, [_, count])| [*replicate, pilot(*replicate, count)])
            .collect()
    }

    /// The samples of a replicate of pixel `index`: the work is minimal if samples are proportional
    /// to the standard deviation (Neyman, Journal of the Royal Statistical Society 97 (1934)). At
    /// most twice the current number; a power of two, for which replicates are stratified.
    fn replicate(&self, film: &ProgressiveFilm, index: usize, square: f64) -> u32 {
        let [count, _] = film.pixel(index).counts();
        let scale = self.gain * self.mean / (2.0 * square);
        let best = scale * (self.deviations[index] + MIN_DEVIATION * self.mean);
        // If the pilots did not find the difference of the replicates, refine all pixels.
        doubled_if(count, self.mean == 0.0 || best >= 2.0 * f64::from(count))
    }
}

/// Doubles a count if more samples are needed.
pub(super) fn doubled_if(count: u32, needs_more: bool) -> u32 {
    if needs_more && count < MAX_LENGTH {
        2 * count
    } else {
        count
    }
}

/// The variance of single samples of each pixel: that of its pilot, blended with those of its
/// neighbours and of the whole picture while the pilot is short, so that an edge that few samples
/// missed is found.
fn smoothed(film: &ProgressiveFilm) -> Vec<f64> {
    /// The weights of the neighbours and of the whole picture, in samples.
    const NEIGHBOUR_WEIGHT: f64 = 2.0;
    const PICTURE_WEIGHT: f64 = 0.25;
    let variances = film.map(Replicates::variance_of_samples);
    let far = variances.iter().sum::<f64>() / variances.len().max(1) as f64;
    let (width, height) = (film.crop().width as usize, film.crop().height as usize);
    let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let of = |index: usize| {
        let (x, y) = (index % width, index / width);
        let rows = around(y, height).map(|y| &variances[y * width..][around(x, width)]);
        let (sum, count) = rows.flatten().fold((0.0, 0.0), |(sum, count), variance| {
            (sum + variance, count + 1.0)
        });
        let near = (sum - variances[index]).max(0.0) / f64::max(count - 1.0, 1.0);
        let [_, pilot] = film.pixel(index).counts();
        let freedom = (f64::from(pilot) - 1.0).max(0.0);
        (freedom * variances[index] + NEIGHBOUR_WEIGHT * near + PICTURE_WEIGHT * far)
            / (freedom + NEIGHBOUR_WEIGHT + PICTURE_WEIGHT)
    };
    (0..variances.len()).map(of).collect()
}
