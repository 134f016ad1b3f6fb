//! Four vectors at once, one in each lane. Every operation is that of one vector in the same order,
//! so that each lane has its bits.

use crate::math::Vec3;
use crate::render::ray::Ray;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};

/// How many lanes there are.
pub(in crate::render) const LANES: usize = 4;

/// The bits of all lanes.
pub(in crate::render) const ALL: u64 = 0b1111;

/// Four vectors.
#[derive(Clone, Copy)]
pub(in crate::render) struct Vectors<S: Simd> {
    pub(in crate::render) x: f64x4<S>,
    pub(in crate::render) y: f64x4<S>,
    pub(in crate::render) z: f64x4<S>,
}

impl<S: Simd> Vectors<S> {
    /// One vector in all lanes.
    #[inline(always)]
    pub(in crate::render) fn splat(simd: S, v: Vec3) -> Self {
        Self {
            x: f64x4::splat(simd, v.x),
            y: f64x4::splat(simd, v.y),
            z: f64x4::splat(simd, v.z),
        }
    }

    /// A vector in each lane.
    #[inline(always)]
    pub(in crate::render) fn each(simd: S, v: [Vec3; LANES]) -> Self {
        Self {
            x: f64x4::simd_from(simd, v.map(|v| v.x)),
            y: f64x4::simd_from(simd, v.map(|v| v.y)),
            z: f64x4::simd_from(simd, v.map(|v| v.z)),
        }
    }

    /// The vector of a lane.
    #[inline(always)]
    pub(in crate::render) fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    #[inline(always)]
    pub(in crate::render) fn plus(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }

    #[inline(always)]
    pub(in crate::render) fn minus(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }

    /// The products of each number and each vector.
    #[inline(always)]
    pub(in crate::render) fn times(self, by: f64x4<S>) -> Self {
        Self {
            x: self.x * by,
            y: self.y * by,
            z: self.z * by,
        }
    }

    /// The products of the coordinates.
    #[inline(always)]
    pub(in crate::render) fn times_each(self, other: Self) -> Self {
        Self {
            x: self.x * other.x,
            y: self.y * other.y,
            z: self.z * other.z,
        }
    }

    #[inline(always)]
    pub(in crate::render) fn over(self, by: f64x4<S>) -> Self {
        Self {
            x: self.x / by,
            y: self.y / by,
            z: self.z / by,
        }
    }

    #[inline(always)]
    pub(in crate::render) fn negated(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }

    #[inline(always)]
    pub(in crate::render) fn abs(self) -> Self {
        Self {
            x: self.x.abs(),
            y: self.y.abs(),
            z: self.z.abs(),
        }
    }

    /// The sum of the coordinates.
    #[inline(always)]
    pub(in crate::render) fn sum(self) -> f64x4<S> {
        self.x + self.y + self.z
    }

    #[inline(always)]
    pub(in crate::render) fn dot(self, other: Self) -> f64x4<S> {
        self.times_each(other).sum()
    }

    #[inline(always)]
    pub(in crate::render) fn length(self) -> f64x4<S> {
        self.dot(self).sqrt()
    }

    /// The vectors of `self` in the lanes of a mask, those of `other` elsewhere.
    #[inline(always)]
    pub(in crate::render) fn where_else(self, mask: mask64x4<S>, other: Self) -> Self {
        Self {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            z: mask.select(self.z, other.z),
        }
    }
}

/// Four rays.
#[derive(Clone, Copy)]
pub(in crate::render) struct FourRays<S: Simd> {
    pub(in crate::render) origin: Vectors<S>,
    pub(in crate::render) direction: Vectors<S>,
}

impl<S: Simd> FourRays<S> {
    /// A ray in each lane.
    #[inline(always)]
    pub(in crate::render) fn each(simd: S, rays: &[Ray; LANES]) -> Self {
        Self {
            origin: Vectors::each(simd, rays.map(|ray| ray.origin)),
            direction: Vectors::each(simd, rays.map(|ray| ray.direction)),
        }
    }

    /// The ray of a lane.
    #[inline(always)]
    pub(in crate::render) fn lane(&self, lane: usize) -> Ray {
        Ray {
            origin: self.origin.lane(lane),
            direction: self.direction.lane(lane),
        }
    }
}

/// The lanes whose bits are set, one after the other.
#[inline(always)]
pub(in crate::render) fn lanes_of(bits: u64) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| bits >> lane & 1 == 1)
}
