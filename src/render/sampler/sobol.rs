//! Numbers for paths: Owen-scrambled points, padded: four dimensions belong together, each such
//! group has its own shuffling and scrambling.
//!
//! After Burley, "Practical hash-based Owen scrambling" (JCGT 9, 2020). Numbers depend on pixel,
//! sample and dimension alone, and in a picture of a given number of samples on that number.

use super::PathVertexKey;
use super::owen::{first_two, last_two, scrambled};
use crate::film::SamplingSeeds;
use rtc_math::mix;

/// A pair of dimensions: 2·g is the first one of group g, 2·g + 1 the second one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SobolPair(u32);

impl SobolPair {
    /// The position in the pixel.
    pub(crate) const FILM: Self = Self(0);
    /// The position on the lens.
    pub(crate) const LENS: Self = Self(2);

    /// The moment of the shutter, by the first number.
    pub(crate) const SHUTTER: Self = Self(3);

    /// The light of vertex `bounces`: grouped with the dimensions before it, the position in the
    /// pixel or the direction from the vertex before.
    pub(crate) fn light(bounces: u32) -> Self {
        Self(4 * bounces + 1)
    }

    /// The direction from a vertex.
    pub(crate) fn direction(bounces: u32) -> Self {
        Self(4 * bounces + 4)
    }

    /// Which wavelength a vertex picks, and whether the path continues.
    pub(crate) fn russian_roulette(bounces: u32) -> Self {
        Self(4 * bounces + 6)
    }

    /// Where media scatter the ray to vertex `bounces`, and the channel that says so; apart from
    /// the pairs of all other vertices.
    pub(crate) fn free_flight(bounces: u32) -> Self {
        Self((1 << 31) | (2 * (bounces & ((1 << 29) - 1))))
    }

    /// Whether microfacets of a vertex reflect or transmit.
    pub(crate) fn lobe(bounces: u32) -> Self {
        Self(4 * bounces + 7)
    }
}

/// 2⁻³².
const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// The numbers of one path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SobolPath {
    pixel: PathVertexKey,
    /// The key of all dimensions except the positions in the pixel and on the lens.
    path: PathVertexKey,
    seeds: SamplingSeeds,
    index: u32,
    /// The index from its highest bit on.
    reversed: u32,
}

impl SobolPath {
    /// The numbers of path `index` of a pixel that has a sequence of its own.
    pub(crate) fn new(pixel: [u32; 2], index: u32, seeds: SamplingSeeds) -> Self {
        let pixel = PathVertexKey::new(pixel, 0);
        Self {
            pixel,
            path: pixel.seeded(seeds.path),
            seeds,
            index,
            reversed: index.reverse_bits(),
        }
    }

    /// The sample values of path `index` of a pixel in a picture of this many paths per pixel, at
    /// least 1.
    ///
    /// Its pixels share a sequence along a curve that fills squares one after another, so that the
    /// errors of neighbours cancel: that of a pixel is as large as by [`Self::new`], that of a
    /// blurred picture is less (Ahmed, Wonka, "Screen-space blue-noise diffusion of Monte Carlo
    /// sampling error via hierarchical ordering of pixels", SIGGRAPH Asia 2020).
    pub(crate) fn in_picture(
        pixel: [u32; 2],
        index: u32,
        seeds: SamplingSeeds,
        samples: u32,
    ) -> Self {
        // Of the bits of an index the lowest count samples; as many of the others as fit are a
        // position on the curve.
        let low = u32::BITS - (samples - 1).leading_zeros();
        let side = (u32::BITS - low) / 2;
        let [tile, place] = [pixel.map(|x| x >> side), pixel.map(|x| x & !(!0 << side))];
        let place = spread(place[1]) << 1 | spread(place[0]);
        let index = place.checked_shl(low).unwrap_or(0) | index;
        Self::new(tile, index, seeds)
    }

    /// A pair of numbers of this path, both from 0 to 1 − 2⁻³².
    #[inline]
    pub(crate) fn pair(&self, pair: SobolPair) -> [f64; 2] {
        let group = u64::from(pair.0 / 2);
        let [film, lens] = [self.seeds.pixel, self.seeds.lens];
        let bits = match group {
            0 => self.pixel.seeded(film),
            1 => self.pixel.seeded(lens),
            _ => self.path,
        }
        .bits(group);
        // Scrambled from its highest bit on, the index shuffles the points and keeps each first 2^k
        // of them together.
        let index = scrambled(self.reversed, bits as u32).reverse_bits();
        // The second pair of a group is always one of the path.
        let ([x, y], seeds) = if pair.0.is_multiple_of(2) {
            (first_two(index), bits.rotate_left(16))
        } else {
            (last_two(index), mix(self.path.bits(group)))
        };
        let (x, y) = (
            scrambled(x, (seeds >> 32) as u32),
            scrambled(y, seeds as u32),
        );
        // Reversed together, they swap positions.
        let both = (u64::from(x) << 32 | u64::from(y)).reverse_bits();
        [both as u32, (both >> 32) as u32].map(|bits| f64::from(bits) * UNIT)
    }

    /// An independent number in [0, 1) for decisions that use no dimension of the sequence, such as
    /// the alpha test.
    pub(crate) fn uniform(&self, dimension: u32, turn: u32) -> f64 {
        let key = self
            .path
            .child(u64::from(self.index) << 32 | u64::from(turn));
        key.uniform(u64::from(dimension))
    }
}

/// A number of 16 bits with a 0 above each of them.
fn spread(mut x: u32) -> u32 {
    for (step, mask) in [
        (8, 0x00FF_00FF),
        (4, 0x0F0F_0F0F),
        (2, 0x3333_3333),
        (1, 0x5555_5555),
    ] {
        x = (x | x << step) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIRS: [SobolPair; 4] = [
        SobolPair::FILM,
        SobolPair::LENS,
        SobolPair(5),
        SobolPair(12),
    ];

    /// Asserts that points, a power of two of them, are in [0, 1) and fill all elementary
    /// intervals.
    fn assert_filled(points: &[[f64; 2]], of: &str) {
        let numbers = points.iter().flatten();
        assert!(
            numbers.clone().all(|u| (0.0..=1.0 - UNIT).contains(u)),
            "{of}"
        );
        let log = points.len().trailing_zeros();
        for across in 0..=log {
            let cell = |[x, y]: &[f64; 2]| {
                let place = |x: f64, log: u32| (x * f64::from(1_u32 << log)) as u32;
                [place(*x, across), place(*y, log - across)]
            };
            let mut cells = points.iter().map(cell).collect::<Vec<_>>();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(
                cells.len(),
                points.len(),
                "{of}, {across} of {log} bits across"
            );
        }
    }

    #[test]
    fn the_first_points_of_every_power_of_two_fill_all_elementary_intervals() {
        for log in 1..=8_u32 {
            for pair in PAIRS {
                let point = |k| SobolPath::new([3, 5], k, SamplingSeeds::NONE).pair(pair);
                let points = (0..1 << log).map(point).collect::<Vec<_>>();
                assert_filled(&points, &format!("{pair:?}"));
            }
        }
    }

    #[test]
    fn so_do_those_of_a_pixel_in_a_picture_and_those_of_a_square_of_pixels() {
        for (side, samples) in [(1, 16), (2, 16), (4, 4), (8, 1)] {
            let pixels = (0..side * side).map(|k| [8 + k % side, 24 + k / side]);
            for pair in PAIRS {
                let point = |(pixel, k)| {
                    SobolPath::in_picture(pixel, k, SamplingSeeds::NONE, samples).pair(pair)
                };
                let points = pixels
                    .clone()
                    .flat_map(|pixel| (0..samples).map(move |k| (pixel, k)));
                let points = points.map(point).collect::<Vec<_>>();
                assert_filled(&points, &format!("{pair:?}, {side} × {side} pixels"));
            }
        }
    }

    #[test]
    fn a_picture_has_room_for_all_its_pixels_and_samples() {
        // Distant pixels, and pixels with very many samples, have independent values.
        for samples in [1, 3, 1 << 20, u32::MAX] {
            let pixels = [
                [0, 0],
                [1, 0],
                [0, 1],
                [1 << 16, 0],
                [0, 1 << 16],
                [u32::MAX; 2],
            ];
            let first = |pixel| {
                SobolPath::in_picture(pixel, samples - 1, SamplingSeeds::NONE, samples)
                    .pair(SobolPair::FILM)
            };
            let mut first_light_of_surface = pixels.map(first).map(|pair| pair.map(f64::to_bits));
            first_light_of_surface.sort_unstable();
            assert!(
                first_light_of_surface
                    .windows(2)
                    .all(|two| two[0] != two[1]),
                "{samples}"
            );
        }
    }

    #[test]
    fn groups_are_independent_of_each_other() {
        // The covariance of two dimensions of different groups vanishes as that of random numbers
        // does.
        let (n, at) = (4096, |k| SobolPath::new([0, 0], k, SamplingSeeds::NONE));
        let product = |k| {
            (at(k).pair(SobolPair::FILM)[0] - 0.5) * (at(k).pair(SobolPair::direction(0))[0] - 0.5)
        };
        let covariance = (0..n).map(product).sum::<f64>() / f64::from(n);
        assert!(
            covariance.abs() < 8.0 / 12.0 / f64::from(n).sqrt(),
            "{covariance}"
        );
    }

    #[test]
    fn no_two_uses_share_a_pair() {
        let uses = (0..9).flat_map(|k| {
            [
                SobolPair::light(k),
                SobolPair::direction(k),
                SobolPair::russian_roulette(k),
                SobolPair::lobe(k),
                SobolPair::free_flight(k),
            ]
        });
        let mut uses = uses
            .chain([SobolPair::FILM, SobolPair::LENS])
            .map(|pair| pair.0)
            .collect::<Vec<_>>();
        let count = uses.len();
        uses.sort_unstable();
        uses.dedup();
        assert_eq!(uses.len(), count);
    }
}
