//! Many rays at once: what each meets is what it meets alone.

use super::flattened::FlattenedRay;
use super::search::{AnySearch, ClosestSearch};
use super::{Hit, NOWHERE, World};
use crate::render::ray::Ray;
use crate::render::shape::geometry::Geometry;

/// So many rays are prepared at once.
const CHUNK: usize = 64;

/// Whether most rays point nearly where the one before points, within about 8°: they find in the
/// caches what that one met, and need no turns.
fn are_coherent<'rays>(mut rays: impl Iterator<Item = &'rays Ray>) -> bool {
    const SQUARED_COSINE: f64 = 0.98;
    let Some(first) = rays.next() else {
        return true;
    };
    let (mut before, mut balance) = (first.direction, 0);
    for Ray { direction, .. } in rays {
        let cosine = direction.dot(before);
        let squares = direction.length_squared() * before.length_squared();
        let is_near = cosine > 0.0 && cosine * cosine >= SQUARED_COSINE * squares;
        balance += if is_near { 1 } else { -1 };
        before = *direction;
    }
    balance >= 0
}

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
            if are_coherent(rays.iter()) {
                hits.extend(rays.iter().map(|ray| self.closest_hit(ray)));
                continue;
            }
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
            if are_coherent(rays.iter().map(|(ray, _)| ray)) {
                hits.extend(rays.iter().map(|(ray, t_max)| self.any_hit(ray, *t_max)));
                continue;
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    #[test]
    fn rays_of_a_camera_are_coherent_and_rays_from_anywhere_are_not() {
        let rays = |spread: f64| {
            let direction = |k: u32| {
                let turn = f64::from(k) * spread;
                Vec3::new(crate::math::cos(turn), crate::math::sin(turn), 0.1) * f64::from(k + 1)
            };
            let ray = |k| Ray {
                origin: Vec3::ZERO,
                direction: direction(k),
            };
            (0..CHUNK as u32).map(ray).collect::<Vec<_>>()
        };
        assert!(are_coherent(rays(0.01).iter()));
        assert!(!are_coherent(rays(2.0).iter()));
        assert!(are_coherent(rays(2.0)[..1].iter()));
    }
}
