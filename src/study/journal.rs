//! The journal of a study: all its renders in order, from which an interrupted study resumes. Which
//! settings are rendered depends only on ray counts, so the same study repeats the same renders.
//!
//! The file format: magic; version and header length (u32 each); the header in JSON, which
//! identifies the study; for each render its key (u64), six ray counts (u64), the numbers of images
//! and values (u32 each), the images, each with width and height (u32) before its pixels, and the
//! values; the xxh3 of all that. Numbers are little-endian.

use super::Effort;
use super::outcome::StudyProvenance;
use super::subject::RenderedTiles;
use rtc_image::Image;
use rtc_render::RayCounts;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use xxhash_rust::xxh3::xxh3_64;

/// The magic bytes.
const MAGIC: [u8; 8] = *b"rtc cost";

const VERSION: u32 = 2;

/// Identifies the study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct JournalHead {
    about: StudyProvenance,
    effort: Effort,
    seed: u64,
}

/// One render: its tiles, if they are still needed; its seconds followed by the errors of its
/// repeats, or for a ray map, the rays of each pixel.
#[derive(Clone)]
pub(super) struct JournalEntry {
    pub(super) key: u64,
    pub(super) rendered: RenderedTiles,
    pub(super) seconds: Vec<f64>,
}

/// The renders of a study, in order.
pub struct Journal {
    head: JournalHead,
    entries: Vec<JournalEntry>,
    /// The number of entries that this run has replayed.
    next: usize,
}

impl Journal {
    /// A journal without renders.
    #[must_use]
    pub fn new(about: &StudyProvenance, effort: Effort, seed: u64) -> Self {
        let head = JournalHead {
            about: about.clone(),
            effort,
            seed,
        };
        Self {
            head,
            entries: Vec::new(),
            next: 0,
        }
    }

    /// The number of renders.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "no caller needs it")]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// The next render, if it is in the journal.
    pub(super) fn replay(&mut self, key: u64) -> Option<JournalEntry> {
        let entry = self.entries.get(self.next);
        let Some(entry) = entry.filter(|entry| entry.key == key).cloned() else {
            // The following entries belong to another run: drop them.
            self.entries.truncate(self.next);
            return None;
        };
        self.next += 1;
        Some(entry)
    }

    /// Records a render.
    pub(super) fn record(&mut self, entry: JournalEntry) {
        self.entries.push(entry);
        self.next = self.entries.len();
    }

    /// The journal as bytes.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        let head = serde_json::to_vec(&self.head).unwrap_or_default();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(count(head.len()));
        bytes.extend(head);
        self.entries.iter().for_each(|entry| entry.save(&mut bytes));
        bytes.extend(xxh3_64(&bytes).to_le_bytes());
        bytes
    }

    /// Loads the renders from bytes into an empty journal.
    ///
    /// # Errors
    /// If the bytes are not a journal, belong to another study or version, or are corrupt.
    pub fn load(mut self, bytes: &[u8]) -> Result<Self, String> {
        const SHORT: &str = "it is corrupt: its end is missing";
        if !bytes.starts_with(&MAGIC) {
            return Err("it contains no renders of a study".to_owned());
        }
        let (bytes, sum) = bytes.split_last_chunk().ok_or(SHORT)?;
        let mut reader = ByteReader(bytes.get(MAGIC.len()..).ok_or(SHORT)?);
        let version = reader.number().ok_or(SHORT)?;
        if version != VERSION {
            return Err(format!("version {version} of its format is unknown"));
        }
        if xxh3_64(bytes) != u64::from_le_bytes(*sum) {
            return Err("it is corrupt: its checksum is wrong".to_owned());
        }
        let length = reader.number().ok_or(SHORT)? as usize;
        let head: Option<JournalHead> = reader
            .take(length)
            .and_then(|head| serde_json::from_slice(head).ok());
        let head = head.ok_or("it is corrupt: its header is invalid")?;
        if let Some(what) = self.head.difference(&head) {
            return Err(format!("it belongs to another study: {what}"));
        }
        while !reader.0.is_empty() {
            self.entries.push(reader.entry().ok_or(SHORT)?);
        }
        Ok(self)
    }
}

impl JournalHead {
    /// Describes the first difference of two studies.
    fn difference(&self, other: &Self) -> Option<String> {
        let (here, there) = (&other.about, &self.about);
        let pairs: [(&str, &dyn Display, &dyn Display); 5] = [
            ("program", &here.software, &there.software),
            ("scene", &here.hash, &there.hash),
            ("processor", &here.processor, &there.processor),
            ("effort", &other.effort.0, &self.effort.0),
            ("seed", &other.seed, &self.seed),
        ];
        let label = pairs.map(|(name, here, there)| (name, here.to_string(), there.to_string()));
        let differing = label.iter().find(|(_, here, there)| here != there);
        differing.map(|(name, here, there)| format!("{name}: {here} here, {there} there"))
    }
}

impl JournalEntry {
    fn save(&self, bytes: &mut Vec<u8>) {
        let RayCounts {
            camera,
            shadow,
            mirror,
            refracted,
            hits,
            unnumbered,
            ..
        } = self.rendered.counts;
        let numbers = [
            self.key, camera, shadow, mirror, refracted, hits, unnumbered,
        ];
        bytes.extend(numbers.into_iter().flat_map(u64::to_le_bytes));
        bytes.extend(count(self.rendered.tiles.len()));
        bytes.extend(count(self.seconds.len()));
        for Image {
            width,
            height,
            pixels,
        } in &self.rendered.tiles
        {
            bytes.extend(width.to_le_bytes());
            bytes.extend(height.to_le_bytes());
            bytes.extend(pixels.iter().flatten().flat_map(|it| it.to_le_bytes()));
        }
        bytes.extend(self.seconds.iter().flat_map(|it| it.to_le_bytes()));
    }
}

fn count(count: usize) -> [u8; 4] {
    u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes()
}

/// A reader of the remaining bytes. It allocates no more memory than they fill.
struct ByteReader<'a>(&'a [u8]);

impl<'a> ByteReader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, reader) = self.0.split_at_checked(count)?;
        self.0 = reader;
        Some(taken)
    }

    fn number(&mut self) -> Option<u32> {
        let bytes = self.take(4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes))
    }

    fn long(&mut self) -> Option<u64> {
        let bytes = self.take(8)?.try_into().ok()?;
        Some(u64::from_le_bytes(bytes))
    }

    fn floats(&mut self, count: usize) -> Option<Vec<f64>> {
        let (chunks, _) = self.take(count.checked_mul(8)?)?.as_chunks();
        Some(chunks.iter().copied().map(f64::from_le_bytes).collect())
    }

    fn image(&mut self) -> Option<Image> {
        let (width, height) = (self.number()?, self.number()?);
        let pixels = (width as usize).checked_mul(height as usize)?;
        let numbers = self.floats(pixels.checked_mul(3)?)?;
        let (pixels, _) = numbers.as_chunks();
        Some(Image {
            width,
            height,
            pixels: pixels.to_vec(),
        })
    }

    fn entry(&mut self) -> Option<JournalEntry> {
        let key = self.long()?;
        let mut counts = RayCounts::default();
        for count in [
            &mut counts.camera,
            &mut counts.shadow,
            &mut counts.mirror,
            &mut counts.refracted,
            &mut counts.hits,
            &mut counts.unnumbered,
        ] {
            *count = self.long()?;
        }
        let (images, seconds) = (self.number()?, self.number()?);
        let mut tiles = Vec::new();
        for _ in 0..images {
            tiles.push(self.image()?);
        }
        let seconds = self.floats(seconds as usize)?;
        let rendered = RenderedTiles { tiles, counts };
        Some(JournalEntry {
            key,
            rendered,
            seconds,
        })
    }
}
