//! The byte format of a [`PartialFilm`]: header, sums, checksum.
//!
//! Numbers are little-endian; floating-point numbers keep every bit. Untrusted bytes are safe to
//! load: no more memory is allocated than they fill or the caller permits.
//!
//! Layout: magic, version, channels, values, summation (1 byte each but the first two); samples and
//! crop (32 bits each, 4 for the crop); the number of counts, and each count (64 bits); the number
//! of nodes, and for each its tile, its first and last block and the sums of its pixels; a CRC-32
//! of all preceding bytes.

use super::partial::{FilmError, FilmLayout, PartialFilm, SumNode, Summation, insert, position};
use super::pixel::PixelSum;
use super::tiled::tiles_of;
use super::{Crop, RayCounts, Values};
use rtc_math::{Vec3, to_u32};

/// The magic number of the bytes of a film.
const MAGIC: [u8; 8] = *b"rtc film";

/// The version of the format, and of the summation order.
const VERSION: u32 = 1;

/// Sums of red, green and blue.
const CHANNELS: u8 = 3;

/// The bytes of a [`PixelSum`].
const PIXEL: usize = 32;

impl PartialFilm {
    /// The film as bytes; equal films are equal bytes.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let FilmLayout {
            crop,
            values,
            summation,
        } = self.layout;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(kind_of_sums(values, summation));
        for number in [crop.x, crop.y, crop.width, crop.height] {
            bytes.extend(number.to_le_bytes());
        }
        let counts = self.counts.to_array();
        bytes.extend(length(counts.len()));
        bytes.extend(counts.into_iter().flat_map(u64::to_le_bytes));
        bytes.extend(length(self.tiles.iter().map(Vec::len).sum()));
        for (tile, nodes) in self.tiles.iter().enumerate() {
            for node in nodes {
                bytes.extend(length(tile));
                node.save(&mut bytes);
            }
        }
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// The bytes of a tile: the kind of its sums, and those of each node.
    ///
    /// # Panics
    /// If there is no such tile.
    #[must_use]
    pub fn tile_bytes(&self, tile: usize) -> Vec<u8> {
        let mut bytes = kind_of_sums(self.layout.values, self.layout.summation).to_vec();
        let nodes = self.tiles[tile].iter();
        nodes.for_each(|node| node.save(&mut bytes));
        bytes
    }

    /// The film of such bytes, of a picture of at most `max_pixels` pixels.
    ///
    /// # Errors
    /// If the bytes are of something else, of another version, or damaged, or the picture is
    /// larger.
    pub fn load(bytes: &[u8], max_pixels: u64) -> Result<Self, FilmError> {
        let mut bytes = FilmBytes::of(bytes, MAGIC, VERSION)?;
        bytes.check(&[&MAGIC[..], &VERSION.to_le_bytes()].concat())?;
        let layout = bytes.layout(max_pixels)?;
        let mut film = Self::new(layout);
        film.counts = bytes.counts()?;
        let areas: Vec<Crop> = tiles_of(layout.crop).collect();
        for _ in 0..bytes.number()? {
            let tile = bytes.number()? as usize;
            let area = areas.get(tile);
            let area = area.ok_or(FilmError::Corrupt("a tile is outside the picture"))?;
            let node = bytes.node(&layout, area)?;
            if position(&film.tiles[tile], &node).is_none() {
                return Err(FilmError::Corrupt("samples are there twice"));
            }
            insert(&layout, &mut film.tiles[tile], node);
        }
        bytes
            .0
            .is_empty()
            .then_some(film)
            .ok_or(FilmError::Corrupt("bytes are left over"))
    }
}

impl SumNode {
    fn save(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.blocks.start.to_le_bytes());
        bytes.extend(self.blocks.end.to_le_bytes());
        for sum in &self.sums {
            bytes.extend(
                sum.radiance
                    .to_array()
                    .into_iter()
                    .flat_map(f64::to_le_bytes),
            );
            bytes.extend(sum.hits.to_le_bytes());
            bytes.extend(sum.samples.to_le_bytes());
        }
    }
}

/// Channels, values and summation, a byte each, and the samples of a pixel.
fn kind_of_sums(values: Values, summation: Summation) -> [u8; 7] {
    let (summation, samples) = match summation {
        Summation::InOrder => (0, 0),
        Summation::InBlocks(samples) => (1, samples),
        Summation::Distance => (2, 0),
    };
    let [a, b, c, d] = samples.to_le_bytes();
    [
        CHANNELS,
        u8::from(values == Values::Linear),
        summation,
        a,
        b,
        c,
        d,
    ]
}

/// A number of entities as bytes: a picture has fewer than 2³² of each.
fn length(count: usize) -> [u8; 4] {
    to_u32(count).to_le_bytes()
}

/// The bytes that are still to be read.
pub(super) struct FilmBytes<'a>(pub(super) &'a [u8]);

impl<'bytes> FilmBytes<'bytes> {
    /// The bytes after the magic number and the version.
    pub(super) fn of(bytes: &'bytes [u8], magic: [u8; 8], version: u32) -> Result<Self, FilmError> {
        let mut bytes = Self(bytes);
        if bytes.array().ok() != Some(magic) {
            return Err(FilmError::NotAFilm);
        }
        match bytes.number()? {
            found if found == version => Ok(bytes),
            other => Err(FilmError::Version(other)),
        }
    }

    /// The next bytes.
    fn take(&mut self, count: usize) -> Result<&[u8], FilmError> {
        let (taken, rest) = self
            .0
            .split_at_checked(count)
            .ok_or(FilmError::Corrupt("its end is missing"))?;
        self.0 = rest;
        Ok(taken)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Result<[u8; N], FilmError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(super) fn number(&mut self) -> Result<u32, FilmError> {
        self.array().map(u32::from_le_bytes)
    }

    /// Takes the checksum off the end, and compares it with that of the bytes read and of the rest.
    fn check(&mut self, read: &[u8]) -> Result<(), FilmError> {
        const WRONG: FilmError = FilmError::Corrupt("its checksum does not fit");
        let (rest, sum) = self.0.split_last_chunk().ok_or(WRONG)?;
        let mut crc = crc32fast::Hasher::new();
        crc.update(read);
        crc.update(rest);
        self.0 = rest;
        (crc.finalize() == u32::from_le_bytes(*sum))
            .then_some(())
            .ok_or(WRONG)
    }

    fn layout(&mut self, max_pixels: u64) -> Result<FilmLayout, FilmError> {
        let [channels, values, summation] = self.array()?;
        let samples = self.number()?;
        let (x, y, width, height) = (
            self.number()?,
            self.number()?,
            self.number()?,
            self.number()?,
        );
        // Check the rectangle.
        let pixels = u64::from(width) * u64::from(height);
        if pixels > max_pixels {
            return Err(FilmError::TooLarge(pixels));
        }
        if x.checked_add(width).is_none() || y.checked_add(height).is_none() {
            return Err(FilmError::Corrupt("its rectangle is too far away"));
        }
        // Decode the kind of values and sums.
        let values = match values {
            0 => Values::Display,
            1 => Values::Linear,
            _ => return Err(FilmError::Corrupt("its kind of values is unknown")),
        };
        let summation = match (channels, summation, samples) {
            (CHANNELS, 0, 0) => Summation::InOrder,
            (CHANNELS, 1, 1..) => Summation::InBlocks(samples),
            (CHANNELS, 2, 0) => Summation::Distance,
            _ => return Err(FilmError::Corrupt("its kind of sums is unknown")),
        };
        let crop = Crop {
            x,
            y,
            width,
            height,
        };
        Ok(FilmLayout {
            crop,
            values,
            summation,
        })
    }

    fn counts(&mut self) -> Result<RayCounts, FilmError> {
        const OTHERS: FilmError = FilmError::Corrupt("its counts are of other effects");
        if self.number()? as usize != RayCounts::default().to_array().len() {
            return Err(OTHERS);
        }
        self.counts_of_effects()
    }

    /// The current number of counts.
    pub(super) fn counts_of_effects(&mut self) -> Result<RayCounts, FilmError> {
        let mut counts = RayCounts::default().to_array();
        for count in &mut counts {
            *count = u64::from_le_bytes(self.array()?);
            // So many rays take a million years; more could not be added up.
            if *count > 1 << 56 {
                return Err(FilmError::Corrupt("its counts are too large"));
            }
        }
        Ok(RayCounts::from_array(counts))
    }

    /// A node of a tile. The bytes of its sums are there before memory is taken for them.
    fn node(&mut self, layout: &FilmLayout, area: &Crop) -> Result<SumNode, FilmError> {
        let blocks = self.number()?..self.number()?;
        if !layout.is_node(&blocks) {
            return Err(FilmError::Corrupt("its samples are not whole blocks"));
        }
        let pixels = area.width as usize * area.height as usize;
        let all = layout.samples_of(&blocks);
        let most = all.end - all.start;
        let sums: Result<_, _> = self
            .take(pixels * PIXEL)?
            .chunks_exact(PIXEL)
            .map(|chunk| FilmBytes(chunk).sum(most))
            .collect();
        sums.map(|sums| SumNode { blocks, sums })
    }

    /// The sum of a pixel, of at most this many samples.
    fn sum(&mut self, most: u32) -> Result<PixelSum, FilmError> {
        let mut radiance = [0.0; 3];
        for channel in &mut radiance {
            *channel = f64::from_le_bytes(self.array()?);
        }
        let (hits, samples) = (self.number()?, self.number()?);
        if hits > samples || samples > most {
            return Err(FilmError::Corrupt("a pixel has too many samples"));
        }
        let radiance = Vec3::from_array(radiance);
        Ok(PixelSum {
            radiance,
            hits,
            samples,
        })
    }
}
