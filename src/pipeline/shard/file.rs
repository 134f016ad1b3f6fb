//! The file format of shards, `.rtp`: 8 bytes of magic, version and header length (u32 each), film
//! length (u64), the header as JSON, the film, the layer values, the progressive state, and the
//! XXH3 of everything before. Numbers are little-endian.

use super::{RenderShard, ShardError, ShardHeader};
use rtc_render::{Crop, PartialFilm};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

/// The magic; any conversion as text changes it.
const MAGIC: [u8; 8] = *b"\x89RTP\r\n\x1a\n";

/// The version of the format.
const VERSION: u32 = 2;

/// The bytes before the header: magic, version, and the lengths of header and film.
const PREAMBLE: usize = 24;

impl RenderShard {
    /// The shard as bytes; equal shards have equal bytes.
    ///
    /// # Panics
    /// If the header exceeds 4 GiB.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let head = ShardHeader {
            tiles: self.hashed_tiles(),
            ..self.head.clone()
        };
        let head = serde_json::to_vec(&head).expect("maps with string keys, lists, numbers");
        let film = self.film.save();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        let length = u32::try_from(head.len()).expect("a header is short");
        bytes.extend(length.to_le_bytes());
        bytes.extend((film.len() as u64).to_le_bytes());
        bytes.extend(head);
        bytes.extend(film);
        let layers = self.layers.values().flatten();
        bytes.extend(layers.flat_map(|value| value.to_le_bytes()));
        bytes.extend(&self.growth);
        bytes.extend(xxh3_64(&bytes).to_le_bytes());
        bytes
    }

    /// Reads a shard of a picture with at most `max_pixels` pixels. Allocates memory in proportion
    /// to the bytes only.
    ///
    /// # Errors
    /// If the bytes are not a shard, of another version, or damaged.
    pub fn load(bytes: &[u8], max_pixels: u64) -> Result<Self, ShardError> {
        // Magic, version and checksum.
        if !bytes.starts_with(&MAGIC) {
            return Err(ShardError::NotAPart);
        }
        let version = number(bytes, MAGIC.len())?;
        if version != VERSION {
            return Err(ShardError::Version(version));
        }
        let (remaining, sum) = bytes.split_last_chunk().ok_or(SHORT)?;
        if xxh3_64(remaining) != u64::from_le_bytes(*sum) {
            return Err(ShardError::Damaged("its checksum does not fit"));
        }
        // Split header, film, layers and progressive state.
        let length = number(remaining, 12)? as usize;
        let film = remaining
            .get(16..PREAMBLE)
            .and_then(|bytes| bytes.try_into().ok());
        let film = film.map(u64::from_le_bytes).ok_or(SHORT)?;
        let film = usize::try_from(film).map_err(|_| SHORT)?;
        let (head, remaining) = remaining[PREAMBLE..]
            .split_at_checked(length)
            .ok_or(SHORT)?;
        let (film, layers) = remaining.split_at_checked(film).ok_or(SHORT)?;
        // Decode and check them.
        let mut head: ShardHeader = serde_json::from_slice(head)
            .map_err(|_| ShardError::Damaged("its header is not as it should be"))?;
        head.check(max_pixels)?;
        let film = PartialFilm::load(film, max_pixels).map_err(ShardError::Film)?;
        head.check_pixels(film.crop())?;
        let growth = usize::try_from(head.growth.unwrap_or(0)).map_err(|_| SHORT)?;
        let border = layers.len().checked_sub(growth).ok_or(SHORT)?;
        let (layers, growth) = layers.split_at(border);
        let layers = head.layers(layers)?;
        let tiles = head.tiles.take();
        let shard = Self {
            head,
            film,
            layers,
            growth: growth.to_vec(),
        };
        match tiles.is_none() || tiles == shard.hashed_tiles() {
            true => Ok(shard),
            false => Err(ShardError::Damaged("its tiles are not those of its hashes")),
        }
    }
}

/// The hash of the bytes of a file.
#[must_use]
pub fn hash_of_file(bytes: &[u8]) -> String {
    format!("xxh3:{:032x}", xxh3_128(bytes))
}

/// The bytes with corrected checksums, so that a fuzz test reaches the code behind them.
pub(crate) fn with_valid_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let film = |bytes: &[u8]| {
        let length = number(bytes, 12).ok()? as usize;
        let film = bytes.get(16..PREAMBLE)?.try_into().ok()?;
        let film = usize::try_from(u64::from_le_bytes(film)).ok()?;
        let start = PREAMBLE.checked_add(length)?;
        Some(start..start.checked_add(film)?)
    };
    if let Some(film) = film(&bytes).and_then(|film| bytes.get_mut(film))
        && let Some((film, sum)) = film.split_last_chunk_mut()
    {
        *sum = crc32fast::hash(film).to_le_bytes();
    }
    if let Some((remaining, sum)) = bytes.split_last_chunk_mut() {
        *sum = xxh3_64(remaining).to_le_bytes();
    }
    bytes
}

/// The maximum number of shares.
pub const MAX_SHARES: u32 = 65_536;

const SHORT: ShardError = ShardError::Damaged("its end is missing");

/// The u32 at an offset.
fn number(bytes: &[u8], at: usize) -> Result<u32, ShardError> {
    let bytes = bytes
        .get(at..at + 4)
        .and_then(|bytes| bytes.try_into().ok());
    bytes.map(u32::from_le_bytes).ok_or(SHORT)
}

impl ShardHeader {
    /// Rejects invalid shares and windows.
    fn check(&self, max_pixels: u64) -> Result<(), ShardError> {
        let [x, y, width, height] = self.window;
        let is_window = x.checked_add(width).is_some()
            && y.checked_add(height).is_some()
            && u64::from(width) * u64::from(height) <= max_pixels;
        let ascend = self.shares.windows(2).all(|pair| pair[0] < pair[1]);
        let are_in_range = self
            .shares
            .iter()
            .all(|share| (1..=self.count).contains(share));
        let are_once =
            (1..self.layers.len()).all(|at| !self.layers[..at].contains(&self.layers[at]));
        let is_begun =
            !self.shares.is_empty() || !self.finished.is_empty() || self.growth.is_some();
        let is_count = (1..=MAX_SHARES).contains(&self.count) && is_begun;
        (is_window && is_count && ascend && are_in_range && are_once)
            .then_some(())
            .ok_or(ShardError::Damaged(
                "its shares can't be those of a picture",
            ))
    }

    /// Rejects a film whose pixels differ from the window.
    fn check_pixels(&self, film: Crop) -> Result<(), ShardError> {
        let window = self.crop();
        let is_whole = (film.x, film.y) == (0, 0);
        let is_inside = window.within(film.width, film.height) == window;
        (film == window || (is_whole && is_inside))
            .then_some(())
            .ok_or(ShardError::Damaged("its film has other pixels"))
    }

    /// The layer values by tile.
    fn layers(&self, bytes: &[u8]) -> Result<BTreeMap<usize, Vec<f32>>, ShardError> {
        const WRONG: ShardError = ShardError::Damaged("its layers have another size");
        let mut remaining = bytes;
        let mut layers = BTreeMap::new();
        for (tile, area) in self.tiles() {
            let length = area.pixels() * self.channels() * 4;
            let (tile_values, after) = remaining.split_at_checked(length).ok_or(WRONG)?;
            let (numbers, _) = tile_values.as_chunks();
            let numbers = numbers.iter().copied().map(f32::from_le_bytes);
            layers.insert(tile, numbers.collect());
            remaining = after;
        }
        remaining.is_empty().then_some(layers).ok_or(WRONG)
    }
}
