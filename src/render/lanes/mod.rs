//! Four rays and vectors in lanes. Every operation has the order of its scalar form, so each lane
//! has the same bits.

pub(crate) mod pow;

use crate::ray::{Interaction, Interactions, Ray, Rays};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};
use rtc_math::{Vec3, Vector};

/// The number of lanes.
pub(crate) const LANES: usize = 4;

/// The bits of all lanes.
pub(crate) const ALL: u64 = 0b1111;

/// Four vectors.
pub(crate) type FourVectors<S> = Vector<f64x4<S>>;

/// One vector in all lanes.
#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, v: Vec3) -> FourVectors<S> {
    Vector::constant(f64x4::splat(simd, 0.0), v)
}

/// A vector in each lane.
#[inline(always)]
pub(crate) fn each<S: Simd>(simd: S, v: [Vec3; LANES]) -> FourVectors<S> {
    Vector {
        x: f64x4::simd_from(simd, v.map(|v| v.x)),
        y: f64x4::simd_from(simd, v.map(|v| v.y)),
        z: f64x4::simd_from(simd, v.map(|v| v.z)),
    }
}

/// Four rays.
pub(crate) type Ray4<S> = Rays<f64x4<S>>;

/// A ray in each lane.
#[inline(always)]
pub(crate) fn four_rays<S: Simd>(simd: S, rays: &[Ray; LANES]) -> Ray4<S> {
    Rays {
        origin: each(simd, rays.map(|ray| ray.origin)),
        direction: each(simd, rays.map(|ray| ray.direction)),
    }
}

/// An interaction in each lane.
#[inline(always)]
pub(crate) fn four_interactions<S: Simd>(
    simd: S,
    all: &[Interaction; LANES],
) -> Interactions<f64x4<S>> {
    Interactions {
        point: each(simd, all.map(|at| at.point)),
        normal: each(simd, all.map(|at| at.normal)),
        offset: f64x4::simd_from(simd, all.map(|at| at.offset)),
        back: each(simd, all.map(|at| at.back)),
    }
}

/// The lanes whose bits are set, one after the other.
#[inline(always)]
pub(crate) fn lanes_of(bits: u64) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| bits >> lane & 1 == 1)
}
