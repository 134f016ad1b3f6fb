//! The triangle of Möller, Trumbore, "Fast, minimum storage ray/triangle intersection" (JGT 2,
//! 1997).

use super::ray::PlainRay;
use super::real::{Real, Vector};
use crate::math::Vec3;

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Triangle<R> {
    corner: Vector<R>,
    edges: [Vector<R>; 2],
}

impl<R: Real> Triangle<R> {
    pub(in crate::render) fn new(vertices: &[Vec3; 3]) -> Self {
        let [a, b, c] = vertices.map(Vector::of);
        Self {
            corner: a,
            edges: [b - a, c - a],
        }
    }

    #[inline]
    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<R> {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let [first, second] = self.edges;
        let across = ray.direction.cross(second);
        let determinant = first.dot(across);
        if determinant == zero {
            return None;
        }
        let inverse = one / determinant;
        let from_corner = ray.origin - self.corner;
        let u = from_corner.dot(across) * inverse;
        if u < zero || u > one {
            return None;
        }
        let upward = from_corner.cross(first);
        let v = ray.direction.dot(upward) * inverse;
        if v < zero || u + v > one {
            return None;
        }
        let t = second.dot(upward) * inverse;
        ray.counts(t).then_some(t)
    }

    pub(super) fn normal(&self) -> Vector<R> {
        self.edges[0].cross(self.edges[1]).normalized()
    }
}
