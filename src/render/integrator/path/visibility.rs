//! Visibility between a vertex and a light.

use super::PathTracer;
use super::state::PathState;
use super::vertex::{MAX_SKIPPED, PathVertex};
use crate::bsdf::BsdfLobes;
use crate::material::standard::Alpha;
use crate::ray::{Interaction, Ray};
use crate::shape::geometry::Intersect;
use crate::world::alpha::AlphaTested;
use crate::world::{Hit, SurfacePrimitive, segment};
use rtc_math::Vec3;
use rtc_plan::PathFeatures;

/// What a path would have left at the surfaces that a shadow ray of it meets.
pub(super) struct StraightPath {
    /// The bounces.
    bounces: u32,
    /// The panes without one.
    free: u32,
    /// The wavelength channel that dispersion picked.
    channel: Option<usize>,
}

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// What the path of a vertex has left behind it.
    pub(super) fn straight_path(&self, state: &PathState) -> StraightPath {
        let most = self.world.plan.max_depth;
        StraightPath {
            bounces: most.saturating_sub(state.depth() + 1),
            free: MAX_SKIPPED.saturating_sub(state.free),
            channel: state.channel,
        }
    }

    /// The transmittance to a point, or to infinity.
    #[inline(never)]
    pub(super) fn visibility(
        &mut self,
        state: &PathState,
        vertex: &PathVertex<'_, 'world>,
        wi: Vec3,
        place: Option<Vec3>,
    ) -> Vec3 {
        if !self.does(PathFeatures::SHADOWS) {
            return Vec3::ONE;
        }
        self.counts.shadow += 1;
        let ray = vertex.at.ray(wi);
        let from = (vertex.hit.surface, vertex.hit.prim_id);
        let is_tested = Self::can(PathFeatures::ALPHA);
        let has_solids = is_tested && self.world.alpha_tested == AlphaTested::Solids;
        let has_panes = Self::can(PathFeatures::TRANSMISSION) && self.world.has_panes;
        if has_solids || has_panes {
            let left = self.straight_path(state);
            return self.transmittance_one_by_one(left, ray, from, wi, place);
        }
        let to_place = |place| segment(ray.origin, place);
        let Some((ray, t_max)) = place.map_or(Some((ray, f64::INFINITY)), to_place) else {
            return Vec3::ONE;
        };
        let world = self.world;
        if is_tested && self.world.alpha_tested == AlphaTested::Triangles {
            let mut pass = |hit| self.alpha_transmittance(&ray, &hit).1;
            Vec3::splat(world.transmittance(&ray, t_max, from, &mut pass))
        } else {
            Vec3::splat(f64::from(!world.any_hit_from(&ray, t_max, from)))
        }
    }

    /// The interaction of a hit, and the fraction of the light that goes straight on: through a
    /// pane, or by the alpha of the surface there.
    pub(super) fn transmittance(
        &mut self,
        left: &mut StraightPath,
        ray: &Ray,
        hit: &Hit,
    ) -> (Option<Interaction>, Vec3) {
        if self.is_aimed_through(hit) {
            let (at, passed) = self.through_pane(left, ray, hit);
            return (Some(at), passed);
        }
        let (at, passed) = self.alpha_transmittance(ray, hit);
        (at, Vec3::splat(passed))
    }

    /// Whether light sampling aims through the surface of a hit where it is smooth: a pane, unless
    /// caustics through it are estimated.
    #[inline]
    pub(super) fn is_aimed_through(&self, hit: &Hit) -> bool {
        let caustics = self.lights.caustics.as_ref();
        Self::can(PathFeatures::TRANSMISSION)
            && self.world.has_panes
            && self.world.panes[self.world.surfaces[hit.surface].material]
            && caustics.is_none_or(|caustics| !caustics.casts(hit.surface))
    }

    /// What goes through a pane where it is smooth, as for a path that has a bounce left for it.
    fn through_pane(
        &mut self,
        left: &mut StraightPath,
        ray: &Ray,
        hit: &Hit,
    ) -> (Interaction, Vec3) {
        let surface = &self.world.surfaces[hit.surface];
        let at = surface.shape.interaction(ray, hit.t, hit.prim_id);
        let request = self.request(surface.material);
        let shading_attributes = (surface.shape).shading_attributes(ray, &at, hit.prim_id, request);
        let mut point = self.point(surface.material, &shading_attributes, at.point);
        if let Some(set) = point.bump_set() {
            point.derivatives = surface.shape.uv_derivatives(ray, &at, hit.prim_id, set);
        }
        let is_free = self.world.has_free_panes && point.material.is_pane;
        let count = match is_free && left.free > 0 {
            true => &mut left.free,
            false => &mut left.bounces,
        };
        if *count == 0 {
            return (at, Vec3::ZERO);
        }
        *count -= 1;
        let vertex = PathVertex {
            at: &at,
            point: &point,
            shading_attributes: &shading_attributes,
            hit: *hit,
        };
        let passed = self.passed_straight(&vertex, -ray.direction, left.channel);
        (at, passed)
    }

    /// What goes straight through the surface of a vertex to a viewer.
    fn passed_straight(
        &mut self,
        vertex: &PathVertex<'_, 'world>,
        wo: Vec3,
        channel: Option<usize>,
    ) -> Vec3 {
        let point = vertex.point;
        let (frame, coat) = point.frame::<F>(vertex.at, vertex.shading_attributes, wo);
        let standard = point.standard::<F>(&frame, coat, channel, self.multiple_scattering);
        let local = frame.to_local(wo);
        if point.material.is_black_behind && vertex.is_behind(local.z) {
            return Vec3::ZERO;
        }
        let bsdf = BsdfLobes::<F>::new(&standard, local);
        self.count_shading(vertex, &standard, &bsdf);
        bsdf.smooth(true).map_or(Vec3::ZERO, |(_, passed)| passed)
    }

    /// The interaction of a hit, and the transmittance of the surface there by its alpha.
    fn alpha_transmittance(&mut self, ray: &Ray, hit: &Hit) -> (Option<Interaction>, f64) {
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
        mut left: StraightPath,
        mut ray: Ray,
        mut from: SurfacePrimitive,
        wi: Vec3,
        place: Option<Vec3>,
    ) -> Vec3 {
        let mut transmittance = Vec3::ONE;
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
                return Vec3::ZERO;
            };
            let (at, fraction) = self.transmittance(&mut left, &ray, &hit);
            transmittance *= fraction;
            let Some(at) = at.filter(|_| transmittance != Vec3::ZERO) else {
                return Vec3::ZERO;
            };
            if !self.heartbeat.passes(&self.counts) {
                return Vec3::ZERO;
            }
            (ray, from) = (at.ray(wi), (hit.surface, hit.prim_id));
        }
        Vec3::ZERO
    }
}
