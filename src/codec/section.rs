//! Sections: runs of little-endian numbers or of text, each aligned to 64 bytes and guarded by a hash, with a table of them all.
//!
//! There is one layout: in the order of the table, each at the next aligned byte, zeros between, nothing behind the
//! last. So every bit of the file is in the header, in a section or a known zero, and a change of any is found.

use super::binary::Container;
use super::{CHECKSUMS_COUNT, Decoded};
use crate::diag::codes;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

/// Sections start at multiples of this many bytes from the start of the file.
pub(super) const ALIGNMENT: usize = 64;

/// What a section is a run of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) enum Element {
    F64,
    U32,
    /// Bytes of text.
    U8,
}

impl Element {
    fn bytes(self) -> usize {
        match self {
            Self::F64 => 8,
            Self::U32 => 4,
            Self::U8 => 1,
        }
    }
}

/// One row of the table.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Entry {
    /// In bytes from the start of the first section.
    offset: u64,
    /// In bytes.
    length: u64,
    element: Element,
    /// Elements of one record.
    stride: usize,
    /// The hash as 16 hexadecimal digits: JSON numbers lose bits in many readers.
    xxh3: String,
}

/// The sections of a file being written.
#[derive(Default)]
pub(super) struct Body {
    pub(super) bytes: Vec<u8>,
    pub(super) entries: Vec<Entry>,
}

impl Body {
    /// Adds a section of records of `stride` elements and returns its index.
    pub(super) fn push(&mut self, element: Element, stride: usize, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        let (offset, length) = (self.bytes.len() as u64, bytes.len() as u64);
        self.bytes.extend(bytes);
        self.entries.push(Entry { offset, length, element, stride, xxh3: hash(bytes) });
        self.entries.len() - 1
    }
}

fn hash(bytes: &[u8]) -> String {
    format!("{:016x}", xxh3_64(bytes))
}

/// A section whose place, hash and numbers are checked.
pub(super) struct Section<'a> {
    bytes: &'a [u8],
    pub(super) element: Element,
    /// Elements of one record.
    pub(super) stride: usize,
}

impl Section<'_> {
    /// Number `index` of a section of [`Element::F64`].
    pub(super) fn f64(&self, index: usize) -> f64 {
        let bytes = self.bytes[8 * index..].first_chunk().expect("the index is below the length of the section");
        f64::from_le_bytes(*bytes)
    }

    /// Number `index` of a section of [`Element::U32`].
    pub(super) fn u32(&self, index: usize) -> u32 {
        let bytes = self.bytes[4 * index..].first_chunk().expect("the index is below the length of the section");
        u32::from_le_bytes(*bytes)
    }

    /// The text of a section of [`Element::U8`], if it is UTF-8.
    pub(super) fn text(&self) -> Option<&str> {
        std::str::from_utf8(self.bytes).ok().filter(|_| self.element == Element::U8)
    }

    /// True if it is `records` records of `stride` elements.
    pub(super) fn holds(&self, element: Element, stride: usize, records: usize) -> bool {
        self.element == element && self.stride == stride && Some(self.len()) == stride.checked_mul(records)
    }

    /// The count of elements.
    pub(super) fn len(&self) -> usize {
        self.bytes.len() / self.element.bytes()
    }
}

/// Checks all there is behind the header, which ends at `end`.
pub(super) fn open<'a>(file: &Container<'a>, mut end: usize, entries: &[Entry]) -> Decoded<Vec<Section<'a>>> {
    let body = end.next_multiple_of(ALIGNMENT);
    padding(file, end, body)?;
    end = body;
    let mut sections = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let start = end.next_multiple_of(ALIGNMENT);
        padding(file, end, start)?;
        let bytes = bytes_of(file, index, entry, start, body)?;
        end = start + bytes.len();
        let section = Section { bytes, element: entry.element, stride: entry.stride };
        numbers(file, index, &section, start)?;
        sections.push(section);
    }
    if end < file.bytes.len() {
        let message = format!("{} bytes follow the last section, which ends at byte {end}", file.bytes.len() - end);
        return Err(file.fault(&codes::MALFORMED, message, end, file.bytes.len()));
    }
    Ok(sections)
}

fn padding(file: &Container, start: usize, end: usize) -> Decoded<()> {
    let Some(padding) = file.bytes.get(start..end) else { return Err(file.truncated(end, "padding")) };
    match padding.iter().position(|byte| *byte != 0) {
        None => Ok(()),
        Some(skip) => {
            let at = start + skip;
            let message = format!("the padding at byte {at} is not zero, so the file is damaged");
            Err(file.fault(&codes::DAMAGED, message, at, at + 1))
        }
    }
}

fn bytes_of<'a>(file: &Container<'a>, index: usize, entry: &Entry, start: usize, body: usize) -> Decoded<&'a [u8]> {
    let Entry { offset, length, element, stride, xxh3 } = entry;
    let record = stride.checked_mul(element.bytes()).unwrap_or(usize::MAX) as u64;
    let whole = if record == 0 { *length == 0 } else { length.is_multiple_of(record) };
    if *offset != (start - body) as u64 || !whole {
        let message = format!("section {index} should start at byte {start} and hold whole records of {record} bytes");
        return Err(file.fault(&codes::MALFORMED, message, start, start));
    }
    let end = usize::try_from(*length).map_or(usize::MAX, |length| start.saturating_add(length));
    let Some(bytes) = file.bytes.get(start..end) else {
        return Err(file.truncated(end, &format!("section {index}")));
    };
    if CHECKSUMS_COUNT && hash(bytes) != *xxh3 {
        let message = format!("the hash of section {index}, bytes {start} to {end}, is wrong");
        return Err(file.fault(&codes::DAMAGED, message, start, end));
    }
    Ok(bytes)
}

fn numbers(file: &Container, index: usize, section: &Section, start: usize) -> Decoded<()> {
    let floats = if section.element == Element::F64 { section.len() } else { 0 };
    match (0..floats).find(|at| !section.f64(*at).is_finite()) {
        None => Ok(()),
        Some(at) => {
            let byte = start + 8 * at;
            let message = format!("the number at byte {byte}, in section {index}, is not finite");
            Err(file.fault(&codes::MALFORMED, message, byte, byte + 8))
        }
    }
}
