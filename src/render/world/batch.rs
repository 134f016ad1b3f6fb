//! Many rays at once: what each meets is what it meets alone.

use super::flattened::FlattenedRay;
use super::search::{AnySearch, ClosestSearch};
use super::{Hit, NOWHERE, World};
use crate::render::ray::Ray;
use crate::render::shape::geometry::Geometry;

/// So many rays are prepared at once.
const CHUNK: usize = 64;

impl<S: Geometry> World<S> {
    /// For each ray what [`World::closest_hit`] finds.
    #[must_use]
    pub fn closest_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let Some(flattened) = &self.flattened else {
            return rays.iter().map(|ray| self.closest_hit(ray)).collect();
        };
        let mut hits = Vec::with_capacity(rays.len());
        let mut searches = Vec::with_capacity(CHUNK);
        for rays in rays.chunks(CHUNK) {
            searches.extend(rays.iter().map(|ray| {
                let is_finite = ray.origin.is_finite() && ray.direction.is_finite();
                let (ray, _) = ray.rescaled();
                let nearest = self.closest_hit_apart(&ray);
                let triangles = FlattenedRay::new(&ray, NOWHERE, &self.surfaces, flattened);
                // A ray that ends before it starts meets nothing.
                let t_max = if is_finite { nearest.t } else { -1.0 };
                (ray, t_max, ClosestSearch { triangles, nearest })
            }));
            flattened.hierarchy.walk_all(&mut searches);
            for (ray, (rescaled, t_max, search)) in rays.iter().zip(searches.drain(..)) {
                let (_, unit) = ray.rescaled();
                let hit = self.hit(&rescaled, unit, NOWHERE, &search.nearest);
                hits.push(hit.filter(|_| t_max >= 0.0));
            }
        }
        hits
    }

    /// For each ray and its `t_max` whether anything that casts shadows is hit with 0 < t < `t_max`.
    #[must_use]
    pub fn any_hits(&self, rays: &[(Ray, f64)]) -> Vec<bool> {
        let Some(flattened) = &self.flattened else {
            return rays
                .iter()
                .map(|(ray, t_max)| self.any_hit(ray, *t_max))
                .collect();
        };
        let mut hits = Vec::with_capacity(rays.len());
        let mut searches = Vec::with_capacity(CHUNK);
        for rays in rays.chunks(CHUNK) {
            let first = hits.len();
            for (ray, t_max) in rays {
                let (ray, unit) = ray.rescaled();
                let t_max = t_max / unit;
                let is_hit = self.any_hit_apart(&ray, t_max);
                hits.push(is_hit);
                let triangles = FlattenedRay::new(&ray, NOWHERE, &self.surfaces, flattened);
                let t_max = if is_hit { -1.0 } else { t_max };
                searches.push((ray, t_max, AnySearch::new(triangles, t_max)));
            }
            flattened.hierarchy.walk_all(&mut searches);
            for (hit, (_, _, search)) in hits[first..].iter_mut().zip(searches.drain(..)) {
                *hit |= search.is_hit;
            }
        }
        hits
    }
}
