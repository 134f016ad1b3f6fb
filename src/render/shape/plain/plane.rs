//! The plane N·p = N·c, and the disc in it.

use super::ray::PlainRay;
use super::real::{Real, Vector};
use crate::math::Vec3;

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Plane<R> {
    pub(super) normal: Vector<R>,
    /// N·c.
    level: R,
}

impl<R: Real> Plane<R> {
    pub(in crate::render) fn new(center: Vec3, unit_normal: Vec3) -> Self {
        let normal = Vector::of(unit_normal);
        Self {
            normal,
            level: normal.dot(Vector::of(center)),
        }
    }

    #[inline]
    pub(super) fn parameter(&self, ray: &PlainRay<R>) -> R {
        (self.level - self.normal.dot(ray.origin)) / self.normal.dot(ray.direction)
    }

    #[inline]
    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let t = self.parameter(ray);
        ray.counts(t).then_some((t, 0))
    }
}

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Disc<R> {
    pub(super) plane: Plane<R>,
    center: Vector<R>,
    radius: R,
}

impl<R: Real> Disc<R> {
    pub(in crate::render) fn new(center: Vec3, unit_normal: Vec3, radius: f64) -> Self {
        Self {
            plane: Plane::new(center, unit_normal),
            center: Vector::of(center),
            radius: R::of(radius),
        }
    }

    /// Where the line meets the disc, wherever that is along it; not a number beside the disc.
    #[inline]
    pub(super) fn parameter(&self, ray: &PlainRay<R>) -> R {
        let t = self.plane.parameter(ray);
        let local = ray.at(t) - self.center;
        if local.dot(local) <= self.radius * self.radius {
            t
        } else {
            R::of(f64::NAN)
        }
    }

    #[inline]
    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let t = self.parameter(ray);
        ray.counts(t).then_some((t, 0))
    }
}
