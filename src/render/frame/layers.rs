//! Layers (AOVs): each pixel traces the same camera rays as for its colour, to their first hits.

use super::{MakeIntegrator, Selection, run};
use crate::film::Job;
use crate::film::heartbeat::OnPixel;
use crate::film::pixel::Accumulator;
use crate::film::tiled::Tiled;
use crate::frame::picture::sample_ranges;
use crate::integrator::aov::{Aov, CameraHit, FirstHits, LayerSums};
use crate::integrator::path::{FirstHitsOfPaths, Strategy};
use crate::integrator::whitted::Tracer;
use crate::light::Lights;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
use rtc_image::Layers;
use rtc_plan::Features;
use std::iter::repeat_n;

impl<S: Intersect> World<S> {
    /// As [`crate::AnyWorld::layers`], for this world.
    pub(crate) fn layers(
        &self,
        wanted: &[Aov],
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Layers> {
        if let Mode::Path(samples) = self.settings.mode {
            let lights = Lights::new(self, Strategy::Mis);
            let make_integrator = || Box::new(FirstHitsOfPaths::new(self, &lights, on_pixel)) as _;
            return self.layers_by(&make_integrator, samples, wanted, job);
        }
        let make_integrator = || {
            let tracer = Tracer::<S, { Features::EVERYTHING.0 }>::new(self, on_pixel);
            Box::new(FirstHits(tracer)) as _
        };
        self.layers_by(&make_integrator, self.settings.grid.samples(), wanted, job)
    }

    /// Renders layers by the first hits of integrators that `make_integrator` makes.
    fn layers_by(
        &self,
        make_integrator: &MakeIntegrator<'_, '_, CameraHit>,
        samples: u32,
        wanted: &[Aov],
        job: &Job,
    ) -> Option<Layers> {
        let camera = &self.camera;
        let open = |_: [u32; 2], _: usize, _: &<LayerSums<'_> as Accumulator>::PixelState| {
            (
                LayerSums::new(wanted, camera),
                sample_ranges(job, 0..samples),
            )
        };
        let blank = <LayerSums<'_> as Accumulator>::PixelState::new();
        let mut film = Tiled::new(self.crop(job), job.tiles, blank);
        run(&mut film, Selection::of(job), make_integrator, &open)?;
        let names: Vec<_> = wanted.iter().flat_map(|aov| aov.channels()).collect();
        // A pixel outside of the job has no values.
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
