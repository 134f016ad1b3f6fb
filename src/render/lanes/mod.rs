//! Vectors of numbers, of which each may be four in lanes. Every operation has the order of its
//! scalar form, so each lane has the same bits.

pub(crate) mod number;
pub(crate) mod pow;

use crate::ray::Ray;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use number::Number;
use rtc_math::{SPLITTER, Vec3};

/// The number of lanes.
pub(crate) const LANES: usize = 4;

/// The bits of all lanes.
pub(crate) const ALL: u64 = 0b1111;

/// A vector, or a vector in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Vectors<N> {
    pub(crate) x: N,
    pub(crate) y: N,
    pub(crate) z: N,
}

/// Four vectors.
pub(crate) type FourVectors<S> = Vectors<f64x4<S>>;

impl<S: Simd> FourVectors<S> {
    /// One vector in all lanes.
    #[inline(always)]
    pub(crate) fn splat(simd: S, v: Vec3) -> Self {
        Self {
            x: f64x4::splat(simd, v.x),
            y: f64x4::splat(simd, v.y),
            z: f64x4::splat(simd, v.z),
        }
    }

    /// A vector in each lane.
    #[inline(always)]
    pub(crate) fn each(simd: S, v: [Vec3; LANES]) -> Self {
        Self {
            x: f64x4::simd_from(simd, v.map(|v| v.x)),
            y: f64x4::simd_from(simd, v.map(|v| v.y)),
            z: f64x4::simd_from(simd, v.map(|v| v.z)),
        }
    }

    /// As [`rtc_math::cross`].
    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: difference_of_products(self.y, other.z, self.z, other.y),
            y: difference_of_products(self.z, other.x, self.x, other.z),
            z: difference_of_products(self.x, other.y, self.y, other.x),
        }
    }

    /// The unit vectors along them, and the lanes that have one.
    #[inline(always)]
    pub(crate) fn normalized(self) -> (mask64x4<S>, Self) {
        let number = |x: f64| f64x4::splat(self.x.simd, x);
        let inverse = number(1.0) / self.length();
        let has = inverse.simd_gt(number(0.0)) & inverse.simd_lt(number(f64::INFINITY));
        (has, self.times(inverse))
    }
}

impl<N: Number> Vectors<N> {
    /// One vector in as many lanes as `like` has.
    #[inline(always)]
    pub(crate) fn constant(like: N, v: Vec3) -> Self {
        Self {
            x: like.constant(v.x),
            y: like.constant(v.y),
            z: like.constant(v.z),
        }
    }

    /// Replaces the vector of a lane.
    #[inline(always)]
    pub(crate) fn put(&mut self, lane: usize, v: Vec3) {
        self.x.put(lane, v.x);
        self.y.put(lane, v.y);
        self.z.put(lane, v.z);
    }

    /// The vector of a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }

    #[inline(always)]
    pub(crate) fn minus(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }

    /// The products of each number and each vector.
    #[inline(always)]
    pub(crate) fn times(self, by: N) -> Self {
        Self {
            x: self.x * by,
            y: self.y * by,
            z: self.z * by,
        }
    }

    /// The products of the coordinates.
    #[inline(always)]
    pub(crate) fn times_each(self, other: Self) -> Self {
        Self {
            x: self.x * other.x,
            y: self.y * other.y,
            z: self.z * other.z,
        }
    }

    #[inline(always)]
    pub(crate) fn over(self, by: N) -> Self {
        Self {
            x: self.x / by,
            y: self.y / by,
            z: self.z / by,
        }
    }

    #[inline(always)]
    pub(crate) fn negated(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self {
            x: self.x.abs(),
            y: self.y.abs(),
            z: self.z.abs(),
        }
    }

    /// The coordinates along an axis, 0 to 2.
    #[inline(always)]
    pub(crate) fn along(self, axis: usize) -> N {
        [self.x, self.y, self.z][axis]
    }

    /// The sum of the coordinates.
    #[inline(always)]
    pub(crate) fn sum(self) -> N {
        self.x + self.y + self.z
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> N {
        self.times_each(other).sum()
    }

    #[inline(always)]
    pub(crate) fn length(self) -> N {
        self.dot(self).sqrt()
    }

    /// The vectors of `self` in the lanes of a mask, those of `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, mask: N::Mask, other: Self) -> Self {
        Self {
            x: N::select(mask, self.x, other.x),
            y: N::select(mask, self.y, other.y),
            z: N::select(mask, self.z, other.z),
        }
    }
}

/// As [`rtc_math::two_difference`].
#[inline(always)]
pub(crate) fn two_difference<S: Simd>(a: f64x4<S>, b: f64x4<S>) -> (f64x4<S>, f64x4<S>) {
    let b = -b;
    let s = a + b;
    let b_virtual = s - a;
    (s, (a - (s - b_virtual)) + (b - b_virtual))
}

/// As [`rtc_math::difference_of_products`].
#[inline(always)]
fn difference_of_products<S: Simd>(a: f64x4<S>, b: f64x4<S>, c: f64x4<S>, d: f64x4<S>) -> f64x4<S> {
    let (p, p_error) = two_product(a, b);
    let (q, q_error) = two_product(c, d);
    (p - q) + (p_error - q_error)
}

/// The products and their rounding errors, by Dekker as in [`rtc_math::two_product`].
#[inline(always)]
fn two_product<S: Simd>(a: f64x4<S>, b: f64x4<S>) -> (f64x4<S>, f64x4<S>) {
    let p = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let e = ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (p, e)
}

/// Veltkamp's splitting into two halves.
#[inline(always)]
fn split<S: Simd>(a: f64x4<S>) -> (f64x4<S>, f64x4<S>) {
    let c = f64x4::splat(a.simd, SPLITTER) * a;
    let high = c - (c - a);
    (high, a - high)
}

/// A ray, or a ray in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Rays<N> {
    pub(crate) origin: Vectors<N>,
    pub(crate) direction: Vectors<N>,
}

/// Four rays.
pub(crate) type Ray4<S> = Rays<f64x4<S>>;

impl<S: Simd> Ray4<S> {
    /// A ray in each lane.
    #[inline(always)]
    pub(crate) fn each(simd: S, rays: &[Ray; LANES]) -> Self {
        Self {
            origin: FourVectors::each(simd, rays.map(|ray| ray.origin)),
            direction: FourVectors::each(simd, rays.map(|ray| ray.direction)),
        }
    }
}

impl Rays<f64> {
    /// One ray.
    #[inline(always)]
    pub(crate) fn one(ray: &Ray) -> Self {
        Self {
            origin: Vectors::constant(0.0, ray.origin),
            direction: Vectors::constant(0.0, ray.direction),
        }
    }
}

impl<N: Number> Rays<N> {
    /// The ray of a lane.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Ray {
        Ray {
            origin: self.origin.lane(lane),
            direction: self.direction.lane(lane),
        }
    }
}

/// The lanes whose bits are set, one after the other.
#[inline(always)]
pub(crate) fn lanes_of(bits: u64) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| bits >> lane & 1 == 1)
}
