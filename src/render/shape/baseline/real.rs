//! The number types of the baseline formulas, f32 and f64, and their vectors.

use rtc_math::{Number, Vec3, Vector};
use std::fmt::Debug;

/// A binary floating-point number. Every operation gives the same bits on every machine.
pub trait Real: Number<Mask = bool> + Debug + PartialOrd + Send + Sync {
    /// From 1 to the next number.
    const EPSILON: Self;

    /// The nearest number.
    #[must_use]
    #[inline]
    fn of(x: f64) -> Self {
        Self::EPSILON.constant(x)
    }

    /// The same number in f64.
    #[must_use]
    fn wide(self) -> f64;

    /// The cube root.
    #[must_use]
    fn cbrt(self) -> Self;

    /// The cosine of an angle in radians.
    #[must_use]
    fn cos(self) -> Self;

    /// The arc cosine in radians.
    #[must_use]
    fn acos(self) -> Self;
}

impl Real for f32 {
    const EPSILON: Self = Self::EPSILON;

    #[inline]
    fn wide(self) -> f64 {
        f64::from(self)
    }

    fn cbrt(self) -> Self {
        libm::cbrtf(self)
    }

    fn cos(self) -> Self {
        libm::cosf(self)
    }

    fn acos(self) -> Self {
        libm::acosf(self)
    }
}

impl Real for f64 {
    const EPSILON: Self = Self::EPSILON;

    #[inline]
    fn wide(self) -> f64 {
        self
    }

    fn cbrt(self) -> Self {
        libm::cbrt(self)
    }

    fn cos(self) -> Self {
        libm::cos(self)
    }

    fn acos(self) -> Self {
        libm::acos(self)
    }
}

/// A vector or a point of the baseline formulas.
pub(crate) trait RealVector {
    /// Each coordinate rounded to the nearest number.
    fn of(v: Vec3) -> Self;

    /// The same vector in f64.
    fn wide(self) -> Vec3;

    /// The vector of length 1 along this one; not a number for one without a length.
    fn normalized(self) -> Self;
}

impl<R: Real> RealVector for Vector<R> {
    #[inline]
    fn of(v: Vec3) -> Self {
        Self::from(v.to_array().map(R::of))
    }

    #[inline]
    fn wide(self) -> Vec3 {
        Vec3::from_array(self.map(R::wide).into_array())
    }

    #[inline]
    fn normalized(self) -> Self {
        self * (R::of(1.0) / self.length())
    }
}
