//! The film: the request of a render ([`RenderSelection`]), and the pixels and counts it returns
//! ([`Film`]).
//!
//! - `pixel`: the accumulators, with a fixed order of summation.
//! - `tile`, `tiled`: the tile a thread works on, and the storage of all tiles.
//! - `partial`, `bytes`: a film of part of a picture, which can be saved and merged.
//! - `progressive`, `growing`: a film that can be refined, and its bytes.
//! - `monitor`: the finished tiles of a picture that is being rendered.
//! - `heartbeat`: progress reports and interruption. `counts`: ray and effect counts.

mod bytes;
mod counts;
pub(crate) mod filter;
pub(crate) mod growing;
pub(crate) mod heartbeat;
pub(crate) mod monitor;
pub(crate) mod partial;
pub(crate) mod pixel;
pub(crate) mod progressive;
pub(crate) mod tile;
pub(crate) mod tiled;

pub use counts::{ClampedLight, RayCounts};

use monitor::FilmMonitor;
use rtc_color::Tone;
use rtc_image::Image;
use rtc_math::mix;
use std::num::NonZeroU32;

/// The pixels and samples to render.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderSelection<'m> {
    /// The requested crop, or the whole picture, clipped to the picture.
    pub crop: Option<Crop>,
    /// The kind of values in the film.
    pub values: Values,
    /// The tiles to render; pixels elsewhere stay black.
    pub tiles: Option<Tiles>,
    /// The seeds of sampling.
    pub seeds: SamplingSeeds,
    /// Which pixels are rendered; the others stay black.
    pub stride: PixelStride,
    /// The background of the picture.
    pub background: Background,
    /// The maximum number of samples per pixel. The first samples of the scene are taken.
    pub samples: Option<NonZeroU32>,
    /// The radiance that a traced path brings at most after its first bounce, in its largest
    /// channel, more than 0; all of it without.
    pub clamp: Option<f64>,
    /// What may show the picture while it is rendered as a whole.
    pub monitor: Option<&'m FilmMonitor>,
}

/// The value of a camera ray that hits no surface. The light on surfaces does not change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// The environment of the scene; black if it has none.
    #[default]
    Environment,
    /// Nothing: the picture has surfaces alone, each pixel weighted by its coverage.
    Nothing,
}

/// The seed of each kind of sampling. 0 is the default; any other number gives independent noise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SamplingSeeds {
    /// For the positions of sub-samples, where their pattern is random.
    pub pixel: u64,
    /// For the points of the lens: other than 0, it rotates their spiral for each sub-sample,
    /// without bias.
    pub lens: u64,
    /// For soft lights and glossy lobes.
    pub path: u64,
}

/// Square tiles spread over a picture: those with ranks from `first` to `last`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiles {
    /// The seed of the ranks.
    pub seed: u64,
    /// The least rank.
    pub first: u64,
    /// The greatest rank.
    pub last: u64,
}

impl SamplingSeeds {
    /// The default seeds.
    pub const NONE: Self = Self {
        pixel: 0,
        lens: 0,
        path: 0,
    };
}

impl Tiles {
    /// The side of a tile in pixels.
    pub const SIDE: u32 = 16;

    /// The rank of a tile, given by its column and row of tiles; differs from tile to tile.
    #[must_use]
    pub fn rank(seed: u64, tile: [u32; 2]) -> u64 {
        mix(mix(seed) ^ (u64::from(tile[0]) << 32 | u64::from(tile[1])))
    }

    /// The tiles of the shares `first` to `last`, counted from 1, of `count`: those whose rank is
    /// in these of `count` equal intervals. Empty if the last is below the first.
    #[must_use]
    pub fn shares([first, last]: [u32; 2], count: u32) -> Self {
        if last < first {
            // No rank is in it.
            return Self {
                seed: 0,
                first: 1,
                last: 0,
            };
        }
        let count = u128::from(count.max(1));
        // The end of the first shares, of 2⁶⁴.
        let split_plane = |shares: u32| (u128::from(shares) << 64) / count;
        let rank = |split_plane: u128| u64::try_from(split_plane).unwrap_or(u64::MAX);
        Self {
            seed: 0,
            first: rank(split_plane(first.saturating_sub(1))),
            last: rank(split_plane(last).saturating_sub(1)),
        }
    }

    /// The rectangles of all tiles of a part of a picture, row by row.
    pub fn of(crop: Crop) -> impl Iterator<Item = Crop> {
        tiled::tiles_of(crop)
    }

    /// Whether a pixel is in one of the tiles.
    #[must_use]
    pub fn contain(&self, pixel: [u32; 2]) -> bool {
        let rank = Self::rank(self.seed, pixel.map(|at| at / Self::SIDE));
        (self.first..=self.last).contains(&rank)
    }
}

/// Every k-th pixel of a row and of a column, from the first: enough for an estimate of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelStride(NonZeroU32);

impl PixelStride {
    /// Every pixel.
    pub const EVERY: Self = Self(NonZeroU32::MIN);

    /// Every k-th pixel; every one for 0.
    #[must_use]
    pub fn new(k: u32) -> Self {
        NonZeroU32::new(k).map_or(Self::EVERY, Self)
    }

    /// The step.
    #[must_use]
    pub fn get(self) -> u32 {
        self.0.get()
    }

    /// The number of pixels rendered, of a row or column of `count`.
    #[must_use]
    pub fn of(self, count: u32) -> u32 {
        count.div_ceil(self.get())
    }
}

impl Default for PixelStride {
    fn default() -> Self {
        Self::EVERY
    }
}

/// A rectangle of pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

impl Crop {
    /// Its number of pixels.
    #[must_use]
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The part of this rectangle inside a picture of the size given; may be empty.
    #[must_use]
    pub fn within(self, width: u32, height: u32) -> Self {
        let (x, y) = (self.x.min(width), self.y.min(height));
        Self {
            x,
            y,
            width: self.width.min(width - x),
            height: self.height.min(height - y),
        }
    }
}

/// The kind of values in a film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Values {
    /// Display values: each sub-sample is clamped to [0, 1] before the mean. For traced paths, the
    /// mean coded by sRGB.
    #[default]
    Display,
    /// The unweighted mean of the sub-samples.
    Linear,
}

/// The tone map of [`Values::Display`] where paths are traced.
pub(crate) const DISPLAY: Tone = Tone::Srgb;

/// The fraction of rays that hit something; 0 without rays.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "a share, rounded")]
pub(crate) fn coverage(hits: u64, rays: u64) -> f32 {
    (hits as f64 / rays.max(1) as f64) as f32
}

/// A picture and its rays.
#[derive(Clone, Debug)]
pub struct Film {
    /// The picture, of the size of the crop.
    pub image: Image,
    /// For each pixel the fraction of the camera rays that hit a surface, in [0, 1].
    pub coverage: Vec<f32>,
    /// The rays it took.
    pub counts: RayCounts,
}

impl Film {
    /// The pixels of `crop` of a film of the complete picture. A film of the size of `crop` stays
    /// as it is.
    #[must_use]
    pub fn cut(self, crop: Crop) -> Self {
        if (self.image.width, self.image.height) == (crop.width, crop.height) {
            return self;
        }
        let width = self.image.width as usize;
        let rows = (crop.y..crop.y + crop.height).map(|y| y as usize * width + crop.x as usize);
        let row = |start: usize| start..start + crop.width as usize;
        let pixels = rows
            .clone()
            .flat_map(|start| &self.image.pixels[row(start)]);
        let image = Image {
            width: crop.width,
            height: crop.height,
            pixels: pixels.copied().collect(),
        };
        let coverage = rows.flat_map(|start| &self.coverage[row(start)]);
        Self {
            image,
            coverage: coverage.copied().collect(),
            counts: self.counts,
        }
    }
}
