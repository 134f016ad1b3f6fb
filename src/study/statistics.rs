//! Statistics for studies: medians with confidence intervals, power laws, hypothesis tests, and a
//! seeded random number generator.

use rtc_math::{GAMMA, exp, ln, mix, pow};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// The best estimate.
    pub value: f64,
    /// The lower end of the interval.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Estimate {
    /// A number known exactly.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            low: value,
            high: value,
        }
    }

    /// Half the width of the interval, as a fraction of the value; 0 for a value of 0.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.value == 0.0 {
            0.0
        } else {
            0.5 * (self.high - self.low) / self.value.abs()
        }
    }

    /// The same, in other units.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            low: self.low * factor,
            high: self.high * factor,
        }
    }
}

/// A seeded random number generator: SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom
/// number generators", OOPSLA 2014).
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The generator of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number below `bound`, which is above 0.
    pub fn below(&mut self, bound: usize) -> usize {
        let bits = mix(self.0);
        self.0 = self.0.wrapping_add(GAMMA);
        let wide = u128::from(bits) * bound as u128;
        usize::try_from(wide >> 64).unwrap_or(0)
    }

    /// Shuffles the items (Fisher–Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// The number of bootstrap resamples.
const DRAWS: usize = 999;

/// The median with its 95 % interval by the bootstrap (Efron, "Bootstrap methods", Annals of
/// Statistics 7 (1979)).
///
/// NaN without values. Fewer than 5 values have their range as interval.
#[must_use]
pub fn median(values: &[f64], rng: &mut SplitMix64) -> Estimate {
    let mut sorted = values.to_vec();
    let value = middle(&mut sorted);
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
        return Estimate::exact(f64::NAN);
    };
    if sorted.len() < 5 {
        return Estimate {
            value,
            low: *first,
            high: *last,
        };
    }
    let mut draws: Vec<_> = (0..DRAWS)
        .map(|_| middle(&mut resample(&sorted, rng)))
        .collect();
    draws.sort_unstable_by(f64::total_cmp);
    Estimate {
        value,
        low: draws[DRAWS / 40],
        high: draws[DRAWS - 1 - DRAWS / 40],
    }
}

fn resample(values: &[f64], rng: &mut SplitMix64) -> Vec<f64> {
    values
        .iter()
        .map(|_| values[rng.below(values.len())])
        .collect()
}

/// The median of values, which it sorts.
fn middle(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ if n % 2 == 1 => values[n / 2],
        _ => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// A law of the form `y = c·x^−p`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PowerLaw {
    /// y at x = 1.
    pub c: f64,
    /// The exponent, with its interval from the residuals of the fit.
    pub p: Estimate,
}

impl PowerLaw {
    /// The least-squares fit to positive points (x, y) on logarithmic scales; `None` for fewer than
    /// three.
    #[must_use]
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let n = points.len();
        if n < 3 {
            return None;
        }
        let logs: Vec<_> = points.iter().map(|(x, y)| (ln(*x), ln(*y))).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n as f64;
        let (x_mean, y_mean) = (mean(|log| log.0), mean(|log| log.1));
        let spread: f64 = logs.iter().map(|(x, _)| (x - x_mean) * (x - x_mean)).sum();
        let slope = logs
            .iter()
            .map(|(x, y)| (x - x_mean) * (y - y_mean))
            .sum::<f64>()
            / spread;
        let residual = |(x, y): &(f64, f64)| y - y_mean - slope * (x - x_mean);
        let squares: f64 = logs.iter().map(|log| residual(log) * residual(log)).sum();
        let half = student(n - 2) * (squares / (n - 2) as f64 / spread).sqrt();
        let c = exp(y_mean - slope * x_mean);
        Some(Self {
            c,
            p: Estimate {
                value: -slope,
                low: -slope - half,
                high: -slope + half,
            },
        })
    }

    /// y at x.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.c * pow(x, -self.p.value)
    }
}

/// Student's t for a two-sided interval of 95 %.
pub(super) fn student(degrees: usize) -> f64 {
    const TABLE: [f64; 15] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160,
        2.145, 2.131,
    ];
    match degrees {
        0 => f64::INFINITY,
        1..=15 => TABLE[degrees - 1],
        16..=30 => 2.08,
        _ => 1.97,
    }
}

/// The number that a standard normal variable exceeds with the probability `tail` ≤ 1/2, to 0.0005
/// (Abramowitz and Stegun, "Handbook of mathematical functions" (1964), 26.2.23).
pub(super) fn normal_quantile(tail: f64) -> f64 {
    let t = (-2.0 * ln(tail)).sqrt();
    t - (2.515_517 + t * (0.802_853 + t * 0.010_328))
        / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)))
}

/// The test of the difference of two means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MeanTest {
    /// The first mean less the second.
    pub(super) difference: f64,
    /// The significance, as a number of standard deviations of a normal variable.
    pub(super) deviations: f64,
}

/// The test of the means of pairs of values, at least two (Student, "The probable error of a mean",
/// Biometrika 6 (1908)). Student's t is converted to a normal variable by Wallace's approximation
/// (Annals of Mathematical Statistics 30 (1959)). Differences of the size of rounding errors count
/// as 0.
pub(super) fn paired(first: &[f64], second: &[f64]) -> MeanTest {
    const ROUNDING: f64 = 1e-12;
    let n = first.len() as f64;
    let differences: Vec<_> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    let difference = differences.iter().sum::<f64>() / n;
    let squares = differences
        .iter()
        .map(|value| (value - difference) * (value - difference));
    let (freedom, variance) = (n - 1.0, squares.sum::<f64>() / (n - 1.0) / n);
    let t = difference * difference / variance.max(ROUNDING * ROUNDING);
    let deviations =
        (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0) * (freedom * ln(1.0 + t / freedom)).sqrt();
    MeanTest {
        difference,
        deviations: match difference.abs() > ROUNDING {
            true => deviations,
            false => 0.0,
        },
    }
}

/// The number that Fisher's F of `over` and `under` degrees of freedom exceeds with the probability
/// `tail`; infinite where the approximation (Paulson, Annals of Mathematical Statistics 13 (1942))
/// has no value.
pub(super) fn fisher_quantile(tail: f64, over: f64, under: f64) -> f64 {
    let z = normal_quantile(tail);
    // Both χ² are the cubes of normal variables (Wilson and Hilferty): means 1 − a and 1 − b,
    // variances a and b.
    let (a, b) = (2.0 / (9.0 * over), 2.0 / (9.0 * under));
    let (ma, mb) = (1.0 - a, 1.0 - b);
    let denominator = mb * mb - z * z * b;
    if denominator <= 0.0 || ma <= 0.0 {
        return f64::INFINITY;
    }
    let root =
        (ma * mb + z * (ma * ma * b + mb * mb * a - z * z * a * b).max(0.0).sqrt()) / denominator;
    root * root * root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_is_found_and_noise_widens_its_interval() {
        let exact: Vec<_> = [1.0, 4.0, 9.0, 16.0, 36.0]
            .map(|x| (x, 3.0 * pow(x, -0.75)))
            .to_vec();
        let law = PowerLaw::fit(&exact).unwrap();
        assert!(
            (law.p.value - 0.75).abs() < 1e-12 && (law.c - 3.0).abs() < 1e-12,
            "{law:?}"
        );
        assert!(law.p.high - law.p.low < 1e-6, "{law:?}");
        let noisy: Vec<_> = exact
            .iter()
            .zip([1.1, 0.9, 1.1, 0.9, 1.1])
            .map(|((x, y), f)| (*x, y * f))
            .collect();
        let law = PowerLaw::fit(&noisy).unwrap();
        assert!(
            law.p.low < 0.75 && 0.75 < law.p.high && law.p.relative() > 0.05,
            "{law:?}"
        );
        assert!(PowerLaw::fit(&exact[..2]).is_none());
    }

    #[test]
    fn the_interval_of_the_median_holds_it_as_often_as_it_says() {
        let mut rng = SplitMix64::new(7);
        let mut held = 0;
        for _ in 0..200 {
            // Uniform in [0, 1): the median is 1/2.
            let values: Vec<_> = (0..15)
                .map(|_| rng.below(1 << 30) as f64 / f64::from(1 << 30))
                .collect();
            let estimate = median(&values, &mut rng);
            held += usize::from(estimate.low <= 0.5 && 0.5 <= estimate.high);
        }
        assert!((180..=199).contains(&held), "{held} of 200");
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        let normal = [(0.5, 0.0), (0.05, 1.6449), (0.025, 1.9600), (0.001, 3.0902)];
        for (tail, z) in normal {
            assert!((normal_quantile(tail) - z).abs() < 1e-3, "{tail}");
        }
        let fisher = [
            (0.05, 10.0, 20.0, 2.348),
            (0.05, 60.0, 120.0, 1.429),
            (0.01, 30.0, 60.0, 2.028),
        ];
        for (tail, over, under, f) in fisher {
            assert!((fisher_quantile(tail, over, under) / f - 1.0).abs() < 0.005);
        }
        assert_eq!(fisher_quantile(0.001, 0.5, 1.0), f64::INFINITY);
    }

    #[test]
    fn the_test_of_two_means_is_that_of_the_tables() {
        // Differences of the mean 1 and of the variance 1: t is √8 times the mean, of 7 degrees.
        let spread = [-1.0, 1.0, 0.0, -1.0, 1.0, 0.0, -1.0, 1.0];
        let scale = (7.0_f64 / 6.0).sqrt();
        // Student's t of 7 degrees that is exceeded by 5 %, 1 %, 0.1 % on both sides together.
        for (t, z) in [(2.3646, 1.960), (3.4995, 2.5758), (5.4079, 3.2905)] {
            let first = spread.map(|value| 3.0 + t / 8.0_f64.sqrt() + value * scale);
            let test = paired(&first, &[3.0; 8]);
            assert!((test.difference - t / 8.0_f64.sqrt()).abs() < 1e-12);
            assert!((test.deviations - z).abs() < 0.02, "{t}: {test:?}");
        }
        assert_eq!(paired(&[1.0; 4], &[1.0 + 1e-15; 4]).deviations, 0.0);
        assert!(paired(&[1.0; 4], &[1.0001; 4]).deviations > 6.0);
    }

    #[test]
    fn medians_of_few_values() {
        let mut rng = SplitMix64::new(1);
        assert!(median(&[], &mut rng).value.is_nan());
        assert_eq!(median(&[3.0], &mut rng), Estimate::exact(3.0));
        assert_eq!(
            median(&[4.0, 1.0], &mut rng),
            Estimate {
                value: 2.5,
                low: 1.0,
                high: 4.0
            }
        );
    }

    #[test]
    fn a_shuffle_keeps_all_and_is_repeatable() {
        let shuffled = |seed| {
            let mut items: Vec<_> = (0..20).collect();
            SplitMix64::new(seed).shuffle(&mut items);
            items
        };
        assert!(shuffled(1) == shuffled(1) && shuffled(1) != shuffled(2));
        let mut sorted = shuffled(1);
        sorted.sort_unstable();
        assert_eq!(sorted, (0..20).collect::<Vec<_>>());
    }
}
