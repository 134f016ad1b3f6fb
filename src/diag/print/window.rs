//! The lines of a file around some spans, safe to print: control characters are replaced, long
//! lines are cut, and spans are mapped to the new text.
//!
//! The size of the result depends on the spans, and not on the size of the file or of its lines.
//! Columns stay the same.

use super::text;
use rtc_source::{SourceMap, Span};
use std::ops::Range;

/// A line is clipped this many bytes after its last mark, or after its start.
const AFTER: usize = 240;
/// A span that starts further into its line than this, in bytes, is given by its position only.
const MAX_COLUMN: u32 = 4096;
/// A mark covers no more of its line than this, in bytes.
const MAX_MARK: u32 = 160;
/// Marks further apart than this, in bytes, are shown in separate windows.
const MAX_GAP: u32 = 400;

/// Lines of a file.
pub(super) struct SourceWindow {
    /// The lines, with line ends between them.
    pub(super) text: String,
    /// The number of the first line, from 1.
    pub(super) first_line: usize,
    /// Offsets in the file and the corresponding offsets in `text`, both ascending.
    offsets: Vec<(usize, usize)>,
}

impl SourceWindow {
    /// The lines from the start of the first span to the end of the last; all lie in one file.
    pub(super) fn new(map: &SourceMap, spans: &[Span]) -> Self {
        let (start, end) = spans.iter().fold((u32::MAX, 0), |(a, b), span| {
            (a.min(span.start), b.max(span.end))
        });
        let file = spans[0].file;
        let first = map.line_column(file, start).line;
        let last = map.line_column(file, end).line;
        let mut window = Self {
            text: String::new(),
            first_line: first as usize,
            offsets: Vec::new(),
        };
        for line in first..=last {
            let range = map.lines(file, line, line);
            let content =
                without_line_end(map.bytes(file), range.start as usize..range.end as usize);
            let kept = clip(map.bytes(file), &content, spans);
            window.line(map.bytes(file), content.start..kept);
            if kept < content.end {
                window.text.push('…');
            }
            if line < last {
                window.text.push('\n');
            }
        }
        window
    }

    /// The range of `span` in the text.
    pub(super) fn range(&self, span: Span) -> Range<usize> {
        let locate = |offset: u32| {
            let after = self
                .offsets
                .partition_point(|(from, _)| *from < offset as usize);
            self.offsets
                .get(after)
                .map_or(self.text.len(), |(_, to)| *to)
        };
        locate(span.start)..locate(span.end).max(locate(span.start))
    }

    fn line(&mut self, bytes: &[u8], kept: Range<usize>) {
        let mut at = kept.start;
        for chunk in bytes[kept.clone()].utf8_chunks() {
            for (offset, c) in chunk.valid().char_indices() {
                self.offsets.push((at + offset, self.text.len()));
                self.text.push(text::picture(c));
            }
            at += chunk.valid().len();
            if !chunk.invalid().is_empty() {
                self.offsets.push((at, self.text.len()));
                self.text.push(char::REPLACEMENT_CHARACTER);
                at += chunk.invalid().len();
            }
        }
        self.offsets.push((kept.end, self.text.len()));
    }
}

fn without_line_end(bytes: &[u8], range: Range<usize>) -> Range<usize> {
    let line = &bytes[range.clone()];
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let line = line.strip_suffix(b"\r").unwrap_or(line);
    range.start..range.start + line.len()
}

/// Where a line is cut: [`AFTER`] bytes after its last mark, between two characters.
fn clip(bytes: &[u8], line: &Range<usize>, spans: &[Span]) -> usize {
    let ends = spans
        .iter()
        .flat_map(|span| [span.start as usize, span.end as usize]);
    let last = ends
        .filter(|end| (line.start..=line.end).contains(end))
        .max()
        .unwrap_or(line.start);
    let is_boundary = |at: &usize| bytes[*at] & 0xc0 != 0x80;
    (last + AFTER..line.end)
        .find(is_boundary)
        .unwrap_or(line.end)
}

/// Whether the line of `span` can be printed up to the start of the span.
pub(super) fn is_near(map: &SourceMap, span: Span) -> bool {
    let before = map
        .bytes(span.file)
        .iter()
        .take(span.start as usize)
        .rev()
        .take(MAX_COLUMN as usize + 1);
    span.start <= MAX_COLUMN || before.into_iter().any(|byte| *byte == b'\n')
}

/// The part of a span in its first line, at most [`MAX_MARK`] bytes.
pub(super) fn mark(map: &SourceMap, span: Span) -> Span {
    let bytes = map.bytes(span.file);
    let start = (span.start as usize).min(bytes.len());
    let end =
        (span.end.min(span.start.saturating_add(MAX_MARK)) as usize).clamp(start, bytes.len());
    let line_end = bytes[start..end]
        .iter()
        .position(|byte| matches!(byte, b'\n' | b'\r'))
        .map_or(end, |at| start + at);
    let at = |offset| u32::try_from(offset).unwrap_or(u32::MAX);
    Span::new(span.file, at(start), at(line_end))
}

/// Whether the whole span can be printed, for a replacement.
pub(super) fn fits(map: &SourceMap, span: Span) -> bool {
    is_near(map, span)
        && span.end as usize <= map.bytes(span.file).len()
        && span.end - span.start <= MAX_GAP
}

/// Groups sorted marks into runs of close ones in one file; each run becomes one window.
pub(super) fn runs<T>(marks: Vec<T>, span: impl Fn(&T) -> Span) -> Vec<Vec<T>> {
    let mut runs: Vec<Vec<T>> = Vec::new();
    for mark in marks {
        let near = |last: &T| {
            let (last, next) = (span(last), span(&mark));
            last.file == next.file && next.start.saturating_sub(last.end) <= MAX_GAP
        };
        match runs.last_mut() {
            Some(run) if run.last().is_some_and(near) => run.push(mark),
            _ => runs.push(vec![mark]),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(text: &[u8], start: u32, end: u32) -> (String, String) {
        let mut map = SourceMap::default();
        let file = map.add("x", text.to_vec());
        let span = mark(&map, Span::new(file, start, end));
        let window = SourceWindow::new(&map, &[span]);
        (
            window.text.get(window.range(span)).unwrap().to_owned(),
            window.text.clone(),
        )
    }

    #[test]
    fn marks_move_with_what_is_replaced() {
        assert_eq!(
            window(b"a\n\x1b\xff: bc\r\nd", 6, 7),
            ("b".into(), "␛\u{fffd}: bc".into())
        );
        assert_eq!(window(b"ab\ncd", 1, 5), ("b".into(), "ab".into()));
        assert_eq!(window(b"ab\n", 3, 3), (String::new(), String::new()));
    }

    #[test]
    fn a_huge_line_is_clipped_at_a_character() {
        let huge = "ü".repeat(100_000);
        let (marked, text) = window(huge.as_bytes(), 1000, 90_000);
        assert_eq!(marked, "ü".repeat(80));
        assert_eq!(text, format!("{}…", "ü".repeat(500 + 80 + 120)));
    }

    #[test]
    fn what_is_far_into_a_line_is_not_shown() {
        let mut map = SourceMap::default();
        let file = map.add("x", [&b"a\n"[..], &[b'b'; 9000]].concat());
        let near = |start| is_near(&map, Span::new(file, start, start + 1));
        assert_eq!([0, 2, 4000, 5000].map(near), [true, true, true, false]);
    }

    #[test]
    fn far_marks_part() {
        let file = SourceMap::default().add("x", Vec::new());
        let spans = [0, 100, 1000].map(|start| Span::new(file, start, start + 1));
        assert_eq!(
            runs(spans.to_vec(), |span| *span)
                .iter()
                .map(Vec::len)
                .collect::<Vec<_>>(),
            [2, 1]
        );
    }
}
