//! The first vertex of a path.

use super::PathTracer;
use super::state::PathState;
use crate::math::Vec3;
use crate::render::film::Seeds;
use crate::render::film::pixel::SampleId;
use crate::render::integrator::aov::{CameraHit, First, FirstHit};
use crate::render::sampler::sobol::Sobol;
use crate::render::shape::geometry::Geometry;

impl<'run, S: Geometry, const F: u32> FirstHit<'run> for PathTracer<'run, S, F> {
    fn first_hit(&mut self, id: &SampleId) -> CameraHit {
        let sobol = Sobol::new(id.pixel, id.index, Seeds::NONE);
        let mut state = PathState::new(self.camera_ray(id.pixel, &sobol), sobol);
        let first = self.at_closest_hit(&mut state, |tracer, state, vertex| {
            let wo = -state.ray.direction;
            let (frame, _) = vertex.point.frame::<F>(vertex.at, vertex.details, wo);
            First {
                albedo: vertex.point.base_color(),
                normal: frame.to_world(Vec3::Z),
                point: vertex.at.point,
                uv: vertex.point.uv(),
                surface: tracer.world.surfaces[vertex.hit.surface].index,
            }
        });
        CameraHit {
            direction: state.ray.direction,
            first,
        }
    }
}
