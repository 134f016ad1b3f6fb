//! The sphere by b² − 4ac.

use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::roots::quadratic;

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Sphere<R> {
    pub(in crate::render) center: Vector<R>,
    pub(in crate::render) radius: R,
}

impl<R: Real> Sphere<R> {
    #[inline]
    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let f = ray.origin - self.center;
        let b = R::of(2.0) * f.dot(ray.direction);
        let c = f.dot(f) - self.radius * self.radius;
        let roots = quadratic(ray.length2, b, c)?;
        roots.into_iter().find(|t| ray.counts(*t)).map(|t| (t, 0))
    }

    pub(super) fn normal(&self, point: Vector<R>) -> Vector<R> {
        (point - self.center).normalized()
    }
}
