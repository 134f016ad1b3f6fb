//! Places in a text as editors count them: lines, and columns in UTF-16 or UTF-8.

use super::protocol::{Position, PositionEncodingKind, Range};
use ropey::Rope;
use rtc_math::to_u32;
use std::sync::Arc;

/// The units of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Columns {
    /// UTF-16, which every editor supports.
    Utf16,
    /// Bytes.
    Utf8,
}

impl Columns {
    /// The cheapest of the encodings that an editor offers.
    pub(super) fn of(offered: &[PositionEncodingKind]) -> Self {
        match offered.contains(&PositionEncodingKind::UTF8) {
            true => Self::Utf8,
            false => Self::Utf16,
        }
    }

    /// As the protocol calls it.
    pub(super) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf8 => PositionEncodingKind::UTF8,
        }
    }

    /// The character index of a position in a rope; clamped to its line and to the text.
    pub(super) fn letter(self, rope: &Rope, place: Position) -> usize {
        let (line, column) = (place.line as usize, place.character as usize);
        if line >= rope.len_lines() {
            return rope.len_chars();
        }
        let start = rope.line_to_char(line);
        let own = rope.line(line);
        let is_break = |letter: &char| matches!(letter, '\n' | '\r');
        let breaks = own
            .chars_at(own.len_chars())
            .reversed()
            .take_while(is_break);
        let end = start + own.len_chars() - breaks.count();
        let letter = match self {
            Self::Utf16 => {
                let sought = rope.char_to_utf16_cu(start).saturating_add(column);
                rope.utf16_cu_to_char(sought.min(rope.len_utf16_cu()))
            }
            Self::Utf8 => {
                let sought = rope.char_to_byte(start).saturating_add(column);
                rope.byte_to_char(sought.min(rope.len_bytes()))
            }
        };
        letter.min(end)
    }

    /// The columns of a text.
    fn sum(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            Self::Utf16 if text.is_ascii() => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
        }
    }

    fn width(self, letter: char) -> usize {
        match self {
            Self::Utf16 => letter.len_utf16(),
            Self::Utf8 => letter.len_utf8(),
        }
    }
}

/// A text whose lines are known.
pub(super) struct TextLines<'t> {
    text: &'t str,
    columns: Columns,
    table: Arc<LineTable>,
}

/// The lines of a text, to be kept beside it.
#[derive(Debug)]
pub(super) struct LineTable {
    /// Where each line starts, in bytes.
    starts: Vec<usize>,
    /// Column counts at regular byte offsets, since a line may be as long as the text.
    widths: Vec<usize>,
}

/// The number of bytes.
const STRIDE: usize = 1 << 9;

impl LineTable {
    pub(super) fn of(text: &str, columns: Columns) -> Self {
        let starts = memchr::memchr2_iter(b'\n', b'\r', text.as_bytes());
        let bytes = text.as_bytes();
        let is_end = |at: &usize| bytes[*at] == b'\n' || bytes.get(at + 1) != Some(&b'\n');
        let starts = starts.filter(is_end).map(|at| at + 1);
        let (mut widths, mut sum) = (vec![0], 0);
        let bounds: Vec<usize> = (0..=text.len() / STRIDE)
            .map(|stride| text.floor_char_boundary(stride * STRIDE))
            .collect();
        for pair in bounds.windows(2) {
            let piece = text.get(pair[0]..pair[1]).unwrap_or_default();
            sum += columns.sum(piece);
            widths.push(sum);
        }
        Self {
            starts: std::iter::once(0).chain(starts).collect(),
            widths,
        }
    }
}

impl<'t> TextLines<'t> {
    #[cfg(test)]
    pub(super) fn of(text: &'t str, columns: Columns) -> Self {
        Self::with(text, columns, Arc::new(LineTable::of(text, columns)))
    }

    /// A text with its table, which is of the same columns.
    pub(super) fn with(text: &'t str, columns: Columns, table: Arc<LineTable>) -> Self {
        Self {
            text,
            columns,
            table,
        }
    }

    /// The columns before a byte, of all lines; of one within a character, before that.
    fn width_before(&self, offset: usize) -> usize {
        let widths = &self.table.widths;
        let known = (offset / STRIDE).min(widths.len() - 1);
        let [from, to] = [known * STRIDE, offset].map(|at| self.text.floor_char_boundary(at));
        let rest = self.text.get(from..to).unwrap_or_default();
        widths[known] + self.columns.sum(rest)
    }

    /// The lines of another text, in the same units.
    pub(super) fn of_other<'o>(&self, text: &'o str) -> TextLines<'o> {
        let table = Arc::new(LineTable::of(text, self.columns));
        TextLines::with(text, self.columns, table)
    }

    /// The line that a byte is in, from 0.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.table.starts.partition_point(|start| *start <= offset) - 1
    }

    /// The position of a byte; inside a character, that of the character.
    pub(super) fn position(&self, offset: usize) -> Position {
        let offset = self.text.floor_char_boundary(offset.min(self.text.len()));
        let line = self.line(offset);
        let column = self.width_before(offset) - self.width_before(self.table.starts[line]);
        Position::new(to_u32(line), to_u32(column))
    }

    /// The range of some bytes.
    pub(super) fn range(&self, start: usize, end: usize) -> Range {
        Range::new(self.position(start), self.position(end.max(start)))
    }

    /// The byte of a position; clamped to its line and to the text.
    pub(super) fn offset(&self, place: Position) -> usize {
        let line = place.line as usize;
        let Some(start) = self.table.starts.get(line).copied() else {
            return self.text.len();
        };
        let next = self
            .table
            .starts
            .get(line + 1)
            .copied()
            .unwrap_or(self.text.len());
        let own = self.text.get(start..next).unwrap_or_default();
        let own = own.trim_end_matches(['\n', '\r']);
        let (end, column) = (start + own.len(), place.character as usize);
        // Counted from the last cached position before it.
        let sought = self.width_before(start) + column;
        let known = self.table.widths.partition_point(|width| *width <= sought) - 1;
        let mut offset = self.text.floor_char_boundary(known * STRIDE);
        offset = offset.clamp(start, end);
        let mut left = sought - self.width_before(offset).min(sought);
        for letter in self.text.get(offset..end).unwrap_or_default().chars() {
            let width = self.columns.width(letter);
            if left < width {
                break;
            }
            left -= width;
            offset += letter.len_utf8();
        }
        offset
    }

    /// The bytes of a line before a byte of it.
    pub(super) fn before(&self, offset: usize) -> &'t str {
        let line = self.line(offset);
        self.text
            .get(self.table.starts[line]..offset)
            .unwrap_or_default()
    }

    /// The end of the line that a byte is in, without its line break.
    pub(super) fn line_end(&self, offset: usize) -> usize {
        let rest = self.text.get(offset..).unwrap_or_default();
        offset + rest.find(['\n', '\r']).unwrap_or(rest.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rope_counts_as_lines_do_and_a_long_line_as_short_ones() {
        let long = "aé😀\u{301}".repeat(400);
        let text = format!("a😀b\r\ncé\rd\n\n{long}\r\n{long}");
        let rope = Rope::from_str(&text);
        for columns in [Columns::Utf16, Columns::Utf8] {
            let lines = TextLines::of(&text, columns);
            for (at, letter) in text.char_indices() {
                let place = lines.position(at);
                if "\r\n".contains(letter) {
                    continue;
                }
                let before = text.split_at(at).0;
                let start = before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
                let before = before.split_at(start).1;
                let width: usize = before.chars().map(|c| columns.width(c)).sum();
                assert_eq!(place.character as usize, width);
                assert_eq!(lines.offset(place), at);
            }
            for (line, column) in (0..8).flat_map(|line| (0..3000).map(move |own| (line, own))) {
                let place = Position::new(line, column);
                let letter = columns.letter(&rope, place);
                assert_eq!(rope.char_to_byte(letter), lines.offset(place), "{place:?}");
            }
        }
    }

    #[test]
    fn columns_count_as_the_editor_does() {
        let text = "a😀b\r\ncé\rd";
        let (wide, bytes) = (
            TextLines::of(text, Columns::Utf16),
            TextLines::of(text, Columns::Utf8),
        );
        let b = text.find('b').unwrap();
        assert_eq!(wide.position(b), Position::new(0, 3));
        assert_eq!(bytes.position(b), Position::new(0, 5));
        let d = text.find('d').unwrap();
        assert_eq!(wide.position(d), Position::new(2, 0));
        for lines in [&wide, &bytes] {
            for (at, _) in text.char_indices().filter(|(_, c)| !"\r\n".contains(*c)) {
                assert_eq!(lines.offset(lines.position(at)), at);
            }
        }
        assert_eq!(wide.offset(Position::new(0, 99)), b + 1);
        assert_eq!(wide.offset(Position::new(9, 0)), text.len());
        assert_eq!(wide.position(text.len() + 7), Position::new(2, 1));
    }
}
