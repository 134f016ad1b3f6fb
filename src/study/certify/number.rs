//! What the evaluation asks of a number that stands for a set of real numbers.

use rtc_math::Number;
use std::fmt::Debug;
use std::ops::{BitAnd, BitOr, BitXor, Not};

/// What is known of a condition on all numbers of a set.
#[derive(Clone, Copy)]
pub struct Certainty {
    can_hold: bool,
    can_fail: bool,
}

impl Certainty {
    /// A condition that certainly holds, certainly fails, or may do either.
    #[must_use]
    pub fn new(holds: bool, fails: bool) -> Self {
        Self {
            can_hold: !fails,
            can_fail: !holds,
        }
    }

    /// The numbers of `yes` if the condition holds, those of `no` if it fails, and of both if
    /// either may be.
    #[must_use]
    pub fn select<N: CertifiedNumber>(self, yes: N, no: N) -> N {
        match (self.can_hold, self.can_fail) {
            (true, true) => yes.hull(no),
            (true, false) => yes,
            (false, _) => no,
        }
    }
}

impl Not for Certainty {
    type Output = Self;

    fn not(self) -> Self {
        Self {
            can_hold: self.can_fail,
            can_fail: self.can_hold,
        }
    }
}

impl BitAnd for Certainty {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self {
            can_hold: self.can_hold && other.can_hold,
            can_fail: self.can_fail || other.can_fail,
        }
    }
}

impl BitOr for Certainty {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        !(!self & !other)
    }
}

impl BitXor for Certainty {
    type Output = Self;

    fn bitxor(self, other: Self) -> Self {
        (self & !other) | (!self & other)
    }
}

/// A set of real numbers. Each operation contains the results of the real operation on all numbers
/// of its operands; the square root is that of the numbers that are not negative.
pub trait CertifiedNumber: Number<Mask = Certainty> + Debug + PartialEq + Send + Sync {
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
