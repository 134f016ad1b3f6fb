//! The number types of the baseline formulas, f32 and f64, and their vectors.

use rtc_math::Vec3;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A binary floating-point number. Every operation gives the same bits on every machine.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// From 1 to the next number.
    const EPSILON: Self;

    /// The nearest number.
    #[must_use]
    fn of(x: f64) -> Self;

    /// The same number in f64.
    #[must_use]
    fn wide(self) -> f64;

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

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

macro_rules! real {
    ($real:ty, $nearest:path, $cbrt:path, $cos:path, $acos:path) => {
        impl Real for $real {
            const EPSILON: Self = Self::EPSILON;

            #[inline]
            fn of(x: f64) -> Self {
                $nearest(x)
            }

            #[inline]
            fn wide(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn sqrt(self) -> Self {
                self.sqrt()
            }

            #[inline]
            fn abs(self) -> Self {
                self.abs()
            }

            fn cbrt(self) -> Self {
                $cbrt(self)
            }

            fn cos(self) -> Self {
                $cos(self)
            }

            fn acos(self) -> Self {
                $acos(self)
            }
        }
    };
}

real!(f32, narrow, libm::cbrtf, libm::cosf, libm::acosf);
real!(
    f64,
    std::convert::identity,
    libm::cbrt,
    libm::cos,
    libm::acos
);

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what the choice of f32 asks for"
)]
fn narrow(x: f64) -> f32 {
    x as f32
}

/// A vector or a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<R> {
    pub(in crate::shape) x: R,
    pub(in crate::shape) y: R,
    pub(in crate::shape) z: R,
}

impl<R: Real> Vector<R> {
    /// Each component rounded to the nearest number.
    #[inline]
    pub(crate) fn of(v: Vec3) -> Self {
        Self {
            x: R::of(v.x),
            y: R::of(v.y),
            z: R::of(v.z),
        }
    }

    #[inline]
    pub(in crate::shape) fn wide(self) -> Vec3 {
        Vec3::new(self.x.wide(), self.y.wide(), self.z.wide())
    }

    #[inline]
    pub(in crate::shape) fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline]
    pub(in crate::shape) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// The vector of length 1 along this one; not a number for one without a length.
    #[inline]
    pub(in crate::shape) fn normalized(self) -> Self {
        self * (R::of(1.0) / self.dot(self).sqrt())
    }
}

impl<R: Real> Add for Vector<R> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl<R: Real> Sub for Vector<R> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl<R: Real> Mul<R> for Vector<R> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: R) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }
}

impl<R: Real> Neg for Vector<R> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }
}
