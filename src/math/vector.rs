//! Vectors of numbers.

use super::{Double, Number, Vec3, difference_of_products};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A vector or a point over a [`Number`]: in lanes, one in each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<N> {
    /// The first coordinate.
    pub x: N,
    /// The second.
    pub y: N,
    /// The third.
    pub z: N,
}

impl<N> From<[N; 3]> for Vector<N> {
    #[inline(always)]
    fn from([x, y, z]: [N; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<N> Vector<N> {
    /// Its coordinates.
    #[inline(always)]
    pub fn into_array(self) -> [N; 3] {
        [self.x, self.y, self.z]
    }

    /// A function of each coordinate.
    #[inline(always)]
    pub fn map<M>(self, function: impl Fn(N) -> M) -> Vector<M> {
        Vector {
            x: function(self.x),
            y: function(self.y),
            z: function(self.z),
        }
    }

    /// A function of each coordinate and that of another vector.
    #[inline(always)]
    fn zip<M>(self, other: Self, function: impl Fn(N, N) -> M) -> Vector<M> {
        Vector {
            x: function(self.x, other.x),
            y: function(self.y, other.y),
            z: function(self.z, other.z),
        }
    }
}

impl<N: Number> Vector<N> {
    /// One vector in as many lanes as `like` has.
    #[inline(always)]
    #[must_use]
    pub fn constant(like: N, v: Vec3) -> Self {
        Self {
            x: like.constant(v.x),
            y: like.constant(v.y),
            z: like.constant(v.z),
        }
    }

    /// The coordinate along an axis, 0 to 2.
    #[inline(always)]
    #[must_use]
    pub fn along(self, axis: usize) -> N {
        self.into_array()[axis]
    }

    /// The products of the coordinates.
    #[inline(always)]
    #[must_use]
    pub fn times_each(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }

    /// The sum of the coordinates.
    #[inline(always)]
    #[must_use]
    pub fn sum(self) -> N {
        self.x + self.y + self.z
    }

    /// The scalar product.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> N {
        self.times_each(other).sum()
    }

    /// The vector product.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        self.cross_by(other, |a, b, c, d| a * b - c * d)
    }

    /// The vector product, whose coordinates are differences a·b − c·d by a function.
    #[inline(always)]
    pub(crate) fn cross_by(self, other: Self, difference: impl Fn(N, N, N, N) -> N) -> Self {
        Self {
            x: difference(self.y, other.z, self.z, other.y),
            y: difference(self.z, other.x, self.x, other.z),
            z: difference(self.x, other.y, self.y, other.x),
        }
    }

    /// The square of the length.
    #[inline(always)]
    #[must_use]
    pub fn square(self) -> N {
        self.map(N::square).sum()
    }

    /// The length.
    #[inline(always)]
    #[must_use]
    pub fn length(self) -> N {
        self.square().sqrt()
    }

    /// The vectors of `self` where a condition holds, those of `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn select(self, mask: N::Mask, other: Self) -> Self {
        self.zip(other, |yes, no| N::select(mask, yes, no))
    }
}

impl<N: Double> Vector<N> {
    /// The vector of a lane.
    #[inline(always)]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }

    /// Replaces the vector of a lane.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, v: Vec3) {
        self.x.put(lane, v.x);
        self.y.put(lane, v.y);
        self.z.put(lane, v.z);
    }

    /// The absolute values of the coordinates.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(N::abs)
    }

    /// The vector product, each coordinate to within 2 u of itself.
    #[inline(always)]
    #[must_use]
    pub fn accurate_cross(self, other: Self) -> Self {
        self.cross_by(other, difference_of_products)
    }

    /// The unit vectors along them, and where there is one.
    #[inline(always)]
    pub fn try_normalize(self) -> (N::Mask, Self) {
        let number = |x: f64| self.x.constant(x);
        let inverse = number(1.0) / self.length();
        let has = number(0.0).less(inverse) & inverse.less(number(f64::INFINITY));
        (has, self * inverse)
    }
}

impl<N: Neg<Output = N>> Neg for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(N::neg)
    }
}

impl<N: Add<Output = N>> Add for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, N::add)
    }
}

impl<N: Sub<Output = N>> Sub for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, N::sub)
    }
}

impl<N: Copy + Mul<Output = N>> Mul<N> for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        self.map(|x| x * factor)
    }
}

impl<N: Copy + Div<Output = N>> Div<N> for Vector<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, divisor: N) -> Self {
        self.map(|x| x / divisor)
    }
}
