//! The first vertex of a path.

use super::state::PathState;
use super::vertex::{PathVertex, RayEnd};
use super::{PathTracer, SamplingStrategy};
use crate::film::heartbeat::{Heartbeat, PixelObserver};
use crate::film::pixel::{PixelSample, SampleId};
use crate::film::{RayCounts, RenderSelection};
use crate::integrator::Integrator;
use crate::integrator::aov::{CameraHit, FindFirstHit, FirstHitDetails, FirstHitFinder};
use crate::light::Lights;
use crate::shape::geometry::Intersect;
use crate::world::World;
use rtc_math::Vec3;
use rtc_plan::PathFeatures;

/// Finds the first hits of paths, with all that surfaces can show.
pub(crate) type PathFirstHitFinder<'world, S> =
    FirstHitFinder<PathTracer<'world, S, { PathFeatures::EVERYTHING.0 }>>;

impl<'world, S: Intersect> PathFirstHitFinder<'world, S> {
    pub(crate) fn new(
        world: &'world World<S>,
        lights: &'world Lights<'world, S>,
        on_pixel: &'world PixelObserver<'world>,
    ) -> Self {
        Self(PathTracer {
            knows_all: true,
            ..PathTracer::new(world, lights, SamplingStrategy::Mis, on_pixel)
        })
    }
}

impl<'run, S: Intersect, const F: u32> FindFirstHit<'run> for PathTracer<'run, S, F> {
    fn first_hit(&mut self, id: &SampleId) -> CameraHit {
        let sobol = self.numbers(id);
        self.go_to_moment(&sobol);
        self.counts.camera += 1;
        // Layers have no weights, so negative lobes of a filter count as positive ones.
        let (ray, _) = self.camera_ray(id.pixel, &sobol);
        let mut state = PathState::new(ray, sobol);
        let first = self.at_closest_hit(&mut state, |tracer, state, vertex| {
            tracer.seen(state, vertex).first
        });
        let first = match first {
            RayEnd::Surface(first) => first,
            RayEnd::Medium(_) | RayEnd::Nothing => None,
        };
        self.counts.hits += u64::from(first.is_some());
        CameraHit {
            direction: state.ray.direction,
            first,
        }
    }
}

impl<S: Intersect, const F: u32> PathTracer<'_, S, F> {
    /// What a camera ray sees at its first vertex.
    #[inline(never)]
    pub(super) fn seen(&self, state: &PathState, vertex: &PathVertex<'_, '_>) -> CameraHit {
        let direction = state.ray.direction;
        let frame = vertex
            .point
            .frame::<F>(vertex.at, vertex.shading_attributes, -direction);
        CameraHit {
            direction,
            first: Some(FirstHitDetails {
                albedo: vertex.point.base_color(),
                normal: frame.0.to_world(Vec3::Z),
                point: vertex.at.point,
                uv: vertex.point.uv(),
                surface: self.world.surfaces[vertex.hit.surface].index,
            }),
        }
    }
}

/// Traces paths, and tells the first hit of each.
pub(crate) struct GuidedPathTracer<'world, S>(
    PathTracer<'world, S, { PathFeatures::EVERYTHING.0 }>,
);

impl<'world, S: Intersect> GuidedPathTracer<'world, S> {
    /// For a job.
    pub(crate) fn new(
        world: &'world World<S>,
        lights: &'world Lights<'world, S>,
        job: &RenderSelection,
        on_pixel: &'world PixelObserver<'world>,
    ) -> Self {
        let tracer = PathTracer::new(world, lights, SamplingStrategy::Mis, on_pixel);
        Self(PathTracer {
            knows_all: true,
            keeps_first: true,
            ..tracer.before(job.background).clamped(job.clamp)
        })
    }
}

impl<'world, S: Intersect> Integrator<'world> for GuidedPathTracer<'world, S> {
    type Sample = (PixelSample, CameraHit);

    fn sample(&mut self, id: &SampleId) -> Self::Sample {
        self.0.first = None;
        let sample = self.0.sample(id);
        let nothing = CameraHit {
            direction: Vec3::ZERO,
            first: None,
        };
        (sample, self.0.first.unwrap_or(nothing))
    }

    fn counts(&self) -> &RayCounts {
        self.0.counts()
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'world> {
        self.0.heartbeat()
    }

    fn should_continue(&mut self) -> bool {
        self.0.should_continue()
    }
}
