//! Participating media along paths: free flight, scattering, and light through media.
//!
//! A path is in the medium of the camera until it crosses a surface whose material names media:
//! from there on it is in that of the side where it goes on. Transmitted, reflected and skipped
//! rays are alike.

use super::scatter::balance_heuristic;
use super::state::PathState;
use super::vertex::{MAX_SKIPPED, PathVertex};
use super::visibility::StraightPath;
use super::{PathTracer, SamplingStrategy};
use crate::light::IncidentLight;
use crate::material::standard::{MediumInterface, StandardMaterial};
use crate::medium::{FreeFlight, HomogeneousMedium};
use crate::ray::Ray;
use crate::sampler::sobol::SobolPair;
use crate::shape::geometry::Intersect;
use crate::world::{MediumId, NO_PRIMITIVE, SurfaceId, SurfacePrimitive, segment};
use rtc_math::Vec3;
use rtc_plan::{Effect, PathFeatures};

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// The free flight of a ray, if there are media.
    #[inline]
    pub(super) fn free_flight(&self, state: &PathState) -> Option<FreeFlight> {
        let flight = || FreeFlight::new(state.beta, state.pair(SobolPair::free_flight));
        self.has_media().then(flight)
    }

    /// Whether the world has media: known at compile time where this tracer knows none.
    #[inline]
    fn has_media(&self) -> bool {
        Self::can(PathFeatures::MEDIA) && !self.world.media.is_empty()
    }

    /// Flies to the hit at a distance, or without one to infinity; to the medium that scatters the
    /// ray before, where the state then is.
    #[inline(never)]
    pub(super) fn fly(
        &mut self,
        state: &mut PathState,
        flight: &mut FreeFlight,
        hit: Option<f64>,
    ) -> Option<MediumId> {
        let id = state.medium?;
        self.counts.add(Effect::Media);
        let medium = &self.world.media[id];
        let distance = flight.pass(medium, hit.unwrap_or(f64::INFINITY))?;
        state.beta *= flight.weight_of_scattering(medium);
        state.travelled += distance;
        state.ray.origin += state.ray.direction * distance;
        Some(id)
    }

    /// Whether a material is a pane that light crosses without a bounce, as it does in Mitsuba's
    /// `volpath`: in a scene that names media, so that boundaries of media cost no depth.
    #[inline]
    pub(super) fn is_free_pane(&self, state: &PathState, material: &StandardMaterial) -> bool {
        Self::can(PathFeatures::TRANSMISSION)
            && self.world.has_free_panes
            && material.is_pane
            && state.free < MAX_SKIPPED
    }

    /// Lets the ray of a path cross a surface with this normal.
    pub(super) fn cross(&self, state: &mut PathState, surface: SurfaceId, normal: Vec3) {
        state.medium = self.medium_beyond(surface, state.ray.direction.dot(normal), state.medium);
    }

    /// The medium of a ray that leaves a surface at a height over its geometric normal, and was in
    /// a medium before.
    pub(super) fn medium_beyond(
        &self,
        surface: SurfaceId,
        height: f64,
        before: Option<MediumId>,
    ) -> Option<MediumId> {
        let material = self.world.surfaces[surface].material;
        match self.world.standards[material].media {
            None => before,
            Some(MediumInterface { interior, .. }) if height < 0.0 => interior,
            Some(MediumInterface { exterior, .. }) => exterior,
        }
    }

    /// Adds light at the point of a medium where the ray is, and samples the next direction; false
    /// if the path ends there.
    #[inline(never)]
    pub(super) fn scatter_in_medium(&mut self, state: &mut PathState, medium: MediumId) -> bool {
        self.counts.hits += u64::from(state.bounces == 0);
        if !self.heartbeat.should_continue(&self.counts) {
            return false;
        }
        // Attenuate by the glass along the ray.
        if Self::can(PathFeatures::TRANSMISSION) && state.body.absorption != Vec3::ZERO {
            self.counts.add(Effect::Volume);
            state.attenuate();
        }
        if state.depth() >= self.world.plan.max_depth {
            return false;
        }
        // Sample one light.
        let world = self.world;
        let phase = &world.media[medium];
        if self.does(PathFeatures::NEE) {
            state.radiance += state.beta * self.light_in_medium(state, phase);
        }
        if state.depth() >= self.max_bounces {
            return false;
        }
        // Sample the phase function; its value over its density is 1.
        let wo = -state.ray.direction;
        let (wi, pdf) = phase.sample_phase(wo, state.pair(SobolPair::direction));
        (state.pdf, state.passed) = (Some(pdf), 0.0);
        state.caustic = None;
        state.ray.direction = wi;
        state.from = NO_PRIMITIVE;
        self.counts.mirror += 1;
        state.russian_roulette()
    }

    /// The direct light of one sampled light at the origin of the ray, which a medium scatters.
    fn light_in_medium(&mut self, state: &PathState, phase: &HomogeneousMedium) -> Vec3 {
        let point = state.ray.origin;
        let Some(IncidentLight {
            wi,
            radiance,
            pdf,
            place,
        }) = self.lights.sample(point, || state.pair(SobolPair::light))
        else {
            return Vec3::ZERO;
        };
        self.counts.add(Effect::DirectLight);
        // Of all lights, only the environment has a density and no position.
        if pdf.is_some() && place.is_none() {
            self.count_environment_map();
        }
        let value = phase.phase(-state.ray.direction.dot(wi));
        let weight = match (pdf, self.strategy) {
            (Some(light_pdf), SamplingStrategy::Mis) => {
                self.counts.add(Effect::Mis);
                balance_heuristic(light_pdf, value)
            }
            _ => 1.0,
        };
        let mut light = radiance * (value * weight);
        if light == Vec3::ZERO {
            return light;
        }
        if Self::can(PathFeatures::TRANSMISSION) {
            light *= (state.body).carried(place.map(|place| place.distance(point)));
        }
        let ray = Ray {
            origin: point,
            direction: wi,
        };
        let left = self.straight_path(state);
        light * self.media_transmittance(left, ray, NO_PRIMITIVE, state.medium, place)
    }

    /// The transmittance from a vertex to a point, or to infinity.
    pub(super) fn light_transmittance(
        &mut self,
        state: &PathState,
        vertex: &PathVertex<'_, 'world>,
        wi: Vec3,
        place: Option<Vec3>,
    ) -> Vec3 {
        if !self.has_media() {
            return self.visibility(state, vertex, wi, place);
        }
        let (hit, at) = (vertex.hit, vertex.at);
        let medium = self.medium_beyond(hit.surface, wi.dot(at.normal), state.medium);
        let left = self.straight_path(state);
        self.media_transmittance(left, at.ray(wi), (hit.surface, hit.prim_id), medium, place)
    }

    /// The transmittance of media and surfaces from the origin of a ray in a medium to a point in
    /// its direction, or to infinity.
    #[inline(never)]
    fn media_transmittance(
        &mut self,
        mut left: StraightPath,
        mut ray: Ray,
        mut from: SurfacePrimitive,
        mut medium: Option<MediumId>,
        place: Option<Vec3>,
    ) -> Vec3 {
        self.counts.shadow += 1;
        let (world, wi) = (self.world, ray.direction);
        let passed = |medium: Option<MediumId>, distance: f64| match medium {
            Some(medium) => world.media[medium].transmittance(distance),
            None => Vec3::ONE,
        };
        let mut transmittance = Vec3::ONE;
        for _ in 0..MAX_SKIPPED {
            // Stop if the rest of the segment is clear.
            let distance = place.map_or(f64::INFINITY, |place| place.distance(ray.origin));
            let (end, t_max) = match place.map(|place| segment(ray.origin, place)) {
                None => (ray, f64::INFINITY),
                Some(None) => return transmittance,
                Some(Some(to_place)) => to_place,
            };
            if !world.any_hit_from(&end, t_max, from) {
                return transmittance * passed(medium, distance);
            }
            // Cross the next surface. By rounding, the closest-hit search may miss one that blocks
            // the segment: it hides the light, as an opaque surface does.
            let Some(hit) = world.closest_hit_from(&ray, from) else {
                return Vec3::ZERO;
            };
            let (at, fraction) = self.transmittance(&mut left, &ray, &hit);
            transmittance *= passed(medium, hit.t) * fraction;
            let Some(at) = at.filter(|_| transmittance != Vec3::ZERO) else {
                return Vec3::ZERO;
            };
            if !self.heartbeat.passes(&self.counts) {
                return Vec3::ZERO;
            }
            medium = self.medium_beyond(hit.surface, wi.dot(at.normal), medium);
            (ray, from) = (at.ray(wi), (hit.surface, hit.prim_id));
        }
        Vec3::ZERO
    }
}
