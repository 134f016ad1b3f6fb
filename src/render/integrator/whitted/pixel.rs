//! The samples of a pixel, and their checks during plan validation.

use super::Tracer;
use crate::camera::grid::{Cell, Grid};
use crate::camera::{camera_ray, image_point, lens_at};
use crate::film::heartbeat::Heartbeat;
use crate::film::pixel::{Sample, SampleId, Stream};
use crate::film::{Counts, Seeds};
use crate::integrator::Integrator;
use crate::lanes::LANES;
use crate::ray::Ray;
use crate::sampler::Key;
use crate::sampler::sequence::Sequence;
use crate::shape::geometry::Intersect;
use rtc_plan::{Effect, Features, PixelClass};

/// The state that the samples of a pixel share.
#[derive(Clone, Copy, Default)]
pub(super) struct PixelState {
    /// The column and the row of the cell of the next sample, and its point of the lens.
    place: [u32; 3],
    /// The cell of the previous sample, where a cell has several points of the lens.
    cell: Option<Cell>,
    /// The previous sample, if samples are checked for being equal.
    last: Option<Sample>,
    /// Whether all samples are validated to be equal.
    pub(super) is_uniform: bool,
}

impl<'run, S: Intersect, const F: u32> Integrator<'run> for Tracer<'run, S, F> {
    type Sample = Sample;

    #[inline(always)]
    fn begin(&mut self, first: &SampleId) {
        if !Self::can(Features::CAMERA) {
            self.pixel = PixelState::default();
            return;
        }
        let several = matches!(first.stream, Stream::Picture(_)) && self.grid.samples() > 1;
        let class = || self.world.plan.pixel_classes.class_of(first.pixel);
        self.pixel = PixelState {
            place: self.grid.place_of(first.index),
            is_uniform: several && class() == PixelClass::Uniform,
            ..PixelState::default()
        };
    }

    #[inline(always)]
    fn sample(&mut self, id: &SampleId) -> Sample {
        let (ray, seed) = match id.stream {
            Stream::Picture(seeds) => (self.ray_of_picture(id.pixel, seeds), seeds.path),
            Stream::Replicate { number, .. } => (self.ray_of_replicate(id, number), number),
        };
        let key = if Self::can(Features::SAMPLED) {
            Key::new(id.pixel, id.index.into()).seeded(seed)
        } else {
            Key::UNUSED
        };
        let sample = self.trace(ray, key);
        self.verify_sample(id.pixel, &sample);
        if Self::can(Features::UNPRUNED) {
            self.pixel.last = Some(sample);
        }
        sample
    }

    #[inline(always)]
    fn samples(&mut self, first: &SampleId) -> Option<[Sample; LANES]> {
        self.four_samples(first)
    }

    #[inline]
    fn is_uniform(&self) -> bool {
        self.pixel.is_uniform
    }

    fn counts(&self) -> &Counts {
        &self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'run> {
        &mut self.heartbeat
    }

    /// False after the observer said stop; then results are ignored.
    #[inline]
    fn should_continue(&mut self) -> bool {
        self.heartbeat.defer(self.pending.len());
        self.heartbeat.should_continue(&self.counts)
    }
}

/// Makes the samples of replicates independent of the random numbers of their paths.
const REPLICATE: u64 = u64::MAX - 2;

impl<S: Intersect, const F: u32> Tracer<'_, S, F> {
    /// The ray of the next sample of the grid of cells and points of the lens.
    #[inline(always)]
    pub(super) fn ray_of_picture(&mut self, pixel: [u32; 2], seeds: Seeds) -> Ray {
        let camera = self.world.camera.of(pixel);
        if !Self::can(Features::CAMERA) {
            return Grid::MIDDLE
                .cell(camera, pixel, [0; 2], seeds)
                .ray(camera, 0);
        }
        let [column, row, k] = self.next_place();
        let cell = || self.grid.cell(camera, pixel, [column, row], seeds);
        if !self.grid.has_lens() {
            return cell().ray(camera, 0);
        }
        self.counts.add(Effect::Lens);
        let cell = match self.pixel.cell {
            Some(cell) if k > 0 => cell,
            _ => cell(),
        };
        self.pixel.cell = Some(cell);
        cell.ray(camera, k)
    }

    /// The column and the row of the cell of the next sample, and its point of the lens.
    #[inline(always)]
    pub(super) fn next_place(&mut self) -> [u32; 3] {
        let place = self.pixel.place;
        self.pixel.place = self.grid.after(place);
        if place[0] + place[1] > 0 {
            self.counts.add(Effect::Supersampling);
        }
        place
    }

    /// The ray of a sample of a sequence without end.
    fn ray_of_replicate(&self, id: &SampleId, number: u64) -> Ray {
        let camera = self.world.camera.of(id.pixel);
        let sequence = Sequence::new(Key::new(id.pixel, number).child(REPLICATE));
        camera_ray(
            lens_at(camera, || sequence.lens(id.index)),
            image_point(camera, id.pixel, sequence.film(id.index)),
        )
    }

    #[inline(always)]
    fn trace(&mut self, ray: Ray, key: Key) -> Sample {
        let hits = self.counts.hits;
        let radiance = self.radiance(ray, key);
        self.weightless = false;
        self.counts.unnumbered += u64::from(radiance.is_nan());
        Sample {
            radiance,
            hit: self.counts.hits > hits,
        }
    }

    /// Checks whether a sample contradicts the plan under verification.
    #[inline(always)]
    fn verify_sample(&self, pixel: [u32; 2], sample: &Sample) {
        self.verify(Effect::Supersampling, "samples of a pixel differ", |plan| {
            let differs = |last: Sample| last.radiance != sample.radiance;
            self.pixel.last.is_some_and(differs)
                && plan.pixel_classes.class_of(pixel) == PixelClass::Uniform
        });
        let what = "a pixel that shows nothing shows something";
        self.verify(Effect::Surfaces, what, |plan| {
            sample.hit && plan.pixel_classes.class_of(pixel) == PixelClass::Nothing
        });
    }
}
