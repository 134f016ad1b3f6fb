//! The first hit of a camera ray, for the AOVs of the Whitted integrator.

use super::WhittedTracer;
use crate::film::SamplingSeeds;
use crate::film::pixel::SampleId;
use crate::integrator::aov::{CameraHit, FindFirstHit, FirstHitDetails};
use crate::sampler::PathVertexKey;
use crate::shape::geometry::AttributeRequest;
use crate::shape::geometry::Intersect;

impl<'run, S: Intersect, const F: u32> FindFirstHit<'run> for WhittedTracer<'run, S, F> {
    fn first_hit(&mut self, id: &SampleId) -> CameraHit {
        self.go_to_moment(id);
        let camera = self.world.camera.of(id.pixel);
        let [column, row, k] = self.grid.place_of(id.index);
        let cell = self
            .grid
            .cell(camera, id.pixel, [column, row], SamplingSeeds::NONE);
        let ray = cell.ray(camera, k);
        let first = self.world.closest_hit(&ray).map(|hit| {
            let shading_point = self.shading_point_of(&ray, hit, PathVertexKey::new(id.pixel, 0));
            let shape = &self.world.surfaces[hit.surface].shape;
            let shading_attributes = shape.shading_attributes(
                &ray,
                &shading_point.interaction,
                hit.prim_id,
                AttributeRequest::ALL,
            );
            FirstHitDetails {
                albedo: shading_point.color * shading_point.material.kd.get(),
                normal: shading_point.normal,
                point: shading_point.interaction.point,
                uv: shading_attributes.uv,
                surface: shading_point.surface,
            }
        });
        CameraHit {
            direction: ray.direction,
            first,
        }
    }
}
