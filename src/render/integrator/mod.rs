//! The integrators. Each computes the samples of pixels.
//!
//! - [`whitted`]: the integrator of course scenes, local shading plus specular rays.
//! - [`path`]: the path tracer.
//! - [`anaglyph`]: what two eyes see, in one picture, by either of them.
//! - [`first_hit`]: depth buffers. [`aov`], [`guide`]: AOVs and denoiser guides.
//!
//! The trait [`Integrator`] is the interface to `frame`: the loop begins a pixel and a stream of
//! samples, and requests its samples in order. An integrator holds a reference to the world, the
//! counts of its rays, and memory that it reuses from pixel to pixel. Each is generic over the
//! shapes of the world, and over a set of features `F` that `kernel` selects.
//!
//! A sample depends on the world and its [`SampleId`] only.

pub(crate) mod anaglyph;
pub(crate) mod aov;
pub(crate) mod first_hit;
pub(crate) mod guide;
pub(crate) mod path;
pub(crate) mod whitted;

use super::film::RayCounts;
use super::film::heartbeat::Heartbeat;
use super::film::pixel::SampleId;
use super::film::tile::FilmTile;
use super::lanes::LANES;

/// A method that computes samples of pixels. Each thread has its own, which reuses its memory from
/// pixel to pixel; the results depend on the world and the [`SampleId`] only.
pub(crate) trait Integrator<'run> {
    /// The kind of a sample.
    type Sample: Copy;

    /// Begins samples of a pixel: those of one stream, in order from `first` on.
    fn begin(&mut self, _first: &SampleId) {}

    /// The value of one sample.
    fn sample(&mut self, id: &SampleId) -> Self::Sample;

    /// The values of the sample and the following ones, if they can be computed together: of the
    /// current stream with this many remaining.
    fn samples(&mut self, _first: &SampleId) -> Option<[Self::Sample; LANES]> {
        None
    }

    /// Whether all samples of the current pixel and stream are proven to be equal.
    fn is_uniform(&self) -> bool {
        false
    }

    /// The rays traced so far.
    fn counts(&self) -> &RayCounts;

    /// Tells the observer how far the work is, and whether to continue.
    fn heartbeat(&mut self) -> &mut Heartbeat<'run>;

    /// Whether to continue: call it before each sample.
    fn should_continue(&mut self) -> bool;

    /// Takes the samples of a tile; false if the observer said stop. Rays may be traced in any
    /// order, but a pixel receives its samples in sequence.
    fn render(&mut self, tile: &mut dyn FilmTile<Self::Sample>) -> bool {
        while let Some((pixel, ranges)) = tile.next() {
            self.heartbeat().begin(pixel);
            // Each stream of a pixel has its own sample indices.
            for (stream, samples) in (0..).map_while(|k| ranges.stream(k)) {
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
                    // Take a full vector of samples at once where the integrator can.
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
                    // All samples of a uniform pixel have the value of the first.
                    if self.is_uniform() {
                        for index in left.by_ref() {
                            id.index = index;
                            tile.add(&id, sample);
                        }
                    }
                }
            }
            // Finish the pixel and tell the observer.
            tile.close();
            let rays = self.counts().rays();
            if !self.heartbeat().done(rays) {
                return false;
            }
        }
        true
    }
}
