//! The axis-aligned plane in four lanes: the steps of [`Plane::intersect`] and
//! [`Plane::interaction`]. Other planes use the scalar code.

use super::Interactions;
use crate::lanes::{FourVectors, Ray4, lanes_of, two_difference};
use crate::shape::plane::{Plane, PlaneAxis};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};

/// As [`Plane::intersect`], for the lanes `active`; infinite for a miss.
#[inline(always)]
pub(super) fn intersect<S: Simd>(
    simd: S,
    plane: &Plane,
    axis: PlaneAxis,
    rays: &Ray4<S>,
    active: mask64x4<S>,
) -> f64x4<S> {
    let number = |x: f64| f64x4::splat(simd, x);
    let zero = number(0.0);
    let slope = number(axis.sign) * rays.direction.along(axis.index);
    // A distance of 0 gives no root above 0, whatever its sign.
    let t = distance(simd, plane, axis, rays.origin) / slope;
    let is_root = active & !slope.simd_eq(zero) & t.simd_gt(zero);
    is_root.select(t, number(f64::INFINITY))
}

/// As [`Plane::interaction`].
#[inline(always)]
pub(super) fn interactions<S: Simd>(
    simd: S,
    plane: &Plane,
    axis: PlaneAxis,
    rays: &Ray4<S>,
    t: f64x4<S>,
) -> Interactions<S> {
    let zero = f64x4::splat(simd, 0.0);
    let anchor = f64x4::splat(simd, plane.anchor[axis.index]);
    let near = rays.origin.plus(rays.direction.times(t));
    let has_zero = near.x.simd_eq(zero) | near.y.simd_eq(zero) | near.z.simd_eq(zero);
    let is_on = near.along(axis.index).simd_eq(anchor) & !has_zero;
    let distance = distance(simd, plane, axis, near);
    let step = distance / f64x4::splat(simd, plane.normal.square);
    let moved = near.plus(FourVectors::splat(simd, plane.normal.raw).times(step));
    let mut point = near.select(is_on, moved);
    let doubted = !is_on & distance.simd_eq(zero);
    if doubted.any_true() {
        for lane in lanes_of(doubted.to_bitmask()) {
            point.put(lane, plane.interaction(&rays.lane(lane), t[lane]).point);
        }
    }
    let normal = FourVectors::splat(simd, plane.normal());
    Interactions::new(simd, rays, point, normal, plane.anchor, 0.0)
}

/// N·(anchor − p), but for the sign of a 0.
#[inline(always)]
fn distance<S: Simd>(simd: S, plane: &Plane, axis: PlaneAxis, p: FourVectors<S>) -> f64x4<S> {
    let sign = f64x4::splat(simd, axis.sign);
    let anchor = f64x4::splat(simd, plane.anchor[axis.index]);
    let (step, error) = two_difference(anchor, p.along(axis.index));
    sign * step + sign * error
}
