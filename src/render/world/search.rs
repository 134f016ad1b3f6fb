//! The BVH visitors for flattened triangles: closest hit and any hit.

use super::flattened::FlattenedRay;
use super::{STOP, SurfacePrimitive};
use crate::accel::wide::{Candidate, TriangleVisitor};
use crate::shape::geometry::Intersect;
use crate::shape::tie::ClosestHit;

/// Looks for the nearest hit.
pub(super) struct ClosestSearch<'traverse, S> {
    pub(super) triangles: FlattenedRay<'traverse, S>,
    pub(super) nearest: ClosestHit<SurfacePrimitive>,
}

impl<S: Intersect> TriangleVisitor for ClosestSearch<'_, S> {
    #[inline(always)]
    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        if let Some((t, key)) = self.triangles.root(&candidate) {
            self.nearest.add(t, key);
        }
        self.nearest.t
    }
}

/// Looks whether anything is hit with 0 < t < `t_max`.
pub(super) struct AnySearch<'traverse, S> {
    triangles: FlattenedRay<'traverse, S>,
    t_max: f64,
    pub(super) is_hit: bool,
}

impl<'traverse, S> AnySearch<'traverse, S> {
    pub(super) fn new(triangles: FlattenedRay<'traverse, S>, t_max: f64) -> Self {
        Self {
            triangles,
            t_max,
            is_hit: false,
        }
    }
}

impl<S: Intersect> TriangleVisitor for AnySearch<'_, S> {
    const IS_CERTAIN: bool = true;

    #[inline(always)]
    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        self.is_hit = self.triangles.root_before(&candidate, self.t_max).is_some();
        if self.is_hit { STOP } else { self.t_max }
    }

    /// A certain hit in single precision is a hit in double precision.
    #[inline(always)]
    fn accepts_certain(&mut self, item: u32) -> bool {
        self.is_hit = !self.triangles.starts_at(item);
        self.is_hit
    }
}
