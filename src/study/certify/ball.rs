//! Ball arithmetic of about 106 bits: a number in double-double, and a bound on the distance of
//! others (van der Hoeven, "Ball arithmetic", 2009). What 53 bits leave open is done again with it.
//!
//! The relative error of an operation of [`DoubleDouble`] is below 15 u² (Joldes, Muller, Popescu,
//! ACM TOMS 44, 2017); 64 u² are allowed.

use super::enclosure::{EXACT, Enclosure, level};
use super::number::{Certainty, CertifiedNumber};
use rtc_math::{DoubleDouble, Number, U, atan2, two_product, two_sum};
use std::f64::consts::TAU;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The relative error of an operation.
const RELATIVE: f64 = 64.0 * U * U;

/// Bounds the errors of subnormal numbers.
const SMALLEST: f64 = 1e-280;

/// More than the rounding of a few operations on radii.
const SLACK: f64 = 1.0 + 16.0 * U;

/// The numbers no further than a radius from a middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDoubleBall {
    middle: DoubleDouble,
    radius: f64,
}

impl DoubleDoubleBall {
    fn single(middle: DoubleDouble) -> Self {
        let radius = 0.0;
        Self { middle, radius }
    }

    /// The result of an operation: its middle was rounded, and its operands had radii.
    fn rounded(middle: DoubleDouble, radius: f64) -> Self {
        let radius = (radius + middle.to_f64().abs() * RELATIVE + SMALLEST) * SLACK;
        Self::with_radius(middle, radius)
    }

    /// Any number without a bound on the radius.
    fn with_radius(middle: DoubleDouble, radius: f64) -> Self {
        if radius.is_finite() && middle.to_f64().is_finite() {
            Self { middle, radius }
        } else {
            Self::ALL
        }
    }

    /// Bounds on the distance of its numbers from 0.
    fn distances(self) -> [f64; 2] {
        let size = self.middle.to_f64().abs();
        let (below, above) = (size * (1.0 - 4.0 * U), size * (1.0 + 4.0 * U));
        [
            ((below - self.radius) * (1.0 - 4.0 * U)).max(0.0),
            (above + self.radius) * SLACK,
        ]
    }

    /// The number, if it is one f64.
    fn as_f64(self) -> Option<f64> {
        let value = self.middle.to_f64();
        let is_single = self.radius == 0.0 && self.middle.rest() == 0.0;
        is_single.then_some(value)
    }

    /// The interval of its bounds.
    fn ends(self) -> Enclosure {
        Enclosure::between(self.low(), self.high())
    }
}

/// 2π.
fn tau() -> DoubleDouble {
    const REST: f64 = 2.449_293_598_294_706_4e-16;
    DoubleDouble::difference(TAU, -REST)
}

/// A number of 64 bits in units of 2⁻⁶⁴.
fn unit_fraction(number: i64) -> DoubleDouble {
    const UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;
    let (high, low) = (number >> 32, number & 0xFFFF_FFFF);
    let [high, low] = [high as f64 * 4_294_967_296.0, low as f64].map(|part| part * UNIT);
    DoubleDouble::difference(high, -low)
}

/// Taylor's series of the sine, and of the cosine, of an angle of at most π/4.
fn sin_cos_series(angle: DoubleDouble) -> [DoubleDouble; 2] {
    /// (π/4)^2n is below 2⁻¹⁰⁶·(2n)! from here on.
    const TERMS: u32 = 14;
    let one = DoubleDouble::from(1.0);
    let square = angle * angle;
    let nested = |first: u32| {
        (1..=TERMS).rev().fold(one, |sum, k| {
            let divisor = f64::from((2 * k + first) * (2 * k + first - 1));
            one - square * sum / DoubleDouble::from(divisor)
        })
    };
    [angle * nested(1), nested(0)]
}

impl Number for DoubleDoubleBall {
    type Mask = Certainty;

    #[inline]
    fn constant(self, x: f64) -> Self {
        Self::point(x)
    }

    fn sqrt(self) -> Self {
        if self.high() <= 0.0 {
            return Self::ZERO;
        }
        if !self.is_positive() {
            let high = Enclosure::between(0.0, self.high()).sqrt().high();
            return Self::between(0.0, high);
        }
        let root = self.middle.sqrt();
        let nearest = root.to_f64();
        if self
            .as_f64()
            .is_some_and(|value| two_product(nearest, nearest) == (value, 0.0))
        {
            return Self::point(nearest);
        }
        // |√x − √m| = |x − m|/(√x + √m).
        Self::rounded(root, self.radius / (nearest * (1.0 - 4.0 * U)))
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

impl CertifiedNumber for DoubleDoubleBall {
    const ZERO: Self = Self {
        middle: DoubleDouble::ZERO,
        radius: 0.0,
    };
    const ONE: Self = Self {
        middle: DoubleDouble::ONE,
        radius: 0.0,
    };
    const ALL: Self = Self {
        middle: DoubleDouble::ZERO,
        radius: f64::INFINITY,
    };
    const NONNEGATIVE: Self = Self::ALL;

    fn point(value: f64) -> Self {
        Self::single(DoubleDouble::from(value))
    }

    fn between(low: f64, high: f64) -> Self {
        if low == high {
            return Self::point(low);
        }
        let middle = 0.5 * low + 0.5 * high;
        let radius = (high - middle).max(middle - low).next_up();
        if low <= high {
            Self::with_radius(DoubleDouble::from(middle), radius)
        } else {
            Self::ALL
        }
    }

    fn low(self) -> f64 {
        -(-self).high()
    }

    fn high(self) -> f64 {
        if let Some(value) = self.as_f64() {
            return value;
        }
        let middle = self.middle.to_f64();
        (middle + (self.radius + 4.0 * U * middle.abs()) * SLACK).next_up()
    }

    fn width(self) -> f64 {
        2.0 * self.radius
    }

    fn center(self) -> Self {
        Self::single(self.middle)
    }

    fn is_zero(self) -> bool {
        self.middle.to_f64() == 0.0 && self.radius == 0.0
    }

    fn is_positive(self) -> bool {
        self.middle.to_f64() > 0.0 && self.distances()[0] > 0.0
    }

    fn is_negative(self) -> bool {
        (-self).is_positive()
    }

    fn is_below(self, other: Self) -> bool {
        (other - self).is_positive()
    }

    fn hull(self, other: Self) -> Self {
        let distance = (other.middle - self.middle).to_f64().abs();
        let radius = (distance * (1.0 + 4.0 * U) + other.radius).max(self.radius);
        Self::with_radius(self.middle, radius * SLACK)
    }

    fn clamp(self, least: f64, most: f64) -> Self {
        let [below, above] = [least, most].map(Self::point);
        if self.is_below(below) {
            return below;
        }
        if above.is_below(self) {
            return above;
        }
        // A ball that meets the range contains its own clamped numbers.
        if self.radius < most - least {
            return self;
        }
        Self::between(self.low().max(least), self.high().min(most))
    }

    /// Products for whole exponents, else the power of intervals.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number in the range"
    )]
    fn power(self, exponent: Self) -> Self {
        const MOST: f64 = 1_048_576.0;
        let whole = exponent.as_f64().filter(|n| n.fract() == 0.0 && *n <= MOST);
        let Some(whole) = whole.filter(|_| self.is_positive()) else {
            let ends = self.ends().power(exponent.ends());
            return Self::between(ends.low(), ends.high());
        };
        let (mut rest, mut power, mut product) = (whole as u32, self, Self::ONE);
        while rest > 0 {
            if rest & 1 == 1 {
                product = product * power;
            }
            power = power.square();
            rest >>= 1;
        }
        product
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 255"
    )]
    fn level(self) -> Option<u8> {
        if let Some(value) = self.as_f64() {
            return Some(level(value));
        }
        let scaled = self.clamp(0.0, 1.0) * Self::point(255.0);
        let floor = scaled.middle.to_f64().floor().clamp(0.0, 255.0);
        // The level of the nearest f64, or the one below.
        [floor, floor - 1.0].into_iter().find_map(|floor| {
            let above = scaled - Self::point(floor);
            let below = Self::point(floor + 1.0) - scaled;
            let is_first = floor == 0.0 || above.is_positive() || above.is_zero();
            let is_last = floor == 255.0 || below.is_positive();
            (is_first && is_last && floor >= 0.0).then_some(floor as u8)
        })
    }

    fn cos_sin(turns: u64) -> [Self; 2] {
        /// More than the error of the series and of the constant.
        const ERROR: f64 = 1024.0 * U * U;
        let quadrant = turns.wrapping_add(1 << 61) >> 62;
        let rest = turns.wrapping_sub(quadrant << 62).cast_signed();
        let [sine, cosine] = sin_cos_series(unit_fraction(rest) * tau());
        let [sine, cosine] = [sine, cosine].map(|middle| Self::with_radius(middle, ERROR));
        match quadrant & 3 {
            0 => [cosine, sine],
            1 => [-sine, cosine],
            2 => [-cosine, -sine],
            _ => [sine, -cosine],
        }
    }

    /// An angle of 53 bits, and the small angle to it: `tan δ = (y·cos − x·sin)/(x·cos + y·sin)`.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "it saturates at half a turn"
    )]
    fn turns(y: Self, x: Self) -> Self {
        const TURN: f64 = 18_446_744_073_709_551_616.0;
        let jumps = !x.is_positive() && !y.has_sign();
        let near = (atan2(y.middle.to_f64(), x.middle.to_f64()) / TAU * TURN) as i64;
        let [cosine, sine] = Self::cos_sin(near.cast_unsigned());
        let tangent = (y * cosine - x * sine) / (x * cosine + y * sine);
        let size = tangent.distances()[1];
        if jumps || size > 0.5 || size.is_nan() {
            return Self::ALL;
        }
        // |arctan q − q| ≤ |q|³/3.
        let radius = tangent.radius + size * size * size;
        let small = Self::with_radius(tangent.middle, radius * SLACK);
        Self::single(unit_fraction(near)) + small / Self::with_radius(tau(), U * U * 8.0)
    }
}

impl Neg for DoubleDoubleBall {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            middle: DoubleDouble::ZERO - self.middle,
            ..self
        }
    }
}

impl Add for DoubleDoubleBall {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if let (Some(a), Some(b)) = (self.as_f64(), other.as_f64())
            && (a + b).is_finite()
        {
            let (sum, error) = two_sum(a, b);
            return Self::single(DoubleDouble::difference(sum, -error));
        }
        if other.is_zero() {
            return self;
        }
        Self::rounded(self.middle + other.middle, self.radius + other.radius)
    }
}

impl Sub for DoubleDoubleBall {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDoubleBall {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let product = self.middle * other.middle;
        if let (Some(a), Some(b)) = (self.as_f64(), other.as_f64())
            && EXACT.contains(&(a * b).abs())
        {
            return Self::single(product);
        }
        let [a, b] = [self, other].map(|ball| ball.middle.to_f64().abs() * (1.0 + 4.0 * U));
        let radius = a * other.radius + b * self.radius + self.radius * other.radius;
        Self::rounded(product, radius)
    }
}

impl Div for DoubleDoubleBall {
    type Output = Self;

    /// Any number if the divisor may be 0.
    fn div(self, other: Self) -> Self {
        let [nearest, _] = other.distances();
        if nearest == 0.0 {
            return Self::ALL;
        }
        if self.is_zero() || other.as_f64() == Some(1.0) {
            return self;
        }
        let quotient = self.middle / other.middle;
        if let (Some(a), Some(b)) = (self.as_f64(), other.as_f64())
            && EXACT.contains(&a.abs())
            && two_product(a / b, b) == (a, 0.0)
        {
            return Self::point(a / b);
        }
        let size = quotient.to_f64().abs() * (1.0 + 4.0 * U);
        Self::rounded(quotient, (self.radius + size * other.radius) / nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::DoubleDoubleBall as Ball;
    use super::*;
    use proptest::prelude::*;

    /// Whether two balls that contain the same number do not contradict each other, and the first
    /// is small beside a size.
    fn agree(ball: Ball, other: Ball, size: f64) -> bool {
        let is_small = ball.width() <= 1e-28 * size;
        is_small && !ball.is_below(other) && !other.is_below(ball)
    }

    proptest! {
        #[test]
        fn operations_undo_each_other_within_their_radii(a in -9.0..9.0, b in 0.1..9.0) {
            let [x, y] = [a, b].map(Ball::point);
            let third = y / Ball::point(3.0);
            prop_assert!(agree((x + third) - third, x, 20.0));
            prop_assert!(agree((x * third) / third, x, 20.0));
            prop_assert!(agree(third.sqrt().square(), third, 20.0));
            let fifth = third * third.square().square();
            prop_assert!(agree(third.power(Ball::point(5.0)), fifth, 1e5));
        }

        #[test]
        fn operations_lie_in_those_of_intervals(a in -9.0..9.0, b in 0.1..9.0, n in 0.0..40.0) {
            let [x, y] = [a, b].map(Enclosure::point);
            let [p, q] = [a, b].map(Ball::point);
            let turns = |x: u64| [Ball::cos_sin(x)[0], Ball::cos_sin(x)[1]];
            let bits = (b * 1e18) as u64;
            let wide = Enclosure::cos_sin(bits);
            let power = y.power(Enclosure::point(n));
            let share = [x / y, Enclosure::turns(x, y), power, wide[0], wide[1]];
            let power = q.power(Ball::point(n));
            let ball = [p / q, Ball::turns(p, q), power, turns(bits)[0], turns(bits)[1]];
            for (wide, ball) in share.into_iter().zip(ball) {
                prop_assert!(wide.low() <= ball.high() && ball.low() <= wide.high());
            }
        }

        #[test]
        fn the_angle_of_a_direction_is_its_turn(bits in any::<u64>()) {
            let [cosine, sine] = Ball::cos_sin(bits);
            let turn = Ball::turns(sine, cosine);
            prop_assert!(agree(turn, Ball::single(unit_fraction(bits.cast_signed())), 1.0));
            prop_assert!(agree(cosine.square() + sine.square(), Ball::ONE, 1.0));
        }
    }

    #[test]
    fn levels_are_those_of_the_exact_product() {
        let fifth = Ball::point(0.2);
        // 255·0.2 is above 51 by a tenth of a unit of rounding, and so is the mean of many.
        let sum = (0..16).fold(Ball::ZERO, |sum, _| sum + fifth);
        assert_eq!((sum / Ball::point(16.0)).level(), Some(51));
        let below = Ball::ONE / Ball::point(5.0) - Ball::point(1e-25);
        assert_eq!(below.level(), Some(50));
        assert_eq!((Ball::ONE / Ball::point(5.0)).level(), None);
        assert_eq!(
            (Ball::ALL.level(), Ball::point(-3.0).level()),
            (None, Some(0))
        );
        assert_eq!(Ball::point(7.0).level(), Some(255));
    }
}
