//! Interval arithmetic: a real number between two f64 (Moore, Kearfott, Cloud, "Introduction to
//! interval analysis", SIAM 2009).
//!
//! Ends are rounded to nearest and then moved by at least one f64 outwards, which covers the half
//! unit of rounding; sums, products and roots of single numbers stay single numbers where they are
//! exact. An end of ±∞ says that there is no bound.

use super::number::{Certainty, CertifiedNumber};
use rtc_math::{Number, U, atan2, cos_sin_revolutions, pow, two_product, two_sum};
use std::f64::consts::TAU;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number between two f64, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    low: f64,
    high: f64,
}

impl Enclosure {
    /// One number, which must be finite.
    #[must_use]
    const fn single(value: f64) -> Self {
        Self {
            low: value,
            high: value,
        }
    }

    /// The numbers no further than `radius` from `value`.
    fn around(value: f64, radius: f64) -> Self {
        Self::outward(value - radius, value + radius)
    }

    /// The ends of a result, each rounded to nearest, moved outwards by one f64, or two near the
    /// subnormal numbers, without a branch: Rump, Zimmermann, Boldo, Melquiond, "Computing
    /// predecessor and successor in rounding to nearest", BIT 49 (2009), algorithm 1.
    #[inline(always)]
    fn outward(low: f64, high: f64) -> Self {
        const RELATIVE: f64 = U * (1.0 + 2.0 * U);
        const SMALLEST: f64 = 5e-324;
        let below = low - (RELATIVE * low.abs() + SMALLEST);
        let above = high + (RELATIVE * high.abs() + SMALLEST);
        Self::between(below, above)
    }

    /// Whether it is one number.
    #[inline]
    fn is_point(self) -> bool {
        self.low == self.high
    }

    /// The same without what rounding added below 0.
    #[inline]
    fn at_least_zero(self) -> Self {
        Self {
            low: self.low.max(0.0),
            ..self
        }
    }

    /// The hull of the four results of an operation on the ends; any number if one is NaN, as from
    /// 0·∞.
    #[inline(always)]
    fn hull_of([a, b, c, d]: [f64; 4]) -> Self {
        // The sum is NaN, too, where the results have no bounds on both sides.
        if (a + b + c + d).is_nan() {
            return Self::ALL;
        }
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    /// The number half-way, and the distance of the ends.
    fn middle(self) -> (f64, f64) {
        let middle = 0.5 * self.low + 0.5 * self.high;
        let radius = (self.high - middle).max(middle - self.low).next_up();
        (middle, radius)
    }

    /// The least distance of its numbers from 0.
    fn least(self) -> f64 {
        self.low.max(-self.high).max(0.0)
    }
}

impl Number for Enclosure {
    type Mask = Certainty;

    #[inline]
    fn constant(self, x: f64) -> Self {
        Self::point(x)
    }

    #[inline]
    fn square(self) -> Self {
        if self.is_point() {
            return self * self;
        }
        let (a, b) = (self.low.abs(), self.high.abs());
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        let near = if self.has_sign() { near } else { 0.0 };
        Self::outward(near * near, far * far).at_least_zero()
    }

    #[inline]
    fn sqrt(self) -> Self {
        let (low, high) = (self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        if self.is_point() && two_product(low, low) == (self.low, 0.0) {
            return Self::single(low);
        }
        Self::outward(low, high).at_least_zero()
    }

    fn abs(self) -> Self {
        Self::select(self.less(Self::ZERO), -self, self)
    }

    fn less(self, other: Self) -> Certainty {
        let fails = other.is_below(self) || (other - self).is_zero();
        Certainty::new(self.is_below(other), fails)
    }

    fn less_or_equal(self, other: Self) -> Certainty {
        !other.less(self)
    }

    fn select(mask: Certainty, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }
}

impl CertifiedNumber for Enclosure {
    const ZERO: Self = Self::single(0.0);
    const ONE: Self = Self::single(1.0);
    const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };
    const NONNEGATIVE: Self = Self {
        low: 0.0,
        high: f64::INFINITY,
    };

    #[inline]
    fn point(value: f64) -> Self {
        Self::single(value)
    }

    #[inline]
    fn between(low: f64, high: f64) -> Self {
        if low <= high {
            Self { low, high }
        } else {
            Self::ALL
        }
    }

    #[inline]
    fn low(self) -> f64 {
        self.low
    }

    #[inline]
    fn high(self) -> f64 {
        self.high
    }

    fn width(self) -> f64 {
        (self.high - self.low).next_up()
    }

    fn center(self) -> Self {
        Self::single(self.middle().0)
    }

    #[inline]
    fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    #[inline]
    fn is_positive(self) -> bool {
        self.low > 0.0
    }

    #[inline]
    fn is_negative(self) -> bool {
        self.high < 0.0
    }

    #[inline]
    fn is_below(self, other: Self) -> bool {
        self.high < other.low
    }

    fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    #[inline]
    fn clamp(self, least: f64, most: f64) -> Self {
        Self {
            low: self.low.clamp(least, most),
            high: self.high.clamp(least, most),
        }
    }

    /// The `pow` of `libm` is that of FreeBSD (`e_pow.c`), whose error is stated to be below 0.70
    /// units in the last place; two units are allowed to either side.
    fn power(self, exponent: Self) -> Self {
        if exponent.is_zero() {
            return Self::ONE;
        }
        let end = |x: f64, exponent: f64| {
            if x <= 0.0 {
                0.0
            } else {
                pow(x.min(1.0), exponent)
            }
        };
        // 0 and 1 are exact.
        let low = end(self.low, exponent.high);
        let high = end(self.high, exponent.low);
        let below = if self.low >= 1.0 || self.low <= 0.0 {
            low
        } else {
            low.next_down().next_down()
        };
        let above = if self.high <= 0.0 || self.high >= 1.0 {
            high
        } else {
            high.next_up().next_up()
        };
        Self::between(below.max(0.0), above.min(1.0))
    }

    #[inline]
    fn level(self) -> Option<u8> {
        let (low, high) = (level(self.low), level(self.high));
        (low == high).then_some(low)
    }

    /// The errors of [`cos_sin_revolutions`] are below 2 u.
    fn cos_sin(turns: u64) -> [Self; 2] {
        let (cosine, sine) = cos_sin_revolutions(turns);
        [cosine, sine].map(|x| Self::around(x, 4.0 * U))
    }

    /// The angle of the middle; that of others differs by no more than their distance from it over
    /// the least distance from 0. `atan2` of `libm` is that of FreeBSD; its error, below two units
    /// in the last place, is allowed four times.
    fn turns(y: Self, x: Self) -> Self {
        let nearest = (y.least() * y.least() + x.least() * x.least()).sqrt() * (1.0 - 4.0 * U);
        let jumps = x.low <= 0.0 && y.low <= 0.0 && y.high >= 0.0;
        let ((y, y_radius), (x, x_radius)) = (y.middle(), x.middle());
        let turn = atan2(y, x) / TAU;
        let spread = (y_radius + x_radius) / nearest;
        let error = (16.0 * U * turn.abs() + spread / TAU) * (1.0 + 8.0 * U);
        // It is NaN or infinite where the angle has no bound.
        if jumps || !error.is_finite() {
            return Self::ALL;
        }
        Self::around(turn, error)
    }
}

/// ⌊255·x⌋ for x clamped to [0, 1], of the exact product.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and 255"
)]
pub(super) fn level(x: f64) -> u8 {
    let (product, error) = two_product(x.clamp(0.0, 1.0), 255.0);
    let floor = product.floor();
    if floor == product && error < 0.0 {
        (floor - 1.0) as u8
    } else {
        floor as u8
    }
}

impl Neg for Enclosure {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}

impl Add for Enclosure {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        if self.is_point() && other.is_point() {
            let (sum, error) = two_sum(self.low, other.low);
            if error == 0.0 {
                return Self::single(sum);
            }
        }
        Self::outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Enclosure {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// Products of this size have an exact error, which is no subnormal number.
pub(super) const EXACT: std::ops::Range<f64> = 1e-250..1e250;

impl Mul for Enclosure {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        if self.is_point() && other.is_point() {
            let (product, error) = two_product(self.low, other.low);
            if error == 0.0 && EXACT.contains(&product.abs()) {
                return Self::single(product);
            }
            return Self::outward(product, product);
        }
        Self::hull_of([
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ])
    }
}

impl Div for Enclosure {
    type Output = Self;

    /// Any number if the divisor may be 0.
    #[inline]
    fn div(self, other: Self) -> Self {
        if !other.has_sign() {
            return Self::ALL;
        }
        if self.is_zero() || other == Self::ONE {
            return self;
        }
        if self.is_point() && other.is_point() {
            let quotient = self.low / other.low;
            let is_normal = EXACT.contains(&self.low.abs()) && EXACT.contains(&quotient.abs());
            if is_normal && two_product(quotient, other.low) == (self.low, 0.0) {
                return Self::single(quotient);
            }
        }
        Self::hull_of([
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certify::vector::CertifiedVector;
    use proptest::prelude::*;
    use rtc_math::{DoubleDouble, Vec3, Vector};

    /// An enclosure, and two numbers in it.
    fn enclosures() -> impl Strategy<Value = (Enclosure, [f64; 2])> {
        let number = prop_oneof![-4.0..4.0, -1e9..1e9, -1e-9..1e-9, Just(0.0), Just(1.0)];
        let width = prop_oneof![Just(0.0), 0.0..1e-12, 0.0..2.0];
        (number, width, 0.0..=1.0_f64).prop_map(|(low, width, place): (f64, f64, f64)| {
            let high = low + width;
            let inner = (low + place * (high - low)).clamp(low, high);
            (Enclosure::between(low, high), [inner, low])
        })
    }

    /// Whether an enclosure holds a number of about 106 bits.
    fn holds(enclosure: Enclosure, number: DoubleDouble) -> bool {
        let distance = |end: f64| (number - DoubleDouble::from(end)).to_f64();
        distance(enclosure.low) >= 0.0 && distance(enclosure.high) <= 0.0
    }

    proptest! {
        #[test]
        fn sums_products_and_quotients_hold_the_double_double_result(
            (a, [a0, a1]) in enclosures(),
            (b, [b0, b1]) in enclosures(),
        ) {
            for (x, y) in [(a0, b0), (a1, b1), (a0, b1)] {
                let (p, q) = (DoubleDouble::from(x), DoubleDouble::from(y));
                prop_assert!(holds(a + b, p + q), "{x} + {y}");
                prop_assert!(holds(a - b, p - q), "{x} - {y}");
                prop_assert!(holds(a * b, p * q), "{x} * {y}");
                if b.low * b.high > 0.0 {
                    prop_assert!(holds(a / b, p / q), "{x} / {y}");
                }
            }
        }

        #[test]
        fn squares_and_roots_hold_the_double_double_result((a, [x, y]) in enclosures()) {
            for x in [x, y] {
                let number = DoubleDouble::from(x);
                prop_assert!(holds(a.square(), number * number), "{x}²");
                if x >= 0.0 {
                    prop_assert!(holds(a.sqrt(), number.sqrt()), "√{x}");
                }
            }
        }

        #[test]
        fn highlights_of_whole_exponents_hold_the_product(
            x in 0.5..1.0_f64, width in 0.0..1e-9_f64, exponent in 1..64_i32,
        ) {
            let number = DoubleDouble::from(x);
            let power = (1..exponent).fold(number, |power, _| power * number);
            let n = Enclosure::point(f64::from(exponent));
            let enclosure = Enclosure::between(x, x + width).power(n);
            prop_assert!(holds(enclosure, power), "{x}^{exponent}");
        }

        #[test]
        fn a_unit_vector_of_a_box_holds_that_of_its_corner(x in -9.0..9.0, y in -9.0..9.0) {
            let corner = Vec3::new(x, y, 1.5);
            let wide = corner.to_array().map(|k: f64| Enclosure::between(k, k + 1e-9));
            let unit = Vector::from(wide).normalized();
            for (axis, part) in corner.normalize().to_array().into_iter().enumerate() {
                let Enclosure { low, high } = unit.into_array()[axis];
                prop_assert!(low <= part + 4.0 * U && part - 4.0 * U <= high);
                prop_assert!(high - low < 1e-8);
            }
        }
    }

    #[test]
    fn exact_results_stay_single_numbers() {
        let [half, quarter] = [0.5, 0.25].map(Enclosure::point);
        assert_eq!(half + quarter, Enclosure::point(0.75));
        assert_eq!(half * half, quarter);
        assert_eq!(quarter.sqrt(), half);
        assert_eq!(quarter / half, half);
        assert_eq!(Enclosure::ALL * Enclosure::ZERO, Enclosure::ZERO);
        assert_eq!(half / Enclosure::between(-1.0, 1.0), Enclosure::ALL);
    }

    #[test]
    fn a_level_is_that_of_the_exact_product() {
        // 0.6 as an f64 lies below three fifths, and 255·0.6 rounds to 153.
        assert_eq!(Enclosure::point(0.6).level(), Some(152));
        assert_eq!(Enclosure::point(0.2).level(), Some(51));
        assert_eq!(Enclosure::ONE.level(), Some(255));
        assert_eq!(Enclosure::between(-3.0, 0.0).level(), Some(0));
        assert_eq!(Enclosure::between(1.0, f64::INFINITY).level(), Some(255));
        assert_eq!(Enclosure::between(0.2_f64.next_down(), 0.2).level(), None);
    }
}
