//! The first hit of a camera ray, as the course's integrator sees it.

use super::Tracer;
use crate::render::film::Seeds;
use crate::render::film::pixel::SampleId;
use crate::render::integrator::aov::{First, FirstHit, Seen};
use crate::render::sampler::Key;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::Asked;

impl<'run, S: Geometry, const F: u32> FirstHit<'run> for Tracer<'run, S, F> {
    fn first_hit(&mut self, id: &SampleId) -> Seen {
        let camera = self.scene().camera();
        let [cell, k] = self.grid.split(id.index);
        let ray = self
            .grid
            .cell(camera, id.pixel, self.grid.place_of(cell), Seeds::NONE)
            .ray(camera, k);
        let first = self.world.nearest(&ray).map(|hit| {
            let view = self.view_of(&ray, hit, Key::new(id.pixel, 0));
            let shape = &self.world.surfaces[hit.surface].shape;
            let details = shape.details(&ray, &view.interaction, hit.part, Asked::ALL);
            First {
                albedo: view.color * view.material.kd.get(),
                normal: view.normal,
                point: view.interaction.point,
                uv: details.uv,
                surface: view.surface,
            }
        });
        Seen {
            direction: ray.direction,
            first,
        }
    }
}
