//! A progressive film: each pixel has four independent replicates of samples, two in each half.
//!
//! The picture is the mean of the halves; the variance between the replicates of a half estimates
//! its error. The number of samples of one half may depend only on the values of the other half, so
//! that the stopping rule adds no bias.

use super::pixel::{Accumulator, Sample, SampleId, SampleRanges, Stream};
use super::tiled::Tiled;
use super::{Background, Counts, Crop, DISPLAY, Tiles, Values, coverage};
use crate::color::Tone;
use crate::image::Image;
use crate::math::Vec3;

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Replicates {
    /// The tone map of the mean, and what the mean is multiplied by before; `None` where each sample
    /// is clamped to [0, 1].
    tone: Option<(Tone, f64)>,
    /// Per replicate, the sum of its samples, clamped if `tone` is `None`. Replicates 0 and 1 are
    /// the first half.
    sums: [Vec3; 4],
    /// Per half, the sum of the squared lengths of the same.
    squares: [f64; 2],
    /// Per half, the sum of its unclamped samples.
    linear: [Vec3; 2],
    /// Per half, the number of samples of each replicate.
    counts: [u32; 2],
    /// Per half, the number of samples that met a surface.
    hits: [u64; 2],
}

/// A part of a growing picture, with 200 bytes per pixel.
#[derive(Clone, Debug)]
pub struct ProgressiveFilm {
    seed: u64,
    /// The background, where paths are traced.
    pub background: Background,
    /// How values are shown, and what they are multiplied by before, where paths are traced.
    pub display: (Tone, f64),
    /// The tiles that grow; all without.
    pub tiles: Option<Tiles>,
    pub(in crate::render) pixels: Tiled<Replicates>,
    /// The rays so far.
    pub counts: Counts,
}

impl ProgressiveFilm {
    /// A film without samples, of a part inside the picture. Another seed gives
    /// independent samples.
    #[must_use]
    pub fn new(crop: Crop, seed: u64) -> Self {
        Self {
            seed,
            background: Background::default(),
            display: (DISPLAY, 1.0),
            tiles: None,
            pixels: Tiled::new(crop, None, Replicates::default()),
            counts: Counts::default(),
        }
    }

    /// The part of the picture that it holds.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.pixels.crop()
    }

    /// The number of pixels.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a picture has pixels")]
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// The pixels row by row.
    pub fn pixels(&self) -> impl Iterator<Item = &Replicates> {
        self.pixels.iter()
    }

    /// A pixel, counted row by row.
    #[must_use]
    pub fn pixel(&self, index: usize) -> &Replicates {
        self.pixels.at(index)
    }

    /// The missing samples of a pixel. `wanted` is the least number of samples of each replicate,
    /// per half.
    pub(in crate::render) fn lacking(
        seed: u64,
        pixel: &Replicates,
        wanted: [u32; 2],
    ) -> SampleRanges {
        let samples = |half: usize| pixel.counts[half]..wanted[half];
        SampleRanges::Replicates(seed, [0, 1].map(samples))
    }

    /// The seed of the samples.
    pub(in crate::render) fn seed(&self) -> u64 {
        self.seed
    }

    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.pixels().map(Replicates::samples).sum()
    }

    /// The picture so far; black where nothing was sampled.
    #[must_use]
    pub fn image(&self, values: Values) -> Image {
        Image {
            width: self.crop().width,
            height: self.crop().height,
            pixels: self
                .pixels()
                .map(|pixel| pixel.mean(values).to_array())
                .collect(),
        }
    }

    /// Of each pixel the fraction of the samples that met a surface.
    #[must_use]
    pub fn coverage(&self) -> Vec<f32> {
        self.pixels().map(Replicates::coverage).collect()
    }
}

impl Replicates {
    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        2 * (u64::from(self.counts[0]) + u64::from(self.counts[1]))
    }

    /// The number of samples of each replicate of a half.
    #[must_use]
    pub fn count(&self, half: usize) -> u32 {
        self.counts[half]
    }

    /// The variance of the mean of a half, from the difference of its replicates: the mean over the
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

    /// The fraction of the samples that met a surface: the mean of the halves.
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

    /// Whether its mean is shown by a tone map.
    pub(super) fn is_toned(&self) -> bool {
        self.tone.is_some()
    }

    /// All sums, and the numbers of samples and of hits per half.
    pub(super) fn to_numbers(self) -> ([f64; 20], [u32; 2], [u64; 2]) {
        let mut numbers = [0.0; 20];
        let sums = self.sums.iter().chain(&self.linear);
        for (numbers, sum) in numbers.chunks_exact_mut(3).zip(sums) {
            numbers.copy_from_slice(&sum.to_array());
        }
        numbers[18..].copy_from_slice(&self.squares);
        (numbers, self.counts, self.hits)
    }

    /// The pixel of [`Self::to_numbers`], without a tone map.
    pub(super) fn from_numbers(numbers: &[f64; 20], counts: [u32; 2], hits: [u64; 2]) -> Self {
        let sum = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        Self {
            tone: None,
            sums: [sum(0), sum(3), sum(6), sum(9)],
            squares: [numbers[18], numbers[19]],
            linear: [sum(12), sum(15)],
            counts,
            hits,
        }
    }

    /// The same samples, shown by `tone`.
    pub(in crate::render) fn toned(self, tone: Option<(Tone, f64)>) -> Self {
        Self { tone, ..self }
    }
}

impl Accumulator for Replicates {
    type Sample = Sample;
    type Kept = Self;

    fn add(&mut self, id: &SampleId, Sample { radiance, hit }: Sample) {
        let Stream::Replicate { replicate, .. } = id.stream else {
            return;
        };
        let shown = match self.tone {
            None => radiance.clamp(Vec3::ZERO, Vec3::ONE),
            Some(_) => radiance,
        };
        let half = replicate / 2;
        self.sums[replicate] += shown;
        self.squares[half] += shown.length_squared();
        self.linear[half] += radiance;
        self.hits[half] += u64::from(hit);
        self.counts[half] = self.counts[half].max(id.index + 1);
    }

    fn close(self) -> Self {
        self
    }
}

fn shown((tone, exposure): (Tone, f64), mean: Vec3) -> Vec3 {
    Vec3::from_array(tone.display((mean * exposure).to_array()))
}

/// The square of the slope of the tone map near a mean grey, over an interval of the given
/// deviation.
fn slope(tone: (Tone, f64), mean: f64, deviation: f64) -> f64 {
    if deviation == 0.0 {
        return 0.0;
    }
    let [low, high] =
        [mean - deviation, mean + deviation].map(|grey| shown(tone, Vec3::splat(grey)).x);
    let slope = (high - low) / (2.0 * deviation);
    slope * slope
}
