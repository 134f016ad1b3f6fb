//! Visibility between a vertex and a light.

use super::PathTracer;
use super::vertex::{MAX_SKIPPED, PathVertex};
use crate::material::standard::Alpha;
use crate::ray::{Interaction, Ray};
use crate::shape::geometry::Intersect;
use crate::world::alpha::AlphaTested;
use crate::world::{Hit, SurfacePrimitive, segment};
use rtc_math::Vec3;
use rtc_plan::PathFeatures;

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// The transmittance to a point, or to infinity.
    #[inline(never)]
    pub(super) fn visibility(
        &mut self,
        vertex: &PathVertex<'_, 'world>,
        wi: Vec3,
        place: Option<Vec3>,
    ) -> f64 {
        if !self.does(PathFeatures::SHADOWS) {
            return 1.0;
        }
        self.counts.shadow += 1;
        let ray = vertex.at.ray(wi);
        let from = (vertex.hit.surface, vertex.hit.prim_id);
        let is_tested = Self::can(PathFeatures::ALPHA);
        if is_tested && self.world.alpha_tested == AlphaTested::Solids {
            return self.transmittance_one_by_one(ray, from, wi, place);
        }
        let to_place = |place| segment(ray.origin, place);
        let Some((ray, t_max)) = place.map_or(Some((ray, f64::INFINITY)), to_place) else {
            return 1.0;
        };
        let world = self.world;
        if is_tested && self.world.alpha_tested == AlphaTested::Triangles {
            let mut pass = |hit| self.transmittance(&ray, &hit).1;
            world.transmittance(&ray, t_max, from, &mut pass)
        } else {
            f64::from(!world.any_hit_from(&ray, t_max, from))
        }
    }

    /// The interaction of a hit, and the transmittance of the surface there.
    pub(super) fn transmittance(&mut self, ray: &Ray, hit: &Hit) -> (Option<Interaction>, f64) {
        let surface = &self.world.surfaces[hit.surface];
        let material = &self.world.standards[surface.material];
        if material.alpha == Alpha::Opaque && material.blend.is_none() {
            return (None, 0.0);
        }
        let at = surface.shape.interaction(ray, hit.t, hit.prim_id);
        let request = self.request(surface.material);
        let shading_attributes = surface
            .shape
            .shading_attributes(ray, &at, hit.prim_id, request);
        let point = self.point(surface.material, &shading_attributes, at.point);
        (
            Some(at),
            1.0 - self.whole_opacity(point, &shading_attributes),
        )
    }

    /// As [`Self::visibility`], for surfaces that a ray may cross more than once.
    fn transmittance_one_by_one(
        &mut self,
        mut ray: Ray,
        mut from: SurfacePrimitive,
        wi: Vec3,
        place: Option<Vec3>,
    ) -> f64 {
        let mut transmittance = 1.0;
        for _ in 0..MAX_SKIPPED {
            let (end, t_max) = match place.map(|place| segment(ray.origin, place)) {
                None => (ray, f64::INFINITY),
                Some(None) => return transmittance,
                Some(Some(to_place)) => to_place,
            };
            // Stop if the rest of the segment is clear.
            if !self.world.any_hit_from(&end, t_max, from) {
                return transmittance;
            }
            // By rounding, the closest-hit search may miss a surface that blocks the segment. It
            // hides the light, as an opaque surface does.
            let Some(hit) = self.world.closest_hit_from(&ray, from) else {
                return 0.0;
            };
            let (at, fraction) = self.transmittance(&ray, &hit);
            transmittance *= fraction;
            let Some(at) = at.filter(|_| transmittance > 0.0) else {
                return 0.0;
            };
            if !self.heartbeat.passes(&self.counts) {
                return 0.0;
            }
            (ray, from) = (at.ray(wi), (hit.surface, hit.prim_id));
        }
        0.0
    }
}
