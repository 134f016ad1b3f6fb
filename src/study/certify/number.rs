//! What the evaluation asks of a number that stands for a set of real numbers.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A set of real numbers. Each operation contains the results of the real operation on all numbers
/// of its operands.
pub trait CertifiedNumber:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Any real number.
    const ALL: Self;
    /// Any real number from 0 on.
    const NONNEGATIVE: Self;

    /// One number, which must be finite.
    fn point(value: f64) -> Self;

    /// The numbers from `low` to `high`; any number if one is NaN or they are in the wrong order.
    fn between(low: f64, high: f64) -> Self;

    /// A lower bound.
    fn low(self) -> f64;

    /// An upper bound.
    fn high(self) -> f64;

    /// A bound on the distance of two of its numbers.
    fn width(self) -> f64;

    /// One of its numbers, about in the middle.
    #[must_use]
    fn center(self) -> Self;

    /// Whether it is 0 and nothing else.
    fn is_zero(self) -> bool;

    /// Whether all its numbers are above 0.
    fn is_positive(self) -> bool;

    /// Whether all its numbers are below 0.
    fn is_negative(self) -> bool;

    /// Whether all its numbers are below all of another.
    fn is_below(self, other: Self) -> bool;

    /// Both, and what lies between.
    #[must_use]
    fn hull(self, other: Self) -> Self;

    /// Its numbers clamped to a range; it may keep numbers outside of the range if it has some
    /// within.
    #[must_use]
    fn clamp(self, least: f64, most: f64) -> Self;

    /// The square.
    #[must_use]
    fn square(self) -> Self;

    /// The square root of the numbers that are not negative.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `max(0, x)^exponent` with x at most 1 and an exponent of at least 0: 0 for x ≤ 0 unless the
    /// exponent is 0.
    #[must_use]
    fn power(self, exponent: Self) -> Self;

    /// ⌊255·x⌋ for x clamped to [0, 1], if it is the same for all its numbers.
    fn level(self) -> Option<u8>;

    /// The cosine and the sine of an angle in units of 2⁻⁶⁴ turns.
    fn cos_sin(turns: u64) -> [Self; 2];

    /// The angle of the point (x, y), as a part of a turn in [−½, ½]; any number where it jumps.
    fn turns(y: Self, x: Self) -> Self;

    /// Whether its numbers are all positive or all negative.
    fn has_sign(self) -> bool {
        self.is_positive() || self.is_negative()
    }

    /// The largest whole numbers not above its numbers, the first and the last; `None` if it has no
    /// bound.
    fn floors(self) -> Option<[f64; 2]> {
        let [low, high] = [self.low().floor(), self.high().floor()];
        (low.is_finite() && high.is_finite()).then_some([low, high])
    }
}
