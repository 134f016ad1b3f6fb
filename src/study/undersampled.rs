//! A bound on the error from features that no sample has hit. No estimate from samples includes it,
//! but the number of samples bounds it (the rule of three).

use super::metrics::LEVELS;
use super::quality::PixelQuality;
use rtc_render::{ProgressiveFilm, Replicates};

/// The expected number of hits of features that are missed with a probability of only 5 %.
const EXPECTED_HITS: f64 = 3.0;

/// The fraction of the squared target that undersampled features may take. Where noise needs many
/// samples, the actual fraction soon is far lower.
const TARGET_FRACTION: f64 = 0.5;

/// The maximum number of samples per replicate that are taken only for undersampled features.
const MAX_SAMPLES: u32 = 256;

/// The error bound of undersampled features of a film.
#[derive(Clone, Copy, Debug)]
pub(super) struct UndersampledError {
    /// Its mean square, for a white of 1.
    pub(super) square: f64,
    /// The subject of the error.
    pub(super) source: UndersampledBound,
}

impl UndersampledError {
    /// Whether a bound includes it, given the mean square error of the sampled part and a target in
    /// grey levels. If light much brighter than white may be undersampled, a bound would be
    /// dominated by it.
    pub(super) fn is_included(&self, sampled: f64, target: Option<f64>) -> bool {
        match target {
            Some(target) => self.square <= allowance(target),
            None => self.source.brightest <= 1.0 || self.square <= sampled,
        }
    }
}

/// The mean square error, for a white of 1, that a target in grey levels allows for undersampled
/// features.
fn allowance(target: f64) -> f64 {
    TARGET_FRACTION * target * target / (LEVELS * LEVELS)
}

/// The bound on undersampled features, from the brightest sample value and the number of pixels.
///
/// A feature with an expected number of 3 hits is missed by all samples with a probability of only
/// e⁻³ = 5 % (the "rule of three": Hanley, Lippman-Hand, "If nothing goes wrong, is everything all
/// right?", JAMA 249 (1983)). Let a pixel have n samples of at most L times the white of a display.
/// A feature that is hit with probability p changes the pixel by pL, at most by 1. If the sum of np
/// over all pixels is at most 3, the sum of the squared changes is largest if as many pixels as
/// possible change by 1, each with p = 1/L: these are k = 3L/n pixels. If k < 1, one pixel changes
/// by k.
#[derive(Clone, Copy, Debug)]
pub(super) struct UndersampledBound {
    /// The largest value of a sample, in multiples of display white: at least 1.
    pub(super) brightest: f64,
    /// The number of pixels.
    pub(super) pixels: usize,
}

impl UndersampledBound {
    /// The mean square error of undersampled features, for a white of 1, if the replicates of each
    /// pixel have at least `count` samples.
    fn square(&self, count: u32) -> f64 {
        let changed = self.changed(2 * u64::from(count));
        let squares = if changed < 1.0 {
            changed * changed
        } else {
            changed
        };
        squares / self.pixels.max(1) as f64
    }

    /// The change of a pixel, in multiples of white, by a feature that is missed by all of its
    /// samples, those of a pilot aside.
    pub(super) fn changed(&self, samples: u64) -> f64 {
        EXPECTED_HITS * self.brightest / samples.max(1) as f64
    }

    /// The quality of a pixel.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float"
    )]
    pub(super) fn quality(&self, pixel: &Replicates) -> PixelQuality {
        let [shown, _] = pixel.counts();
        PixelQuality {
            error: pixel.standard_error().map(|error| error as f32),
            samples: pixel.samples(),
            undersampled: self.changed(2 * u64::from(shown)).min(1.0) as f32,
        }
    }

    /// The bound for a film with samples in all pixels.
    pub(super) fn of(&self, film: &ProgressiveFilm) -> UndersampledError {
        let shown = film.pixels().map(|pixel| pixel.counts()[0]);
        self.within(shown.min().unwrap_or(0))
    }

    /// The bound for pixels with at least `count` samples in each of two replicates.
    pub(super) fn within(&self, count: u32) -> UndersampledError {
        UndersampledError {
            square: self.square(count),
            source: *self,
        }
    }

    /// The minimum number of samples per replicate for a bound in grey levels; 1 if that is too
    /// many.
    pub(super) fn least(&self, error: f64) -> u32 {
        self.closing(error, MAX_SAMPLES).unwrap_or(1)
    }

    /// The minimum number of samples per replicate, a power of two of at most `most`, for a bound
    /// in grey levels.
    pub(super) fn closing(&self, error: f64, most: u32) -> Option<u32> {
        let counts = std::iter::successors(Some(1_u32), |count| count.checked_mul(2));
        let mut counts = counts.take_while(|count| *count <= most);
        counts.find(|count| self.square(*count) <= allowance(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_by_hand() {
        let undersampled = |brightest| UndersampledBound {
            brightest,
            pixels: 100,
        };
        // One pixel of a hundred with an error of 3/8.
        assert_eq!(undersampled(1.0).square(4), 0.375 * 0.375 / 100.0);
        // Three pixels with an error of 1.
        assert_eq!(undersampled(8.0).square(4), 0.03);
    }

    #[test]
    fn the_minimum_leaves_half_of_the_squared_target() {
        let undersampled = UndersampledBound {
            brightest: 1.0,
            pixels: 1600,
        };
        let square = |count| undersampled.square(count) * LEVELS * LEVELS;
        let least = undersampled.least(1.0);
        assert!(square(least) <= 0.5 && square(least / 2) > 0.5, "{least}");
        assert_eq!(undersampled.least(1e-9), 1, "too many");
    }

    /// No other distribution of three hits over pixels gives a larger error.
    #[test]
    fn no_undersampled_feature_exceeds_the_bound() {
        for (brightest, count) in [(1.0, 1), (1.0, 4), (8.0, 4), (3.0, 16)] {
            let undersampled = UndersampledBound {
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
