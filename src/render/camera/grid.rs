//! The samples of a pixel in a course scene: sub-samples in a grid of cells, and lens points for
//! each sub-sample.

use super::{Camera, CranleyPatterson, image_point, lens_point, ray_through};
use crate::film::SamplingSeeds;
use crate::ray::Ray;
use crate::sampler::PathVertexKey;
use rtc_math::Vec3;

/// The position of each sub-sample in its cell of the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pattern {
    /// In the middle.
    Grid,
    /// Anywhere in its cell, seeded by pixel and sample.
    Jitter,
    /// Anywhere in the pixel, seeded by pixel and sample.
    Random,
}

/// The arrangement of the samples of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleGrid {
    /// Cells along each side of a pixel.
    factor: u32,
    /// Points of the lens for each cell.
    points: u32,
    pattern: Pattern,
}

/// A sub-sample: a point of the image plane, and the rotation of its lens points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SubSample {
    target: Vec3,
    rotated: CranleyPatterson,
}

impl SampleGrid {
    /// One ray through the middle of a pixel.
    pub(crate) const MIDDLE: Self = Self {
        factor: 1,
        points: 1,
        pattern: Pattern::Grid,
    };

    /// `factor × factor` cells, each with a number of lens points.
    pub(crate) fn new(factor: u32, points: u32, pattern: Pattern) -> Self {
        Self {
            factor,
            points,
            pattern,
        }
    }

    /// Whether rays start at several points of a lens.
    pub(crate) fn has_lens(&self) -> bool {
        self.points > 1
    }

    /// The number of samples of a pixel.
    pub(crate) fn samples(&self) -> u32 {
        let cells = self.factor.saturating_mul(self.factor);
        cells.saturating_mul(self.points)
    }

    /// The column and the row of the cell of a sample, and which point of the lens it takes.
    pub(crate) fn place_of(&self, sample: u32) -> [u32; 3] {
        let cell = sample / self.points;
        [cell % self.factor, cell / self.factor, sample % self.points]
    }

    /// The indices of the next sample, without a division.
    #[inline]
    pub(crate) fn after(&self, [column, row, k]: [u32; 3]) -> [u32; 3] {
        if k + 1 < self.points {
            [column, row, k + 1]
        } else if column + 1 < self.factor {
            [column + 1, row, 0]
        } else {
            [0, row + 1, 0]
        }
    }

    /// A cell of a pixel, by its column and row.
    #[inline(always)]
    pub(crate) fn cell(
        &self,
        camera: &Camera,
        pixel: [u32; 2],
        [column, row]: [u32; 2],
        seeds: SamplingSeeds,
    ) -> SubSample {
        let key = || self.key(pixel, [column, row]);
        SubSample {
            target: image_point(camera, pixel, self.place_in(pixel, [column, row], seeds)),
            rotated: CranleyPatterson::new(seeds.lens, key),
        }
    }

    /// The key of a cell.
    #[inline(always)]
    fn key(&self, pixel: [u32; 2], [column, row]: [u32; 2]) -> PathVertexKey {
        let number = u64::from(row) * u64::from(self.factor) + u64::from(column);
        PathVertexKey::new(pixel, number)
    }

    /// Whether all rays start at the eye of a camera.
    #[inline(always)]
    pub(crate) fn starts_at_eye(&self, camera: &Camera, seeds: SamplingSeeds) -> bool {
        self.points == 1 && camera.lens_samples == 1 && seeds.lens == 0
    }

    /// The offset of a sub-sample within its pixel, each coordinate in [0, 1], by the column and
    /// the row of its cell.
    #[inline(always)]
    pub(crate) fn place_in(
        &self,
        pixel: [u32; 2],
        cell: [u32; 2],
        seeds: SamplingSeeds,
    ) -> [f64; 2] {
        self.place(cell, || self.key(pixel, cell).seeded(seeds.pixel))
    }

    /// The offset of a sub-sample within its pixel, each coordinate in [0, 1].
    #[inline(always)]
    fn place(&self, cell: [u32; 2], key: impl Fn() -> PathVertexKey) -> [f64; 2] {
        let random = || {
            let key = key().child(PATTERN);
            [0, 1].map(|axis| key.uniform(axis))
        };
        let within = |offset: [f64; 2]| {
            [0, 1].map(|axis| (f64::from(cell[axis]) + offset[axis]) / f64::from(self.factor))
        };
        match self.pattern {
            Pattern::Grid => within([0.5; 2]),
            Pattern::Jitter => within(random()),
            Pattern::Random => random(),
        }
    }
}

impl SubSample {
    /// The ray from point k of the lens.
    #[inline]
    pub(crate) fn ray(&self, camera: &Camera, k: u32) -> Ray {
        ray_through(camera, lens_point(camera, k, self.rotated), self.target)
    }
}

/// Makes the random numbers of sub-samples independent of those of the paths.
const PATTERN: u64 = u64::MAX;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_after_one_is_that_of_the_next_sample() {
        for (factor, points) in [(1, 1), (3, 1), (1, 4), (3, 5)] {
            let grid = SampleGrid {
                factor,
                points,
                pattern: Pattern::Grid,
            };
            for sample in 1..grid.samples() {
                let after = grid.after(grid.place_of(sample - 1));
                assert_eq!(after, grid.place_of(sample), "{factor} {points}");
            }
        }
    }
}
