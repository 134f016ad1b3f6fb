//! What was found about a scene, with no reference to it.

use super::Severity;
use rtc_diag::{self as diag, Diagnostic};
use rtc_source::{SourceMap, Span};
use std::fmt;
use std::ops::Range;

/// One finding about a scene. It displays as text with the source and marks in it, as a compiler
/// does.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Finding {
    /// The stable code, as `VA003`; `schema/diagnostics.md` lists them.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in one sentence, lower case, without a full stop.
    pub message: String,
    /// The culprit, where it has a place.
    pub primary: Option<Label>,
    /// Other places that matter.
    pub secondary: Vec<Label>,
    /// What to do about it.
    pub hints: Vec<Hint>,
    /// A JSON pointer to the culprit, for input that is JSON or has no text.
    pub pointer: Option<String>,
    text: String,
}

/// A place and what is there.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Label {
    /// Where.
    pub location: Location,
    /// What is here, in a few words; may be empty.
    pub text: String,
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Location {
    /// The name of the file, as it was opened or found.
    pub file: String,
    /// Its bytes; empty for a place between two.
    pub bytes: Range<usize>,
    /// The line of the first byte, from 1; `None` where the file is not text.
    pub line: Option<u32>,
    /// The column of the first byte in characters, from 1; `None` where the file is not text.
    pub column: Option<u32>,
}

/// Advice, with the text that follows it where there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Hint {
    /// In words.
    pub text: String,
    /// What to put where: the new text of a place.
    pub replacement: Option<Label>,
}

/// Columns of the text.
const WIDTH: usize = 100;

impl Finding {
    pub(super) fn new(found: &Diagnostic, map: &SourceMap) -> Self {
        let Diagnostic {
            code,
            severity,
            message,
            primary,
            secondary,
            hints,
            pointer,
            alias: _,
            cause: _,
        } = found;
        let label = |label: &diag::Label| Label::new(label.span, &label.text, map);
        let hint = |hint: &diag::Hint| Hint {
            text: hint.text.clone(),
            replacement: hint
                .replacement
                .as_ref()
                .map(|by| Label::new(by.span, &by.text, map)),
        };
        Self {
            code: code.id,
            severity: *severity,
            message: message.clone(),
            primary: primary.as_ref().map(label),
            secondary: secondary.iter().map(label).collect(),
            hints: hints.iter().map(hint).collect(),
            pointer: pointer.clone(),
            text: diag::one(found, map, WIDTH),
        }
    }

    /// Code, place and message in one line, as `scene.yaml:3:5: error[VA003]: …`.
    #[must_use]
    pub fn short(&self) -> String {
        let place = self.primary.as_ref().map(|label| &label.location);
        let place = place.map_or_else(String::new, |at| match (at.line, at.column) {
            (Some(line), Some(column)) => format!("{}:{line}:{column}: ", at.file),
            _ => format!("{}: ", at.file),
        });
        let Self { code, message, .. } = self;
        format!("{place}{}[{code}]: {message}", self.severity.name())
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text.trim_end())
    }
}

impl Label {
    fn new(span: Span, text: &str, map: &SourceMap) -> Self {
        let Span { file, start, end } = span;
        let at = map.is_text(file).then(|| map.line_column(file, start));
        Self {
            location: Location {
                file: map.name(file).to_owned(),
                bytes: start as usize..end as usize,
                line: at.map(|at| at.line),
                column: at.map(|at| at.column),
            },
            text: text.to_owned(),
        }
    }
}
