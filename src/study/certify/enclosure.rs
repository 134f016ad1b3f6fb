//! Interval arithmetic: a real number between two f64 (Moore, Kearfott, Cloud, "Introduction to
//! interval analysis", SIAM 2009).
//!
//! Every operation contains the results of the real operation on all numbers of its operands. Ends
//! are rounded to nearest and then moved by one f64 outwards, which covers the half unit of
//! rounding; sums, products and roots of single numbers stay single numbers where they are exact.
//! An end of ±∞ says that there is no bound.

use rtc_math::{U, Vec3, pow, two_product, two_sum};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number between two f64, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    low: f64,
    high: f64,
}

impl Enclosure {
    /// 0.
    pub const ZERO: Self = Self::point(0.0);

    /// 1.
    pub const ONE: Self = Self::point(1.0);

    /// Any real number.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Any real number from 0 on.
    pub const NONNEGATIVE: Self = Self {
        low: 0.0,
        high: f64::INFINITY,
    };

    /// One number, which must be finite.
    #[must_use]
    pub const fn point(value: f64) -> Self {
        Self {
            low: value,
            high: value,
        }
    }

    /// The numbers from `low` to `high`; any number if one is NaN or they are in the wrong order.
    #[must_use]
    pub fn between(low: f64, high: f64) -> Self {
        if low <= high {
            Self { low, high }
        } else {
            Self::ALL
        }
    }

    /// The numbers no further than `radius` from `value`.
    #[must_use]
    pub fn around(value: f64, radius: f64) -> Self {
        Self::outward(value - radius, value + radius)
    }

    /// The ends of a result, each rounded to nearest, one f64 further apart on either side.
    #[inline]
    fn outward(low: f64, high: f64) -> Self {
        Self::between(low.next_down(), high.next_up())
    }

    /// The lower end.
    #[must_use]
    pub fn low(self) -> f64 {
        self.low
    }

    /// The upper end.
    #[must_use]
    pub fn high(self) -> f64 {
        self.high
    }

    /// A number about half-way, and a bound on the distance of the others.
    #[must_use]
    pub fn middle(self) -> (f64, f64) {
        let middle = 0.5 * self.low + 0.5 * self.high;
        let radius = (self.high - middle).max(middle - self.low).next_up();
        (middle, radius)
    }

    /// Whether it is one number.
    #[inline]
    fn is_point(self) -> bool {
        self.low == self.high
    }

    /// Whether it is 0 and nothing else.
    #[must_use]
    #[inline]
    pub fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    /// Whether all its numbers are above 0.
    #[must_use]
    #[inline]
    pub fn is_positive(self) -> bool {
        self.low > 0.0
    }

    /// Whether all its numbers are below 0.
    #[must_use]
    #[inline]
    pub fn is_negative(self) -> bool {
        self.high < 0.0
    }

    /// Whether all its numbers are below all of another.
    #[must_use]
    #[inline]
    pub fn is_below(self, other: Self) -> bool {
        self.high < other.low
    }

    /// Both, and what lies between.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Its numbers clamped to a range.
    #[must_use]
    pub fn clamp(self, least: f64, most: f64) -> Self {
        Self {
            low: self.low.clamp(least, most),
            high: self.high.clamp(least, most),
        }
    }

    /// The square.
    #[must_use]
    #[inline]
    pub fn square(self) -> Self {
        if self.is_point() {
            return self * self;
        }
        let (a, b) = (self.low.abs(), self.high.abs());
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        if self.low > 0.0 || self.high < 0.0 {
            Self::outward(near * near, far * far).at_least_zero()
        } else {
            Self::outward(0.0, far * far).at_least_zero()
        }
    }

    /// The square root of the numbers that are not negative.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let (low, high) = (self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        if self.is_point() && two_product(low, low) == (self.low, 0.0) {
            return Self::point(low);
        }
        Self::outward(low, high).at_least_zero()
    }

    /// `max(0, x)^exponent` with x at most 1: Phong's highlight, which is 0 for x ≤ 0 unless the
    /// exponent is 0.
    ///
    /// The `pow` of `libm` is that of FreeBSD (`e_pow.c`), whose error is stated to be below 0.70
    /// units in the last place; two units are allowed to either side.
    #[must_use]
    pub fn highlight(self, exponent: f64) -> Self {
        if exponent == 0.0 {
            return Self::ONE;
        }
        let end = |x: f64| {
            if x <= 0.0 {
                0.0
            } else {
                pow(x.min(1.0), exponent)
            }
        };
        // 0 and 1 are exact.
        let (low, high) = (end(self.low), end(self.high));
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

    /// The same without what rounding added below 0.
    #[inline]
    fn at_least_zero(self) -> Self {
        Self {
            low: self.low.max(0.0),
            ..self
        }
    }

    /// ⌊255·x⌋ for x clamped to [0, 1], if it is the same for all its numbers.
    #[must_use]
    pub fn level(self) -> Option<u8> {
        let (low, high) = (level(self.low), level(self.high));
        (low == high).then_some(low)
    }
}

/// ⌊255·x⌋ for x clamped to [0, 1], of the exact product.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 0 and 255"
)]
fn level(x: f64) -> u8 {
    let (product, error) = two_product(x.clamp(0.0, 1.0), 255.0);
    let floor = product.floor();
    if floor == product && error < 0.0 {
        (floor - 1.0) as u8
    } else {
        floor as u8
    }
}

impl From<f64> for Enclosure {
    fn from(value: f64) -> Self {
        Self::point(value)
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
                return Self::point(sum);
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
const EXACT: std::ops::Range<f64> = 1e-250..1e250;

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
                return Self::point(product);
            }
        }
        let ends = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        // 0·∞ leaves no bound.
        if ends.iter().any(|end| end.is_nan()) {
            return Self::ALL;
        }
        let [a, b, c, d] = ends;
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

impl Div for Enclosure {
    type Output = Self;

    /// Any number if the divisor may be 0.
    fn div(self, other: Self) -> Self {
        if !(other.is_positive() || other.is_negative()) {
            return Self::ALL;
        }
        if self.is_zero() || other == Self::ONE {
            return self;
        }
        if self.is_point() && other.is_point() {
            let quotient = self.low / other.low;
            let is_normal = EXACT.contains(&self.low.abs()) && EXACT.contains(&quotient.abs());
            if is_normal && two_product(quotient, other.low) == (self.low, 0.0) {
                return Self::point(quotient);
            }
        }
        let ends = [
            self.low / other.low,
            self.low / other.high,
            self.high / other.low,
            self.high / other.high,
        ];
        if ends.iter().any(|end| end.is_nan()) {
            return Self::ALL;
        }
        let [a, b, c, d] = ends;
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }
}

/// A vector of enclosures: a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnclosureVector(pub [Enclosure; 3]);

impl EnclosureVector {
    /// One vector, which must be finite.
    #[must_use]
    pub fn point(vector: Vec3) -> Self {
        Self(vector.to_array().map(Enclosure::point))
    }

    /// The scalar product.
    #[must_use]
    #[inline]
    pub fn dot(self, other: Self) -> Enclosure {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    /// The vector product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The square of the length.
    #[must_use]
    #[inline]
    pub fn square(self) -> Enclosure {
        let [x, y, z] = self.0.map(Enclosure::square);
        x + y + z
    }

    /// The length.
    #[must_use]
    pub fn length(self) -> Enclosure {
        self.square().sqrt()
    }

    /// The unit vector along it; its components have no bound if it may be 0.
    #[must_use]
    pub fn normalized(self) -> Self {
        let length = self.length();
        // A component of a unit vector is at most 1.
        Self(self.0.map(|x| (x / length).clamp(-1.0, 1.0)))
    }

    /// A vector about in the middle, and a bound on the distance of the others.
    #[must_use]
    pub fn middle(self) -> (Vec3, f64) {
        let [x, y, z] = self.0.map(Enclosure::middle);
        let radius = (x.1 + y.1 + z.1) * (1.0 + 4.0 * U);
        (Vec3::new(x.0, y.0, z.0), radius)
    }
}

impl Neg for EnclosureVector {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl Add for EnclosureVector {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl Sub for EnclosureVector {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul<Enclosure> for EnclosureVector {
    type Output = Self;

    #[inline]
    fn mul(self, factor: Enclosure) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rtc_math::DoubleDouble;

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
            let enclosure = Enclosure::between(x, x + width).highlight(f64::from(exponent));
            prop_assert!(holds(enclosure, power), "{x}^{exponent}");
        }

        #[test]
        fn a_unit_vector_of_a_box_holds_that_of_its_corner(x in -9.0..9.0, y in -9.0..9.0) {
            let corner = Vec3::new(x, y, 1.5);
            let wide = corner.to_array().map(|k: f64| Enclosure::between(k, k + 1e-9));
            let unit = EnclosureVector(wide).normalized();
            for (axis, part) in corner.normalize().to_array().into_iter().enumerate() {
                let Enclosure { low, high } = unit.0[axis];
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
