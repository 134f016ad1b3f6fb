//! Points spread evenly over pixel and lens together: Sobol's sequence in four dimensions,
//! scrambled differently for each key.
//!
//! The first n points are unbiased for every n, and stratified if n is a power of two.

use crate::render::sampler::Key;

const DIMENSIONS: usize = 4;

/// The direction numbers (Joe and Kuo, "Constructing Sobol sequences with better two-dimensional
/// projections", SIAM Journal on Scientific Computing 30 (2008)).
const DIRECTIONS: [[u32; 32]; DIMENSIONS] = [
    directions(0, 0, [0; 3]),
    directions(1, 0, [1, 0, 0]),
    directions(2, 1, [1, 3, 0]),
    directions(3, 1, [1, 3, 1]),
];

/// The direction numbers of a primitive polynomial, given by its degree and its inner coefficients
/// as bits. Degree 0 is van der Corput's sequence.
const fn directions(degree: usize, inner: u32, first: [u32; 3]) -> [u32; 32] {
    let mut v = [0; 32];
    let mut k = 0;
    while k < 32 {
        if degree == 0 {
            v[k] = 1 << (31 - k);
        } else if k < degree {
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
pub(in crate::render) struct Sequence([u64; DIMENSIONS]);

impl Sequence {
    /// The sequence of a key.
    #[must_use]
    pub(in crate::render) fn new(key: Key) -> Self {
        Self([0, 1, 2, 3].map(|dimension| key.bits(dimension)))
    }

    /// Point `index`, each coordinate in (0, 1).
    #[must_use]
    pub(in crate::render) fn point(&self, index: u32) -> [f64; DIMENSIONS] {
        /// 2⁻³².
        const UNIT: f64 = 1.0 / 4_294_967_296.0;
        [0, 1, 2, 3].map(|dimension| {
            let x = scrambled(sobol(&DIRECTIONS[dimension], index), self.0[dimension]);
            (f64::from(x) + 0.5) * UNIT
        })
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

/// Owen scrambling by a hash (Burley, "Practical hash-based Owen scrambling", JCGT 9 (2020), with
/// the constants of Vegdahl, "Building a better LK hash" (2021)), then a digital shift, which makes
/// each point uniform by itself.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the halves of the seed are meant"
)]
fn scrambled(x: u32, seed: u64) -> u32 {
    let (shift, seed) = ((seed >> 32) as u32, seed as u32);
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^= x.wrapping_mul(0x53A2_2864);
    x.reverse_bits() ^ shift
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(x: f64, cells: usize) -> usize {
        (0..cells)
            .rfind(|i| x * cells as f64 >= *i as f64)
            .unwrap_or(0)
    }

    #[test]
    fn powers_of_two_fill_every_stratum_once() {
        for seed in 0..8 {
            let sequence = Sequence::new(Key::new([3, 9], seed));
            for dimension in 0..DIMENSIONS {
                let mut seen = [0; 64];
                (0..64).for_each(|k| seen[cell(sequence.point(k)[dimension], 64)] += 1);
                assert_eq!(seen, [1; 64], "dimension {dimension}");
            }
            let mut seen = [0; 16];
            for k in 0..16 {
                let [x, y, ..] = sequence.point(k);
                seen[4 * cell(x, 4) + cell(y, 4)] += 1;
            }
            assert_eq!(seen, [1; 16], "the pixel, in squares");
        }
    }

    #[test]
    fn every_point_is_uniform_over_the_keys() {
        for index in [0, 1, 5] {
            let points = (0..4096).map(|seed| Sequence::new(Key::new([1, 2], seed)).point(index));
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
