//! The noise of a growing film, the confidence of that estimate, and where more samples reduce it most.

use super::metrics::LEVELS;
use super::statistics::fisher_quantile;
use crate::render::{ProgressiveFilm, Replicates};

/// The noise of a whole film.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// The expected mean square error of a channel, for a white of 1.
    pub(super) square: f64,
    /// The degrees of freedom of the error itself; `square` has twice as many.
    freedom: f64,
}

impl Noise {
    /// The noise of a film with samples everywhere.
    pub(super) fn of(film: &ProgressiveFilm) -> Self {
        // The variance of the mean of two independent halves.
        let variance =
            |pixel: &Replicates| 0.25 * (pixel.variance_of_half(0) + pixel.variance_of_half(1));
        let (mut sum, mut squares) = (0.0, 0.0);
        for variance in film.pixels().map(variance) {
            sum += variance;
            squares += variance * variance;
        }
        // The mean square error and its estimate, of twice the degrees of freedom k, are as far
        // apart as Fisher's F if their relative variances sum to 3/k (Satterthwaite, "An
        // approximate distribution of estimates of variance components", Biometrics
        // Bulletin 2 (1946)). Each pixel adds its squared error, of the square 3v² in the mean, and
        // its estimate, of 2v², less 2v², if samples are normal; where what they meet is
        // rare both have the same square, far above v². So twice the square of the estimate
        // bounds what a pixel adds; three channels count as one, as if grey.
        let freedom = if squares > 0.0 {
            1.5 * sum * sum / squares
        } else {
            f64::INFINITY
        };
        Self {
            square: sum / film.len().max(1) as f64,
            freedom,
        }
    }

    /// The factor on the square such that the error exceeds it only with the probability `tail`.
    pub(super) fn caution(&self, tail: f64) -> f64 {
        if self.freedom.is_finite() {
            fisher_quantile(tail, self.freedom, 2.0 * self.freedom)
        } else {
            1.0
        }
    }

    /// The root mean square error in grey levels that is exceeded with the probability `tail` only.
    pub(super) fn bound(&self, tail: f64) -> f64 {
        if self.square == 0.0 {
            0.0
        } else {
            (self.square * self.caution(tail)).sqrt() * LEVELS
        }
    }
}

/// The maximum length of a replicate.
const LONGEST: u32 = 1 << 24;

/// The allocation of samples to the halves of pixels.
pub(super) struct Allotment {
    /// The standard deviation of a single sample, estimated from the other half of the pixel and its neighbours.
    deviations: Vec<[f64; 2]>,
    /// The mean of all deviations.
    mean: f64,
    /// The ratio of the noise to that of independent samples: replicates are stratified.
    gain: f64,
}

impl Allotment {
    /// The noise of a film with samples everywhere.
    pub(super) fn of(film: &ProgressiveFilm, noise: &Noise) -> Self {
        let seen = [0, 1].map(|half| smoothed(film, half));
        let deviations: Vec<_> = seen[1]
            .iter()
            .zip(&seen[0])
            .map(|(a, b)| [a.sqrt(), b.sqrt()])
            .collect();
        let pixels = deviations.len().max(1) as f64;
        let mean = deviations.iter().flatten().sum::<f64>() / (2.0 * pixels);
        let independent = |(pixel, [a, b]): (&Replicates, &[f64; 2])| {
            0.125 * (a * a / f64::from(pixel.count(0)) + b * b / f64::from(pixel.count(1)))
        };
        let square = film.pixels().zip(&deviations).map(independent).sum::<f64>() / pixels;
        Self {
            deviations,
            mean,
            gain: if square > 0.0 {
                noise.square / square
            } else {
                1.0
            },
        }
    }

    /// How many samples a replicate of each half of pixel `index` is to have so that the mean
    /// square error becomes `square`: the least work is samples in proportion to the deviation
    /// (Neyman, Journal of the Royal Statistical Society 97 (1934)). At most twice as many as
    /// there are; a power of two, of which replicates are stratified.
    pub(super) fn wanted(&self, film: &ProgressiveFilm, index: usize, square: f64) -> [u32; 2] {
        let scale = self.gain * self.mean / (4.0 * square);
        [0, 1].map(|half: usize| {
            let count = film.pixel(index).count(half);
            let best = scale * self.deviations[index][half];
            if best >= 2.0 * f64::from(count) && count < LONGEST {
                2 * count
            } else {
                count
            }
        })
    }
}

/// The variance of single samples, of one half of each pixel: its own, and as long as it has few
/// samples also that of its neighbours and of the whole picture, so that an edge missed by few
/// samples is found.
fn smoothed(film: &ProgressiveFilm, half: usize) -> Vec<f64> {
    /// The weights of the neighbours and of the whole picture, in samples.
    const NEAR: f64 = 2.0;
    const FAR: f64 = 0.25;
    let own: Vec<_> = film
        .pixels()
        .map(|pixel| pixel.variance_of_samples(half))
        .collect();
    let far = own.iter().sum::<f64>() / own.len().max(1) as f64;
    let (width, height) = (film.crop().width as usize, film.crop().height as usize);
    let around = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let of = |index: usize| {
        let (x, y) = (index % width, index / width);
        let rows = around(y, height).map(|y| &own[y * width..][around(x, width)]);
        let (sum, count) = rows.flatten().fold((0.0, 0.0), |(sum, count), variance| {
            (sum + variance, count + 1.0)
        });
        let near = (sum - own[index]).max(0.0) / f64::max(count - 1.0, 1.0);
        let freedom = 2.0 * f64::from(film.pixel(index).count(half)) - 1.0;
        (freedom * own[index] + NEAR * near + FAR * far) / (freedom + NEAR + FAR)
    };
    (0..own.len()).map(of).collect()
}
