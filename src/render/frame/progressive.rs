//! A film that grows: in each pixel four strands of samples, independent of each other, two to each
//! half of the pixel.
//!
//! The mean of the halves is the picture; how far the strands of a half are apart tells what that
//! is worth. How many samples a half takes may hang on what the other half saw: neither is then
//! biased by its own luck.

use crate::color::Tone;
use crate::image::Image;
use crate::math::Vec3;
use crate::render::camera::{camera_ray, image_point, lens_at};
use crate::render::film::heartbeat::{Heartbeat, Proceed};
use crate::render::film::{Behind, Counts, Crop, Values, coverage};
use crate::render::integrator::whitted::Tracer;
use crate::render::kernel::{choose_of_few, dispatch};
use crate::render::sampler::Key;
use crate::render::sampler::sequence::Sequence;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::valid::Mode;
use rayon::prelude::*;

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Strands {
    /// How the mean of the samples is shown; none where each is clamped to [0, 1].
    tone: Option<Tone>,
    /// Per strand, the sum of its samples, clamped if they are shown so; strands 0 and 1 are the
    /// first half.
    sums: [Vec3; 4],
    /// Per half, the sum of the squared lengths of the same.
    squares: [f64; 2],
    /// Per half, the sum of its samples as they are.
    linear: [Vec3; 2],
    /// Per half, how many samples each of its strands has.
    counts: [u32; 2],
    /// Per half, how many of its samples met a surface.
    hits: [u64; 2],
}

/// A part of a picture that grows, 192 bytes a pixel.
#[derive(Clone, Debug)]
pub struct Growing {
    crop: Crop,
    seed: u64,
    /// What it shows behind all surfaces, where paths are traced.
    pub behind: Behind,
    /// Row by row.
    pub pixels: Vec<Strands>,
    /// The rays so far.
    pub counts: Counts,
}

impl Growing {
    /// A film without samples, of a part that lies within the picture. Another seed gives
    /// independent samples.
    #[must_use]
    pub fn new(crop: Crop, seed: u64) -> Self {
        let pixels = vec![Strands::default(); crop.width as usize * crop.height as usize];
        Self {
            crop,
            seed,
            behind: Behind::default(),
            pixels,
            counts: Counts::default(),
        }
    }

    /// The part of the picture that it holds.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// Takes the samples that are wanted of each pixel, by tracers of which each row has its own;
    /// see [`crate::render::AnyWorld::grow`].
    pub(in crate::render) fn lengthen<'run, T: Sampling<'run>>(
        &mut self,
        tracer: impl Fn() -> T + Sync,
        wanted: &(dyn Fn(usize) -> [u32; 2] + Sync),
    ) -> bool {
        let Self {
            crop,
            seed,
            behind: _,
            pixels,
            counts,
        } = self;
        let (crop, seed, width) = (*crop, *seed, (crop.width as usize).max(1));
        let row = |(y, row): (usize, &mut [Strands])| {
            let mut tracer = tracer();
            for (i, (x, strands)) in (crop.x..).zip(row).enumerate() {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "a row of a picture whose height is a u32"
                )]
                let pixel = [x, crop.y + y as u32];
                strands.tone = T::TONE;
                tracer.heartbeat().begin(pixel);
                strands.lengthen(wanted(y * width + i), &mut tracer, pixel, seed);
                let so_far = tracer.counts();
                if !tracer.heartbeat().done(&so_far) {
                    return None;
                }
            }
            Some(tracer.counts())
        };
        let rows = pixels.par_chunks_mut(width).enumerate().map(row);
        let more = rows.try_reduce(Counts::default, |a, b| Some(a.plus(b)));
        *counts = counts.plus(more.unwrap_or_default());
        more.is_some()
    }

    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.pixels.iter().map(Strands::samples).sum()
    }

    /// The picture so far; black where nothing was sampled.
    #[must_use]
    pub fn image(&self, values: Values) -> Image {
        let pixels = self
            .pixels
            .iter()
            .map(|pixel| pixel.mean(values).to_array())
            .collect();
        Image {
            width: self.crop.width,
            height: self.crop.height,
            pixels,
        }
    }

    /// Of each pixel the share of the samples that met a surface.
    #[must_use]
    pub fn coverage(&self) -> Vec<f32> {
        self.pixels.iter().map(Strands::coverage).collect()
    }
}

impl Strands {
    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        2 * (u64::from(self.counts[0]) + u64::from(self.counts[1]))
    }

    /// How many samples each strand of a half has.
    #[must_use]
    pub fn count(&self, half: usize) -> u32 {
        self.counts[half]
    }

    /// The variance of the mean of a half, from how far its strands are apart: the mean over the
    /// channels.
    #[must_use]
    pub fn variance_of_half(&self, half: usize) -> f64 {
        let (n, [a, b]) = (
            f64::from(self.counts[half].max(1)),
            [self.sums[2 * half], self.sums[2 * half + 1]],
        );
        let apart = match self.tone {
            None => (a - b) / n,
            Some(tone) => shown(tone, a / n) - shown(tone, b / n),
        };
        apart.length_squared() / 12.0
    }

    /// The variance of the samples of a half: the mean over the channels.
    #[must_use]
    pub fn variance_of_samples(&self, half: usize) -> f64 {
        let n = 2.0 * f64::from(self.counts[half]);
        let sum = self.sums[2 * half] + self.sums[2 * half + 1];
        let square = self.squares[half] - sum.length_squared() / n.max(1.0);
        let variance = square.max(0.0) / (3.0 * (n - 1.0).max(1.0));
        match self.tone {
            None => variance,
            Some(tone) => {
                let (mean, deviation) = (
                    sum.element_sum() / (3.0 * n.max(1.0)),
                    (variance / n.max(1.0)).sqrt(),
                );
                variance * slope(tone, mean, deviation)
            }
        }
    }

    /// The share of the samples that met a surface: the mean of the halves.
    fn coverage(&self) -> f32 {
        let of = |half: usize| coverage(self.hits[half], 2 * u64::from(self.counts[half]));
        (of(0) + of(1)) * 0.5
    }

    /// The mean of the halves, whatever the samples of each.
    fn mean(&self, values: Values) -> Vec3 {
        let of = |half: usize| {
            let sum = match values {
                Values::Display => self.sums[2 * half] + self.sums[2 * half + 1],
                Values::Linear => self.linear[half],
            };
            sum / (2.0 * f64::from(self.counts[half].max(1)))
        };
        let mean = (of(0) + of(1)) * 0.5;
        match (values, self.tone) {
            (Values::Display, Some(tone)) => shown(tone, mean),
            (Values::Display | Values::Linear, _) => mean,
        }
    }

    /// Takes the samples of a pixel that the strands lack of those wanted.
    fn lengthen<'run>(
        &mut self,
        wanted: [u32; 2],
        tracer: &mut impl Sampling<'run>,
        pixel: [u32; 2],
        seed: u64,
    ) {
        for strand in 0..4_usize {
            let (half, before) = (strand / 2, tracer.counts().hits);
            let number = (seed << 2 | strand as u64).wrapping_add(1);
            for index in self.counts[half]..wanted[half] {
                let so_far = tracer.counts();
                if !tracer.heartbeat().goes_on(&so_far) {
                    return;
                }
                let radiance = tracer.sample(pixel, number, index);
                let shown = match self.tone {
                    None => radiance.clamp(Vec3::ZERO, Vec3::ONE),
                    Some(_) => radiance,
                };
                self.sums[strand] += shown;
                self.squares[half] += shown.length_squared();
                self.linear[half] += radiance;
            }
            self.hits[half] += tracer.counts().hits - before;
        }
        self.counts = [0, 1].map(|half: usize| self.counts[half].max(wanted[half]));
    }
}

fn shown(tone: Tone, mean: Vec3) -> Vec3 {
    Vec3::from_array(tone.display(mean.to_array()))
}

/// The square of how much faster what is shown of a grey grows than the grey, about a mean of the
/// deviation given.
fn slope(tone: Tone, mean: f64, deviation: f64) -> f64 {
    if deviation == 0.0 {
        return 0.0;
    }
    let [low, high] =
        [mean - deviation, mean + deviation].map(|grey| shown(tone, Vec3::splat(grey)).x);
    let slope = (high - low) / (2.0 * deviation);
    slope * slope
}

/// What takes samples of pixels.
pub(in crate::render) trait Sampling<'run> {
    /// How the mean of its samples is shown; none where each is clamped to [0, 1].
    const TONE: Option<Tone>;

    /// Sample `index` of strand `number` of a pixel, strands of other numbers being independent.
    fn sample(&mut self, pixel: [u32; 2], number: u64, index: u32) -> Vec3;

    /// The rays traced so far.
    fn counts(&self) -> Counts;

    /// Tells of the pixel under way, and whether to go on with it.
    fn heartbeat(&mut self) -> &mut Heartbeat<'run>;
}

impl<S: Geometry> World<S> {
    /// As [`crate::render::AnyWorld::grow`].
    pub(in crate::render) fn grow(
        &self,
        film: &mut Growing,
        wanted: &(dyn Fn(usize) -> [u32; 2] + Sync),
        proceed: &Proceed<'_>,
    ) -> bool {
        if let Mode::Path(path) = self.scene.settings().mode {
            return self.grow_paths(path, film, wanted, proceed);
        }
        dispatch!(choose_of_few(self.plan.features); 1 4 10; self.grow_with(film, wanted, proceed))
    }

    /// Grows with the features `F`.
    fn grow_with<const F: u32>(
        &self,
        film: &mut Growing,
        wanted: &(dyn Fn(usize) -> [u32; 2] + Sync),
        proceed: &Proceed<'_>,
    ) -> bool {
        let tracer = || {
            let mut tracer: Tracer<'_, S, F> = Tracer::new(self, proceed);
            tracer.spread = true;
            tracer
        };
        film.lengthen(tracer, wanted)
    }
}

/// Keeps the numbers of strands apart from those of the paths through them.
const STRAND: u64 = u64::MAX - 2;

impl<'world, S: Geometry, const F: u32> Sampling<'world> for Tracer<'world, S, F> {
    const TONE: Option<Tone> = None;

    fn sample(&mut self, pixel: [u32; 2], number: u64, index: u32) -> Vec3 {
        let camera = self.scene().camera();
        let [x, y, u, v] = Sequence::new(Key::new(pixel, number).child(STRAND)).point(index);
        let origin = lens_at(camera, [u, v]);
        let ray = camera_ray(origin, image_point(camera, pixel, [x, y]));
        let radiance = self.radiance(ray, Key::new(pixel, u64::from(index)).seeded(number));
        self.counts.unnumbered += u64::from(radiance.is_nan());
        radiance
    }

    fn counts(&self) -> Counts {
        self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'world> {
        &mut self.heartbeat
    }
}
