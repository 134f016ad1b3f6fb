//! Layers (AOVs): each pixel traces the same camera rays as for its colour, to their first hits.

use super::{Selection, run};
use crate::image::Layers;
use crate::plan::{Features, PathFeatures};
use crate::render::film::heartbeat::OnPixel;
use crate::render::film::pixel::Accumulator;
use crate::render::film::tiled::Tiled;
use crate::render::film::{Crop, Job};
use crate::render::frame::picture::asked;
use crate::render::integrator::aov::{Aov, FirstHit, FirstHits, LayerSums};
use crate::render::integrator::path::{PathTracer, Strategy};
use crate::render::integrator::whitted::Tracer;
use crate::render::light::Lights;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::render::world::settings::Mode;

impl<S: Geometry> World<S> {
    /// As [`crate::render::AnyWorld::layers`], of what this world holds.
    pub(in crate::render) fn layers(
        &self,
        wanted: &[Aov],
        crop: Crop,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Layers> {
        if let Mode::Path(samples) = self.settings.mode {
            let lights = Lights::new(self, Strategy::Mis);
            let worker = || {
                PathTracer::<S, { PathFeatures::EVERYTHING.0 }>::new(
                    self,
                    &lights,
                    Strategy::Mis,
                    on_pixel,
                )
                .knowing_all()
            };
            return self.layers_by(worker, samples, wanted, crop);
        }
        let worker = || Tracer::<S, { Features::EVERYTHING.0 }>::new(self, on_pixel);
        self.layers_by(worker, self.settings.grid.samples(), wanted, crop)
    }

    /// Renders layers by integrators that `worker` makes.
    fn layers_by<'run, I: FirstHit<'run>>(
        &self,
        worker: impl Fn() -> I + Sync + Send,
        samples: u32,
        wanted: &[Aov],
        crop: Crop,
    ) -> Option<Layers> {
        let job = Job {
            crop: Some(crop),
            ..Job::default()
        };
        let camera = &self.camera;
        let open = |_: [u32; 2], _: usize, _: &<LayerSums<'_> as Accumulator>::Kept| {
            (LayerSums::new(wanted, camera), asked(&job, 0..samples))
        };
        let mut film = Tiled::new(self.crop(&job), <LayerSums<'_> as Accumulator>::Kept::new());
        run(
            &mut film,
            Selection::default(),
            || FirstHits(worker()),
            &open,
        )?;
        Some(Layers {
            names: wanted
                .iter()
                .flat_map(|aov| aov.channels())
                .copied()
                .collect(),
            values: film.iter().flatten().copied().collect(),
        })
    }
}
