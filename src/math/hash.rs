//! SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014):
//! bits that look random, the same on every machine.

/// The increment of the generator's state per number.
pub const GAMMA: u64 = 0x9E37_79B9_7F4A_7C15;

/// The number after state `x` of the generator: equal numbers for equal states, and no likeness for
/// others.
#[must_use]
#[inline]
pub fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(GAMMA);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// A number in [0, 1) of the upper 53 bits.
#[must_use]
#[inline]
pub fn fraction(bits: u64) -> f64 {
    /// 2⁻⁵³.
    const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;
    (bits >> 11) as f64 * UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_the_paper() {
        // The first numbers of seed 1234567 by the reference implementation.
        let numbers =
            [0, 1, 2].map(|k: u64| mix(1_234_567_u64.wrapping_add(k.wrapping_mul(GAMMA))));
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(numbers, expected);
    }

    #[test]
    fn a_fraction_is_never_one() {
        assert_eq!(fraction(0), 0.0);
        assert_eq!(fraction(1 << 63), 0.5);
        assert_eq!(fraction(u64::MAX), 1.0f64.next_down());
    }
}
