//! Denoised pictures: two half buffers with independent samples, the guides of both, and guides
//! from additional camera rays.

use super::{PixelSelection, run};
use crate::film::heartbeat::PixelObserver;
use crate::film::pixel::PixelSum;
use crate::film::tiled::TiledValues;
use crate::film::{Film, RayCounts, RenderSelection};
use crate::frame::picture::sample_ranges;
use crate::integrator::guide::{GuideSums, GuidedAccumulator};
use crate::integrator::path::{GuidedPathTracer, PathFirstHitFinder, SamplingStrategy};
use crate::light::Lights;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::any::AnyWorld;
use rtc_image::{DenoisedImage, DenoisingGuide, Image, NoisyHalf, denoise};
use std::ops::Range;

/// Camera rays of the exact guides for each sample, those of the picture included, and the most
/// that so are taken.
const GUIDE_RAYS: (u32, u32) = (5, 256);

/// Guides of halves that differ by less than the root of this are exact enough.
const EXACT: f64 = 1e-3;

/// A denoised picture as rendered.
#[derive(Clone, Debug)]
pub struct DenoisedFilm {
    /// The picture, and all rays, those of guides included.
    pub film: Film,
    /// The noisy picture of the same samples.
    pub plain: Image,
    /// For each pixel about how large its squared error is, relative to its brightness.
    pub doubts: Vec<f64>,
}

impl<S: Intersect> World<S> {
    /// The guides of pixels by ranges of the samples of traced paths, and the rays they take.
    pub(crate) fn guides(
        &self,
        samples: &(dyn Fn(usize) -> Range<u32> + Sync),
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<(Vec<DenoisingGuide>, RayCounts)> {
        let lights = Lights::new(self, SamplingStrategy::Mis);
        let make_integrator = || Box::new(PathFirstHitFinder::new(self, &lights, on_pixel)) as _;
        let open = |_: [u32; 2], index: usize, _: &DenoisingGuide| {
            (
                GuideSums::new(&self.camera),
                sample_ranges(job, samples(index)),
            )
        };
        let mut film = TiledValues::new(self.crop(job), job.tiles, DenoisingGuide::default());
        let counts = run(&mut film, PixelSelection::of(job), &make_integrator, &open)?;
        Some((film.iter().copied().collect(), counts))
    }
}

/// A picture of some samples, and the guides of their camera rays.
pub(crate) type GuidedFilm = (Film, Vec<DenoisingGuide>);

impl<S: Intersect> World<S> {
    /// Renders a range of the samples of traced paths, with the guides of their camera rays.
    pub(crate) fn guided(
        &self,
        samples: &Range<u32>,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<GuidedFilm> {
        if self.camera.is_anaglyph() {
            // Its colours are of both eyes, its guides of the left one.
            let mut film = self.whole(job, |_, job| self.sum(samples, job, on_pixel))?;
            let (guides, counts) = self.guides(&|_| samples.clone(), job, on_pixel)?;
            film.counts = film.counts.plus(counts);
            return Some((film, guides));
        }
        let lights = Lights::new(self, SamplingStrategy::Mis);
        let make_integrator = || Box::new(GuidedPathTracer::new(self, &lights, job, on_pixel)) as _;
        let open = |_: [u32; 2], _: usize, _: &(PixelSum, DenoisingGuide)| {
            (
                GuidedAccumulator::new(&self.camera),
                sample_ranges(job, samples.clone()),
            )
        };
        let mut guides = Vec::new();
        let film = self.whole(job, |_, job| {
            let none = (PixelSum::default(), DenoisingGuide::default());
            let mut film = TiledValues::new(self.crop(job), job.tiles, none);
            let counts = run(&mut film, PixelSelection::of(job), &make_integrator, &open)?;
            guides = film.iter().map(|(_, guide)| *guide).collect();
            let mut sums = self.film(job);
            let pairs = sums.values_mut().zip(film.values());
            pairs.for_each(|(sum, (found, _))| *sum = *found);
            Some((sums, counts))
        })?;
        Some((film, guides))
    }
}

impl AnyWorld {
    /// A denoised path-traced picture with the given samples per pixel, at least 2; `None` if
    /// `on_pixel` said stop. `between` is called between two passes over all pixels.
    #[must_use]
    pub fn denoised(
        &self,
        samples: u32,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
        between: &dyn Fn(),
    ) -> Option<DenoisedFilm> {
        // Render both halves of the samples by no rule: rules keep colours, but not all guides.
        let unpruned = self.unpruned();
        let world = unpruned.as_ref().unwrap_or(self);
        let middle = samples / 2;
        let ranges = [0..middle, middle..samples];
        let (a, first) = world.guided(&ranges[0], job, on_pixel)?;
        between();
        let (b, second) = world.guided(&ranges[1], job, on_pixel)?;
        between();
        let halves = [first, second];
        let (guides, of_guides) = world.exact_guides(halves, &ranges, job, on_pixel)?;
        let [first, second, exact] = &guides;
        // Denoise, with each half weighting the other.
        let half = |image, guides| NoisyHalf { image, guides };
        let halves = [half(&a.image, first), half(&b.image, second)];
        let DenoisedImage { image, doubts } = denoise(halves, exact);
        let [first, second] = ranges.map(|range| range.len() as f64);
        let mean = |a: f64, b: f64| (a * first + b * second) / (first + second);
        let pairs = a.image.pixels.iter().zip(&b.image.pixels);
        let pixels = pairs.map(|(a, b)| [0, 1, 2].map(|c| mean(a[c], b[c])));
        let plain = Image {
            pixels: pixels.collect(),
            ..image
        };
        let coverage = a.coverage.iter().zip(&b.coverage);
        let coverage = coverage.map(|(a, b)| mean(f64::from(*a), f64::from(*b)) as f32);
        let film = Film {
            image,
            coverage: coverage.collect(),
            counts: a.counts.plus(b.counts).plus(of_guides),
        };
        Some(DenoisedFilm {
            film,
            plain,
            doubts,
        })
    }

    /// The guides of two ranges of samples, and exact ones: where those differ, by more rays.
    fn exact_guides(
        &self,
        [first, second]: [Vec<DenoisingGuide>; 2],
        ranges: &[Range<u32>; 2],
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<([Vec<DenoisingGuide>; 3], RayCounts)> {
        // More rays where halves differ.
        let (rays, most) = GUIDE_RAYS;
        let samples = ranges[1].end;
        let rays = samples.saturating_mul(rays).min(most).max(samples);
        let is_exact = |index: usize| {
            let pairs = first[index][..DISTANCE].iter().zip(&second[index]);
            pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>() < EXACT
        };
        let wanted = |index| samples..if is_exact(index) { samples } else { rays };
        let (mut exact, counts) = self.guides(&wanted, job, on_pixel)?;
        // The mean of all rays of a pixel.
        for (index, guide) in exact.iter_mut().enumerate() {
            let sources = [&first[index], &second[index], &*guide];
            let counts = [&ranges[0], &ranges[1], &wanted(index)].map(|range| range.len() as f64);
            let sum = |k: usize| (0..3).map(|i| counts[i] * sources[i][k]).sum::<f64>();
            *guide = std::array::from_fn(|k| sum(k) / counts.iter().sum::<f64>());
        }
        let mut guides = [first, second, exact];
        scale_distances(&mut guides);
        Some((guides, counts))
    }
}

/// The place of the distance in a guide.
const DISTANCE: usize = rtc_image::GUIDES - 1;

/// Scales the distances of guides to [0, 1], by those that the last meet.
fn scale_distances(guides: &mut [Vec<DenoisingGuide>; 3]) {
    let with_hit = guides[2].iter().filter(|guide| guide[0] > 0.0);
    let distances = with_hit.map(|guide| guide[DISTANCE] / guide[0]);
    let (near, far) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), d| {
        (near.min(d), far.max(d))
    });
    let scale = if far > near { 1.0 / (far - near) } else { 0.0 };
    for guide in guides.iter_mut().flatten() {
        guide[DISTANCE] = if guide[0] > 0.0 {
            (guide[DISTANCE] - near * guide[0]) * scale
        } else {
            0.0
        };
    }
}
