//! The distribution of the error of a setting over renders with other seeds: its expectation and
//! its standard deviation.

use super::metrics::{LEVELS, mean_product};
use super::subject::RenderedTiles;
use rtc_image::Image;
use rtc_ir::{Mode, Pattern, Settings};
use rtc_render::SamplingSeeds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The error over renders with other seeds (Celarek, Jakob, Wimmer, Lehtinen, "Quantifying the
/// error of light transport algorithms", Computer Graphics Forum 38(4), 2019): the expectation of
/// the mean square error, and its deviation. Fixed sampling patterns are the same in all renders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct ErrorSpread {
    /// The number of renders.
    pub renders: u32,
    /// The root of the expected mean square error, in grey levels.
    pub expected: f64,
    /// The standard deviation of the error of a render (its `rmse`), in grey levels; 0 if all are
    /// identical.
    pub deviation: f64,
}

impl ErrorSpread {
    /// From the mean square errors of the renders, for a white of 1.
    pub(super) fn of(squares: &[f64]) -> Self {
        let count = squares.len().max(1) as f64;
        let mean = |values: &dyn Fn(f64) -> f64| {
            let values = squares.iter().map(|square| values(*square));
            values.sum::<f64>() / count
        };
        // Relative to the first, so that identical errors give exactly 0.
        let first = squares.first().copied().unwrap_or_default().sqrt();
        let off = mean(&|square: f64| square.sqrt() - first);
        let square =
            mean(&|square: f64| (square.sqrt() - first - off) * (square.sqrt() - first - off));
        let unbiased = square * count / (count - 1.0).max(1.0);
        Self {
            renders: u32::try_from(squares.len()).unwrap_or(u32::MAX),
            expected: mean(&|square| square).sqrt() * LEVELS,
            deviation: unbiased.sqrt() * LEVELS,
        }
    }

    /// The deviation as a fraction of the expected error; 0 if that is 0.
    #[must_use]
    pub fn relative(&self) -> f64 {
        match self.expected {
            0.0 => 0.0,
            expected => self.deviation / expected,
        }
    }
}

/// The seeds of the renders of a row, and the reference.
#[derive(Clone, Copy)]
pub(super) struct ReseededRenders<'t> {
    /// The reference; without one all renders have the same seeds.
    pub(super) reference: Option<&'t [Image]>,
    /// The number of earlier renders of the row.
    pub(super) before: u64,
}

impl ReseededRenders<'_> {
    /// The seeds of a render; the first has those of `rtc render`.
    pub(super) fn seeds(&self, number: u64, settings: &Settings) -> SamplingSeeds {
        /// Different from the seeds of references and sweeps.
        const FIRST: u64 = 0xAF7E;
        let number = self.before + number;
        if self.reference.is_none() || number == 0 {
            return SamplingSeeds::NONE;
        }
        let seed = FIRST + number;
        let path = SamplingSeeds {
            path: seed,
            ..SamplingSeeds::NONE
        };
        match (&settings.mode, settings.pattern) {
            (Mode::Path(_), _) => SamplingSeeds {
                pixel: seed,
                lens: seed,
                ..path
            },
            (_, Pattern::Grid) => path,
            (_, Pattern::Jitter | Pattern::Random) => SamplingSeeds {
                pixel: seed,
                ..path
            },
        }
    }

    /// The mean square error of a render against the reference.
    pub(super) fn square(&self, rendered: &RenderedTiles) -> Option<f64> {
        let reference = self.reference?;
        Some(mean_product(
            [&rendered.tiles, reference],
            [&rendered.tiles, reference],
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_of_four_errors_by_hand() {
        let squares = [1.0, 4.0, 1.0, 4.0].map(|levels: f64| levels / (LEVELS * LEVELS));
        let ErrorSpread {
            renders,
            expected,
            deviation,
        } = ErrorSpread::of(&squares);
        // The errors are 1, 2, 1 and 2 grey levels.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(renders == 4 && near(expected, 2.5_f64.sqrt()));
        assert!(near(deviation, (1.0_f64 / 3.0).sqrt()), "{deviation}");
        let identical = ErrorSpread::of(&[squares[0]]);
        assert!(near(identical.expected, 1.0) && identical.deviation == 0.0);
        assert_eq!(ErrorSpread::of(&[]).relative(), 0.0);
    }
}
