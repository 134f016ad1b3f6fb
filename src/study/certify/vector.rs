//! Vectors of certified numbers.

use super::number::CertifiedNumber;
use rtc_math::{U, Vec3};
use std::ops::{Add, Mul, Neg, Sub};

/// A vector whose coordinates are sets of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CertifiedVector<N>(pub(super) [N; 3]);

impl<N: CertifiedNumber> CertifiedVector<N> {
    /// One vector, which must be finite.
    pub(super) fn point(vector: Vec3) -> Self {
        Self(vector.to_array().map(N::point))
    }

    /// The scalar product.
    #[inline]
    pub(super) fn dot(self, other: Self) -> N {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    /// The vector product.
    #[inline]
    pub(super) fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The square of the length.
    #[inline]
    pub(super) fn square(self) -> N {
        let [x, y, z] = self.0.map(N::square);
        x + y + z
    }

    /// The length.
    pub(super) fn length(self) -> N {
        self.square().sqrt()
    }

    /// The unit vector along it; its components have no bound but 1 if it may be 0.
    pub(super) fn normalized(self) -> Self {
        let length = self.length();
        Self(self.0.map(|x| (x / length).clamp(-1.0, 1.0)))
    }

    /// The vector over a number.
    pub(super) fn over(self, divisor: N) -> Self {
        Self(self.0.map(|x| x / divisor))
    }

    /// The sum of its coordinates times three vectors.
    pub(super) fn combined(self, [x, y, z]: [Self; 3]) -> Self {
        let [a, b, c] = self.0;
        x * a + y * b + z * c
    }

    /// A vector about in the middle, and a bound on the distance of the others.
    pub(super) fn middle(self) -> (Vec3, f64) {
        let parts = self.0.map(|part| {
            let (low, high) = (part.low(), part.high());
            let middle = 0.5 * low + 0.5 * high;
            (middle, (high - middle).max(middle - low))
        });
        let [x, y, z] = parts;
        let radius = (x.1 + y.1 + z.1) * (1.0 + 8.0 * U);
        (Vec3::new(x.0, y.0, z.0), radius)
    }
}

impl<N: CertifiedNumber> Neg for CertifiedVector<N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<N: CertifiedNumber> Add for CertifiedVector<N> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl<N: CertifiedNumber> Sub for CertifiedVector<N> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl<N: CertifiedNumber> Mul<N> for CertifiedVector<N> {
    type Output = Self;

    #[inline]
    fn mul(self, factor: N) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}
