//! The body of a PLY, number by number.

use super::head::{PlyElement, PlyEncoding, PlyHeader, PlyNumberType, PlyProperty};
use crate::words::{Word, WordError, WordLines};
use std::ops::Range;

/// The rest of a body.
pub(super) struct PlyBody<'a> {
    bytes: &'a [u8],
    form: PlyEncoding,
    /// The offset of the next number; of a text, of the next line.
    at: usize,
    lines: WordLines<'a>,
    words: Vec<Word<'a>>,
    /// The number of words read from the line.
    used: usize,
    /// Whether each row may have a line of its own.
    is_by_lines: bool,
    /// The number of lines begun.
    line: usize,
    /// The line on which the row began, if at its start.
    row_line: Option<usize>,
    /// The number that was read last.
    last: Range<usize>,
    value: f64,
}

impl<'a> PlyBody<'a> {
    /// The body of a file, in the format of its header.
    pub(super) fn new(bytes: &'a [u8], head: &PlyHeader<'_>) -> Self {
        let (body, form) = (head.start, head.form);
        let rows = head
            .elements
            .iter()
            .filter(|element| !element.properties.is_empty());
        let rows = rows.fold(0_usize, |sum, element| sum.saturating_add(element.count));
        Self {
            bytes,
            form,
            is_by_lines: form == PlyEncoding::Text && has_lines(&bytes[body..], rows),
            at: body,
            lines: WordLines::from(bytes, body),
            words: Vec::new(),
            used: 0,
            line: 0,
            row_line: Some(1),
            last: body..body,
            value: 0.0,
        }
    }

    /// The fewest bytes that a number takes.
    pub(super) fn least(&self, kind: PlyNumberType) -> usize {
        match self.form {
            // A digit, and a space before the next one.
            PlyEncoding::Text => 2,
            PlyEncoding::LittleEndian | PlyEncoding::BigEndian => kind.size(),
        }
    }

    /// The number of remaining bytes; for a text, an upper bound.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Whether the rest is long enough for an element.
    pub(super) fn has_room(&self, element: &PlyElement<'_>) -> bool {
        let properties = element.properties.iter();
        let row: usize = properties
            .map(|property| self.least(property.length.unwrap_or(property.kind)))
            .sum();
        // The last number of a text has no space behind it.
        row.checked_mul(element.count)
            .is_some_and(|all| all <= self.left() + 1)
    }

    /// The next number, of a type; `element` announced it.
    pub(super) fn number(
        &mut self,
        kind: PlyNumberType,
        element: &PlyElement<'_>,
    ) -> Result<f64, WordError> {
        self.value = match self.form {
            PlyEncoding::Text => self.word(element),
            PlyEncoding::LittleEndian => self.binary(kind, element, false),
            PlyEncoding::BigEndian => self.binary(kind, element, true),
        }?;
        Ok(self.value)
    }

    /// The row ends; true if it is all of a line but for numbers that no property has, which are
    /// passed over.
    pub(super) fn end_row(&mut self) -> bool {
        let is_whole = self.is_by_lines && self.row_line == Some(self.line);
        let has_more = is_whole && self.used < self.words.len();
        if has_more {
            self.used = self.words.len();
        }
        self.row_line = (self.used == self.words.len()).then_some(self.line + 1);
        has_more
    }

    fn word(&mut self, element: &PlyElement<'_>) -> Result<f64, WordError> {
        if self.used == self.words.len() {
            self.used = 0;
            self.line += 1;
            if !self.lines.next(&mut self.words) {
                return Err(element.is_cut_off());
            }
        }
        let word = self.words[self.used];
        self.used += 1;
        self.last = word.range();
        self.at = self.last.end;
        word.number()
    }

    fn binary(
        &mut self,
        kind: PlyNumberType,
        element: &PlyElement<'_>,
        is_big: bool,
    ) -> Result<f64, WordError> {
        let size = kind.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err(element.is_cut_off());
        };
        self.last = self.at..self.at + size;
        self.at += size;
        let mut eight = [0; 8];
        eight[..size].copy_from_slice(bytes);
        if is_big {
            eight[..size].reverse();
        }
        let [a, b, c, d, ..] = eight;
        Ok(match kind {
            PlyNumberType::I8 => f64::from(i8::from_le_bytes([a])),
            PlyNumberType::U8 => f64::from(a),
            PlyNumberType::I16 => f64::from(i16::from_le_bytes([a, b])),
            PlyNumberType::U16 => f64::from(u16::from_le_bytes([a, b])),
            PlyNumberType::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            PlyNumberType::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            PlyNumberType::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            PlyNumberType::F64 => f64::from_le_bytes(eight),
        })
    }

    /// The length of a list.
    pub(super) fn count(
        &mut self,
        kind: PlyNumberType,
        element: &PlyElement<'_>,
    ) -> Result<u32, WordError> {
        let number = self.number(kind, element)?;
        super::whole(number)
            .ok_or_else(|| self.fault("the length of a list is no whole number", "here"))
    }

    /// Passes over a property.
    pub(super) fn skip(
        &mut self,
        property: &PlyProperty<'_>,
        element: &PlyElement<'_>,
    ) -> Result<(), WordError> {
        let count = match property.length {
            Some(length) => self.count(length, element)?,
            None => 1,
        };
        for _ in 0..count {
            self.number(property.kind, element)?;
        }
        Ok(())
    }

    /// Whether the number that was read last equals `number`.
    pub(super) fn last_is(&self, number: f64) -> bool {
        self.value == number
    }

    /// An error at the current line of a text.
    pub(super) fn line_fault(&self, message: &str, label: &str) -> WordError {
        let first = self.words.first().copied().unwrap_or(Word::START);
        first.fault(message, label)
    }

    /// An error at the last number read.
    pub(super) fn fault(&self, message: &str, label: &str) -> WordError {
        WordError::new(self.last.clone(), message, label)
    }
}

/// Whether a text has at least the given number of non-empty lines.
fn has_lines(text: &[u8], rows: usize) -> bool {
    let lines = text.split(|byte| matches!(byte, b'\n' | b'\r'));
    let mut lines = lines.filter(|line| !line.trim_ascii().is_empty());
    rows == 0 || lines.nth(rows - 1).is_some()
}
