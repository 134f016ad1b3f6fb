//! Random numbers and counts over many rays: ray k of a count is known by the seed and k, on any
//! number of threads.

use rayon::prelude::*;
use rtc::internals::math::{GAMMA, Vec3, mix};

/// A sequence of numbers by SplitMix64.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The stream of one index.
    pub(crate) fn at(seed: u64, index: u64) -> Self {
        Self(Self(seed).bits().wrapping_add(Self(index).bits()))
    }

    fn bits(&mut self) -> u64 {
        let bits = mix(self.0);
        self.0 = self.0.wrapping_add(GAMMA);
        bits
    }

    /// In [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// In [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Between `low` and `high`, the same share for every power of ten.
    pub(crate) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        low * rtc::internals::math::pow(high / low, self.uniform())
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % n as u64).unwrap()
    }

    /// In [−1, 1)³.
    pub(crate) fn cube(&mut self) -> Vec3 {
        Vec3::new(self.uniform(), self.uniform(), self.uniform()) * 2.0 - 1.0
    }

    /// A unit vector.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Rays of each of `rows` counts: as many as `RTC_RAYS` says, or 250 000 in all.
pub(crate) fn rays(rows: usize) -> u64 {
    let count = std::env::var("RTC_RAYS")
        .ok()
        .and_then(|count| count.parse().ok());
    count.unwrap_or(250_000 / rows as u64)
}

/// What a count found.
#[derive(Clone, Copy)]
pub(crate) struct Tally {
    pub(crate) rays: u64,
    pub(crate) bad: u64,
    /// The first index with anything bad.
    first: u64,
}

impl Tally {
    const NONE: Self = Self {
        rays: 0,
        bad: 0,
        first: u64::MAX,
    };

    fn plus(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            bad: self.bad + other.bad,
            first: self.first.min(other.first),
        }
    }
}

/// Sums over the indices what `judge` finds, (rays, bad ones), and prints a row of
/// `benches/hard-cases.md`.
pub(crate) fn tally(
    group: &str,
    name: &str,
    indices: u64,
    judge: impl Fn(u64) -> (u64, u64) + Sync,
) -> Tally {
    let one = |index: u64| {
        let (rays, bad) = judge(index);
        Tally {
            rays,
            bad,
            first: if bad > 0 { index } else { u64::MAX },
        }
    };
    let sum = (0..indices)
        .into_par_iter()
        .map(one)
        .reduce(|| Tally::NONE, Tally::plus);
    let first = if sum.bad > 0 {
        format!(", first at index {}", sum.first)
    } else {
        String::new()
    };
    println!("| {group} | {name} | {} | {}{first} |", sum.rays, sum.bad);
    sum
}
