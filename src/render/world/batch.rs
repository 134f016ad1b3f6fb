//! Closest-hit and any-hit queries for many rays. The results equal those of single queries.

use super::flattened::{Flattened, FlattenedRay};
use super::search::{AnySearch, ClosestSearch};
use super::{Hit, NO_PRIMITIVE, STOP, World};
use crate::accel::wide::Visitor;
use crate::ray::Ray;
use crate::shape::geometry::Intersect;
use crate::shape::tie::Nearest;

/// The number of rays prepared at once.
const CHUNK: usize = 64;

/// Whether most rays point nearly where the one before points, within about 8°: they visit much
/// the same nodes.
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

impl<S: Intersect> World<S> {
    /// For each ray the result of [`World::closest_hit`].
    #[must_use]
    pub fn closest_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let Some(flattened) = &self.flattened else {
            return rays.iter().map(|ray| self.closest_hit(ray)).collect();
        };
        let mut hits = Vec::with_capacity(rays.len());
        let mut units = Vec::with_capacity(CHUNK);
        let mut searches = Vec::with_capacity(CHUNK);
        for rays in rays.chunks(CHUNK) {
            for ray in rays {
                let is_finite = ray.origin.is_finite() && ray.direction.is_finite();
                let (ray, unit) = ray.rescaled();
                units.push(unit);
                let nearest = if is_finite {
                    self.closest_hit_in_objects(&ray)
                } else {
                    Nearest::up_to(STOP, NO_PRIMITIVE)
                };
                let triangles = FlattenedRay::new(&ray, NO_PRIMITIVE, &self.surfaces, flattened);
                searches.push((ray, nearest.t, ClosestSearch { triangles, nearest }));
            }
            flattened.traverse_all(&mut searches);
            for (unit, (ray, _, search)) in units.drain(..).zip(searches.drain(..)) {
                hits.push(self.hit(&ray, unit, NO_PRIMITIVE, &search.nearest));
            }
        }
        hits
    }

    /// For each ray and its `t_max` whether anything that casts shadows is hit with 0 < t <
    /// `t_max`.
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
                let is_hit = self.any_hit_in_objects(&ray, t_max);
                hits.push(is_hit);
                let triangles = FlattenedRay::new(&ray, NO_PRIMITIVE, &self.surfaces, flattened);
                let t_max = if is_hit { STOP } else { t_max };
                searches.push((ray, t_max, AnySearch::new(triangles, t_max)));
            }
            flattened.traverse_all(&mut searches);
            for (hit, (_, _, search)) in hits[first..].iter_mut().zip(searches.drain(..)) {
                *hit |= search.is_hit;
            }
        }
        hits
    }
}

impl Flattened {
    /// Has each ray's visitor visit the triangles it may hit.
    fn traverse_all<V: Visitor>(&self, searches: &mut [(Ray, f64, V)]) {
        if are_coherent(searches.iter().map(|(ray, ..)| ray)) {
            self.hierarchy.traverse_packets(searches);
        } else {
            self.hierarchy.traverse_all(searches);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::Vec3;

    #[test]
    fn rays_of_a_camera_are_coherent_and_rays_from_anywhere_are_not() {
        let rays = |spread: f64| {
            let direction = |k: u32| {
                let turn = f64::from(k) * spread;
                Vec3::new(rtc_math::cos(turn), rtc_math::sin(turn), 0.1) * f64::from(k + 1)
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
