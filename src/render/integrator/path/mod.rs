//! The path integrator: multiple importance sampling of next-event estimation and BSDF sampling
//! (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., §13.4).
//!
//! Reflection and transmission are checked against the geometric normal, so that shading normals
//! leak no light into closed meshes.

mod aov;
mod caustic;
mod chain;
mod medium;
mod scatter;
mod state;
mod vertex;
mod visibility;

use super::Integrator;
use super::aov::CameraHit;
use crate::camera::{image_point, lens_at, ray_through};
use crate::film::heartbeat::{Heartbeat, PixelObserver};
use crate::film::pixel::{PixelSample, SampleId, SampleStream};
use crate::film::{Background, RayCounts};
use crate::light::Lights;
use crate::ray::Ray;
use crate::sampler::sobol::{SobolPair, SobolPath};
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
pub(crate) use aov::{GuidedPathTracer, PathFirstHitFinder};
use rtc_math::Vec3;
use rtc_plan::{Effect, FeatureSet, PathFeatures, RemainingEnvironment};
use state::PathState;
use vertex::RayEnd;

/// The sampling strategy. All strategies have the same expected value; only the noise differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplingStrategy {
    /// Both, weighted by the balance heuristic (Veach, Guibas, 1995).
    #[default]
    Mis,
    /// Next-event estimation, except for delta lobes.
    Nee,
    /// BSDF sampling, except for punctual lights.
    BsdfSampling,
}

/// Traces paths through a world, with the [`PathFeatures`] `F`.
pub(crate) struct PathTracer<'world, S, const F: u32> {
    world: &'world World<S>,
    lights: &'world Lights<'world, S>,
    /// The world with those of all moments of the shutter, and the lights of them.
    all_moments: (&'world World<S>, &'world Lights<'world, S>),
    /// Whether rough surfaces keep the light that bounces between their facets.
    multiple_scattering: bool,
    strategy: SamplingStrategy,
    /// Whether vertices have all shading attributes, not only those that their materials need.
    knows_all: bool,
    /// Whether the first hit of the last path is kept, and that hit.
    keeps_first: bool,
    first: Option<CameraHit>,
    /// The background for camera rays that hit nothing.
    background: Background,
    /// The most that a path brings after its first bounce.
    clamp: Option<f64>,
    /// Whether the environment emits light.
    has_environment: bool,
    /// The maximum number of bounces.
    max_bounces: u32,
    /// The planned features; `F` may have more.
    planned: PathFeatures,
    /// Tells of the pixel under way, and whether to continue with it.
    heartbeat: Heartbeat<'world>,
    counts: RayCounts,
}

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    pub(crate) fn new(
        world: &'world World<S>,
        lights: &'world Lights<'world, S>,
        strategy: SamplingStrategy,
        on_pixel: &'world PixelObserver<'world>,
    ) -> Self {
        let plan = world.plan.paths.as_ref();
        let useless = u32::from(plan.is_some_and(|plan| !plan.last_ray));
        Self {
            world,
            lights,
            all_moments: (world, lights),
            multiple_scattering: world.settings.multiple_scattering,
            strategy,
            knows_all: false,
            keeps_first: false,
            first: None,
            background: Background::default(),
            clamp: None,
            has_environment: plan
                .is_none_or(|plan| plan.environment != RemainingEnvironment::Nothing),
            max_bounces: world.plan.max_depth.saturating_sub(useless),
            planned: plan.map_or(PathFeatures::EVERYTHING, |plan| plan.features),
            heartbeat: Heartbeat::new(on_pixel),
            counts: RayCounts::default(),
        }
    }

    /// The same tracer with another background.
    pub(crate) fn before(self, background: Background) -> Self {
        Self { background, ..self }
    }

    /// The same tracer with a clamp.
    pub(crate) fn clamped(self, clamp: Option<f64>) -> Self {
        Self { clamp, ..self }
    }

    /// Whether this tracer can do it: known at compile time.
    #[inline]
    const fn can(feature: PathFeatures) -> bool {
        FeatureSet(F).contains(feature)
    }

    /// Whether it is to be done: known at compile time where this tracer cannot.
    #[inline]
    fn does(&self, feature: PathFeatures) -> bool {
        Self::can(feature) && self.planned.contains(feature)
    }

    /// The numbers of a sample. In a picture of a given number of samples a pixel shares its
    /// sequence with its neighbours; samples beyond that number come from a sequence of its own.
    fn numbers(&self, id: &SampleId) -> SobolPath {
        let (pixel, index, seeds) = (id.pixel, id.index, id.stream.seeds());
        match (id.stream, self.world.settings.mode) {
            (SampleStream::Picture(_), Mode::Path(samples)) if index < samples => {
                SobolPath::in_picture(pixel, index, seeds, samples)
            }
            _ => SobolPath::new(pixel, index, seeds),
        }
    }

    /// Goes to the moment of the shutter at which a path is traced, if surfaces move.
    #[inline]
    fn go_to_moment(&mut self, sobol: &SobolPath) {
        let (world, lights) = self.all_moments;
        if let Some(moment) = world.moment_of(sobol) {
            self.counts.add(Effect::MotionBlur);
            self.world = &world.moments[moment];
            self.lights = &lights.moments[moment];
        }
    }

    /// The ray from the camera that a path of a pixel begins with, and the factor of its radiance
    /// by the filter of the pixel.
    fn camera_ray(&mut self, pixel: [u32; 2], sobol: &SobolPath) -> (Ray, f64) {
        let camera = self.world.camera.of(pixel);
        let (place, factor) = match &self.world.settings.filter {
            None => (sobol.pair(SobolPair::FILM), 1.0),
            Some(filter) => filter.sample(sobol.pair(SobolPair::FILM)),
        };
        let target = image_point(camera, pixel, place);
        if camera.lens_radius == 0.0 {
            return (ray_through(camera, camera.eye, target), factor);
        }
        self.counts.add(Effect::Lens);
        let lens_point = lens_at(camera, || sobol.pair(SobolPair::LENS));
        (ray_through(camera, lens_point, target), factor)
    }

    /// The radiance along one path.
    #[inline(always)]
    fn radiance(&mut self, ray: Ray, sobol: SobolPath) -> Vec3 {
        self.counts.camera += 1;
        let mut state = PathState::new(ray, sobol);
        state.medium = self.world.camera_medium;
        loop {
            let end = self.at_closest_hit(&mut state, |tracer, state, vertex| {
                tracer.counts.hits += u64::from(state.bounces == 0);
                if tracer.keeps_first && state.bounces == 0 {
                    tracer.first = Some(tracer.seen(state, vertex));
                }
                tracer.heartbeat.should_continue(&tracer.counts) && tracer.scatter(state, vertex)
            });
            let continues = match end {
                RayEnd::Surface(continues) => continues,
                RayEnd::Medium(medium) => self.scatter_in_medium(&mut state, medium),
                RayEnd::Nothing => {
                    self.add_escaped_radiance(&mut state);
                    false
                }
            };
            if !continues {
                break;
            }
            if state.bounces == 0 {
                state.radiance_of_first = state.radiance;
            }
            state.bounces += 1;
        }
        self.clamp
            .map_or(state.radiance, |limit| self.clamp(&state, limit))
    }

    /// The radiance of a path with the full contribution of its first vertex and the others clamped
    /// to the limit in each channel.
    fn clamp(&mut self, state: &PathState, limit: f64) -> Vec3 {
        let first = match state.bounces {
            0 => state.radiance,
            _ => state.radiance_of_first,
        };
        let rest = state.radiance - first;
        let share = limit / rest.max_element();
        let clamped = if share < 1.0 {
            first + rest * share
        } else {
            state.radiance
        };
        let [before, after] = [state.radiance, clamped].map(Vec3::element_sum);
        // A path that overflowed is dropped.
        if before.is_finite() {
            self.counts.clamped.add(before, before - after);
        }
        clamped
    }
}

impl<'world, S: Intersect, const F: u32> Integrator<'world> for PathTracer<'world, S, F> {
    type Sample = PixelSample;

    fn sample(&mut self, id: &SampleId) -> PixelSample {
        if id.index > 0 {
            self.counts.add(Effect::Supersampling);
        }
        let sobol = self.numbers(id);
        self.go_to_moment(&sobol);
        let ((ray, factor), hits) = (self.camera_ray(id.pixel, &sobol), self.counts.hits);
        let radiance = self.radiance(ray, sobol) * factor;
        let hit = self.counts.hits > hits;
        let is_shown = self.background == Background::Environment || hit;
        // Drop samples that overflowed.
        let is_shown = is_shown && radiance.is_finite();
        PixelSample {
            radiance: if is_shown { radiance } else { Vec3::ZERO },
            hit,
        }
    }

    fn counts(&self) -> &RayCounts {
        &self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'world> {
        &mut self.heartbeat
    }

    #[inline]
    fn should_continue(&mut self) -> bool {
        self.heartbeat.should_continue(&self.counts)
    }
}
