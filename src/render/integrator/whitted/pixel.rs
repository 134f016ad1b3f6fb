//! The samples of a pixel, and what a validation asks of them.

use super::Tracer;
use crate::math::Vec3;
use crate::plan::{Effect, Features, PixelClass};
use crate::render::camera::grid::{Cell, Grid};
use crate::render::camera::{camera_ray, image_point, lens_at};
use crate::render::film::heartbeat::Heartbeat;
use crate::render::film::pixel::{Sample, SampleId, Stream};
use crate::render::film::{Counts, Seeds};
use crate::render::integrator::Integrator;
use crate::render::sampler::Key;
use crate::render::sampler::sequence::Sequence;
use crate::render::shape::geometry::Geometry;

/// What the samples of a pixel share.
#[derive(Clone, Copy, Default)]
pub(super) struct PixelState {
    /// Which cell, and which point of the lens, the sample before took.
    at: Option<[u32; 2]>,
    /// The column and the row of that cell.
    place: [u32; 2],
    cell: Option<Cell>,
    /// The sample before.
    last: Option<Sample>,
    /// Whether all samples are proven to be equal.
    is_uniform: bool,
}

impl<'run, S: Geometry, const F: u32> Integrator<'run> for Tracer<'run, S, F> {
    type Sample = Sample;

    #[inline]
    fn sample(&mut self, id: &SampleId) -> Sample {
        match id.stream {
            Stream::Picture(seeds) => self.sample_of_picture(id, seeds),
            Stream::Replicate { number, .. } => self.sample_of_replicate(id, number),
        }
    }

    fn counts(&self) -> &Counts {
        &self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'run> {
        &mut self.heartbeat
    }

    /// False from when the observer said stop, and nothing counts any more.
    #[inline]
    fn goes_on(&mut self) -> bool {
        self.heartbeat.put_off(self.pending.len());
        self.heartbeat.goes_on(&self.counts)
    }
}

/// Keeps the numbers of replicates apart from those of the paths through them.
const STRAND: u64 = u64::MAX - 2;

impl<S: Geometry, const F: u32> Tracer<'_, S, F> {
    /// A sample of the grid of cells and points of the lens.
    #[inline(always)]
    fn sample_of_picture(&mut self, id: &SampleId, seeds: Seeds) -> Sample {
        if id.index == 0 {
            self.begin_pixel(id.pixel);
        }
        if let Some(last) = self.pixel.last
            && self.pixel.is_uniform
        {
            return last;
        }
        let camera = &self.world.camera;
        let (cell, k) = if Self::can(Features::CAMERA) {
            self.cell_of(id, seeds)
        } else {
            (Grid::MIDDLE.cell(camera, id.pixel, [0; 2], seeds), 0)
        };
        let key = Key::new(id.pixel, id.index.into()).seeded(seeds.path);
        let sample = self.trace(cell.ray(camera, k), key);
        self.verify_sample(id.pixel, &sample);
        self.pixel.last = Some(sample);
        sample
    }

    /// A sample of a sequence without end.
    fn sample_of_replicate(&mut self, id: &SampleId, number: u64) -> Sample {
        let camera = &self.world.camera;
        let sequence = Sequence::new(Key::new(id.pixel, number).child(STRAND));
        let [x, y, u, v] = sequence.point(id.index);
        let ray = camera_ray(
            lens_at(camera, [u, v]),
            image_point(camera, id.pixel, [x, y]),
        );
        self.trace(ray, Key::new(id.pixel, id.index.into()).seeded(number))
    }

    #[inline(always)]
    fn begin_pixel(&mut self, pixel: [u32; 2]) {
        let several = Self::can(Features::CAMERA) && self.grid.samples() > 1;
        let is_uniform = several && self.world.plan.region.class_of(pixel) == PixelClass::Uniform;
        self.pixel = PixelState {
            is_uniform,
            ..PixelState::default()
        };
    }

    /// The cell of a sample, and which point of the lens it takes. Samples come in order, so that
    /// of the sample before leads to it.
    #[inline(always)]
    fn cell_of(&mut self, id: &SampleId, seeds: Seeds) -> (Cell, u32) {
        let before = self.pixel.at;
        let split = || self.grid.split(id.index);
        let [at, k] = before.map_or_else(split, |before| self.grid.after(before));
        self.pixel.at = Some([at, k]);
        if at > 0 {
            self.counts.add(Effect::Supersampling);
        }
        if self.grid.has_lens() {
            self.counts.add(Effect::Lens);
        }
        let cell = match self.pixel.cell {
            Some(cell) if k > 0 => cell,
            _ => {
                self.pixel.place = match before {
                    Some(_) => self.grid.next_place(at, self.pixel.place),
                    None => self.grid.place_of(at),
                };
                let camera = &self.world.camera;
                self.grid.cell(camera, id.pixel, self.pixel.place, seeds)
            }
        };
        self.pixel.cell = Some(cell);
        (cell, k)
    }

    #[inline(always)]
    fn trace(&mut self, ray: crate::render::ray::Ray, key: Key) -> Sample {
        let hits = self.counts.hits;
        let radiance: Vec3 = self.radiance(ray, key);
        self.weightless = false;
        self.counts.unnumbered += u64::from(radiance.is_nan());
        Sample {
            radiance,
            hit: self.counts.hits > hits,
        }
    }

    /// Looks whether a sample shows what the plan under validation rules out.
    #[inline(always)]
    fn verify_sample(&self, pixel: [u32; 2], sample: &Sample) {
        self.verify(Effect::Supersampling, "samples of a pixel differ", |plan| {
            let differs = |last: Sample| last.radiance != sample.radiance;
            self.pixel.last.is_some_and(differs)
                && plan.region.class_of(pixel) == PixelClass::Uniform
        });
        let what = "a pixel that shows nothing shows something";
        self.verify(Effect::Surfaces, what, |plan| {
            sample.hit && plan.region.class_of(pixel) == PixelClass::Nothing
        });
    }
}
