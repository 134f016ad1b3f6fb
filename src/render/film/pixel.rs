//! The accumulators of a pixel.
//!
//! The order of summation is fixed for each kind of picture and depends on the sample indices
//! alone, so a picture has the same bytes however its samples are distributed.

use super::{SamplingSeeds, Values, coverage};
use rtc_math::Vec3;
use std::ops::{Add, Range};

/// One sample of a pixel. It is a function of these three alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleId {
    /// The pixel, from the upper left.
    pub(crate) pixel: [u32; 2],
    /// To which sequence it belongs.
    pub(crate) stream: SampleStream,
    /// Its index in that sequence.
    pub(crate) index: u32,
}

/// A sequence of samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SampleStream {
    /// The samples of the scene's settings.
    Picture(SamplingSeeds),
    /// One of three sequences without end that are independent of each other: two replicates and
    /// a pilot. Those of other numbers are independent too.
    Replicate {
        /// Which of the three.
        replicate: usize,
        /// The number that its samples are keyed by.
        number: u64,
    },
}

impl SampleStream {
    /// The seeds of its samples.
    pub(crate) fn seeds(self) -> SamplingSeeds {
        match self {
            Self::Picture(seeds) => seeds,
            Self::Replicate { number, .. } => SamplingSeeds {
                pixel: number,
                lens: number,
                path: number,
            },
        }
    }
}

/// The value of one sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelSample {
    /// The radiance, finite where paths are traced.
    pub(crate) radiance: Vec3,
    /// Whether the camera ray hit a surface.
    pub(crate) hit: bool,
}

/// Adds up the samples of one pixel.
pub(crate) trait PixelAccumulator {
    /// The kind of a sample.
    type Sample: Copy;

    /// The state of a pixel in the film.
    type PixelState: Send;

    /// Adds the next sample of a stream.
    fn add(&mut self, id: &SampleId, sample: Self::Sample);

    /// The state after all requested samples.
    fn close(self) -> Self::PixelState;
}

/// The samples that a pixel is to take.
#[derive(Clone, Debug)]
pub(crate) enum SampleRanges {
    /// A range of the samples of the scene's settings.
    Picture(SamplingSeeds, Range<u32>),
    /// A range for each of the two replicates, and one for the pilot; keyed by a seed.
    Replicates(u64, [Range<u32>; 2]),
}

impl SampleRanges {
    /// The k-th stream that samples are taken of, and which of them; `None` after the last.
    #[inline]
    pub(crate) fn stream(&self, k: usize) -> Option<(SampleStream, Range<u32>)> {
        match self {
            Self::Picture(seeds, samples) => {
                (k == 0).then(|| (SampleStream::Picture(*seeds), samples.clone()))
            }
            Self::Replicates(seed, [shown, pilot]) => {
                let number = (seed << 2 | k as u64).wrapping_add(1);
                let stream = SampleStream::Replicate {
                    replicate: k,
                    number,
                };
                let ranges = [shown, shown, pilot];
                ranges.get(k).map(|samples| (stream, (*samples).clone()))
            }
        }
    }
}

/// The sum of samples of a pixel, as a film stores it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PixelSum {
    /// The sum of the radiance, clamped sample by sample where a display shows it so; of a depth
    /// buffer the distance, in each channel.
    pub(crate) radiance: Vec3,
    /// The number of samples that hit a surface.
    pub(crate) hits: u32,
    /// The number of samples.
    pub(crate) samples: u32,
}

impl PixelSum {
    /// The mean of the samples; black without any.
    pub(crate) fn mean(&self) -> [f64; 3] {
        (self.radiance / f64::from(self.samples.max(1))).to_array()
    }

    /// The fraction of the camera rays that hit a surface.
    pub(crate) fn coverage(&self) -> f32 {
        coverage(self.hits.into(), self.samples.into())
    }
}

impl Add for PixelSum {
    type Output = Self;

    fn add(self, later: Self) -> Self {
        Self {
            radiance: self.radiance + later.radiance,
            hits: self.hits + later.hits,
            samples: self.samples + later.samples,
        }
    }
}

/// The samples, added one after the other: pictures of the course.
pub(crate) struct SequentialAccumulator {
    values: Values,
    sum: PixelSum,
}

impl SequentialAccumulator {
    pub(crate) fn new(values: Values) -> Self {
        let sum = PixelSum::default();
        Self { values, sum }
    }
}

impl PixelAccumulator for SequentialAccumulator {
    type Sample = PixelSample;
    type PixelState = PixelSum;

    #[inline]
    fn add(&mut self, _: &SampleId, PixelSample { radiance, hit }: PixelSample) {
        self.sum.radiance += match self.values {
            Values::Display => radiance.clamp(Vec3::ZERO, Vec3::ONE),
            Values::Linear => radiance,
        };
        self.sum.hits += u32::from(hit);
        self.sum.samples += 1;
    }

    fn close(self) -> PixelSum {
        self.sum
    }
}

/// Samples of a block, which are added one after the other.
pub const BLOCK: u32 = 16;

/// The samples, added in aligned blocks of [`BLOCK`] along a binary tree over the blocks:
/// path-traced pictures. The sum of any 2^k aligned blocks is one node of the tree, whichever
/// process adds it.
#[derive(Default)]
pub(crate) struct BlockAccumulator {
    block: Vec3,
    tree: SumTree,
    hits: u32,
    samples: u32,
}

/// Sums of blocks: of each level of the tree at most one node is open.
#[derive(Clone, Debug, Default)]
struct SumTree {
    /// The open nodes, those of more blocks first.
    open: arrayvec::ArrayVec<Vec3, 32>,
    blocks: u32,
}

impl PixelAccumulator for BlockAccumulator {
    type Sample = PixelSample;
    type PixelState = PixelSum;

    #[inline]
    fn add(&mut self, _: &SampleId, PixelSample { radiance, hit }: PixelSample) {
        self.block += radiance;
        self.hits += u32::from(hit);
        self.samples += 1;
        if self.samples.is_multiple_of(BLOCK) {
            self.tree.add(std::mem::take(&mut self.block));
        }
    }

    fn close(mut self) -> PixelSum {
        if !self.samples.is_multiple_of(BLOCK) {
            self.tree.add(self.block);
        }
        PixelSum {
            radiance: self.tree.sum(),
            hits: self.hits,
            samples: self.samples,
        }
    }
}

impl SumTree {
    /// Adds the sum of the next block: two nodes of one level make a node of the next.
    fn add(&mut self, block: Vec3) {
        let mut node = block;
        for _ in 0..self.blocks.trailing_ones() {
            node = self.open.pop().unwrap_or_default() + node;
        }
        self.open.push(node);
        self.blocks += 1;
    }

    /// The sum of all blocks: open nodes are added from the smallest on.
    fn sum(self) -> Vec3 {
        let smallest_first = self.open.into_iter().rev();
        smallest_first
            .reduce(|sum, node| node + sum)
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id() -> SampleId {
        SampleId {
            pixel: [0; 2],
            stream: SampleStream::Picture(SamplingSeeds::NONE),
            index: 0,
        }
    }

    fn radiance(index: u32) -> Vec3 {
        Vec3::splat(1.0 / f64::from(3 + index))
    }

    /// The sum over aligned blocks, by recursion.
    fn node(blocks: Range<u32>, samples: u32) -> Vec3 {
        if blocks.len() == 1 {
            let range = blocks.start * BLOCK..((blocks.start + 1) * BLOCK).min(samples);
            return range.fold(Vec3::ZERO, |sum, index| sum + radiance(index));
        }
        let count = blocks.end - blocks.start;
        let half = blocks.start + (count.next_power_of_two() / 2);
        node(blocks.start..half, samples) + node(half..blocks.end, samples)
    }

    #[test]
    fn blocks_are_added_along_a_binary_tree() {
        for samples in [1, 15, 16, 17, 48, 49, 64, 112, 1000] {
            let mut sums = BlockAccumulator::default();
            let sample = |index| PixelSample {
                radiance: radiance(index),
                hit: index % 2 == 0,
            };
            (0..samples).for_each(|index| sums.add(&id(), sample(index)));
            let expected = node(0..samples.div_ceil(BLOCK), samples) / f64::from(samples);
            let sum = sums.close();
            assert_eq!(sum.mean(), expected.to_array(), "{samples}");
            assert!((f64::from(sum.coverage()) - 0.5).abs() <= 0.6 / f64::from(samples));
        }
    }

    #[test]
    fn a_pixel_without_samples_is_black() {
        assert_eq!(
            SequentialAccumulator::new(Values::Display).close().mean(),
            [0.0; 3]
        );
        assert_eq!(BlockAccumulator::default().close().mean(), [0.0; 3]);
    }

    #[test]
    fn only_what_is_displayed_is_clamped_sample_by_sample() {
        for (values, mean) in [(Values::Display, 0.5), (Values::Linear, 1.0)] {
            let mut sums = SequentialAccumulator::new(values);
            for value in [3.0, -1.0] {
                sums.add(
                    &id(),
                    PixelSample {
                        radiance: Vec3::splat(value),
                        hit: true,
                    },
                );
            }
            assert_eq!(sums.close().mean(), [mean; 3]);
        }
    }
}
