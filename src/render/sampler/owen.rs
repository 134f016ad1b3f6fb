//! The points of a sequence in four dimensions, and Owen's scrambling of their coordinates.
//!
//! Faure's sequence in base 4 (Niederreiter, "Point sets and sequences with small discrepancy",
//! Monatshefte für Mathematik 104 (1987), over GF(4)), with its digits mapped so that the first two
//! dimensions are those of Sobol', and the last two are with each other as good in base 2.
//! Coordinates are given from their lowest bit on, so that their highest bits come first.

/// The first two coordinates of a point: van der Corput's, which turns the index round, and
/// Pascal's matrix. Each 2ᵐ points from a multiple of 2ᵐ on have one in each elementary interval.
#[inline]
pub(crate) fn first_two(index: u32) -> [u32; 2] {
    [index, within_digits(pascal(u64::from(index)) as u32)]
}

/// The other two coordinates: with each other they are as good as the first two, and each 4ᵐ points
/// have one in each elementary interval in base 4 of all four dimensions.
///
/// With D = diag(1, ω, ω², …) over digits of two bits, the third matrix is D⁻¹·P·D, the fourth
/// D⁻²·P·D²; P is Pascal's matrix of digits. In the second and the fourth coordinate it is applied
/// to the bits of each digit, too.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "the halves are meant")]
pub(crate) fn last_two(index: u32) -> [u32; 2] {
    // The lower half is the third coordinate, the upper half the fourth.
    let both = u64::from(index) << 32 | u64::from(index);
    let both = times(both, UP, DOWN);
    let both = times(pascal(both), DOWN, UP);
    let fourth = (both >> 32) as u32;
    [both as u32, within_digits(fourth)]
}

/// Pascal's matrix of the two bits of each digit: the lower one becomes the sum of both.
#[inline]
fn within_digits(x: u32) -> u32 {
    x ^ ((x >> 1) & EVEN as u32)
}

/// Every second bit, from the lowest on.
const EVEN: u64 = 0x5555_5555_5555_5555;

/// The digits at the positions 1, 4, 7 … of a half, and those at 2, 5, 8 ….
const PLACES: [u64; 2] = [0x0C30_C30C, 0x30C3_0C30];

/// The digits that D multiplies by ω in the lower half, and D² in the upper one.
const UP: u64 = PLACES[1] << 32 | PLACES[0];

/// Those that they multiply by ω².
const DOWN: u64 = PLACES[0] << 32 | PLACES[1];

/// Multiplies some digits by ω, and others by ω², in GF(4): ω² = ω + 1, the lower bit counts ones.
#[inline]
fn times(x: u64, omega: u64, omega_squared: u64) -> u64 {
    let (ones, omegas) = (x & EVEN, (x >> 1) & EVEN);
    let sum = ones ^ omegas;
    x & !(omega | omega_squared) | (omegas | sum << 1) & omega | (sum | ones << 1) & omega_squared
}

/// Pascal's matrix modulo 2 over digits of two bits, in both halves: digit i is the sum of the
/// digits j whose positions have all bits of i.
#[inline]
fn pascal(mut x: u64) -> u64 {
    for (step, mask) in [
        (2, 0x3333_3333_3333_3333),
        (4, 0x0F0F_0F0F_0F0F_0F0F),
        (8, 0x00FF_00FF_00FF_00FF),
        (16, 0x0000_FFFF_0000_FFFF_u64),
    ] {
        x ^= (x >> step) & mask;
    }
    x
}

/// Owen's nested scrambling from the lowest bit up: each bit is flipped by a hash of those below it
/// (Laine, Karras, "Stratified sampling for stochastic transparency", 2011, with the constants of
/// Vegdahl, "Building a better LK hash", 2021).
#[inline]
pub(crate) fn scrambled(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^ x.wrapping_mul(0x53A2_2864)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The coordinates, from their highest bit on.
    fn point(index: u32) -> [u32; 4] {
        let ([a, b], [c, d]) = (first_two(index), last_two(index));
        [a, b, c, d].map(u32::reverse_bits)
    }

    /// The number of boxes with a point of the first `count`, where each dimension is halved this
    /// many times.
    fn filled(count: u32, cuts: [u32; 4]) -> usize {
        let place = |x: u32, cut: u32| u64::from(x) >> (32 - cut);
        let cell = |index: u32| {
            let point = point(index);
            [0, 1, 2, 3].map(|axis| place(point[axis], cuts[axis]))
        };
        let mut cells = (0..count).map(cell).collect::<Vec<_>>();
        cells.sort_unstable();
        cells.dedup();
        cells.len()
    }

    #[test]
    fn both_pairs_fill_all_elementary_intervals_of_every_power_of_two() {
        for log in 0..=8 {
            for cut in 0..=log {
                for cuts in [[cut, log - cut, 0, 0], [0, 0, cut, log - cut]] {
                    assert_eq!(filled(1 << log, cuts), 1 << log, "{cuts:?}");
                }
            }
        }
    }

    #[test]
    fn all_four_fill_those_in_base_4_of_every_power_of_four() {
        for log in 0..=4 {
            let lengths = |rest: u32| (0..=rest).map(move |cut| (cut, rest - cut));
            for (a, rest) in lengths(log) {
                for (b, rest) in lengths(rest) {
                    for (c, d) in lengths(rest) {
                        let cuts = [a, b, c, d].map(|digits| 2 * digits);
                        assert_eq!(filled(1 << (2 * log), cuts), 1 << (2 * log), "{cuts:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn scrambling_keeps_what_is_above_apart_from_what_is_below() {
        // Numbers that are equal in their first bits, from the lowest on, stay so, and the next bit
        // differs.
        for k in 0..32_u32 {
            let seed = 0x9E37_79B9_u32.wrapping_mul(k + 1);
            let (a, b) = (0x1234_5678, 0x1234_5678 ^ 1 << k);
            let different = scrambled(a, seed) ^ scrambled(b, seed);
            assert_eq!(different.trailing_zeros(), k);
        }
    }
}
