//! The samples of a pixel, and their checks during plan validation.

use super::WhittedTracer;
use crate::camera::grid::{SampleGrid, SubSample};
use crate::camera::{camera_ray, image_point, lens_at};
use crate::film::heartbeat::Heartbeat;
use crate::film::pixel::{PixelSample, SampleId, SampleStream};
use crate::film::{RayCounts, SamplingSeeds};
use crate::integrator::Integrator;
use crate::lanes::LANES;
use crate::ray::Ray;
use crate::sampler::PathVertexKey;
use crate::sampler::sequence::Sequence;
use crate::sampler::sobol::SobolPath;
use crate::shape::geometry::Intersect;
use rtc_plan::{Effect, PixelClass, WhittedFeatures};

/// The state that the samples of a pixel share.
#[derive(Clone, Copy, Default)]
pub(super) struct PixelState {
    /// The column and the row of the cell of the next sample, and its point of the lens.
    place: [u32; 3],
    /// The cell of the previous sample, where a cell has several points of the lens.
    cell: Option<SubSample>,
    /// The previous sample, if samples are checked for being equal.
    last: Option<PixelSample>,
    /// Whether all samples are validated to be equal.
    pub(super) is_uniform: bool,
}

impl<'run, S: Intersect, const F: u32> Integrator<'run> for WhittedTracer<'run, S, F> {
    type Sample = PixelSample;

    #[inline(always)]
    fn begin(&mut self, first: &SampleId) {
        if !Self::can(WhittedFeatures::CAMERA) {
            self.pixel = PixelState::default();
            return;
        }
        let several = matches!(first.stream, SampleStream::Picture(_)) && self.grid.samples() > 1;
        let class = || self.world.plan.pixel_classes.class_of(first.pixel);
        self.pixel = PixelState {
            place: self.grid.place_of(first.index),
            is_uniform: several && class() == PixelClass::Uniform,
            ..PixelState::default()
        };
    }

    #[inline(always)]
    fn sample(&mut self, id: &SampleId) -> PixelSample {
        self.go_to_moment(id);
        let (ray, seed) = match id.stream {
            SampleStream::Picture(seeds) => (self.ray_of_picture(id.pixel, seeds), seeds.path),
            SampleStream::Replicate { number, .. } => (self.ray_of_replicate(id, number), number),
        };
        let key = if Self::can(WhittedFeatures::SAMPLED) {
            PathVertexKey::new(id.pixel, id.index.into()).seeded(seed)
        } else {
            PathVertexKey::UNUSED
        };
        let sample = self.trace(ray, key);
        self.verify_sample(id.pixel, &sample);
        if Self::can(WhittedFeatures::UNPRUNED) {
            self.pixel.last = Some(sample);
        }
        sample
    }

    #[inline(always)]
    fn samples(&mut self, first: &SampleId) -> Option<[PixelSample; LANES]> {
        self.four_samples(first)
    }

    #[inline]
    fn is_uniform(&self) -> bool {
        self.pixel.is_uniform
    }

    fn counts(&self) -> &RayCounts {
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

impl<S: Intersect, const F: u32> WhittedTracer<'_, S, F> {
    /// Goes to the moment of the shutter at which a sample is taken, if surfaces move.
    #[inline(always)]
    pub(super) fn go_to_moment(&mut self, id: &SampleId) {
        let all = self.all_moments;
        if all.moments.is_empty() {
            return;
        }
        let numbers = SobolPath::new(id.pixel, id.index, id.stream.seeds());
        if let Some(moment) = all.moment_of(&numbers) {
            self.counts.add(Effect::MotionBlur);
            self.world = &all.moments[moment];
        }
    }

    /// The ray of the next sample of the grid of cells and points of the lens.
    #[inline(always)]
    pub(super) fn ray_of_picture(&mut self, pixel: [u32; 2], seeds: SamplingSeeds) -> Ray {
        let camera = self.world.camera.of(pixel);
        if !Self::can(WhittedFeatures::CAMERA) {
            return SampleGrid::MIDDLE
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
        let sequence = Sequence::new(PathVertexKey::new(id.pixel, number).child(REPLICATE));
        camera_ray(
            lens_at(camera, || sequence.lens(id.index)),
            image_point(camera, id.pixel, sequence.film(id.index)),
        )
    }

    #[inline(always)]
    fn trace(&mut self, ray: Ray, key: PathVertexKey) -> PixelSample {
        let hits = self.counts.hits;
        let radiance = self.radiance(ray, key);
        self.weightless = false;
        self.counts.unnumbered += u64::from(radiance.is_nan());
        PixelSample {
            radiance,
            hit: self.counts.hits > hits,
        }
    }

    /// Checks whether a sample contradicts the plan under verification.
    #[inline(always)]
    fn verify_sample(&self, pixel: [u32; 2], sample: &PixelSample) {
        self.verify(Effect::Supersampling, "samples of a pixel differ", |plan| {
            let differs = |last: PixelSample| last.radiance != sample.radiance;
            self.pixel.last.is_some_and(differs)
                && plan.pixel_classes.class_of(pixel) == PixelClass::Uniform
        });
        let what = "a pixel that shows nothing shows something";
        self.verify(Effect::Surfaces, what, |plan| {
            sample.hit && plan.pixel_classes.class_of(pixel) == PixelClass::Nothing
        });
    }
}
