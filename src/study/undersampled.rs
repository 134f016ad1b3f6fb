//! What no sample may have met: no estimate from samples knows of it, but their number bounds it.

use super::metrics::LEVELS;
use rtc_render::ProgressiveFilm;

/// The expected meetings that do not stay out, but with a probability of 5 %.
const EXPECTED_HITS: f64 = 3.0;

/// The fraction of the square of a target that may be left to what is not met. Where noise needs many
/// samples, all pixels soon have so many that far less is left.
const TARGET_FRACTION: f64 = 0.25;

/// The most samples of a replicate that all pixels are to have for what is not met alone.
const MOST: u32 = 256;

/// The error by what no sample of a film may have met.
#[derive(Clone, Copy, Debug)]
pub(super) struct UndersampledError {
    /// Its mean square, for a white of 1.
    pub(super) square: f64,
    /// As of [`Undersampled`].
    pub(super) brightest: f64,
}

impl UndersampledError {
    /// Whether a bound is told that counts it, beside the mean square error of what was met. A target is
    /// in grey levels. If much brighter light than white may be unmet, a bound would tell of nothing
    /// else.
    pub(super) fn is_included(&self, sampled: f64, target: Option<f64>) -> bool {
        match target {
            Some(target) => self.square <= allowance(target),
            None => self.brightest <= 1.0 || self.square <= sampled,
        }
    }
}

/// The mean square error, for a white of 1, that a target in grey levels leaves to what is not met.
fn allowance(target: f64) -> f64 {
    TARGET_FRACTION * target * target / (LEVELS * LEVELS)
}

/// What a sample may show, and in how many pixels.
///
/// Features that all samples together were to meet three times in the mean are met by none with a
/// probability of e⁻³ = 5 % only (the "rule of three": Hanley, Lippman-Hand, "If nothing goes wrong,
/// is everything all right?", JAMA 249 (1983)). Let a pixel have n samples, none of which shows more
/// than L times the white of a display. A feature that a share p of its samples meets changes it by
/// pL, at most by 1. With np in sum at most 3 over all pixels, the sum of the squared changes is
/// greatest where as many pixels as can be change by 1, each with p = 1/L: those are k = 3L/n. If
/// that is less than one, one pixel changes by k.
#[derive(Clone, Copy, Debug)]
pub(super) struct Undersampled {
    /// The greatest value of a sample, in multiples of the white of a display: at least 1.
    pub(super) brightest: f64,
    /// The number of pixels.
    pub(super) pixels: usize,
}

impl Undersampled {
    /// The mean square error by what is not met, for a white of 1, if the replicates of each pixel
    /// have `count` samples or more.
    fn square(&self, count: u32) -> f64 {
        let changed = EXPECTED_HITS * self.brightest / (2.0 * f64::from(count.max(1)));
        let squares = if changed < 1.0 {
            changed * changed
        } else {
            changed
        };
        squares / self.pixels.max(1) as f64
    }

    /// Of a film with samples everywhere.
    pub(super) fn of(&self, film: &ProgressiveFilm) -> UndersampledError {
        let shown = film.pixels().map(|pixel| pixel.counts()[0]);
        self.within(shown.min().unwrap_or(0))
    }

    /// Of pixels that have `count` samples or more in each of two replicates.
    pub(super) fn within(&self, count: u32) -> UndersampledError {
        UndersampledError {
            square: self.square(count),
            brightest: self.brightest,
        }
    }

    /// The least samples of a replicate with which a bound in grey levels can be told; 1 if that is
    /// too many.
    pub(super) fn least(&self, error: f64) -> u32 {
        let counts = std::iter::successors(Some(1), |count| Some(2 * count));
        let mut counts = counts.take_while(|count| *count <= MOST);
        counts
            .find(|count| self.square(*count) <= allowance(error))
            .unwrap_or(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_by_hand() {
        let undersampled = |brightest| Undersampled {
            brightest,
            pixels: 100,
        };
        // One pixel of a hundred, off by 3/8.
        assert_eq!(undersampled(1.0).square(4), 0.375 * 0.375 / 100.0);
        // Three pixels, off by 1.
        assert_eq!(undersampled(8.0).square(4), 0.03);
    }

    #[test]
    fn as_few_samples_as_leave_a_quarter_of_the_square() {
        let undersampled = Undersampled {
            brightest: 1.0,
            pixels: 1600,
        };
        let remaining = |count| undersampled.square(count).sqrt() * LEVELS;
        let least = undersampled.least(1.0);
        assert!(
            remaining(least) <= 0.5 && remaining(least / 2) > 0.5,
            "{least}"
        );
        assert_eq!(undersampled.least(1e-9), 1, "too many");
    }

    /// No other share-out of three meetings over pixels changes them by more.
    #[test]
    fn nothing_unmet_is_worse() {
        for (brightest, count) in [(1.0, 1), (1.0, 4), (8.0, 4), (3.0, 16)] {
            let undersampled = Undersampled {
                brightest,
                pixels: 64,
            };
            let samples = 2.0 * f64::from(count);
            for pixels in 1..=64 {
                let fraction = (EXPECTED_HITS / (samples * f64::from(pixels))).min(1.0);
                let change = (fraction * brightest).min(1.0);
                let square = f64::from(pixels) * change * change / 64.0;
                assert!(
                    square <= undersampled.square(count) * (1.0 + 1e-12),
                    "{pixels} pixels of {samples} samples"
                );
            }
        }
    }
}
