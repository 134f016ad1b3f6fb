//! Points spread evenly over pixel and lens together: Sobol's sequence in four dimensions,
//! scrambled differently for each key.
//!
//! The first n points are unbiased for every n, and stratified if n is a power of two.

use crate::sampler::PathVertexKey;
use crate::sampler::owen::{first_two, scrambled};

/// The direction numbers of the dimensions of the lens (Joe and Kuo, "Constructing Sobol sequences
/// with better two-dimensional projections", SIAM Journal on Scientific Computing 30 (2008)). Those
/// of the pixel are van der Corput's, which turns the index round, and Pascal's matrix.
const LENS: [[u32; 32]; 2] = [directions(2, 1, [1, 3, 0]), directions(3, 1, [1, 3, 1])];

/// The direction numbers of a primitive polynomial, given by its degree and its inner coefficients
/// as bits.
const fn directions(degree: usize, inner: u32, first: [u32; 3]) -> [u32; 32] {
    let mut v = [0; 32];
    let mut k = 0;
    while k < 32 {
        if k < degree {
            v[k] = first[k] << (31 - k);
        } else {
            v[k] = v[k - degree] ^ (v[k - degree] >> degree);
            let mut i = 1;
            while i < degree {
                if inner >> (degree - 1 - i) & 1 == 1 {
                    v[k] ^= v[k - i];
                }
                i += 1;
            }
        }
        k += 1;
    }
    v
}

/// A sequence of its own for each key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sequence(PathVertexKey);

impl Sequence {
    /// The sequence of a key.
    #[must_use]
    pub(crate) fn new(key: PathVertexKey) -> Self {
        Self(key)
    }

    /// The position in the pixel of point `index`, each coordinate in (0, 1).
    #[must_use]
    #[inline]
    pub(crate) fn film(&self, index: u32) -> [f64; 2] {
        let [x, y] = first_two(index);
        [self.number(0, x), self.number(1, y)]
    }

    /// The position on the lens, in the same way.
    #[must_use]
    pub(crate) fn lens(&self, index: u32) -> [f64; 2] {
        let [x, y] = [0, 1].map(|which| sobol(&LENS[which], index).reverse_bits());
        [self.number(2, x), self.number(3, y)]
    }

    /// The coordinate of a dimension, of its bits from the lowest on: scrambled, then shifted,
    /// which makes each point uniform by itself.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the halves of the hash are meant"
    )]
    #[inline]
    fn number(&self, dimension: u64, bits: u32) -> f64 {
        /// 2⁻³².
        const UNIT: f64 = 1.0 / 4_294_967_296.0;
        let hash = self.0.bits(dimension);
        let number = scrambled(bits, hash as u32).reverse_bits() ^ (hash >> 32) as u32;
        (f64::from(number) + 0.5) * UNIT
    }
}

fn sobol(directions: &[u32; 32], index: u32) -> u32 {
    let (mut x, mut left) = (0, index);
    while left != 0 {
        x ^= directions[left.trailing_zeros() as usize];
        left &= left - 1;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(x: f64, cells: usize) -> usize {
        (0..cells)
            .rfind(|i| x * cells as f64 >= *i as f64)
            .unwrap_or(0)
    }

    fn point(sequence: &Sequence, index: u32) -> [f64; 4] {
        let ([x, y], [u, v]) = (sequence.film(index), sequence.lens(index));
        [x, y, u, v]
    }

    #[test]
    fn powers_of_two_fill_every_stratum_once() {
        for seed in 0..8 {
            let sequence = Sequence::new(PathVertexKey::new([3, 9], seed));
            for dimension in 0..4 {
                let mut seen = [0; 64];
                (0..64).for_each(|k| seen[cell(point(&sequence, k)[dimension], 64)] += 1);
                assert_eq!(seen, [1; 64], "dimension {dimension}");
            }
            let mut seen = [0; 16];
            for k in 0..16 {
                let [x, y] = sequence.film(k);
                seen[4 * cell(x, 4) + cell(y, 4)] += 1;
            }
            assert_eq!(seen, [1; 16], "the pixel, in squares");
        }
    }

    #[test]
    fn every_point_is_uniform_over_the_keys() {
        for index in [0, 1, 5] {
            let points = (0..4096)
                .map(|seed| point(&Sequence::new(PathVertexKey::new([1, 2], seed)), index));
            let sum = points.fold([0.0; 8], |mut sum, point| {
                (0..4).for_each(|d| {
                    sum[d] += point[d] / 4096.0;
                    sum[d + 4] += point[d] * point[(d + 1) % 4] / 4096.0;
                });
                sum
            });
            // Four deviations of a mean of 4096: 0.29/64 and 0.22/64.
            assert!(
                sum[..4].iter().all(|mean| (mean - 0.5).abs() < 0.018),
                "{sum:?}"
            );
            assert!(
                sum[4..].iter().all(|mean| (mean - 0.25).abs() < 0.014),
                "{sum:?}"
            );
        }
    }
}
