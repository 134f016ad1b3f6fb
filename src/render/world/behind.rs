//! What camera rays see behind the back faces that they pass.

use super::{NO_PRIMITIVE, World};
use crate::ray::Ray;
use crate::shape::geometry::Intersect;
use rtc_math::Vec3;

/// The maximum number of back faces that a ray passes.
const MOST_PASSED: usize = 64;

/// A point that a camera ray sees behind back faces of single-sided materials.
#[derive(Clone, Copy, Debug)]
pub struct SeenBehind {
    /// Where the ray passes the last of these faces.
    pub passed: Vec3,
    /// The point, as a start of rays on the side of the viewer.
    pub point: Vec3,
    /// The geometric unit normal there, on the side of the viewer.
    pub normal: Vec3,
}

impl<S: Intersect> World<S> {
    /// The point that a camera ray sees, if it passes back faces before. Alpha and the other parts
    /// of blends count as opaque. Only worlds of path tracing have single-sided materials.
    pub(super) fn seen_behind(&self, mut ray: Ray) -> Option<SeenBehind> {
        let (mut from, mut passed) = (NO_PRIMITIVE, None);
        for _ in 0..MOST_PASSED {
            let hit = self.closest_hit_from(&ray, from)?;
            let surface = &self.surfaces[hit.surface];
            let at = surface.shape.interaction(&ray, hit.t, hit.prim_id);
            let is_back = ray.direction.dot(at.normal) > 0.0;
            let material = self.standards.get(surface.material.index());
            if !(is_back && material.is_some_and(|material| material.is_seen_from_one_side)) {
                return passed.map(|passed| SeenBehind {
                    passed,
                    point: at.ray(-ray.direction).origin,
                    normal: if is_back { -at.normal } else { at.normal },
                });
            }
            passed = Some(at.point);
            (ray, from) = (at.ray(ray.direction), (hit.surface, hit.prim_id));
        }
        None
    }
}
