//! Progressive pictures: each pixel takes the requested samples that its replicates lack.

use super::{MakeIntegrator, PixelSelection, run_tiles};
use crate::film::heartbeat::PixelObserver;
use crate::film::pixel::PixelSample;
use crate::film::progressive::{ProgressiveFilm, Replicates};
use crate::integrator::anaglyph::for_eyes;
use crate::integrator::path::{PathTracer, SamplingStrategy};
use crate::integrator::whitted::WhittedTracer;
use crate::kernel::KernelTask;
use crate::light::Lights;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
use rtc_color::Tone;

/// For each pixel, row by row, the requested samples of each replicate, and of the pilot.
type SampleRange<'run> = dyn Fn(usize) -> [u32; 2] + Sync + 'run;

impl<S: Intersect> World<S> {
    /// As [`crate::AnyWorld::grow`].
    pub(crate) fn grow(
        &self,
        film: &mut ProgressiveFilm,
        wanted: &SampleRange<'_>,
        on_pixel: &PixelObserver<'_>,
    ) -> bool {
        if let Mode::Path(_) = self.settings.mode {
            return self.run_paths(ProgressivePathTask(self, film, wanted, on_pixel));
        }
        self.run(ProgressiveTask(self, film, wanted, on_pixel))
    }
}

/// Adds samples to a film.
struct ProgressiveTask<'run, S>(
    &'run World<S>,
    &'run mut ProgressiveFilm,
    &'run SampleRange<'run>,
    &'run PixelObserver<'run>,
);

impl<S: Intersect> KernelTask for ProgressiveTask<'_, S> {
    const HAS_KERNELS: bool = S::HAS_KERNELS;
    type Output = bool;

    fn run<const F: u32>(self) -> bool {
        let Self(world, film, wanted, on_pixel) = self;
        add_samples(film, wanted, None, &|| {
            let tracer = WhittedTracer::<S, F>::new(world, on_pixel);
            for_eyes(&world.camera, tracer.spread())
        })
    }
}

/// Adds samples of paths to a film.
struct ProgressivePathTask<'run, S>(
    &'run World<S>,
    &'run mut ProgressiveFilm,
    &'run SampleRange<'run>,
    &'run PixelObserver<'run>,
);

impl<S: Intersect> KernelTask for ProgressivePathTask<'_, S> {
    const HAS_KERNELS: bool = S::HAS_KERNELS;
    type Output = bool;

    fn run<const F: u32>(self) -> bool {
        let Self(world, film, wanted, on_pixel) = self;
        let (lights, background) = (Lights::new(world, SamplingStrategy::Mis), film.background);
        let tracer = || PathTracer::<S, F>::new(world, &lights, SamplingStrategy::Mis, on_pixel);
        let tone = Some(film.display);
        add_samples(film, wanted, tone, &|| {
            for_eyes(&world.camera, tracer().before(background))
        })
    }
}

/// Takes the requested samples by integrators that `make_integrator` makes, displayed by `tone`;
/// false if the observer said stop.
fn add_samples(
    film: &mut ProgressiveFilm,
    wanted: &SampleRange<'_>,
    tone: Option<(Tone, f64)>,
    make_integrator: &MakeIntegrator<'_, '_, PixelSample>,
) -> bool {
    let seed = film.seed();
    let selection = PixelSelection {
        tiles: film.tiles,
        ..PixelSelection::default()
    };
    let open = |_: [u32; 2], index: usize, pixel: &Replicates| {
        (
            pixel.toned(tone),
            ProgressiveFilm::lacking(seed, pixel, wanted(index)),
        )
    };
    let (counts, is_done) = run_tiles(&mut film.pixels, selection, make_integrator, &open);
    film.counts = film.counts.plus(counts);
    is_done
}
