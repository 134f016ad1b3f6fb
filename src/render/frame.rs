//! From world to film: pixels in tiles of one row each, on all threads of the pool.

use super::camera::{Twist, camera_ray, image_point, lens_point, lens_samples};
use super::film::{Counts, Crop, Film, Job, Values};
use super::sampler::Key;
use super::whitted::Tracer;
use super::world::World;
use crate::image::Image;
use crate::math::Vec3;
use crate::valid::{Mode, Pattern};
use rayon::prelude::*;

impl World {
    /// Renders on the threads of the current pool; `None` if `proceed` said stop.
    ///
    /// `proceed` is called from all threads after each pixel with the number of rays it took.
    #[must_use]
    pub fn render(&self, job: &Job, proceed: &(dyn Fn(u64) -> bool + Sync)) -> Option<Film> {
        let camera = self.scene.camera();
        let (width, height) = (camera.width.get(), camera.height.get());
        let whole = Crop { x: 0, y: 0, width, height };
        let crop = job.crop.map_or(whole, |crop| crop.within(width, height));
        match self.scene.settings().mode {
            Mode::Zbuffer => {
                let (mut depths, counts) = self.tiles(whole, proceed, |tracer, pixel| tracer.depth(pixel))?;
                normalize_depths(&mut depths);
                let image = cut(&depths, whole, crop);
                Some(Film { image, counts })
            }
            Mode::Phong | Mode::Normal | Mode::Gooch(_) => {
                let (pixels, counts) = self.tiles(crop, proceed, |tracer, pixel| tracer.pixel(pixel, job))?;
                Some(Film { image: Image { width: crop.width, height: crop.height, pixels }, counts })
            }
        }
    }

    /// The values of all pixels of a rectangle, row by row, and the rays they took.
    fn tiles<T: Send + Clone + Default>(
        &self,
        crop: Crop,
        proceed: &(dyn Fn(u64) -> bool + Sync),
        value: impl Fn(&mut Tracer<'_>, [u32; 2]) -> T + Sync,
    ) -> Option<(Vec<T>, Counts)> {
        let mut pixels = vec![T::default(); crop.width as usize * crop.height as usize];
        let row = |(y, row): (u32, &mut [T])| {
            let mut tracer = Tracer::new(self);
            for (x, pixel) in (crop.x..).zip(row) {
                let before = tracer.counts.rays();
                *pixel = value(&mut tracer, [x, y]);
                if !proceed(tracer.counts.rays() - before) {
                    return None;
                }
            }
            Some(tracer.counts)
        };
        let width = (crop.width as usize).max(1);
        let rows = (crop.y..crop.y + crop.height).into_par_iter().zip(pixels.par_chunks_mut(width));
        let counts = rows.map(row).try_reduce(Counts::default, |a, b| Some(a.plus(b)))?;
        Some((pixels, counts))
    }
}

impl Tracer<'_> {
    /// The mean of all sub-samples and points of the lens; black outside the tiles.
    fn pixel(&mut self, pixel: [u32; 2], job: &Job) -> [f64; 3] {
        if job.tiles.is_some_and(|tiles| !tiles.contain(pixel)) {
            return [0.0; 3];
        }
        let scene = self.scene();
        let camera = scene.camera();
        let factor = scene.settings().supersampling.get();
        let points = lens_samples(&camera.lens);
        let mut sum = Vec3::ZERO;
        let mut sample = 0_u64;
        for j in 0..factor {
            for i in 0..factor {
                let cell = u64::from(j) * u64::from(factor) + u64::from(i);
                let key = Key::new(pixel, cell);
                let place = place_in_pixel(scene.settings().pattern, [i, j], factor, key.seeded(job.seeds.pixel));
                let target = image_point(camera, pixel, place);
                let twist = Twist::new(job.seeds.lens, key);
                for k in 0..points {
                    let ray = camera_ray(lens_point(camera, k, twist), target);
                    let radiance = self.radiance(ray, Key::new(pixel, sample).seeded(job.seeds.path));
                    sum += match job.values {
                        Values::Display => radiance.clamp(Vec3::ZERO, Vec3::ONE),
                        Values::Linear => radiance,
                    };
                    sample += 1;
                }
            }
        }
        (sum / sample as f64).to_array()
    }

    /// The distance to what the middle of a pixel shows.
    fn depth(&mut self, pixel: [u32; 2]) -> Option<f64> {
        let camera = self.scene().camera();
        let ray = camera_ray(camera.eye, image_point(camera, pixel, [0.5; 2]));
        self.distance(&ray)
    }
}

/// Where in its pixel a sub-sample lies, each coordinate in [0, 1].
fn place_in_pixel(pattern: Pattern, cell: [u32; 2], factor: u32, key: Key) -> [f64; 2] {
    let key = key.child(PATTERN);
    let random = || [key.uniform(0), key.uniform(1)];
    let within = |offset: [f64; 2]| [0, 1].map(|axis| (f64::from(cell[axis]) + offset[axis]) / f64::from(factor));
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
    let rows = values.chunks(whole.width as usize).skip(crop.y as usize).take(crop.height as usize);
    let inside = rows.flat_map(|row| row.iter().skip(crop.x as usize).take(crop.width as usize));
    let pixels = inside.map(|value| [value.unwrap_or(0.0); 3]).collect();
    Image { width: crop.width, height: crop.height, pixels }
}
