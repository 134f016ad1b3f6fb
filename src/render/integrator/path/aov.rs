//! The first vertex of a path.

use super::state::PathState;
use super::vertex::RayEnd;
use super::{PathTracer, SamplingStrategy};
use crate::film::heartbeat::PixelObserver;
use crate::film::pixel::SampleId;
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
            let wo = -state.ray.direction;
            let (frame, _) = vertex
                .point
                .frame::<F>(vertex.at, vertex.shading_attributes, wo);
            FirstHitDetails {
                albedo: vertex.point.base_color(),
                normal: frame.to_world(Vec3::Z),
                point: vertex.at.point,
                uv: vertex.point.uv(),
                surface: tracer.world.surfaces[vertex.hit.surface].index,
            }
        });
        let first = match first {
            RayEnd::Surface(first) => Some(first),
            RayEnd::Medium(_) | RayEnd::Nothing => None,
        };
        self.counts.hits += u64::from(first.is_some());
        CameraHit {
            direction: state.ray.direction,
            first,
        }
    }
}
