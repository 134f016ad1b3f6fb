//! Complete and partial pictures: each pixel takes the samples of the scene's settings, or a range.
//! Layers (AOVs) trace the same camera rays, to their first hits.

use super::{MakeIntegrator, PixelSelection, run, run_monitored};
use crate::film::heartbeat::PixelObserver;
use crate::film::partial::{FilmError, FilmLayout, PartialFilm, Summation};
use crate::film::pixel::{
    BlockAccumulator, PixelAccumulator, PixelSum, SampleRanges, SequentialAccumulator,
};
use crate::film::tile::BeginPixel;
use crate::film::tiled::TiledValues;
use crate::film::{Crop, Film, RayCounts, RenderSelection};
use crate::integrator::anaglyph::for_eyes;
use crate::integrator::aov::{Aov, AovAccumulator, CameraHit, FirstHitFinder};
use crate::integrator::first_hit::{DepthIntegrator, PixelDistance};
use crate::integrator::path::{PathFirstHitFinder, PathTracer, SamplingStrategy};
use crate::integrator::whitted::WhittedTracer;
use crate::light::Lights;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
use rtc_image::PixelLayers;
use rtc_plan::{FeatureSet, PixelClass, WhittedFeatures};
use std::iter::repeat_n;
use std::ops::Range;

/// The sums of the pixels of a picture, and the rays they took.
pub(crate) type PictureSums = (TiledValues<PixelSum>, RayCounts);

impl<S: Intersect> World<S> {
    /// Sums all samples of pixels with the features `F`; `None` if `on_pixel` said stop.
    pub(crate) fn sum_with<const F: u32>(
        &self,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PictureSums> {
        if let Mode::Depth = self.settings.mode {
            return self.sum_distances(job, on_pixel);
        }
        let samples = if FeatureSet(F).contains(WhittedFeatures::CAMERA) {
            self.settings.grid.samples()
        } else {
            1
        };
        let open = |pixel: [u32; 2], _: usize, _: &PixelSum| {
            let is_blank = self.plan.pixel_classes.class_of(pixel) == PixelClass::Nothing;
            let samples = if is_blank { 0 } else { samples };
            (
                SequentialAccumulator::new(job.values),
                sample_ranges(job, 0..limited(job, samples)),
            )
        };
        let tracer = || WhittedTracer::<S, F>::new(self, on_pixel);
        let make_integrator = || for_eyes(&self.camera, tracer());
        self.run_job(job, &make_integrator, &open)
    }

    /// Sums samples of pixels by tracing paths with the features `F`; `None` if `on_pixel` said
    /// stop.
    pub(crate) fn sum_paths_with<const F: u32>(
        &self,
        strategy: SamplingStrategy,
        samples: &Range<u32>,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PictureSums> {
        let lights = Lights::new(self, strategy);
        let open = |_: [u32; 2], _: usize, _: &PixelSum| {
            (
                BlockAccumulator::default(),
                sample_ranges(job, samples.clone()),
            )
        };
        let make_integrator = || {
            let tracer = PathTracer::<S, F>::new(self, &lights, strategy, on_pixel);
            for_eyes(
                &self.camera,
                tracer.before(job.background).clamped(job.clamp),
            )
        };
        self.run_job(job, &make_integrator, &open)
    }

    /// Distances of the complete picture: the brightness of a pixel depends on all of them.
    fn sum_distances(
        &self,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PictureSums> {
        let open = |pixel: [u32; 2], _: usize, _: &PixelSum| {
            let is_blank = self.plan.pixel_classes.class_of(pixel) == PixelClass::Nothing;
            (
                PixelDistance::default(),
                sample_ranges(job, 0..u32::from(!is_blank)),
            )
        };
        let make_integrator = || Box::new(DepthIntegrator::new(self, on_pixel)) as _;
        self.run_job(job, &make_integrator, &open)
    }

    /// Sums the samples of the pixels of a job.
    fn run_job<A: PixelAccumulator<PixelState = PixelSum>>(
        &self,
        job: &RenderSelection<'_>,
        make_integrator: &MakeIntegrator<'_, '_, A::Sample>,
        open: &BeginPixel<'_, A>,
    ) -> Option<PictureSums> {
        let mut film = self.film(job);
        let counts = run_monitored(
            (self.layout(job), &mut film),
            job.monitor,
            PixelSelection::of(job),
            make_integrator,
            open,
        )?;
        Some((film, counts))
    }

    /// Renders a complete picture from the sums of all samples that `sum` computes.
    pub(crate) fn whole(
        &self,
        job: &RenderSelection,
        sum: impl FnOnce(&Range<u32>, &RenderSelection) -> Option<PictureSums>,
    ) -> Option<Film> {
        let layout = self.layout(job);
        let tiles = match layout.summation {
            // The brightness of a distance depends on all others.
            Summation::Distance => None,
            Summation::InOrder | Summation::InBlocks(_) => job.tiles,
        };
        let (film, counts) = sum(&layout.all_samples(), &RenderSelection { tiles, ..*job })?;
        Some(layout.develop(&film, counts).cut(self.crop(job)))
    }

    /// Renders some samples of a picture, or all, from the sums of a range of samples that `sum`
    /// computes.
    pub(crate) fn part(
        &self,
        job: &RenderSelection,
        samples: Option<Range<u32>>,
        sum: impl Fn(&Range<u32>, &RenderSelection) -> Option<PictureSums>,
    ) -> Result<Option<PartialFilm>, FilmError> {
        let layout = self.layout(job);
        // The pixels of a part are not final.
        let job = &RenderSelection {
            monitor: None,
            ..*job
        };
        let mut part = PartialFilm::new(layout);
        for blocks in layout.nodes_of(samples)? {
            let Some((film, counts)) = sum(&layout.samples_of(&blocks), job) else {
                return Ok(None);
            };
            part.add(PartialFilm::of(layout, &blocks, film, counts))?;
        }
        Ok(Some(part))
    }

    /// A film of the tiles of a job, without samples.
    pub(super) fn film(&self, job: &RenderSelection) -> TiledValues<PixelSum> {
        TiledValues::new(self.layout(job).crop, job.tiles, PixelSum::default())
    }

    /// The pixels of a job, and the summation of their samples.
    fn layout(&self, job: &RenderSelection) -> FilmLayout {
        let (crop, summation) = match self.settings.mode {
            Mode::Path(samples) => {
                let samples = limited(job, samples);
                (self.crop(job), Summation::InBlocks(samples))
            }
            Mode::Depth => (self.crop(&RenderSelection::default()), Summation::Distance),
            Mode::Phong | Mode::Normal | Mode::Gooch(_) => (self.crop(job), Summation::InOrder),
        };
        let values = job.values;
        FilmLayout {
            crop,
            values,
            summation,
        }
    }

    /// The crop of a job.
    pub(crate) fn crop(&self, job: &RenderSelection) -> Crop {
        let [width, height] = self.camera.size;
        let whole = Crop {
            x: 0,
            y: 0,
            width,
            height,
        };
        job.crop.map_or(whole, |crop| crop.within(width, height))
    }
}

impl PixelSelection {
    /// The request of a job.
    pub(crate) fn of(job: &RenderSelection) -> Self {
        Self {
            tiles: job.tiles,
            stride: job.stride,
        }
    }
}

/// The number of samples of a pixel, limited by the job.
fn limited(job: &RenderSelection, samples: u32) -> u32 {
    job.samples.map_or(samples, |most| samples.min(most.get()))
}

/// The samples of a pixel in a job.
pub(crate) fn sample_ranges(job: &RenderSelection, samples: Range<u32>) -> SampleRanges {
    SampleRanges::Picture(job.seeds, samples)
}

impl<S: Intersect> World<S> {
    /// As [`crate::AnyWorld::layers`], for this world.
    pub(crate) fn layers(
        &self,
        wanted: &[Aov],
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PixelLayers> {
        if let Mode::Path(samples) = self.settings.mode {
            let lights = Lights::new(self, SamplingStrategy::Mis);
            let make_integrator =
                || Box::new(PathFirstHitFinder::new(self, &lights, on_pixel)) as _;
            return self.layers_by(&make_integrator, samples, wanted, job);
        }
        let make_integrator = || {
            let tracer = WhittedTracer::<S, { WhittedFeatures::EVERYTHING.0 }>::new(self, on_pixel);
            Box::new(FirstHitFinder(tracer)) as _
        };
        self.layers_by(&make_integrator, self.settings.grid.samples(), wanted, job)
    }

    /// Renders layers by the first hits of integrators that `make_integrator` makes.
    fn layers_by(
        &self,
        make_integrator: &MakeIntegrator<'_, '_, CameraHit>,
        samples: u32,
        wanted: &[Aov],
        job: &RenderSelection,
    ) -> Option<PixelLayers> {
        let camera = &self.camera;
        let open =
            |_: [u32; 2], _: usize, _: &<AovAccumulator<'_> as PixelAccumulator>::PixelState| {
                (
                    AovAccumulator::new(wanted, camera),
                    sample_ranges(job, 0..samples),
                )
            };
        let blank = <AovAccumulator<'_> as PixelAccumulator>::PixelState::new();
        let mut film = TiledValues::new(self.crop(job), job.tiles, blank);
        run(&mut film, PixelSelection::of(job), make_integrator, &open)?;
        let names: Vec<_> = wanted.iter().flat_map(|aov| aov.channels()).collect();
        // A pixel outside of the job has no values.
        let mut values = Vec::with_capacity(film.len() * names.len());
        for kept in film.iter() {
            values.extend_from_slice(kept);
            values.extend(repeat_n(0.0, names.len() - kept.len()));
        }
        Some(PixelLayers {
            values,
            names: names.into_iter().copied().collect(),
        })
    }
}
