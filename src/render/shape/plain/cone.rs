//! The capped cone: the quadratic of ρ² = (k·m)², with m the height left to the apex, and a disc.

use super::plane::Disc;
use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::roots::quadratic;
use crate::math::Vec3;

/// The parts: side and base.
const PARTS: [u32; 2] = [0, 1];

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Cone<R> {
    base: Vector<R>,
    axis: Vector<R>,
    height: R,
    /// Radius over height.
    slope: R,
    cap: Disc<R>,
}

impl<R: Real> Cone<R> {
    pub(in crate::render) fn new(base: Vec3, up: Vec3, radius: f64) -> Self {
        let height = up.length();
        let axis = up / height;
        Self {
            base: Vector::of(base),
            axis: Vector::of(axis),
            height: R::of(height),
            slope: R::of(radius / height),
            cap: Disc::new(base, -axis, radius),
        }
    }

    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let [side, base] = PARTS;
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let (from_axis, across) = (f - self.axis * above, ray.direction - self.axis * rise);
        // Subtract the square of the cone's own radius, slope·(height − above − rise·t).
        let (width, narrowing) = (self.slope * (self.height - above), self.slope * rise);
        let a = across.dot(across) - narrowing * narrowing;
        let b = R::of(2.0) * (from_axis.dot(across) + width * narrowing);
        let c = from_axis.dot(from_axis) - width * width;
        let none = R::of(f64::NAN);
        let within = |t: R| {
            let height = above + rise * t;
            if height >= R::of(0.0) && height <= self.height {
                t
            } else {
                none
            }
        };
        let [first, second] = quadratic(a, b, c)?.map(within);
        ray.first([
            (first, side),
            (second, side),
            (self.cap.parameter(ray), base),
        ])
    }

    pub(super) fn normal(&self, point: Vector<R>, prim_id: u32) -> Vector<R> {
        if prim_id == PARTS[1] {
            return self.cap.plane.normal;
        }
        let local = point - self.base;
        let from_axis = local - self.axis * local.dot(self.axis);
        (from_axis.normalized() + self.axis * self.slope).normalized()
    }
}
