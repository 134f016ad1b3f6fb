//! The integrators. Each estimates the value of one sample of a pixel.
//!
//! - [`whitted`]: the integrator of course scenes, local shading plus specular rays.
//! - [`path`]: the path tracer.
//! - [`first_hit`]: depth buffers. [`aov`], [`guide`]: AOVs and denoiser guides.

pub(crate) mod aov;
pub(crate) mod first_hit;
pub(crate) mod guide;
pub(crate) mod path;
pub(crate) mod whitted;

use super::film::Counts;
use super::film::heartbeat::Heartbeat;
use super::film::pixel::SampleId;
use super::film::tile::FilmTile;
use super::lanes::LANES;

/// A way to find what samples of pixels show. Each thread has its own, which keeps its memory from
/// pixel to pixel; what it finds depends on the world and the [`SampleId`] alone.
pub(crate) trait Integrator<'run> {
    /// What a sample is.
    type Sample: Copy;

    /// Begins samples of a pixel: those of one stream, in order from `first` on.
    fn begin(&mut self, _first: &SampleId) {}

    /// What one sample shows.
    fn sample(&mut self, id: &SampleId) -> Self::Sample;

    /// What the sample and those after it show, if they can be had together: of a stream begun at
    /// which so many are left.
    fn samples(&mut self, _first: &SampleId) -> Option<[Self::Sample; LANES]> {
        None
    }

    /// Whether all samples of the pixel and the stream begun are validated to be equal.
    fn is_uniform(&self) -> bool {
        false
    }

    /// The rays traced so far.
    fn counts(&self) -> &Counts;

    /// Tells the observer how far the work is, and whether to continue.
    fn heartbeat(&mut self) -> &mut Heartbeat<'run>;

    /// Whether to continue: to be asked before each sample.
    fn should_continue(&mut self) -> bool;

    /// Takes the samples that a tile is to have; false if the observer said stop. In which order
    /// rays are traced is the integrator's own affair: a pixel gets its samples in theirs.
    fn render(&mut self, tile: &mut dyn FilmTile<Self::Sample>) -> bool {
        while let Some((pixel, asked)) = tile.next() {
            self.heartbeat().begin(pixel);
            for (stream, samples) in (0..).map_while(|k| asked.stream(k)) {
                let mut id = SampleId {
                    pixel,
                    stream,
                    index: samples.start,
                };
                self.begin(&id);
                let mut left = samples;
                while let Some(index) = left.next() {
                    if !self.should_continue() {
                        return false;
                    }
                    id.index = index;
                    if left.len() + 1 >= LANES
                        && let Some(samples) = self.samples(&id)
                    {
                        for sample in samples {
                            tile.add(&id, sample);
                            id.index += 1;
                        }
                        left.start = id.index;
                        continue;
                    }
                    let sample = self.sample(&id);
                    tile.add(&id, sample);
                    if self.is_uniform() {
                        for index in left.by_ref() {
                            id.index = index;
                            tile.add(&id, sample);
                        }
                    }
                }
            }
            tile.close();
            let rays = self.counts().rays();
            if !self.heartbeat().done(rays) {
                return false;
            }
        }
        true
    }
}
