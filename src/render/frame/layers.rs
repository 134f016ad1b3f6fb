//! Layers (AOVs): each pixel traces the same camera rays as for its colour, to their first hits.

use super::{Selection, run};
use crate::image::Layers;
use crate::plan::Features;
use crate::render::film::Job;
use crate::render::film::heartbeat::OnPixel;
use crate::render::film::pixel::Accumulator;
use crate::render::film::tiled::Tiled;
use crate::render::frame::picture::asked;
use crate::render::integrator::aov::{Aov, FirstHit, FirstHits, LayerSums};
use crate::render::integrator::path::{FirstHitsOfPaths, Strategy};
use crate::render::integrator::whitted::Tracer;
use crate::render::light::Lights;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::render::world::settings::Mode;
use std::iter::repeat_n;

impl<S: Geometry> World<S> {
    /// As [`crate::render::AnyWorld::layers`], of what this world holds.
    pub(in crate::render) fn layers(
        &self,
        wanted: &[Aov],
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Layers> {
        if let Mode::Path(samples) = self.settings.mode {
            let lights = Lights::new(self, Strategy::Mis);
            let worker = || FirstHitsOfPaths::new(self, &lights, on_pixel);
            return self.layers_by(worker, samples, wanted, job);
        }
        let worker = || FirstHits(Tracer::<S, { Features::EVERYTHING.0 }>::new(self, on_pixel));
        self.layers_by(worker, self.settings.grid.samples(), wanted, job)
    }

    /// Renders layers by the first hits of integrators that `worker` makes.
    fn layers_by<'run, I: FirstHit<'run>>(
        &self,
        worker: impl Fn() -> FirstHits<I> + Sync + Send,
        samples: u32,
        wanted: &[Aov],
        job: &Job,
    ) -> Option<Layers> {
        let camera = &self.camera;
        let open = |_: [u32; 2], _: usize, _: &<LayerSums<'_> as Accumulator>::Kept| {
            (LayerSums::new(wanted, camera), asked(job, 0..samples))
        };
        let blank = <LayerSums<'_> as Accumulator>::Kept::new();
        let mut film = Tiled::new(self.crop(job), job.tiles, blank);
        run(&mut film, Selection::of(job), worker, &open)?;
        let names: Vec<_> = wanted.iter().flat_map(|aov| aov.channels()).collect();
        // A pixel that nobody asked for has no numbers.
        let mut values = Vec::with_capacity(film.len() * names.len());
        for kept in film.iter() {
            values.extend_from_slice(kept);
            values.extend(repeat_n(0.0, names.len() - kept.len()));
        }
        Some(Layers {
            values,
            names: names.into_iter().copied().collect(),
        })
    }
}
