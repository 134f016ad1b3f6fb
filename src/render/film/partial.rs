//! A film of part of a picture: sums of some samples in some tiles.
//!
//! Partial films can be saved, loaded and merged, on any machine and in any order. The merged film
//! equals, bit for bit, the film of one complete render.

use super::pixel::{BLOCK, PixelSum};
use super::tiled::{TiledValues, tiles_of};
use super::{Crop, DISPLAY, Film, RayCounts, Values};
use rtc_image::Image;
use std::fmt;
use std::ops::Range;

/// The summation of the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Summation {
    /// One after the other: all of them are one part.
    InOrder,
    /// This many samples in aligned blocks along a binary tree.
    InBlocks(u32),
    /// The one sample is a distance.
    Distance,
}

/// The properties that the films of one picture share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FilmLayout {
    /// The rectangle of pixels.
    pub(crate) crop: Crop,
    /// The conversion of sums to pixels.
    pub(crate) values: Values,
    /// The summation of their samples.
    pub(crate) summation: Summation,
}

/// A film of a part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialFilm {
    pub(super) layout: FilmLayout,
    pub(super) counts: RayCounts,
    /// For each tile of the picture its present nodes, in order, with whole subtrees merged.
    pub(super) tiles: Vec<Vec<SumNode>>,
}

/// The mean of some samples of a pixel, linear; black without samples.
#[derive(Clone, Copy, Debug)]
pub struct MeanOfSamples {
    /// The mean in each channel.
    pub mean: [f64; 3],
    /// The number of samples.
    pub samples: u32,
}

/// A node of the tree over the blocks of samples, with its sums of the pixels of a tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SumNode {
    /// Its leaves.
    pub(super) blocks: Range<u32>,
    /// One for each pixel, row by row.
    pub(super) sums: Vec<PixelSum>,
}

/// Why a part of a picture cannot be made, loaded, added or developed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilmError {
    /// Parts by samples of a picture whose samples are summed one after the other.
    Inseparable,
    /// Samples that are not whole blocks of the picture's.
    Misaligned(Range<u32>),
    /// Two parts of different pictures.
    OtherPicture,
    /// Two parts with the same block of samples of the tile whose upper left pixel is given.
    Overlap([u32; 2]),
    /// Samples of the tile whose upper left pixel is given are missing.
    Missing([u32; 2]),
    /// More pixels than are allowed.
    TooLarge(u64),
    /// Bytes of something else.
    NotAFilm,
    /// Bytes of another version of the format.
    Version(u32),
    /// Damaged bytes, with the error.
    Corrupt(&'static str),
}

impl fmt::Display for FilmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inseparable => {
                write!(f, "only pictures of traced paths have parts by samples")
            }
            Self::Misaligned(Range { start, end }) => write!(
                f,
                "samples {start} to {end} are not whole blocks of {BLOCK}"
            ),
            Self::OtherPicture => write!(f, "the parts are of different pictures"),
            Self::Overlap([x, y]) => write!(f, "the tile at ({x}, {y}) is in both parts"),
            Self::Missing([x, y]) => write!(f, "samples of the tile at ({x}, {y}) are missing"),
            Self::TooLarge(pixels) => write!(f, "a film of {pixels} pixels is too large"),
            Self::NotAFilm => write!(f, "the bytes are not a film"),
            Self::Version(version) => write!(f, "version {version} of films is unknown"),
            Self::Corrupt(what) => write!(f, "the film is damaged: {what}"),
        }
    }
}

impl std::error::Error for FilmError {}

impl FilmLayout {
    /// The number of leaves of the tree of sums.
    pub(super) fn blocks(&self) -> u32 {
        match self.summation {
            Summation::InOrder | Summation::Distance => 1,
            Summation::InBlocks(samples) => samples.div_ceil(BLOCK),
        }
    }

    /// The samples of a node; of a picture of one node, as many as there are.
    pub(crate) fn samples_of(&self, blocks: &Range<u32>) -> Range<u32> {
        let Summation::InBlocks(samples) = self.summation else {
            return 0..u32::MAX;
        };
        let sample = |block: u32| block.saturating_mul(BLOCK).min(samples);
        sample(blocks.start)..sample(blocks.end)
    }

    /// All samples.
    pub(crate) fn all_samples(&self) -> Range<u32> {
        self.samples_of(&(0..self.blocks()))
    }

    /// The largest nodes of the tree that a range of samples consists of, or all of them.
    ///
    /// # Errors
    /// If the range is not of whole blocks, or the samples are not summed in blocks.
    pub(crate) fn nodes_of(
        &self,
        samples: Option<Range<u32>>,
    ) -> Result<Vec<Range<u32>>, FilmError> {
        let blocks = match samples {
            None => 0..self.blocks(),
            Some(samples) => self.blocks_of(samples)?,
        };
        let (mut nodes, mut start) = (Vec::new(), blocks.start);
        while start < blocks.end {
            // The largest node that begins here and ends in time; a leaf always does.
            let ends = (0..=start.trailing_zeros().min(31)).rev();
            let mut ends = ends.map(|level| self.clipped(start, level));
            let end = ends.find(|end| *end <= blocks.end).unwrap_or(blocks.end);
            nodes.push(start..end);
            start = end;
        }
        Ok(nodes)
    }

    /// The blocks that a range of samples is.
    fn blocks_of(&self, samples: Range<u32>) -> Result<Range<u32>, FilmError> {
        let Summation::InBlocks(_) = self.summation else {
            return Err(FilmError::Inseparable);
        };
        let blocks = samples.start / BLOCK..samples.end.div_ceil(BLOCK);
        let is_whole = self.samples_of(&blocks) == samples;
        is_whole
            .then_some(blocks)
            .ok_or(FilmError::Misaligned(samples))
    }

    /// The end of the node of `2^level` blocks from `start` on, so far as there are blocks.
    fn clipped(&self, start: u32, level: u32) -> u32 {
        let end = u64::from(start) + (1 << level);
        end.try_into().unwrap_or(u32::MAX).min(self.blocks())
    }

    /// Whether a range of blocks is a node of the tree.
    pub(super) fn is_node(&self, blocks: &Range<u32>) -> bool {
        let Range { start, end } = *blocks;
        start < end && end <= self.blocks() && {
            let level = (end - start).next_power_of_two().trailing_zeros();
            start.trailing_zeros() >= level && self.clipped(start, level) == end
        }
    }

    /// Whether two nodes are the children of one node.
    fn are_siblings(&self, left: &Range<u32>, right: &Range<u32>) -> bool {
        left.end == right.start
            && (left.end - left.start).is_power_of_two()
            && self.is_node(&(left.start..right.end))
    }

    /// The picture of all sums.
    pub(crate) fn develop(&self, film: &TiledValues<PixelSum>, counts: RayCounts) -> Film {
        let (pixels, coverage) = match (self.summation, self.values) {
            (Summation::Distance, _) => shown(film, depths(film)),
            (Summation::InBlocks(_), Values::Display) => {
                shown(film, |sum| DISPLAY.display(sum.mean()))
            }
            (Summation::InBlocks(_) | Summation::InOrder, _) => shown(film, PixelSum::mean),
        };
        let Crop { width, height, .. } = self.crop;
        let image = Image {
            width,
            height,
            pixels,
        };
        Film {
            image,
            coverage,
            counts,
        }
    }
}

/// The pixels row by row as `show` converts them, and their coverage, in one pass over the film.
fn shown(
    film: &TiledValues<PixelSum>,
    show: impl Fn(&PixelSum) -> [f64; 3],
) -> (Vec<[f64; 3]>, Vec<f32>) {
    let mut pixels = Vec::with_capacity(film.len());
    let mut coverage = Vec::with_capacity(film.len());
    film.iter().for_each(|sum| {
        pixels.push(show(sum));
        coverage.push(sum.coverage());
    });
    (pixels, coverage)
}

/// Distances as greys, the nearest of all white, the farthest black: `(t_max − t)/(t_max − t_min)`.
fn depths(film: &TiledValues<PixelSum>) -> impl Fn(&PixelSum) -> [f64; 3] {
    let hits = film.iter().filter(|sum| sum.hits > 0);
    let (near, far) = hits.fold((f64::INFINITY, 0.0_f64), |(near, far), sum| {
        (near.min(sum.radiance.x), far.max(sum.radiance.x))
    });
    let grey = move |sum: &PixelSum| match far - near {
        _ if sum.hits == 0 => 0.0,
        range if range > 0.0 => (far - sum.radiance.x) / range,
        _ => 1.0,
    };
    move |sum| [grey(sum); 3]
}

impl PartialFilm {
    /// The rays it took.
    #[must_use]
    pub fn counts(&self) -> RayCounts {
        self.counts
    }

    /// The pixels that it develops to: the whole picture for distances, else the requested ones.
    #[must_use]
    pub fn crop(&self) -> Crop {
        self.layout.crop
    }

    /// The tiles with samples: their numbers and rectangles.
    pub fn held_tiles(&self) -> impl Iterator<Item = (usize, Crop)> {
        let tiles = tiles_of(self.layout.crop).enumerate();
        tiles.filter(|(tile, _)| !self.tiles[*tile].is_empty())
    }

    /// The samples that it has of a tile, in ranges that each are made at once; `None` for those of
    /// pictures that have no parts by samples.
    ///
    /// # Panics
    /// If there is no such tile.
    pub fn samples_of_tile(&self, tile: usize) -> impl Iterator<Item = Option<Range<u32>>> {
        let is_in_blocks = matches!(self.layout.summation, Summation::InBlocks(_));
        let nodes = self.tiles[tile].iter();
        nodes.map(move |node| is_in_blocks.then(|| self.layout.samples_of(&node.blocks)))
    }

    /// For each pixel of a tile, row by row, the mean of the samples that are here; empty without
    /// samples.
    ///
    /// # Panics
    /// If there is no such tile.
    #[must_use]
    pub fn means_of_tile(&self, tile: usize) -> Vec<MeanOfSamples> {
        let [first, others @ ..] = self.tiles[tile].as_slice() else {
            return Vec::new();
        };
        let of_pixel = |(index, first): (usize, &PixelSum)| {
            let others = others.iter().map(|node| node.sums[index]);
            let sum = others.fold(*first, |sum, other| sum + other);
            MeanOfSamples {
                mean: sum.mean(),
                samples: sum.samples,
            }
        };
        first.sums.iter().enumerate().map(of_pixel).collect()
    }

    pub(crate) fn new(layout: FilmLayout) -> Self {
        Self {
            layout,
            counts: RayCounts::default(),
            tiles: vec![Vec::new(); tiles_of(layout.crop).count()],
        }
    }

    /// A node of a film's tiles, as rendered.
    pub(crate) fn of(
        layout: FilmLayout,
        blocks: &Range<u32>,
        film: TiledValues<PixelSum>,
        counts: RayCounts,
    ) -> Self {
        let node = |sums: Vec<PixelSum>| {
            let blocks = blocks.clone();
            Vec::from_iter((!sums.is_empty()).then_some(SumNode { blocks, sums }))
        };
        Self {
            layout,
            counts,
            tiles: film.into_tiles().into_iter().map(node).collect(),
        }
    }

    /// Adds the samples and the rays of another part.
    ///
    /// # Errors
    /// If it belongs to another picture, or has samples that are already present; this part is then
    /// unchanged.
    pub fn add(&mut self, other: Self) -> Result<(), FilmError> {
        if self.layout != other.layout {
            return Err(FilmError::OtherPicture);
        }
        let both = self.tiles.iter().zip(&other.tiles);
        for (area, (nodes, others)) in tiles_of(self.layout.crop).zip(both) {
            if others.iter().any(|other| position(nodes, other).is_none()) {
                return Err(FilmError::Overlap([area.x, area.y]));
            }
        }
        for (nodes, others) in self.tiles.iter_mut().zip(other.tiles) {
            for node in others {
                insert(&self.layout, nodes, node);
            }
        }
        self.counts = self.counts.plus(other.counts);
        Ok(())
    }

    /// The picture, once all samples of all tiles are there.
    ///
    /// # Errors
    /// If samples are missing.
    pub fn develop(&self) -> Result<Film, FilmError> {
        let all = 0..self.layout.blocks();
        // Missing tiles are detected before memory is taken for the picture.
        let is_whole = |nodes: &[SumNode]| matches!(nodes, [node] if node.blocks == all);
        let missing = self.tiles.iter().position(|nodes| !is_whole(nodes));
        if let Some(area) = missing.and_then(|tile| tiles_of(self.layout.crop).nth(tile)) {
            return Err(FilmError::Missing([area.x, area.y]));
        }
        let mut film = TiledValues::new(self.layout.crop, None, PixelSum::default());
        for ((_, sums), nodes) in film.tiles_mut().zip(&self.tiles) {
            nodes
                .iter()
                .for_each(|node| sums.copy_from_slice(&node.sums));
        }
        Ok(self.layout.develop(&film, self.counts))
    }
}

/// Where a node belongs among others; `None` if it shares a block with one of them.
pub(super) fn position(nodes: &[SumNode], node: &SumNode) -> Option<usize> {
    let at = nodes.partition_point(|other| other.blocks.end <= node.blocks.start);
    let is_free = |next: &SumNode| next.blocks.start >= node.blocks.end;
    nodes.get(at).is_none_or(is_free).then_some(at)
}

/// Adds a node that shares no block with the others, and joins siblings.
pub(super) fn insert(layout: &FilmLayout, nodes: &mut Vec<SumNode>, node: SumNode) {
    let Some(mut at) = position(nodes, &node) else {
        return;
    };
    nodes.insert(at, node);
    loop {
        let joins = |left: usize| {
            let pair = nodes.get(left..left + 2);
            pair.is_some_and(|pair| layout.are_siblings(&pair[0].blocks, &pair[1].blocks))
        };
        if at > 0 && joins(at - 1) {
            at -= 1;
        } else if !joins(at) {
            return;
        }
        let right = nodes.remove(at + 1);
        nodes[at].join(right);
    }
}

impl SumNode {
    /// Adds the sibling to the right: each sum is left plus right, in any order of arrival.
    fn join(&mut self, right: Self) {
        self.blocks.end = right.blocks.end;
        for (left, right) in self.sums.iter_mut().zip(right.sums) {
            *left = *left + right;
        }
    }
}
