//! Confidence limits of a probability from counts of successes.

/// The binomial probability of at most `kept` successes of `all`, each with probability `p` in (0,
/// 1).
pub(crate) fn at_most(kept: u64, all: u64, p: f64) -> f64 {
    let (mut term, mut sum) = (1.0_f64, 0.0);
    // Sum from 0 successes on, scaled so that the terms do not underflow.
    let mut scale = 1.0;
    for k in 0..=all {
        if k <= kept {
            sum += term;
        }
        scale = if k == 0 { term } else { scale + term };
        term *= (all - k) as f64 / (k + 1) as f64 * p / (1.0 - p);
    }
    sum / scale
}

/// The one-sided lower 95 % confidence limit of the probability, from `kept` successes of `all`
/// (Clopper and Pearson, Biometrika 26 (1934)).
pub(crate) fn lower(kept: u64, all: u64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        // At the limit, this number or more has a probability of 5 %.
        let more = if kept == 0 {
            1.0
        } else {
            1.0 - at_most(kept - 1, all, middle)
        };
        if more < 0.05 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The number of tests that are significant at a family-wise level of 5 % (Holm, Scandinavian
/// Journal of Statistics 6 (1979)).
pub(crate) fn holm(mut chances: Vec<f64>) -> usize {
    chances.sort_by(f64::total_cmp);
    let count = chances.len();
    let is_significant = |(k, chance): &(usize, &f64)| **chance * ((count - k) as f64) < 0.05;
    chances
        .iter()
        .enumerate()
        .take_while(is_significant)
        .count()
}
