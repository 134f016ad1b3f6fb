//! Sections: arrays of little-endian numbers or of bytes, each aligned to 64 bytes and hashed, with
//! a table of contents.
//!
//! The layout is fixed: sections in the order of the table, each at the next aligned offset, zeros
//! between, nothing after the last. So every bit of the file is in the header, in a section or a
//! known zero, and any change is detected.

use super::container::{CHECKSUMS_COUNT, Container};
use super::decoded::Decoded;
use rtc_diag::codes;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, Write};
use xxhash_rust::xxh3::{Xxh3Default, xxh3_64};

/// The alignment of sections, in bytes from the start of the file.
pub(super) const ALIGNMENT: usize = 64;

/// The element type of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) enum ElementType {
    F32,
    F64,
    U32,
    /// Bytes of a string or of pixels.
    U8,
}

impl ElementType {
    fn bytes(self) -> usize {
        match self {
            Self::F64 => 8,
            Self::F32 | Self::U32 => 4,
            Self::U8 => 1,
        }
    }
}

/// An entry of the table of contents.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SectionEntry {
    /// In bytes from the start of the first section.
    offset: u64,
    /// In bytes.
    length: u64,
    element: ElementType,
    /// Elements per record.
    stride: usize,
    /// The hash as 16 hexadecimal digits: many readers lose bits of JSON numbers.
    xxh3: String,
}

/// The data of a section to be written.
pub(super) enum SectionContent<'s> {
    Bytes(Cow<'s, [u8]>),
    F32(&'s [f32]),
    F64(&'s [f64]),
    U32(&'s [u32]),
}

impl SectionContent<'_> {
    /// In bytes.
    fn length(&self) -> usize {
        match self {
            Self::Bytes(bytes) => bytes.len(),
            Self::F32(numbers) => size_of_val(*numbers),
            Self::F64(numbers) => size_of_val(*numbers),
            Self::U32(numbers) => size_of_val(*numbers),
        }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Bytes(bytes) => out.write_all(bytes),
            Self::F32(numbers) => write_numbers(numbers, f32::to_le_bytes, out),
            Self::F64(numbers) => write_numbers(numbers, f64::to_le_bytes, out),
            Self::U32(numbers) => write_numbers(numbers, u32::to_le_bytes, out),
        }
    }
}

/// Writes numbers in chunks, so that their bytes are never all in memory.
fn write_numbers<T: Copy, const B: usize>(
    numbers: &[T],
    to_bytes: impl Fn(T) -> [u8; B],
    out: &mut dyn Write,
) -> io::Result<()> {
    const PIECE: usize = 4096;
    let mut piece = [[0; B]; PIECE];
    numbers.chunks(PIECE).try_for_each(|numbers| {
        piece
            .iter_mut()
            .zip(numbers)
            .for_each(|(bytes, number)| *bytes = to_bytes(*number));
        out.write_all(piece[..numbers.len()].as_flattened())
    })
}

/// The sections of a file to be written.
#[derive(Default)]
pub(super) struct SectionWriter<'s> {
    contents: Vec<SectionContent<'s>>,
    /// In bytes.
    length: usize,
    pub(super) entries: Vec<SectionEntry>,
}

impl<'s> SectionWriter<'s> {
    /// Adds a section of records of `stride` elements and returns its index.
    pub(super) fn push(
        &mut self,
        element: ElementType,
        stride: usize,
        content: SectionContent<'s>,
    ) -> usize {
        let mut hash = HashWriter::default();
        content.write(&mut hash).expect("hashing does not fail");
        let (offset, length) = (self.length.next_multiple_of(ALIGNMENT), content.length());
        self.length = offset + length;
        self.contents.push(content);
        let (offset, length, xxh3) = (offset as u64, length as u64, hex(hash.0.digest()));
        self.entries.push(SectionEntry {
            offset,
            length,
            element,
            stride,
            xxh3,
        });
        self.entries.len() - 1
    }

    /// Writes the sections, each at the next aligned offset. `out` must be aligned at the start.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut end = 0_usize;
        for content in &self.contents {
            let start = end.next_multiple_of(ALIGNMENT);
            out.write_all(&[0; ALIGNMENT][..start - end])?;
            content.write(out)?;
            end = start + content.length();
        }
        Ok(())
    }
}

/// A writer that only hashes.
#[derive(Default)]
pub(super) struct HashWriter(pub(super) Xxh3Default);

impl Write for HashWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A hash as hexadecimal digits.
fn hex(hash: u64) -> String {
    format!("{hash:016x}")
}

/// A section whose position, hash and numbers are checked.
pub(super) struct Section<'a> {
    bytes: &'a [u8],
    pub(super) element: ElementType,
    /// Elements per record.
    pub(super) stride: usize,
}

impl Section<'_> {
    /// Number `index` of a section of [`ElementType::F64`].
    pub(super) fn f64(&self, index: usize) -> f64 {
        let bytes = self.bytes[8 * index..]
            .first_chunk()
            .expect("the index is below the length of the section");
        f64::from_le_bytes(*bytes)
    }

    /// Number `index` of a section of [`ElementType::U32`].
    pub(super) fn u32(&self, index: usize) -> u32 {
        let bytes = self.bytes[4 * index..]
            .first_chunk()
            .expect("the index is below the length of the section");
        u32::from_le_bytes(*bytes)
    }

    /// The bytes of a section of [`ElementType::U8`].
    pub(super) fn octets(&self) -> Option<&[u8]> {
        (self.element == ElementType::U8 && self.stride == 1).then_some(self.bytes)
    }

    /// The string of a section of [`ElementType::U8`], if it is UTF-8.
    pub(super) fn as_str(&self) -> Option<&str> {
        self.octets()
            .and_then(|bytes| std::str::from_utf8(bytes).ok())
    }

    /// A section as vectors of `N` numbers of type `element`, each decoded by `number`; `None` if
    /// the section has another type or stride.
    pub(super) fn vectors<T: Copy + Default, const N: usize, const B: usize>(
        &self,
        element: ElementType,
        number: impl Fn([u8; B]) -> T,
    ) -> Option<Vec<[T; N]>> {
        if self.element != element || element.bytes() != B || self.stride != N {
            return None;
        }
        let mut vectors = vec![[T::default(); N]; self.len() / N];
        let numbers = vectors
            .as_flattened_mut()
            .iter_mut()
            .zip(self.bytes.as_chunks().0);
        numbers.for_each(|(to, bytes)| *to = number(*bytes));
        Some(vectors)
    }

    /// The offset of the first float that is not finite, in bytes from the start of the section.
    fn not_finite(&self) -> Option<usize> {
        let position = match self.element {
            ElementType::F32 => first(self.bytes, |bytes| f32::from_le_bytes(bytes).is_finite()),
            ElementType::F64 => first(self.bytes, |bytes| f64::from_le_bytes(bytes).is_finite()),
            ElementType::U32 | ElementType::U8 => None,
        };
        position.map(|index| index * self.element.bytes())
    }

    /// Whether the section consists of `records` records of `stride` elements.
    pub(super) fn holds(&self, element: ElementType, stride: usize, records: usize) -> bool {
        self.element == element
            && self.stride == stride
            && Some(self.len()) == stride.checked_mul(records)
    }

    /// The number of elements.
    pub(super) fn len(&self) -> usize {
        self.bytes.len() / self.element.bytes()
    }
}

/// Checks everything after the header, which ends at `end`.
pub(super) fn open<'a>(
    file: &Container<'a>,
    mut end: usize,
    entries: &[SectionEntry],
) -> Decoded<Vec<Section<'a>>> {
    let body = end.next_multiple_of(ALIGNMENT);
    padding(file, end, body)?;
    end = body;
    let mut sections = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let start = end.next_multiple_of(ALIGNMENT);
        padding(file, end, start)?;
        let bytes = bytes_of(file, index, entry, start, body)?;
        end = start + bytes.len();
        let section = Section {
            bytes,
            element: entry.element,
            stride: entry.stride,
        };
        numbers(file, index, &section, start)?;
        sections.push(section);
    }
    if end < file.bytes.len() {
        let message = format!(
            "{} bytes follow the last section, which ends at byte {end}",
            file.bytes.len() - end
        );
        return Err(file.error_at(&codes::MALFORMED, message, end, file.bytes.len()));
    }
    Ok(sections)
}

fn padding(file: &Container, start: usize, end: usize) -> Decoded<()> {
    let Some(padding) = file.bytes.get(start..end) else {
        return Err(file.truncated(end, "padding"));
    };
    match padding.iter().position(|byte| *byte != 0) {
        None => Ok(()),
        Some(skip) => {
            let at = start + skip;
            let message = format!("the padding at byte {at} is not zero, so the file is damaged");
            Err(file.error_at(&codes::DAMAGED, message, at, at + 1))
        }
    }
}

fn bytes_of<'a>(
    file: &Container<'a>,
    index: usize,
    entry: &SectionEntry,
    start: usize,
    body: usize,
) -> Decoded<&'a [u8]> {
    // Check offset and length.
    let SectionEntry {
        offset,
        length,
        element,
        stride,
        xxh3,
    } = entry;
    let record = stride.checked_mul(element.bytes()).unwrap_or(usize::MAX) as u64;
    let is_integral = if record == 0 {
        *length == 0
    } else {
        length.is_multiple_of(record)
    };
    if *offset != (start - body) as u64 || !is_integral {
        let message = format!(
            "section {index} should start at byte {start} and hold whole records of {record} bytes"
        );
        return Err(file.error_at(&codes::MALFORMED, message, start, start));
    }
    // Check that the file holds the section.
    let end = usize::try_from(*length).map_or(usize::MAX, |length| start.saturating_add(length));
    let Some(bytes) = file.bytes.get(start..end) else {
        return Err(file.truncated(end, &format!("section {index}")));
    };
    // Check the hash.
    if CHECKSUMS_COUNT && hex(xxh3_64(bytes)) != *xxh3 {
        let message = format!("the hash of section {index}, bytes {start} to {end}, is wrong");
        return Err(file.error_at(&codes::DAMAGED, message, start, end));
    }
    Ok(bytes)
}

fn numbers(file: &Container, index: usize, section: &Section, start: usize) -> Decoded<()> {
    match section.not_finite() {
        None => Ok(()),
        Some(at) => {
            let byte = start + at;
            let message = format!("the number at byte {byte}, in section {index}, is not finite");
            Err(file.error_at(
                &codes::MALFORMED,
                message,
                byte,
                byte + section.element.bytes(),
            ))
        }
    }
}

/// The index of the first number of `B` bytes that is invalid.
fn first<const B: usize>(bytes: &[u8], sound: impl Fn([u8; B]) -> bool) -> Option<usize> {
    bytes
        .as_chunks()
        .0
        .iter()
        .position(|number| !sound(*number))
}
