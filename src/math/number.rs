//! Numbers with a range guaranteed by their type; and the parsing and printing of numbers.

use std::fmt::{Display, LowerExp};

/// A finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Positive(f64);

impl Positive {
    /// 1.
    pub const ONE: Self = Self(1.0);

    /// `None` unless the value is finite and above 0.
    #[must_use]
    pub const fn new(value: f64) -> Option<Self> {
        if value > 0.0 && value.is_finite() {
            Some(Self(value))
        } else {
            None
        }
    }

    /// The same number; 1 for one out of range.
    #[must_use]
    pub const fn or_one(value: f64) -> Self {
        match Self::new(value) {
            Some(number) => number,
            None => Self::ONE,
        }
    }

    /// The number.
    #[must_use]
    #[inline]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A finite number of at least 0; never −0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct NonNegative(f64);

impl NonNegative {
    /// 0.
    pub const ZERO: Self = Self(0.0);

    /// 1.
    pub const ONE: Self = Self(1.0);

    /// The nearest to a value; 0 for NaN.
    #[must_use]
    pub const fn saturating(value: f64) -> Self {
        Self(if value > 0.0 {
            value.min(f64::MAX)
        } else {
            0.0
        })
    }

    /// The product with a number, 0 if that is negative.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self(self.0 * factor.clamp(0.0, f64::MAX / self.0.max(1.0)))
    }

    /// `None` unless the value is finite and at least 0.
    #[must_use]
    pub fn new(value: f64) -> Option<Self> {
        (value >= 0.0 && value.is_finite()).then_some(Self(value + 0.0))
    }

    /// The number.
    #[must_use]
    #[inline]
    pub fn get(self) -> f64 {
        self.0
    }
}

impl From<UnitInterval> for NonNegative {
    fn from(fraction: UnitInterval) -> Self {
        Self(fraction.0)
    }
}

impl From<Positive> for f64 {
    fn from(number: Positive) -> Self {
        number.get()
    }
}

impl From<Positive> for NonNegative {
    fn from(number: Positive) -> Self {
        Self(number.0)
    }
}

/// A number from 0 to 1; never −0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct UnitInterval(f64);

impl UnitInterval {
    /// 0.
    pub const ZERO: Self = Self(0.0);

    /// 1.
    pub const ONE: Self = Self(1.0);

    /// `None` unless the value is from 0 to 1.
    #[must_use]
    pub fn new(value: f64) -> Option<Self> {
        (0.0..=1.0).contains(&value).then_some(Self(value + 0.0))
    }

    /// The nearest to a value; 0 for NaN.
    #[must_use]
    pub const fn saturating(value: f64) -> Self {
        Self(if value > 0.0 { value.min(1.0) } else { 0.0 })
    }

    /// 1 − x.
    #[must_use]
    pub fn complement(self) -> Self {
        Self(1.0 - self.0)
    }

    /// The number.
    #[must_use]
    #[inline]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// The shortest text that reads back as the same number.
#[must_use]
pub fn shortest<T: Display + LowerExp>(value: T) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    // 0.0001 and 100000 are more readable than shorter exponents.
    if plain.len() <= scientific.len() + 4 {
        plain
    } else {
        scientific
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_range_saturates_at_the_ends() {
        for (value, fraction, number) in [
            (-1.0, 0.0, 0.0),
            (0.25, 0.25, 0.25),
            (7.0, 1.0, 7.0),
            (f64::INFINITY, 1.0, f64::MAX),
            (f64::NAN, 0.0, 0.0),
        ] {
            assert_eq!(UnitInterval::saturating(value).get(), fraction, "{value}");
            assert_eq!(NonNegative::saturating(value).get(), number, "{value}");
        }
        assert!(UnitInterval::new(1.0 + f64::EPSILON).is_none());
        assert!(UnitInterval::new(f64::NAN).is_none());
        assert!(UnitInterval::new(-0.0).unwrap().get().is_sign_positive());
        assert!(UnitInterval::saturating(-0.0).get().is_sign_positive());
    }

    #[test]
    fn numbers_are_short_and_read_back() {
        for (value, text) in [
            (0.0001, "0.0001"),
            (1e5, "100000"),
            (1e-9, "1e-9"),
            (0.1 + 0.2, "0.30000000000000004"),
        ] {
            assert_eq!(shortest(value), text);
            assert_eq!(text.parse(), Ok(value));
        }
    }

    #[test]
    fn ranges_are_kept_at_their_ends() {
        assert!(Positive::new(0.0).is_none() && Positive::new(f64::INFINITY).is_none());
        assert!(Positive::new(f64::NAN).is_none() && NonNegative::new(f64::NAN).is_none());
        assert!(NonNegative::new(-f64::MIN_POSITIVE).is_none());
        assert!(NonNegative::new(-0.0).unwrap().get().is_sign_positive());
    }
}
