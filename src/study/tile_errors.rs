//! The error of the whole picture, estimated from random tiles. Errors are distributed unevenly: a
//! few tiles have most of the error, and they may not be among the random ones.

use super::metrics::mean_square;
use super::statistics::student;
use rtc_image::Image;
use rtc_math::exp;

/// The mean square error of each of some tiles.
#[derive(Clone, Debug)]
pub(super) struct TileErrors {
    squares: Vec<f64>,
    /// The pixels of each, over their mean number.
    weights: Vec<f64>,
    /// The fraction of the picture that the tiles cover.
    fraction: f64,
}

impl TileErrors {
    /// The errors of tiles that are a `fraction` of a picture.
    pub(super) fn of(test: &[Image], reference: &[Image], fraction: f64) -> Self {
        let pairs = test.iter().zip(reference);
        let pixels = test.iter().map(|tile| tile.pixels.len()).sum::<usize>();
        let mean = pixels.max(1) as f64 / test.len().max(1) as f64;
        Self {
            squares: pairs.map(|(a, b)| mean_square(a, b)).collect(),
            weights: test.iter().map(|a| a.pixels.len() as f64 / mean).collect(),
            fraction,
        }
    }

    /// The confidence interval of the mean square error of the whole picture: 95 % if errors are
    /// distributed evenly, less if few tiles have most of the error.
    ///
    /// The interval is symmetric on a logarithmic scale. Its upper end includes an additional tile
    /// with `WORST_FACTOR` times the worst error, because sampled errors are too small more often
    /// than too large.
    pub(super) fn interval(&self) -> [f64; 2] {
        const WORST_FACTOR: f64 = 2.0;
        let mean = self.mean();
        if self.fraction >= 1.0 || mean == 0.0 {
            return [mean, mean];
        }
        if self.squares.len() < 2 {
            return [0.0, 1.0];
        }
        let worst = self.squares.iter().copied().fold(0.0, f64::max);
        let mut more = self.clone();
        more.squares.push(WORST_FACTOR * worst);
        more.weights.push(1.0);
        // The error of a channel is at most 1.
        let high = (more.mean() * more.factor()).clamp(mean, mean.max(1.0));
        [mean / self.factor(), high]
    }

    /// The relative half-width of the interval of the mean, as a factor.
    fn factor(&self) -> f64 {
        let n = self.squares.len();
        exp(student(n - 1) * self.scale(n) * deviation(&self.squares, &self.weights) / self.mean())
    }

    /// The mean square error of all tiles.
    fn mean(&self) -> f64 {
        mean(&self.squares, &self.weights)
    }

    /// Whether the error is certainly less than that of another render of the same tiles, by more
    /// than a factor. Errors common to both cancel (the ratio estimator; Cochran, "Sampling
    /// techniques" (1977), 6.4).
    pub(super) fn is_clearly_below(&self, other: &Self, factor: f64) -> bool {
        let (ours, theirs) = (self.mean(), other.mean());
        let most = 1.0 / (factor * factor);
        if theirs == 0.0 || self.fraction >= 1.0 {
            return ours < most * theirs;
        }
        let ratio = ours / theirs;
        let pairs = self.squares.iter().zip(&other.squares);
        let residuals: Vec<_> = pairs.map(|(a, b)| a - ratio * b).collect();
        let n = residuals.len();
        let off = deviation(&residuals, &self.weights) * self.scale(n) / theirs;
        n > 1 && ratio + student(n - 1) * off < most
    }

    /// The standard deviation of a mean of `n` tiles over that of a tile: the picture is finite.
    fn scale(&self, n: usize) -> f64 {
        ((1.0 - self.fraction) / n.max(1) as f64).sqrt()
    }
}

fn mean(values: &[f64], weights: &[f64]) -> f64 {
    let sum = values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
    sum / weights.iter().sum::<f64>().max(f64::MIN_POSITIVE)
}

/// The standard deviation of the weighted differences of values from their mean.
fn deviation(values: &[f64], weights: &[f64]) -> f64 {
    let mean = mean(values, weights);
    let pairs = values.iter().zip(weights);
    let squares = pairs.map(|(v, w)| w * (v - mean) * (w * (v - mean)));
    (squares.sum::<f64>() / values.len().saturating_sub(1).max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(squares: &[f64], fraction: f64) -> TileErrors {
        TileErrors {
            squares: squares.to_vec(),
            weights: vec![1.0; squares.len()],
            fraction,
        }
    }

    #[test]
    fn all_tiles_give_the_exact_error_and_few_a_wide_interval() {
        let squares = [0.01, 0.04, 0.01, 0.02];
        assert_eq!(errors(&squares, 1.0).interval(), [0.02, 0.02]);
        assert_eq!(errors(&[0.5], 0.5).interval(), [0.0, 1.0]);
        let [some, many] = [0.1, 0.9].map(|fraction| errors(&squares, fraction).interval());
        assert!(some[0] < many[0] && many[0] < 0.02 && 0.02 < many[1] && many[1] < some[1]);
        // The expected value: ln of the factor is t₃·√(0.9/4)·s/0.02, and s is 0.01·√2.
        let low = 0.02 / exp(3.182 * 0.225_f64.sqrt() * 2.0_f64.sqrt() / 2.0);
        assert!((some[0] / low - 1.0).abs() < 1e-12, "{some:?}");
    }

    #[test]
    fn common_tiles_distinguish_settings_with_overlapping_intervals() {
        let coarse = [0.0, 0.9, 0.0, 0.1, 0.02, 0.4];
        let half = errors(&coarse.map(|square| 0.25 * square), 0.1);
        let coarse = errors(&coarse, 0.1);
        assert!(half.interval()[1] > coarse.interval()[0]);
        assert!(half.is_clearly_below(&coarse, 1.001) && !coarse.is_clearly_below(&half, 1.001));
        assert!(!coarse.is_clearly_below(&coarse, 1.0));
        // Better in the mean, but only in one tile.
        let other = errors(&[0.0, 0.5, 0.0, 0.2, 0.03, 0.5], 0.1);
        assert!(other.mean() < coarse.mean() && !other.is_clearly_below(&coarse, 1.001));
    }
}
