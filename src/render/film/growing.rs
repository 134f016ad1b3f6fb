//! The byte format of a progressive film.
//!
//! Layout: magic, version, seed, crop (4 numbers of 32 bits), whether the means are tone mapped,
//! the counts, and the samples of its pixels, tile by tile. Numbers are little-endian;
//! floating-point numbers keep every bit.

use super::Crop;
use super::bytes::FilmBytes;
use super::partial::FilmError;
use super::progressive::{NUMBERS, ProgressiveFilm, Replicates, SHOWN};

/// The magic number of the bytes.
const MAGIC: [u8; 8] = *b"rtc grow";

/// The version of the format, and of the state of a pixel.
const VERSION: u32 = 2;

/// The most samples of a replicate.
const LONGEST: u32 = 1 << 24;

impl ProgressiveFilm {
    /// The film as bytes; equal films are equal bytes.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let Crop {
            x,
            y,
            width,
            height,
        } = self.crop();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.seed().to_le_bytes());
        bytes.extend([x, y, width, height].into_iter().flat_map(u32::to_le_bytes));
        let is_toned = self.pixels.values().any(Replicates::is_toned);
        bytes.push(u8::from(is_toned));
        let counts = self.counts.to_array();
        bytes.extend(counts.into_iter().flat_map(u64::to_le_bytes));
        bytes.reserve(self.len() * Replicates::BYTES);
        let pixels = self.pixels.values();
        pixels.for_each(|pixel| pixel.save(&mut bytes));
        bytes
    }

    /// Fills a film without samples with those of such bytes, of a film of the same crop and seed.
    ///
    /// # Errors
    /// If the bytes are of something else or of another version, or damaged.
    pub fn load(mut self, bytes: &[u8]) -> Result<Self, FilmError> {
        let mut bytes = FilmBytes::of(bytes, MAGIC, VERSION)?;
        let seed = u64::from_le_bytes(bytes.array()?);
        let mut crop = [0; 4];
        for number in &mut crop {
            *number = bytes.number()?;
        }
        let Crop {
            x,
            y,
            width,
            height,
        } = self.crop();
        if seed != self.seed() || crop != [x, y, width, height] {
            return Err(FilmError::OtherPicture);
        }
        let tone = match bytes.array()? {
            [0] => None,
            [1] => Some(self.display),
            _ => return Err(FilmError::Corrupt("its tone map is unknown")),
        };
        self.counts = bytes.counts_of_effects()?;
        for pixel in self.pixels.values_mut() {
            *pixel = Replicates::load(&mut bytes)?.toned(tone);
        }
        let is_all = bytes.0.is_empty();
        is_all
            .then_some(self)
            .ok_or(FilmError::Corrupt("bytes are left over"))
    }
}

impl Replicates {
    /// The bytes of a pixel.
    const BYTES: usize = NUMBERS * 8 + 2 * 4 + 8;

    fn save(&self, bytes: &mut Vec<u8>) {
        let (numbers, counts, hits) = self.to_numbers();
        bytes.extend(numbers.into_iter().flat_map(f64::to_le_bytes));
        bytes.extend(counts.into_iter().flat_map(u32::to_le_bytes));
        bytes.extend(hits.to_le_bytes());
    }

    fn load(bytes: &mut FilmBytes<'_>) -> Result<Self, FilmError> {
        let mut numbers = [0.0; NUMBERS];
        for number in &mut numbers {
            *number = f64::from_le_bytes(bytes.array()?);
        }
        let counts = [bytes.number()?, bytes.number()?];
        let hits = u64::from_le_bytes(bytes.array()?);
        let are_some =
            counts.iter().all(|count| *count <= LONGEST) && hits <= 2 * u64::from(counts[SHOWN]);
        if !are_some || !numbers.iter().all(|number| number.is_finite()) {
            return Err(FilmError::Corrupt("a pixel has samples that can't be"));
        }
        Ok(Self::from_numbers(&numbers, counts, hits))
    }
}
