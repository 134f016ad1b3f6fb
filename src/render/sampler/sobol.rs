//! Numbers for paths: Owen-scrambled Sobol' points, padded: each pair of dimensions is the first
//! two of the sequence, with its own shuffling and scrambling.
//!
//! After Burley, "Practical hash-based Owen scrambling" (JCGT 9, 2020). A pair depends on pixel,
//! sample and dimension alone.

use crate::render::film::Seeds;
use crate::render::sampler::Key;

/// The pair of the place in the pixel.
pub(in crate::render) const FILM: u32 = 0;

/// The pair of the place on the lens.
pub(in crate::render) const LENS: u32 = 1;

/// The first pair for the bounces.
pub(in crate::render) const CORNERS: u32 = 2;

/// The largest number of a pair, 1 − 2⁻³².
pub(in crate::render) const MAX: f64 = 1.0 - UNIT;

/// 2⁻³².
const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// The numbers of one path.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Sobol {
    pixel: Key,
    /// The key of the bounces.
    path: Key,
    seeds: Seeds,
    index: u32,
    /// The index from its highest bit on.
    reversed: u32,
}

impl Sobol {
    /// The numbers of path `index` of a pixel.
    pub(in crate::render) fn new(pixel: [u32; 2], index: u32, seeds: Seeds) -> Self {
        let pixel = Key::new(pixel, 0);
        Self {
            pixel,
            path: pixel.seeded(seeds.path),
            seeds,
            index,
            reversed: index.reverse_bits(),
        }
    }

    /// Pair `dimension` of this path, both numbers from 0 to [`MAX`].
    #[inline]
    pub(in crate::render) fn pair(&self, dimension: u32) -> [f64; 2] {
        let point = self.point(dimension);
        // Reversed together, they change places.
        let both = (u64::from(point.first()) << 32 | u64::from(point.second())).reverse_bits();
        [number(both as u32), number((both >> 32) as u32)]
    }

    /// The second number of a pair.
    #[inline]
    pub(in crate::render) fn second(&self, dimension: u32) -> f64 {
        number(self.point(dimension).second().reverse_bits())
    }

    /// The point of the sequence that a pair takes.
    #[inline]
    fn point(&self, dimension: u32) -> Point {
        let key = match dimension {
            FILM => self.pixel.seeded(self.seeds.pixel),
            LENS => self.pixel.seeded(self.seeds.lens),
            _ => self.path,
        };
        let bits = key.bits(u64::from(dimension));
        let (low, high) = (bits as u32, (bits >> 32) as u32);
        // Scrambled from its highest bit on, the index shuffles the points and keeps each first 2^k
        // of them together.
        let index = scrambled(self.reversed, low).reverse_bits();
        Point { index, low, high }
    }

    /// An independent number in [0, 1) for decisions that use no dimension of the sequence, such as
    /// the alpha test.
    pub(in crate::render) fn uniform(&self, dimension: u32, turn: u32) -> f64 {
        let key = self
            .path
            .child(u64::from(self.index) << 32 | u64::from(turn));
        key.uniform(u64::from(dimension))
    }
}

/// A point of the sequence, and the halves of the hash that scrambles it.
struct Point {
    index: u32,
    low: u32,
    high: u32,
}

impl Point {
    /// The first coordinate, from its lowest bit on.
    #[inline]
    fn first(&self) -> u32 {
        scrambled(self.index, self.high)
    }

    /// The second coordinate, from its lowest bit on.
    #[inline]
    fn second(&self) -> u32 {
        scrambled(pascal(self.index), self.low.rotate_left(16) ^ self.high)
    }
}

/// The number of a coordinate.
#[inline]
fn number(bits: u32) -> f64 {
    f64::from(bits) * UNIT
}

/// Owen's nested scrambling from the lowest bit up: each bit is flipped by a hash of those below it
/// (Laine, Karras, 2011, with Burley's constants).
#[inline]
fn scrambled(x: u32, seed: u32) -> u32 {
    let mut x = x.wrapping_add(seed);
    for factor in [0x6C50_B47C, 0xB82F_1E52, 0xC7AF_E638, 0x8D22_F6E6_u32] {
        x ^= x.wrapping_mul(factor);
    }
    x
}

/// Pascal's matrix modulo 2, the generator of the second dimension: bit i is the parity of the bits
/// j that have all bits of i.
#[inline]
pub(super) fn pascal(mut x: u32) -> u32 {
    for (step, mask) in [
        (1, 0x5555_5555),
        (2, 0x3333_3333),
        (4, 0x0F0F_0F0F),
        (8, 0x00FF_00FF),
        (16, 0xFFFF_u32),
    ] {
        x ^= (x >> step) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_of_every_power_of_two_fill_all_elementary_intervals() {
        for log in 1..=8_u32 {
            let count = 1_u32 << log;
            let points = (0..count)
                .map(|k| Sobol::new([3, 5], k, Seeds::NONE).pair(2))
                .collect::<Vec<_>>();
            for across in 0..=log {
                let (columns, rows) = (1_u32 << across, 1_u32 << (log - across));
                let mut cells = points
                    .iter()
                    .map(|[x, y]| {
                        (
                            (x * f64::from(columns)) as u32,
                            (y * f64::from(rows)) as u32,
                        )
                    })
                    .collect::<Vec<_>>();
                cells.sort_unstable();
                cells.dedup();
                assert_eq!(cells.len(), count as usize, "{columns} × {rows}");
            }
        }
    }

    #[test]
    fn a_second_number_alone_is_that_of_its_pair() {
        for index in 0..64 {
            let sobol = Sobol::new([7, 9], index, Seeds::NONE);
            assert_eq!(sobol.second(index), sobol.pair(index)[1]);
            assert!(sobol.pair(index).iter().all(|u| (0.0..=MAX).contains(u)));
        }
    }

    #[test]
    fn pairs_are_independent_of_each_other() {
        // The covariance of two dimensions of different pairs vanishes as that of random numbers
        // does.
        let (n, at) = (4096, |k| Sobol::new([0, 0], k, Seeds::NONE));
        let product = |k| (at(k).pair(0)[0] - 0.5) * (at(k).pair(1)[0] - 0.5);
        let covariance = (0..n).map(product).sum::<f64>() / f64::from(n);
        assert!(
            covariance.abs() < 8.0 / 12.0 / f64::from(n).sqrt(),
            "{covariance}"
        );
    }
}
