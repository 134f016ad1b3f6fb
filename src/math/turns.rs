//! Angles as 64-bit fractions of 2π: addition and reduction are exact.

use super::func::sin_cos;
use std::f64::consts::TAU;

/// The cosine and sine of an angle in units of 2⁻⁶⁴ turns, each to within 2 u absolute.
///
/// The quadrant is taken off in integers, so the angle handed to `libm` is at most π/4.
#[must_use]
pub fn cos_sin_revolutions(turns: u64) -> (f64, f64) {
    /// 2⁻⁶⁴.
    const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;
    let quadrant = (turns.wrapping_add(1 << 61)) >> 62;
    let rest = turns.wrapping_sub(quadrant << 62).cast_signed();
    let angle = rest as f64 * (UNIT * TAU);
    let (s, c) = sin_cos(angle);
    match quadrant {
        0 => (c, s),
        1 => (-s, c),
        2 => (-c, -s),
        _ => (s, -c),
    }
}

/// `k` golden angles, k·π(3 − √5), in units of 2⁻⁶⁴ turns: no error grows with k but that of the
/// constant.
#[must_use]
pub fn golden_revolutions(k: u64) -> u64 {
    /// (3 − √5)/2 · 2⁶⁴.
    const GOLDEN: u64 = 0x61C8_8646_80B5_83EB;
    k.wrapping_mul(GOLDEN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_of_a_turn_are_exact() {
        let quarter = |k: u64, expected| assert_eq!(cos_sin_revolutions(k << 62), expected);
        quarter(0, (1.0, 0.0));
        quarter(1, (-0.0, 1.0));
        quarter(2, (-1.0, -0.0));
        quarter(3, (0.0, -1.0));
    }

    #[test]
    fn the_golden_angle_is_that_of_the_formula() {
        let angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let (c, s) = cos_sin_revolutions(golden_revolutions(1));
        assert!((c - libm::cos(angle)).abs() < 1e-15 && (s - libm::sin(angle)).abs() < 1e-15);
    }
}
