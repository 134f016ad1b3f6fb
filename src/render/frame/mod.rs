//! From world to film: pixels in tiles of one row each, on all threads of the pool.

pub(in crate::render) mod progressive;
pub(in crate::render) mod verify;

use crate::image::Image;
use crate::math::Vec3;
use crate::plan::{Effect, Features, Sight};
use crate::render::camera::{Twist, image_point, lens_point, lens_samples, ray_through};
use crate::render::film::heartbeat::Proceed;
use crate::render::film::{Counts, Crop, Film, Job, Values};
use crate::render::integrator::whitted::Tracer;
use crate::render::ray::Ray;
use crate::render::sampler::Key;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::valid::{Mode, Pattern, Proof};
use rayon::prelude::*;

impl<S: Geometry> World<S> {
    /// Renders with the features `F`; `None` if `proceed` said stop.
    pub(in crate::render) fn render_with<const F: u32>(
        &self,
        job: &Job,
        proceed: &Proceed<'_>,
    ) -> Option<Film> {
        let camera = self.scene.camera();
        let (width, height) = (camera.width.get(), camera.height.get());
        let whole = Crop {
            x: 0,
            y: 0,
            width,
            height,
        };
        let crop = job.crop.map_or(whole, |crop| crop.within(width, height));
        match self.scene.settings().mode {
            Mode::Zbuffer => {
                let job = Job {
                    tiles: None,
                    ..*job
                };
                let depth = |tracer: &mut Tracer<'_, S, F>, pixel| tracer.depth(pixel);
                let (mut depths, coverage, counts) = self.rows(whole, &job, proceed, depth)?;
                normalize_depths(&mut depths);
                let image = cut(&depths, whole, crop);
                let coverage = part(&coverage, whole, crop).copied().collect();
                Some(Film {
                    image,
                    coverage,
                    counts,
                })
            }
            Mode::Phong | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => {
                let pixel = |tracer: &mut Tracer<'_, S, F>, pixel| tracer.pixel(pixel, job);
                let (pixels, coverage, counts) = self.rows(crop, job, proceed, pixel)?;
                Some(Film {
                    image: Image {
                        width: crop.width,
                        height: crop.height,
                        pixels,
                    },
                    coverage,
                    counts,
                })
            }
        }
    }

    /// The values and the coverage of all pixels of a rectangle, row by row, and the rays they
    /// took.
    fn rows<T: Send + Clone + Default, const F: u32>(
        &self,
        crop: Crop,
        job: &Job,
        proceed: &Proceed<'_>,
        value: impl Fn(&mut Tracer<'_, S, F>, [u32; 2]) -> T + Sync,
    ) -> Option<(Vec<T>, Vec<f32>, Counts)> {
        let count = crop.width as usize * crop.height as usize;
        let (mut pixels, mut coverage) = (vec![T::default(); count], vec![0.0; count]);
        let row = |((y, row), shares): ((u32, &mut [T]), &mut [f32])| {
            let mut tracer = Tracer::new(self, proceed);
            for x in job.columns(y, crop.x..crop.x + crop.width) {
                let (before, place) = (tracer.counts, (x - crop.x) as usize);
                tracer.heartbeat.begin([x, y]);
                row[place] = value(&mut tracer, [x, y]);
                shares[place] = tracer.counts.coverage_since(&before);
                if !tracer.heartbeat.done(&tracer.counts) {
                    return None;
                }
            }
            Some(tracer.counts)
        };
        let width = (crop.width as usize).max(1);
        let rows = (crop.y..crop.y + crop.height)
            .into_par_iter()
            .zip(pixels.par_chunks_mut(width));
        let rows = rows
            .zip(coverage.par_chunks_mut(width))
            .step_by(job.stride.get() as usize);
        let counts = rows
            .map(row)
            .try_reduce(Counts::default, |a, b| Some(a.plus(b)))?;
        Some((pixels, coverage, counts))
    }
}

impl<S: Geometry, const F: u32> Tracer<'_, S, F> {
    /// The mean of all sub-samples and points of the lens.
    fn pixel(&mut self, pixel: [u32; 2], job: &Job) -> [f64; 3] {
        let scene = self.scene();
        let camera = scene.camera();
        let hits = self.counts.hits;
        let sight = self.world.plan.region.sight(pixel);
        if sight == Sight::Nothing {
            return [0.0; 3];
        }
        let mut first = None;
        let factor = if Self::can(Features::CAMERA) {
            scene.settings().supersampling.get()
        } else {
            1
        };
        let points = if Self::can(Features::CAMERA) {
            lens_samples(&camera.lens)
        } else {
            1
        };
        let mut sum = Vec3::ZERO;
        let mut sample = 0_u64;
        for j in 0..factor {
            for i in 0..factor {
                let cell = u64::from(j) * u64::from(factor) + u64::from(i);
                let key = Key::new(pixel, cell);
                let pattern = if Self::can(Features::CAMERA) {
                    scene.settings().pattern
                } else {
                    Pattern::Grid
                };
                let place = place_in_pixel(pattern, [i, j], factor, key.seeded(job.seeds.pixel));
                let target = image_point(camera, pixel, place);
                let twist = Twist::new(job.seeds.lens, key);
                for k in 0..points {
                    if !self.goes_on() {
                        return [0.0; 3];
                    }
                    let radiance = match first.filter(|_| sight == Sight::Uniform) {
                        Some(first) => first,
                        None => {
                            let ray = ray_through(camera, lens_point(camera, k, twist), target);
                            self.radiance(ray, Key::new(pixel, sample).seeded(job.seeds.path))
                        }
                    };
                    self.weightless = false;
                    self.counts.unnumbered += u64::from(radiance.is_nan());
                    self.verify(Effect::Supersampling, "samples of a pixel differ", |plan| {
                        plan.region.sight(pixel) == Sight::Uniform
                            && first.is_some_and(|first| first != radiance)
                    });
                    first = Some(radiance);
                    sum += match job.values {
                        Values::Display => radiance.clamp(Vec3::ZERO, Vec3::ONE),
                        Values::Linear => radiance,
                    };
                    sample += 1;
                }
            }
        }
        self.weightless = false;
        self.verify(
            Effect::Surfaces,
            "a pixel that shows nothing shows something",
            |plan| plan.region.sight(pixel) == Sight::Nothing && self.counts.hits > hits,
        );
        (sum / sample as f64).to_array()
    }

    /// The distance to what the middle of a pixel shows.
    fn depth(&mut self, pixel: [u32; 2]) -> Option<f64> {
        if self.world.plan.region.sight(pixel) == Sight::Nothing {
            return None;
        }
        let camera = self.scene().camera();
        let ray = ray_through(camera, camera.eye, image_point(camera, pixel, [0.5; 2]));
        self.distance(&ray)
    }
}

/// The camera rays of a pixel, in the order of its sub-samples and of the points of the lens.
pub(in crate::render) fn camera_rays(scene: &Proof, pixel: [u32; 2]) -> impl Iterator<Item = Ray> {
    let (camera, settings) = (scene.camera(), scene.settings());
    // The z-buffer asks the middle of each pixel, through the eye.
    let (factor, points, pattern) = match settings.mode {
        Mode::Zbuffer => (1, 1, Pattern::Grid),
        Mode::Phong | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => (
            settings.supersampling.get(),
            lens_samples(&camera.lens),
            settings.pattern,
        ),
    };
    let cells = (0..factor).flat_map(move |j| (0..factor).map(move |i| [i, j]));
    cells.flat_map(move |[i, j]| {
        let key = Key::new(pixel, u64::from(j) * u64::from(factor) + u64::from(i));
        let target = image_point(camera, pixel, place_in_pixel(pattern, [i, j], factor, key));
        (0..points)
            .map(move |k| ray_through(camera, lens_point(camera, k, Twist::new(0, key)), target))
    })
}

/// Where in its pixel a sub-sample lies, each coordinate in [0, 1].
fn place_in_pixel(pattern: Pattern, cell: [u32; 2], factor: u32, key: Key) -> [f64; 2] {
    let key = key.child(PATTERN);
    let random = || [key.uniform(0), key.uniform(1)];
    let within = |offset: [f64; 2]| {
        [0, 1].map(|axis| (f64::from(cell[axis]) + offset[axis]) / f64::from(factor))
    };
    match pattern {
        Pattern::Grid => within([0.5; 2]),
        Pattern::Jitter => within(random()),
        Pattern::Random => random(),
    }
}

/// Keeps the numbers of sub-samples apart from those of the paths through them.
const PATTERN: u64 = u64::MAX;

/// Turns distances into brightness: `(t_max − t)/(t_max − t_min)` over all that was hit.
fn normalize_depths(depths: &mut [Option<f64>]) {
    let hits = || depths.iter().flatten().copied();
    let near = hits().fold(f64::INFINITY, f64::min);
    let far = hits().fold(0.0, f64::max);
    let range = far - near;
    for t in depths.iter_mut().flatten() {
        *t = if range > 0.0 { (far - *t) / range } else { 1.0 };
    }
}

/// The pixels of `crop` out of those of `whole`, in grey; black where nothing was hit.
fn cut(values: &[Option<f64>], whole: Crop, crop: Crop) -> Image {
    let pixels = part(values, whole, crop)
        .map(|value| [value.unwrap_or(0.0); 3])
        .collect();
    Image {
        width: crop.width,
        height: crop.height,
        pixels,
    }
}

/// The values of the pixels of `crop` out of those of `whole`.
fn part<T>(values: &[T], whole: Crop, crop: Crop) -> impl Iterator<Item = &T> {
    let rows = values
        .chunks(whole.width as usize)
        .skip(crop.y as usize)
        .take(crop.height as usize);
    rows.flat_map(move |row| row.iter().skip(crop.x as usize).take(crop.width as usize))
}
