//! A progressive film: each pixel has three independent sample sequences, two replicates and a
//! pilot.
//!
//! The picture is the mean of the replicates; their difference estimates its error. The number of
//! samples depends on the pilots and on the film as a whole, but not on the replicates of the
//! pixel. So adaptive sampling biases neither the picture nor its estimated variance. If two halves
//! chose the number for each other, both would be biased
//! (`docs/book/src/decisions/0013-pilots.md`).

use super::pixel::{PixelAccumulator, PixelSample, SampleId, SampleRanges, SampleStream};
use super::tiled::TiledValues;
use super::{Background, Crop, DISPLAY, RayCounts, Tiles, Values, coverage};
use rayon::prelude::*;
use rtc_color::Tone;
use rtc_image::Image;
use rtc_math::Vec3;

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Replicates {
    /// The tone map of the mean, and the factor before it; `None` where each sample is clamped to
    /// [0, 1].
    tone: Option<(Tone, f64)>,
    /// For each replicate and for the pilot, the sum of its samples, clamped if `tone` is `None`.
    sums: [Vec3; 3],
    /// The sum of the squared lengths of those of the pilot.
    square: f64,
    /// The sum of the unclamped samples of the replicates.
    linear: Vec3,
    /// The number of samples of each replicate, and of the pilot.
    counts: [u32; 2],
    /// The number of samples of the replicates that hit a surface.
    hits: u64,
}

/// The index of the replicates among counts.
pub(super) const SHOWN: usize = 0;

/// The index of the pilot among counts, and among the sequences.
const PILOT: (usize, usize) = (1, 2);

/// A part of a progressive picture, with 136 bytes per pixel.
#[derive(Clone, Debug)]
pub struct ProgressiveFilm {
    seed: u64,
    /// The background, where paths are traced.
    pub background: Background,
    /// The tone map and the factor before it, for path tracing.
    pub display: (Tone, f64),
    /// The tiles that grow; all without.
    pub tiles: Option<Tiles>,
    pub(crate) pixels: TiledValues<Replicates>,
    /// The rays so far.
    pub counts: RayCounts,
}

impl ProgressiveFilm {
    /// A film without samples, of a part inside the picture. Another seed gives
    /// independent samples.
    #[must_use]
    pub fn new(crop: Crop, seed: u64) -> Self {
        Self::filled(crop, seed, Replicates::default())
    }

    /// A film of grey samples, one a replicate, with the tone map of path tracing if there is one:
    /// its picture takes as long to develop as one of a scene.
    #[must_use]
    pub fn grey(crop: Crop, tone: Option<(Tone, f64)>) -> Self {
        let grey = Vec3::splat(0.2);
        let pixel = Replicates {
            tone,
            sums: [grey; 3],
            square: grey.length_squared(),
            linear: 2.0 * grey,
            counts: [1, 1],
            hits: 2,
        };
        Self::filled(crop, 0, pixel)
    }

    fn filled(crop: Crop, seed: u64, pixel: Replicates) -> Self {
        Self {
            seed,
            background: Background::default(),
            display: (DISPLAY, 1.0),
            tiles: None,
            pixels: TiledValues::new(crop, None, pixel),
            counts: RayCounts::default(),
        }
    }

    /// Its part of the picture.
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

    /// A value of each pixel, row by row, found by all threads of the pool.
    pub fn map<T: Send>(&self, value: impl Fn(&Replicates) -> T + Sync) -> Vec<T> {
        let rows = (0..self.crop().height).into_par_iter();
        rows.flat_map_iter(|row| self.pixels.row(row).map(&value))
            .collect()
    }

    /// A pixel, counted row by row.
    #[must_use]
    pub fn pixel(&self, index: usize) -> &Replicates {
        self.pixels.at(index)
    }

    /// The missing samples of a pixel. `wanted` is the minimum number of samples of each replicate,
    /// and of the pilot.
    pub(crate) fn lacking(seed: u64, pixel: &Replicates, wanted: [u32; 2]) -> SampleRanges {
        let samples = |part: usize| pixel.counts[part]..wanted[part];
        SampleRanges::Replicates(seed, [0, 1].map(samples))
    }

    /// The seed of the samples.
    pub(crate) fn seed(&self) -> u64 {
        self.seed
    }

    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.pixels().map(Replicates::samples).sum()
    }

    /// The picture so far; black without samples.
    #[must_use]
    pub fn image(&self, values: Values) -> Image {
        Image {
            width: self.crop().width,
            height: self.crop().height,
            pixels: self.map(|pixel| pixel.mean(values).to_array()),
        }
    }

    /// For each pixel the fraction of the samples that hit a surface.
    #[must_use]
    pub fn coverage(&self) -> Vec<f32> {
        self.map(Replicates::coverage)
    }
}

/// The sums of a pixel.
pub(super) const NUMBERS: usize = 13;

impl Replicates {
    /// All samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        let [shown, pilot] = self.counts.map(u64::from);
        2 * shown + pilot
    }

    /// The number of samples of each replicate, and of the pilot.
    #[must_use]
    pub fn counts(&self) -> [u32; 2] {
        self.counts
    }

    /// The variance of the mean of the replicates, from their difference: the mean over the
    /// channels.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.difference().length_squared() / 12.0
    }

    /// The standard error of the mean of the replicates in each channel, of display values.
    #[must_use]
    pub fn standard_error(&self) -> [f64; 3] {
        (0.5 * self.difference().abs()).to_array()
    }

    /// The difference of the replicates, of display values.
    fn difference(&self) -> Vec3 {
        let (n, [a, b, _]) = (f64::from(self.counts[SHOWN].max(1)), self.sums);
        match self.tone {
            None => (a - b) / n,
            Some(_) if self.counts[SHOWN] == 0 => Vec3::ZERO,
            Some(tone) => shown(tone, a / n) - shown(tone, b / n),
        }
    }

    /// The square error of a value of the pixel that is independent of the replicates, as it is
    /// displayed: the mean over the channels. Its noise cancels in the mean, so it may be below 0.
    #[must_use]
    pub fn square_error(&self, value: [f64; 3]) -> f64 {
        let n = f64::from(self.counts[SHOWN].max(1));
        let [value, a, b] = [Vec3::from_array(value), self.sums[0] / n, self.sums[1] / n]
            .map(|mean| self.tone.map_or(mean, |tone| shown(tone, mean)));
        (value - a).dot(value - b) / 3.0
    }

    /// The variance of the samples of the pilot: the mean over the channels.
    #[must_use]
    pub fn variance_of_samples(&self) -> f64 {
        let (n, sum) = (f64::from(self.counts[PILOT.0]), self.sums[PILOT.1]);
        let square = self.square - sum.length_squared() / n.max(1.0);
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

    /// The fraction of the samples of the replicates that hit a surface.
    fn coverage(&self) -> f32 {
        coverage(self.hits, 2 * u64::from(self.counts[SHOWN]))
    }

    /// The mean of the replicates; black without samples.
    #[must_use]
    pub fn mean(&self, values: Values) -> Vec3 {
        let sum = match values {
            Values::Display => self.sums[0] + self.sums[1],
            Values::Linear => self.linear,
        };
        let mean = sum / (2.0 * f64::from(self.counts[SHOWN].max(1)));
        match (values, self.tone) {
            (Values::Display, Some(tone)) if self.counts[SHOWN] > 0 => shown(tone, mean),
            (Values::Display | Values::Linear, _) => mean,
        }
    }

    /// Whether its mean is shown by a tone map.
    pub(super) fn is_toned(&self) -> bool {
        self.tone.is_some()
    }

    /// All sums, and the numbers of samples and of hits.
    pub(super) fn to_numbers(self) -> ([f64; NUMBERS], [u32; 2], u64) {
        let mut numbers = [self.square; NUMBERS];
        let sums = self.sums.iter().chain([&self.linear]);
        for (numbers, sum) in numbers.chunks_exact_mut(3).zip(sums) {
            numbers.copy_from_slice(&sum.to_array());
        }
        (numbers, self.counts, self.hits)
    }

    /// The pixel of [`Self::to_numbers`], without a tone map.
    pub(super) fn from_numbers(numbers: &[f64; NUMBERS], counts: [u32; 2], hits: u64) -> Self {
        let sum = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        Self {
            tone: None,
            sums: [sum(0), sum(3), sum(6)],
            square: numbers[NUMBERS - 1],
            linear: sum(9),
            counts,
            hits,
        }
    }

    /// The same samples, shown by `tone`.
    pub(crate) fn toned(self, tone: Option<(Tone, f64)>) -> Self {
        Self { tone, ..self }
    }
}

impl PixelAccumulator for Replicates {
    type Sample = PixelSample;
    type PixelState = Self;

    fn add(&mut self, id: &SampleId, PixelSample { radiance, hit }: PixelSample) {
        let SampleStream::Replicate { replicate, .. } = id.stream else {
            return;
        };
        let shown = match self.tone {
            None => radiance.clamp(Vec3::ZERO, Vec3::ONE),
            Some(_) => radiance,
        };
        self.sums[replicate] += shown;
        let part = if replicate == PILOT.1 {
            self.square += shown.length_squared();
            PILOT.0
        } else {
            self.linear += radiance;
            self.hits += u64::from(hit);
            SHOWN
        };
        self.counts[part] = self.counts[part].max(id.index + 1);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_samples_go_through_the_tone_map() {
        let crop = Crop {
            x: 3,
            y: 15,
            width: 20,
            height: 2,
        };
        for tone in [None, Some((Tone::Agx, 2.0))] {
            let film = ProgressiveFilm::grey(crop, tone);
            let grey = tone.map_or([0.2; 3], |(tone, exposure)| {
                tone.display([0.2 * exposure; 3])
            });
            assert_eq!(film.image(Values::Display).pixels, vec![grey; 40]);
            assert!(film.pixels().all(|pixel| pixel.variance() == 0.0));
        }
    }
}
