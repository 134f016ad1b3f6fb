//! A location as people and tools count it: bytes of a file, and lines and columns if it is text.

use super::text::clean;
use rtc_source::{SourceMap, Span};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt;

/// A location in a file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct SourceLocation<'a> {
    /// The name of the file as the user gave it.
    pub(super) file: &'a str,
    /// The first byte, from 0.
    pub(super) byte_start: u32,
    /// One past the last byte.
    pub(super) byte_end: u32,
    /// Line and column of the first character; absent where the file is not text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) start: Option<TextPosition>,
    /// Line and column just past the last character.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) end: Option<TextPosition>,
}

/// Line and column, both from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(super) struct TextPosition {
    pub(super) line: u32,
    pub(super) column: u32,
}

impl<'a> SourceLocation<'a> {
    /// The location of `span`.
    pub(super) fn new(map: &'a SourceMap, span: Span) -> Self {
        let Span { file, start, end } = span;
        let point = |offset| {
            let at = map.line_column(file, offset);
            TextPosition {
                line: at.line,
                column: at.column,
            }
        };
        let text = map.is_text(file);
        Self {
            file: map.name(file),
            byte_start: start,
            byte_end: end,
            start: text.then(|| point(start)),
            end: text.then(|| point(end)),
        }
    }
}

impl fmt::Display for SourceLocation<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = clean(self.file);
        match self.start {
            Some(TextPosition { line, column }) => write!(f, "{file}:{line}:{column}"),
            None => write!(f, "{file}: byte {}", self.byte_start),
        }
    }
}
