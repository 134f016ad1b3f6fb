//! Double-double arithmetic: a number as an unevaluated sum of two f64, about 106 bits. It serves
//! the rare cases that one f64 cannot decide.

use super::{two_difference, two_product, two_sum};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `high + low`, with `|low| ≤ ½ ulp(high)`.
///
/// The operations are those of Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic
/// building blocks of double-word arithmetic", ACM TOMS 44 (2017): algorithms 6, 12 and 18, each
/// with a relative error of a few u².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// 0.
    pub const ZERO: Self = Self {
        high: 0.0,
        low: 0.0,
    };

    /// 1.
    pub const ONE: Self = Self {
        high: 1.0,
        low: 0.0,
    };

    /// `a − b` exactly.
    #[must_use]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_difference(a, b);
        Self { high, low }
    }

    /// The nearest f64.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.high
    }

    /// What is left beyond the nearest f64.
    #[must_use]
    pub fn rest(self) -> f64 {
        self.low
    }

    /// The square root; 0 for values not above 0.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(0.0);
        }
        // One Newton step from the rounded root.
        let root = self.high.sqrt();
        let (square, error) = two_product(root, root);
        let rest = ((self.high - square) - error) + self.low;
        normalized(root, rest / (2.0 * root))
    }
}

fn normalized(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble {
        high,
        low: b - (high - a),
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, s_error) = two_sum(self.high, other.high);
        let (t, t_error) = two_sum(self.low, other.low);
        let first = normalized(s, s_error + t);
        normalized(first.high, first.low + t_error)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (p, p_error) = two_product(self.high, other.high);
        normalized(p, p_error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let rest = self - other * Self::from(quotient);
        normalized(quotient, rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_times_three_is_one_to_a_hundred_bits() {
        let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
        let rest = third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0);
        assert!(rest.to_f64().abs() < 1e-31, "{rest:?}");
    }

    #[test]
    fn the_root_of_two_squares_to_two() {
        let root = DoubleDouble::from(2.0).sqrt();
        assert!((root * root - DoubleDouble::from(2.0)).to_f64().abs() < 1e-31);
    }

    #[test]
    fn what_one_double_swallows_is_kept() {
        let sum = DoubleDouble::difference(1e20, -1.0) - DoubleDouble::from(1e20);
        assert_eq!(sum.to_f64(), 1.0);
    }
}
