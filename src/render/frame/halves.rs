//! Denoised pictures: two halves of the samples of each pixel, the guides of both, and guides of more
//! camera rays.

use super::{Selection, run};
use crate::image::{Guide, NoisyHalf, denoise};
use crate::plan::PathFeatures;
use crate::render::film::heartbeat::OnPixel;
use crate::render::film::tiled::Tiled;
use crate::render::film::{Film, Job};
use crate::render::frame::picture::asked;
use crate::render::integrator::aov::FirstHits;
use crate::render::integrator::guide::GuideSums;
use crate::render::integrator::path::{PathTracer, Strategy};
use crate::render::light::Lights;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::render::world::any::AnyWorld;
use std::ops::Range;

/// Camera rays of the exact guides for each sample, and the most that so are taken.
const GUIDE_RAYS: (u32, u32) = (4, 256);

impl<S: Geometry> World<S> {
    /// The guides of pixels by a range of the samples of traced paths.
    pub(in crate::render) fn guides(
        &self,
        samples: &Range<u32>,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Vec<Guide>> {
        let lights = Lights::new(self, Strategy::Mis);
        let tracer = || {
            PathTracer::<S, { PathFeatures::EVERYTHING.0 }>::new(
                self,
                &lights,
                Strategy::Mis,
                on_pixel,
            )
            .knowing_all()
        };
        let open = |_: [u32; 2], _: usize, _: &Guide| {
            (GuideSums::new(&self.camera), asked(job, samples.clone()))
        };
        let mut film = Tiled::new(self.crop(job), job.tiles, Guide::default());
        run(&mut film, Selection::of(job), || FirstHits(tracer()), &open)?;
        Some(film.iter().copied().collect())
    }
}

impl AnyWorld {
    /// A denoised picture of traced paths, of so many samples a pixel, at least 2; `None` if
    /// `on_pixel` said stop.
    #[must_use]
    pub fn denoised(&self, samples: u32, job: &Job, on_pixel: &OnPixel<'_>) -> Option<Film> {
        let middle = samples / 2;
        let ranges = [0..middle, middle..samples];
        let [first, second] = ranges
            .clone()
            .map(|range| self.range(&range, job, on_pixel));
        let films = [first?, second?];
        let (rays, most) = GUIDE_RAYS;
        let rays = samples.saturating_mul(rays).min(most).max(samples);
        let all = [ranges[0].clone(), ranges[1].clone(), 0..rays];
        let mut guides = self.guides(&all, job, on_pixel)?;
        scale_distances(&mut guides);
        let [first, second, exact] = guides;
        let half = |film, guides| NoisyHalf {
            image: film,
            guides,
        };
        let halves = [
            half(&films[0].image, &first),
            half(&films[1].image, &second),
        ];
        let image = denoise(halves, &exact);
        let [a, b] = films;
        let mean = |(a, b): (f32, f32)| {
            let parts = [(a, middle), (b, samples - middle)];
            parts
                .map(|(part, count)| part * count as f32)
                .iter()
                .sum::<f32>()
                / samples as f32
        };
        let coverage = a.coverage.into_iter().zip(b.coverage).map(mean);
        Some(Film {
            image,
            coverage: coverage.collect(),
            counts: a.counts.plus(b.counts),
        })
    }
}

/// Scales the distances of guides to [0, 1], by those that the last meet.
fn scale_distances(guides: &mut [Vec<Guide>; 3]) {
    const LAST: usize = crate::image::GUIDES - 1;
    let met = guides[2].iter().filter(|guide| guide[0] > 0.0);
    let distances = met.map(|guide| guide[LAST] / guide[0]);
    let (near, far) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), d| {
        (near.min(d), far.max(d))
    });
    let scale = if far > near { 1.0 / (far - near) } else { 0.0 };
    for guide in guides.iter_mut().flatten() {
        guide[LAST] = if guide[0] > 0.0 {
            (guide[LAST] - near * guide[0]) * scale
        } else {
            0.0
        };
    }
}
