//! Bounds from a sample without a defect: the hypergeometric distribution, in integers.

/// The least number of defects among `all` that `drawn` of them, chosen at random without
/// replacement, all miss with a probability of at most one in `odds`. So if the sample has none,
/// there are fewer defects than that, with a confidence of 1 − 1/`odds`. `None` if nothing was
/// drawn.
///
/// None of `d` defects is in the sample with the probability C(N−d, k) / C(N, k), which falls as
/// `d` grows.
#[must_use]
pub fn least_faults(all: u64, drawn: u64, odds: u64) -> Option<u64> {
    let (mut low, mut high) = (0, all);
    while low < high {
        let middle = low + (high - low) / 2;
        if is_rare(all, drawn, middle, odds) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    is_rare(all, drawn, low, odds).then_some(low)
}

/// Whether C(N−d, k) / C(N, k) ≤ 1 / odds. The quotient is ∏ (N−b−i) / (N−i) over i < a, for the
/// smaller and the larger, a and b, of d and k. No factor is above 1, so it is known as soon as the
/// factors so far are small enough; else a·b is below N·ln(odds), and a below the root of that.
fn is_rare(all: u64, drawn: u64, faults: u64, odds: u64) -> bool {
    let (fewer, more) = (drawn.min(faults), drawn.max(faults));
    if more > all - fewer {
        return true;
    }
    let (mut missed, mut chances) = (BigNatural::from(odds), BigNatural::from(1));
    for index in 0..fewer {
        missed.multiply(all - more - index);
        chances.multiply(all - index);
        if missed <= chances {
            return true;
        }
    }
    missed <= chances
}

/// A natural number, in digits of 64 bits, the highest first, without leading zeros.
#[derive(PartialEq, Eq)]
struct BigNatural(Vec<u64>);

impl BigNatural {
    fn from(number: u64) -> Self {
        Self(vec![number])
    }

    fn multiply(&mut self, factor: u64) {
        let mut carry = 0_u128;
        for digit in self.0.iter_mut().rev() {
            carry += u128::from(*digit) * u128::from(factor);
            #[expect(clippy::cast_possible_truncation, reason = "the low digit")]
            {
                *digit = carry as u64;
            }
            carry >>= 64;
        }
        if let Ok(digit @ 1..) = u64::try_from(carry) {
            self.0.insert(0, digit);
        }
    }
}

impl PartialOrd for BigNatural {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        let key = |number: &Self| number.0.len();
        Some(
            key(self)
                .cmp(&key(other))
                .then_with(|| self.0.cmp(&other.0)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of ways to draw `drawn` of `all` that miss the first `faults`, and the number of
    /// all ways, by enumeration.
    fn enumerated(all: u32, drawn: u32, faults: u32) -> [u64; 2] {
        let subsets = (0..1_u32 << all).filter(|subset| subset.count_ones() == drawn);
        subsets.fold([0, 0], |[missed, ways], subset| {
            let hits = subset & ((1 << faults) - 1);
            [missed + u64::from(hits == 0), ways + 1]
        })
    }

    #[test]
    fn the_bound_is_that_of_counting_all_draws() {
        for all in 1..=12_u32 {
            for drawn in 0..=all {
                for odds in [2, 10, 50] {
                    let is_rare = |faults: &u32| {
                        let [missed, ways] = enumerated(all, drawn, *faults);
                        missed * odds <= ways
                    };
                    let expected = (0..=all).find(is_rare).map(u64::from);
                    let found = least_faults(all.into(), drawn.into(), odds);
                    assert_eq!(found, expected, "{drawn} of {all}, {odds}");
                }
            }
        }
    }

    #[test]
    fn known_bounds() {
        // All are drawn: no defect. None is drawn: no bound.
        assert_eq!(least_faults(1000, 1000, 50), Some(1));
        assert_eq!(least_faults(1000, 0, 50), None);
        // Many tiles, a small sample: 1 − 0.02^(1/32) of them, by the binomial distribution.
        let all = 1 << 30;
        let share = least_faults(all, 32, 50).unwrap() as f64 / all as f64;
        let binomial = 1.0 - rtc_math::pow(0.02, 1.0 / 32.0);
        assert!((share - binomial).abs() < 1e-6, "{share} {binomial}");
    }

    #[test]
    fn large_draws_end_soon() {
        assert_eq!(least_faults(1 << 20, 1 << 19, 50), Some(6));
        assert_eq!(least_faults(1 << 40, 1 << 39, 50), Some(6));
        assert!(least_faults(1 << 24, 1 << 12, 50).unwrap() < 1 << 14);
    }
}
