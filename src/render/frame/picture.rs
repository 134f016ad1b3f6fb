//! Whole pictures: each pixel takes all samples that the scene asks for.

use super::{Selection, run};
use crate::image::Image;
use crate::plan::{Features, PixelClass};
use crate::render::camera::grid::Grid;
use crate::render::film::heartbeat::OnPixel;
use crate::render::film::pixel::{FinishedPixel, InBlocks, InOrder, SampleRanges, Stream};
use crate::render::film::tiled::Tiled;
use crate::render::film::{Counts, Crop, Film, Job, Values};
use crate::render::integrator::first_hit::{Depth, Distance};
use crate::render::integrator::path::{PathTracer, Strategy};
use crate::render::integrator::whitted::Tracer;
use crate::render::light::Lights;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::valid::{Mode, PathSettings};

impl<S: Geometry> World<S> {
    /// Renders with the features `F`; `None` if `on_pixel` said stop.
    pub(in crate::render) fn render_with<const F: u32>(
        &self,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Film> {
        if let Mode::Zbuffer = self.scene.settings().mode {
            return self.render_depth(job, on_pixel);
        }
        let samples = if Features(F).contains(Features::CAMERA) {
            Grid::of(&self.scene).samples()
        } else {
            1
        };
        let open = |pixel: [u32; 2], _: usize, _: &FinishedPixel| {
            let is_blank = self.plan.region.class_of(pixel) == PixelClass::Nothing;
            let samples = if is_blank { 0 } else { samples };
            (InOrder::new(job.values), whole(job, samples))
        };
        let mut film = Tiled::new(self.crop(job), FinishedPixel::default());
        let worker = || Tracer::<S, F>::new(self, on_pixel);
        let counts = run(&mut film, Selection::of(job), worker, &open)?;
        Some(developed(&film, counts))
    }

    /// Renders by tracing paths with the features `F`; `None` if `on_pixel` said stop.
    pub(in crate::render) fn render_paths_with<const F: u32>(
        &self,
        path: PathSettings,
        strategy: Strategy,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Film> {
        let lights = Lights::new(self, strategy);
        let tone = (job.values == Values::Display).then(|| self.scene.settings().mode.tone());
        let open = |_: [u32; 2], _: usize, _: &FinishedPixel| {
            (InBlocks::new(tone), whole(job, path.samples.get()))
        };
        let mut film = Tiled::new(self.crop(job), FinishedPixel::default());
        let worker = || {
            PathTracer::<S, F>::new(self, &lights, path, strategy, on_pixel).before(job.background)
        };
        let counts = run(&mut film, Selection::of(job), worker, &open)?;
        Some(developed(&film, counts))
    }

    /// Renders distances, the nearest of all pixels white, the farthest black.
    fn render_depth(&self, job: &Job, on_pixel: &OnPixel<'_>) -> Option<Film> {
        let open = |pixel: [u32; 2], _: usize, _: &Option<f64>| {
            let is_blank = self.plan.region.class_of(pixel) == PixelClass::Nothing;
            (Distance::default(), whole(job, u32::from(!is_blank)))
        };
        let crop = self.crop(job);
        let mut film = Tiled::new(self.crop(&Job::default()), None);
        let selection = Selection {
            tiles: None,
            stride: job.stride,
        };
        let counts = run(&mut film, selection, || Depth::new(self, on_pixel), &open)?;
        let brightness = brightness_of(film.iter().copied());
        let of_crop = || part(&film, crop);
        let pixels = of_crop().map(|t| [t.map_or(0.0, &brightness); 3]).collect();
        let coverage = of_crop()
            .map(|t| f32::from(u8::from(t.is_some())))
            .collect();
        let image = Image {
            width: crop.width,
            height: crop.height,
            pixels,
        };
        Some(Film {
            image,
            coverage,
            counts,
        })
    }

    /// The part of the picture that a job asks for.
    pub(in crate::render) fn crop(&self, job: &Job) -> Crop {
        let camera = self.scene.camera();
        let (width, height) = (camera.width.get(), camera.height.get());
        let whole = Crop {
            x: 0,
            y: 0,
            width,
            height,
        };
        job.crop.map_or(whole, |crop| crop.within(width, height))
    }
}

impl Selection {
    fn of(job: &Job) -> Self {
        Self {
            tiles: job.tiles,
            stride: job.stride,
        }
    }
}

/// The samples of a pixel that a job asks for, from the first on.
pub(in crate::render) fn whole(job: &Job, samples: u32) -> SampleRanges {
    let mut asked = SampleRanges::new();
    let samples = job.samples.map_or(samples, |most| samples.min(most.get()));
    asked.push((Stream::Picture(job.seeds), 0..samples));
    asked
}

/// The picture of a film.
fn developed(film: &Tiled<FinishedPixel>, counts: Counts) -> Film {
    let Crop { width, height, .. } = film.crop();
    Film {
        image: Image {
            width,
            height,
            pixels: film.iter().map(|pixel| pixel.color).collect(),
        },
        coverage: film.iter().map(|pixel| pixel.coverage).collect(),
        counts,
    }
}

/// How bright a distance is: `(t_max − t)/(t_max − t_min)` over all of them.
fn brightness_of(distances: impl Iterator<Item = Option<f64>>) -> impl Fn(f64) -> f64 {
    let (near, far) = distances
        .flatten()
        .fold((f64::INFINITY, 0.0_f64), |(near, far), t| {
            (near.min(t), far.max(t))
        });
    let range = far - near;
    move |t| if range > 0.0 { (far - t) / range } else { 1.0 }
}

/// The values of the pixels of `crop`, out of those of the whole picture.
fn part<K>(film: &Tiled<K>, crop: Crop) -> impl Iterator<Item = &K> {
    let width = film.crop().width as usize;
    let rows = (crop.y..crop.y + crop.height).map(move |y| y as usize * width);
    rows.flat_map(move |row| (crop.x..crop.x + crop.width).map(move |x| film.at(row + x as usize)))
}
