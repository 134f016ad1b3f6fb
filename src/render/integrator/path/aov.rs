//! Layers of scenes whose paths are traced: where each path has its first corner.

use crate::image::Layers;
use crate::math::Vec3;
use crate::render::film::{Crop, Seeds};
use crate::render::integrator::aov::{Aov, First, See, Sums};
use crate::render::integrator::path::Strategy;
use crate::render::integrator::path::tracer::{Tracer, Walk};
use crate::render::light::Lights;
use crate::render::sampler::sobol::Sobol;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::valid::Path;

impl<S: Geometry> World<S> {
    /// Renders layers; `None` if `proceed` said stop.
    pub(in crate::render) fn layers_of_paths(
        &self,
        path: Path,
        wanted: &[Aov],
        crop: Crop,
        proceed: &(dyn Fn() -> bool + Sync),
    ) -> Option<Layers> {
        let lights = Lights::new(self, Strategy::Both);
        let proceed = |_| proceed();
        let tracer = || Tracer::new(self, &lights, path, Strategy::Both, &proceed).knowing_all();
        self.layers_by(tracer, wanted, crop)
    }
}

impl<S: Geometry> See for Tracer<'_, S> {
    fn see(&mut self, pixel: [u32; 2], sums: &mut Sums) -> bool {
        for index in 0..self.path.samples.get() {
            if !self.heartbeat.goes_on(&self.counts) {
                return false;
            }
            let sobol = Sobol::new(pixel, index, Seeds::NONE);
            let mut walk = Walk::new(self.camera_ray(pixel, &sobol), sobol);
            let first = self.meet(&mut walk).map(|corner| First {
                albedo: corner.point.base_color(),
                normal: corner.frame.to_world(Vec3::Z),
                point: corner.at.point,
                uv: corner.point.uv(),
                surface: self.world.surfaces[corner.hit.surface].index,
            });
            sums.add(walk.ray.direction, first);
        }
        self.heartbeat.done(&self.counts)
    }
}
