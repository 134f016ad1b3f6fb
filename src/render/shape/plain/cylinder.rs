//! The capped cylinder: the quadratic of what is left of ray and point across the axis, and two
//! discs.

use super::plane::Disc;
use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::roots::quadratic;
use crate::math::Vec3;

/// The parts: side, base and top.
const PARTS: [u32; 3] = [0, 1, 2];

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Cylinder<R> {
    base: Vector<R>,
    axis: Vector<R>,
    height: R,
    radius: R,
    caps: [Disc<R>; 2],
}

impl<R: Real> Cylinder<R> {
    pub(in crate::render) fn new(base: Vec3, unit_axis: Vec3, height: f64, radius: f64) -> Self {
        let cap = |center: Vec3, normal: Vec3| Disc::new(center, normal, radius);
        Self {
            base: Vector::of(base),
            axis: Vector::of(unit_axis),
            height: R::of(height),
            radius: R::of(radius),
            caps: [
                cap(base, -unit_axis),
                cap(base + unit_axis * height, unit_axis),
            ],
        }
    }

    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let [side, base, top] = PARTS;
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let (from_axis, across) = (f - self.axis * above, ray.direction - self.axis * rise);
        let b = R::of(2.0) * from_axis.dot(across);
        let c = from_axis.dot(from_axis) - self.radius * self.radius;
        let none = R::of(f64::NAN);
        let within = |t: R| {
            let height = above + rise * t;
            if height >= R::of(0.0) && height <= self.height {
                t
            } else {
                none
            }
        };
        let [first, second] = quadratic(across.dot(across), b, c)?.map(within);
        let [low, high] = self.caps.map(|cap| cap.parameter(ray));
        ray.first([(first, side), (second, side), (low, base), (high, top)])
    }

    pub(super) fn normal(&self, point: Vector<R>, prim_id: u32) -> Vector<R> {
        let local = point - self.base;
        match prim_id {
            1 | 2 => self.caps[prim_id as usize - 1].plane.normal,
            _ => (local - self.axis * local.dot(self.axis)).normalized(),
        }
    }
}
