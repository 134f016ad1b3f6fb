//! Lookup in the ray-cone cache for four rays at once. Four-lane shape tests cost less than
//! building a cone for few rays, so after a cone with few uses some rays skip the cache.

use super::{BoundingSpheres, LEVELS, ONE, RayCone, RayConeCache, Shaft};
use crate::accel::bounds::BoundingSphere;
use crate::lanes::{FourVectors, LANES, Ray4, lanes_of, splat};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

impl RayCone {
    /// The lanes whose rays the cone contains.
    #[inline(always)]
    fn holds_each<S: Simd>(&self, simd: S, rays: &Ray4<S>) -> u64 {
        let from = rays.origin - splat(simd, self.origin);
        let along = rays.direction - splat(simd, self.direction);
        let is_near = from.dot(from).simd_le(f64x4::splat(simd, self.near));
        let is_alike = along.dot(along).simd_le(f64x4::splat(simd, self.alike));
        (is_near & is_alike).to_bitmask()
    }
}

impl Shaft {
    /// The lanes whose points the cone contains.
    #[inline(always)]
    fn holds_each<S: Simd>(&self, light: usize, from: FourVectors<S>) -> u64 {
        if self.light != light {
            return 0;
        }
        let step = from - splat(from.x.simd, self.from);
        let is_near = step.dot(step).simd_le(f64x4::splat(from.x.simd, self.near));
        is_near.to_bitmask()
    }
}

impl RayConeCache {
    /// As [`Self::along`], for the rays of some lanes: those that a cone contains, and the items
    /// that one of them may hit.
    #[inline(always)]
    pub(crate) fn along_each<S: Simd>(
        &mut self,
        simd: S,
        balls: &BoundingSpheres,
        bounce: usize,
        rays: &Ray4<S>,
        active: u64,
    ) -> (u64, u64) {
        let cone = &mut self.cones[bounce % LEVELS];
        let (mut answered, mut items, mut left) = (0, 0, active);
        let mut contained = active & cone.holds_each(simd, rays);
        while left != 0 {
            if contained == 0 && cone.pace.pauses(left.count_ones()) {
                return (answered | (left & are_sound(simd, rays)), balls.all);
            }
            if contained == 0 {
                let lane = left.trailing_zeros() as usize;
                contained = 1 << lane;
                let Some(around) = cone.around(&rays.lane(lane), balls) else {
                    (left, contained) = (left & !contained, 0);
                    continue;
                };
                *cone = around;
                contained |= left & cone.holds_each(simd, rays);
            }
            cone.pace.uses += contained.count_ones();
            (answered, items) = (answered | contained, items | cone.items);
            (left, contained) = (left & !contained, 0);
        }
        (answered, items)
    }

    /// As [`Self::towards`], from the points of some lanes: 0 in the others.
    #[inline(always)]
    pub(crate) fn towards_each<S: Simd>(
        &mut self,
        balls: &BoundingSpheres,
        [bounce, light, lights]: [usize; 3],
        from: FourVectors<S>,
        active: u64,
        target: impl Fn() -> BoundingSphere,
    ) -> [u64; LANES] {
        let shaft = self.shaft([bounce, light, lights]);
        let mut items = [0; LANES];
        let mut contained = active & shaft.holds_each(light, from);
        let mut left = active;
        while left != 0 {
            if contained == 0 && shaft.pace.pauses(left.count_ones()) {
                lanes_of(left).for_each(|lane| items[lane] = balls.all);
                return items;
            }
            if contained == 0 {
                let lane = left.trailing_zeros() as usize;
                *shaft = shaft.around(balls, light, from.lane(lane), &target());
                contained = 1 << lane | (left & shaft.holds_each(light, from));
            }
            for lane in lanes_of(contained) {
                items[lane] = shaft.items;
            }
            shaft.pace.uses += contained.count_ones();
            (left, contained) = (left & !contained, 0);
        }
        items
    }
}

/// The lanes whose rays a cone can be around.
#[inline(always)]
fn are_sound<S: Simd>(simd: S, rays: &Ray4<S>) -> u64 {
    let number = |x: f64| f64x4::splat(simd, x);
    let is_finite = rays.origin.abs().sum().simd_lt(number(f64::INFINITY));
    let length2 = rays.direction.dot(rays.direction);
    let is_unit = (length2 - number(1.0)).abs().simd_le(number(ONE));
    (is_finite & is_unit).to_bitmask()
}
