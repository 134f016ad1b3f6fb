//! Double-double: a number as an unevaluated sum of two f64, about 106 bits. For the cold paths
//! that decide what one f64 can't.

use super::{two_difference, two_product, two_sum};
use std::ops::{Add, Div, Mul, Sub};

/// `high + low`, with `|low| ≤ ½ ulp(high)`.
///
/// The operations are those of Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic
/// building blocks of double-word arithmetic", ACM TOMS 44 (2017): algorithms 6, 12 and 18, each
/// with a relative error of a few u².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// `a − b` exactly.
    #[must_use]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_difference(a, b);
        Self { high, low }
    }

    /// The nearest f64.
    #[must_use]
    pub fn rounded(self) -> f64 {
        self.high
    }

    /// The square root; 0 for what is not above 0.
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

fn normalized(a: f64, b: f64) -> Double {
    let high = a + b;
    Double {
        high,
        low: b - (high - a),
    }
}

impl From<f64> for Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (s, s_error) = two_sum(self.high, other.high);
        let (t, t_error) = two_sum(self.low, other.low);
        let first = normalized(s, s_error + t);
        normalized(first.high, first.low + t_error)
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self {
            high: -other.high,
            low: -other.low,
        }
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (p, p_error) = two_product(self.high, other.high);
        normalized(p, p_error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
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
        let third = Double::from(1.0) / Double::from(3.0);
        let rest = third * Double::from(3.0) - Double::from(1.0);
        assert!(rest.rounded().abs() < 1e-31, "{rest:?}");
    }

    #[test]
    fn the_root_of_two_squares_to_two() {
        let root = Double::from(2.0).sqrt();
        assert!((root * root - Double::from(2.0)).rounded().abs() < 1e-31);
    }

    #[test]
    fn what_one_double_swallows_is_kept() {
        let sum = Double::difference(1e20, -1.0) - Double::from(1e20);
        assert_eq!(sum.rounded(), 1.0);
    }
}
