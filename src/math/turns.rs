//! Angles in turns, which reduce without error.

use super::func::{cos, sin};
use std::f64::consts::TAU;

/// The cosine and sine of an angle given in turns, for |turns| < 2^50: right to within 2 u absolute.
///
/// The quadrant is taken off exactly, so the angle handed to `libm` is at most π/4.
#[must_use]
pub fn cos_sin_turns(turns: f64) -> (f64, f64) {
    let quarters = (4.0 * turns).round();
    let rest = (turns - quarters / 4.0) * TAU;
    let (c, s) = (cos(rest), sin(rest));
    match quarters.rem_euclid(4.0) {
        0.0 => (c, s),
        1.0 => (-s, c),
        2.0 => (-c, -s),
        _ => (s, -c),
    }
}

/// `k` golden angles as turns in [0, 1), k·(3 − √5)/2 modulo 1, in 64-bit integers: no error grows with k.
#[must_use]
pub fn golden_turns(k: u64) -> f64 {
    /// (3 − √5)/2 · 2⁶⁴.
    const GOLDEN: u64 = 0x61C8_8646_80B5_83EB;
    /// 2⁻⁵³.
    const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;
    (k.wrapping_mul(GOLDEN) >> 11) as f64 * UNIT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_of_a_turn_are_exact() {
        let near = |turns, expected| assert_eq!(cos_sin_turns(turns), expected);
        near(0.0, (1.0, 0.0));
        near(0.25, (0.0, 1.0));
        near(0.5, (-1.0, 0.0));
        near(-0.25, (0.0, -1.0));
        near(7.75, (0.0, -1.0));
    }

    #[test]
    fn the_golden_angle_is_that_of_the_formula() {
        let angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        assert!((golden_turns(1) * TAU - angle).abs() < 1e-15);
    }
}
