//! Scattering at a vertex: next-event estimation and BSDF sampling.

use super::state::PathState;
use super::vertex::PathVertex;
use super::{PathTracer, SamplingStrategy};
use crate::bsdf::BsdfLobes;
use crate::bsdf::standard::StandardParameters;
use crate::light::IncidentLight;
use crate::light::caustic::CausticLights;
use crate::material::point::{MaterialPoint, ShadingFrame};
use crate::sampler::sobol::SobolPair;
use crate::shape::geometry::Intersect;
use rtc_math::Vec3;
use rtc_plan::{Effect, PathFeatures};

/// The BSDF at a vertex, in its frame of shading.
pub(super) struct VertexBsdf<'vertex, const F: u32> {
    pub(super) frame: &'vertex ShadingFrame,
    pub(super) bsdf: &'vertex BsdfLobes<'vertex, F>,
    /// The direction to the viewer in the frame.
    pub(super) wo: Vec3,
}

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// Adds the radiance of the environment to a path that leaves the scene.
    pub(super) fn add_escaped_radiance(&mut self, state: &mut PathState) {
        if !self.has_environment {
            return;
        }
        let (radiance, light_pdf) = self.lights.environment(state.ray.direction);
        self.count_environment_map();
        if radiance != Vec3::ZERO {
            self.counts.add(Effect::Environment);
            let weight = self.weight_of_scattering(state.pdf, light_pdf);
            state.radiance += state.beta * radiance * (weight * Self::scale(state));
        }
    }

    /// What light of the radiance 1 along the ray counts.
    #[inline]
    fn scale(state: &PathState) -> f64 {
        if Self::can(PathFeatures::TRANSMISSION) {
            state.body.scale
        } else {
            1.0
        }
    }

    /// Counts a look-up of the environment's image.
    pub(super) fn count_environment_map(&mut self) {
        if self.world.lights.environment.is_looked_up() {
            self.counts.add(Effect::EnvironmentMap);
        }
    }

    /// Adds light at a vertex and samples the next direction; false if the path ends there.
    pub(super) fn scatter(
        &mut self,
        state: &mut PathState,
        vertex: &PathVertex<'_, 'world>,
    ) -> bool {
        // Attenuate by the medium along the ray.
        if Self::can(PathFeatures::TRANSMISSION) && state.body.absorption != Vec3::ZERO {
            self.counts.add(Effect::Volume);
            state.attenuate();
        }
        if vertex.point.material.is_unlit {
            self.counts.add(Effect::Unlit);
            state.radiance += state.beta * vertex.point.base_color();
            return false;
        }
        self.add_emission(state, vertex);
        let is_counted = state.depth() < self.world.plan.max_depth;
        let is_pane = self.is_free_pane(state, vertex.point.material);
        if !is_counted && !is_pane {
            return false;
        }
        let (point, wo) = (vertex.point, -state.ray.direction);
        if Self::can(PathFeatures::TRANSMISSION) {
            self.disperse(state, point);
        }
        // Evaluate the material, and make its BSDF.
        let (frame, coat) = point.frame::<F>(vertex.at, vertex.shading_attributes, wo);
        let multiple = self.multiple_scattering;
        let standard = point.standard::<F>(&frame, coat, state.channel, multiple);
        let wo = frame.to_local(wo);
        if point.material.is_black_behind && vertex.is_behind(wo.z) {
            return false;
        }
        let bsdf = BsdfLobes::<F>::new(&standard, wo);
        self.count_shading(vertex, &standard, &bsdf);
        let shading = VertexBsdf {
            frame: &frame,
            bsdf: &bsdf,
            wo,
        };
        // Sample one light, and one through smooth surfaces.
        let is_sampled = self.does(PathFeatures::NEE) && is_counted && !bsdf.is_delta();
        if is_sampled {
            state.radiance += state.beta * self.direct(state, vertex, &shading);
        }
        let receives = is_sampled && self.receives(vertex, &standard);
        if receives {
            state.radiance += state.beta * self.caustic(state, vertex, &shading);
        }
        (state.depth() < self.max_bounces || is_pane)
            && self.turn(state, vertex, &shading, receives)
    }

    /// Adds the emitted radiance of a surface.
    fn add_emission(&mut self, state: &mut PathState, vertex: &PathVertex<'_, 'world>) {
        let emission = vertex.point.emission();
        if emission == Vec3::ZERO {
            return;
        }
        self.counts.add(Effect::Emission);
        if vertex.point.has_emission_map() {
            self.counts.add(Effect::Textures);
        }
        let (hit, wo) = (vertex.hit, -state.ray.direction);
        // An estimated caustic counts once.
        let is_aimed_at =
            |caustics: &CausticLights| state.is_caustic() && caustics.is_aimed_at(hit.surface);
        if self.lights.caustics.as_ref().is_some_and(is_aimed_at) {
            return;
        }
        let (lights, part) = (self.lights, (hit.surface, hit.prim_id));
        let place = (vertex.at.point, vertex.at.normal);
        let distance = state.passed + state.travelled;
        let light_pdf = || lights.pdf_of_surface(part, place, -wo, distance);
        let weight = self.weight_of_scattering(state.pdf, light_pdf);
        state.radiance += state.beta * emission * (weight * Self::scale(state));
    }

    /// Samples the BSDF for the next direction; false if the path ends.
    fn turn(
        &mut self,
        state: &mut PathState,
        vertex: &PathVertex<'_, 'world>,
        VertexBsdf {
            frame,
            bsdf,
            wo: local,
        }: &VertexBsdf<'_, F>,
        receives: bool,
    ) -> bool {
        let (PathVertex { at, point, hit, .. }, wo) = (vertex, -state.ray.direction);
        let Some(sample) = bsdf.sample(state.pair(SobolPair::direction), || {
            state.pair(SobolPair::lobe)[0]
        }) else {
            return false;
        };
        let wi = frame.to_world(sample.wi).normalize();
        // End the path where shading and geometric normal disagree on reflection or transmission:
        // light would leak.
        let through = Self::can(PathFeatures::TRANSMISSION) && sample.wi.z * local.z < 0.0;
        if through != (wi.dot(at.normal) * wo.dot(at.normal) < 0.0) {
            return false;
        }
        // Light that goes straight through a pane takes no bounce.
        if through && self.is_free_pane(state, point.material) {
            state.free += 1;
        } else if state.depth() >= self.max_bounces {
            return false;
        }
        state.beta *= sample.f * (sample.wi.z.abs() / sample.pdf);
        // Light sampling at the vertex before has aimed through a pane.
        if through && sample.delta && self.is_aimed_through(hit) {
            state.passed += state.travelled;
        } else {
            (state.pdf, state.passed) = ((!sample.delta).then_some(sample.pdf), 0.0);
        }
        if through && point.material.bounds_a_volume {
            state.enter(point.material, wi.dot(at.normal) < 0.0);
        }
        if Self::can(PathFeatures::MEDIA) {
            state.medium = self.medium_beyond(hit.surface, wi.dot(at.normal), state.medium);
        }
        if self.has_caustics() {
            let is_regular = || self.is_regular(vertex, frame.to_world(Vec3::Z));
            state.caustic = match sample.delta {
                true => state
                    .caustic
                    .filter(|_| is_regular())
                    .map(|length| length + 1),
                false => receives.then_some(0),
            };
        }
        (state.ray, state.from) = (at.ray(wi), (hit.surface, hit.prim_id));
        *if through {
            &mut self.counts.refracted
        } else {
            &mut self.counts.mirror
        } += 1;
        state.russian_roulette()
    }

    /// Picks a wavelength at the first surface that disperses.
    fn disperse(&mut self, state: &mut PathState, point: &MaterialPoint<'world>) {
        let is_dispersed = point.material.dispersed.is_some();
        if is_dispersed && state.channel.is_none() && point.transmits() {
            self.counts.add(Effect::Dispersion);
            state.pick_wavelength();
        }
    }

    /// Counts the evaluations of a material.
    #[inline]
    pub(super) fn count_shading(
        &mut self,
        vertex: &PathVertex<'_, '_>,
        standard: &StandardParameters<'_>,
        bsdf: &BsdfLobes<'_, F>,
    ) {
        let material = vertex.point.material;
        let mut count = |effect: Effect, is_there: bool| {
            if is_there {
                self.counts.add(effect);
            }
        };
        count(
            Effect::NormalInterpolation,
            vertex.shading_attributes.normal.is_some(),
        );
        count(Effect::NormalMapping, vertex.point.has_normal_map());
        count(Effect::Textures, material.has_shading_map);
        count(Effect::Microfacets, bsdf.reflects());
        count(Effect::Compensation, bsdf.compensates());
        if Self::can(PathFeatures::LAYERS) {
            for (layer, is_there) in standard.layers() {
                count(Effect::Layer(layer), is_there);
            }
        }
        debug_assert!(!material.is_unlit, "a path ends on an unlit surface");
    }

    /// The direct light of one sampled light at a vertex.
    fn direct(
        &mut self,
        state: &PathState,
        vertex: &PathVertex<'_, 'world>,
        VertexBsdf { frame, bsdf, wo }: &VertexBsdf<'_, F>,
    ) -> Vec3 {
        let at = vertex.at;
        let Some(IncidentLight {
            wi,
            radiance,
            pdf,
            place,
        }) = self
            .lights
            .sample(at.point, || state.pair(SobolPair::light))
        else {
            return Vec3::ZERO;
        };
        self.counts.add(Effect::DirectLight);
        // Of all lights, only the environment has a density and no position.
        if pdf.is_some() && place.is_none() {
            self.count_environment_map();
        }
        let local = frame.to_local(wi);
        let through = local.z * wo.z < 0.0;
        if through != (wi.dot(at.normal) * -state.ray.direction.dot(at.normal) < 0.0) {
            return Vec3::ZERO;
        }
        let (f, weight) = match (pdf, self.strategy) {
            (Some(light_pdf), SamplingStrategy::Mis) => {
                self.counts.add(Effect::Mis);
                let value = bsdf.evaluate(local);
                (value.f, balance_heuristic(light_pdf, value.pdf))
            }
            _ => (bsdf.f(local), 1.0),
        };
        let mut light = f * radiance * (local.z.abs() * weight);
        if light == Vec3::ZERO {
            return light;
        }
        if Self::can(PathFeatures::TRANSMISSION) {
            let material = vertex.point.material;
            let body = match through && material.bounds_a_volume {
                true => (state.body).beyond(material, state.channel, wi.dot(at.normal) < 0.0),
                false => state.body,
            };
            light *= body.carried(place.map(|place| place.distance(at.point)));
        }
        light * self.light_transmittance(state, vertex, wi, place)
    }

    /// The MIS weight of light found by BSDF sampling, given both densities.
    pub(super) fn weight_of_scattering(
        &mut self,
        pdf: Option<f64>,
        light_pdf: impl FnOnce() -> f64,
    ) -> f64 {
        if !self.does(PathFeatures::NEE) {
            return 1.0;
        }
        let Some(pdf) = pdf else { return 1.0 };
        match self.strategy {
            SamplingStrategy::Mis => {
                let light_pdf = light_pdf();
                if light_pdf > 0.0 {
                    self.counts.add(Effect::Mis);
                }
                balance_heuristic(pdf, light_pdf)
            }
            SamplingStrategy::Nee if light_pdf() > 0.0 => 0.0,
            SamplingStrategy::Nee | SamplingStrategy::BsdfSampling => 1.0,
        }
    }
}

/// Veach's balance heuristic: by trial, higher powers leave more noise in most scenes (decision
/// 16).
pub(super) fn balance_heuristic(pdf: f64, other: f64) -> f64 {
    1.0 / (1.0 + other / pdf)
}
