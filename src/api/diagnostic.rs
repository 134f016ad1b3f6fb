//! Diagnostics about a scene, as owned values.

use super::Severity;
use super::path::path;
use rtc_diag as diag;
use rtc_ir::Scene;
use rtc_source::{SourceMap, Span};
use std::fmt;
use std::ops::Range;

/// An error, a warning or a note about a scene. It displays as text with the marked source, like a
/// compiler message.
///
/// ```
/// use rtc::{Scene, Severity};
///
/// let text = "Objects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
/// let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), text.into())])?;
/// let found = scene.check();
/// let typo = found.iter().find(|found| found.code == "SC001").unwrap();
/// assert_eq!(typo.severity, Severity::Warning);
/// assert!(typo.short().starts_with("a.yaml:2:39: warning[SC001]"));
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// The stable code, for example `VA003`; `schema/diagnostics.md` lists all codes.
    pub code: &'static str,
    /// The severity.
    pub severity: Severity,
    /// The message: one sentence, lower case, without a full stop.
    pub message: String,
    /// The position of the error, if it has one.
    pub primary: Option<Label>,
    /// Related positions.
    pub secondary: Vec<Label>,
    /// How to fix it.
    pub hints: Vec<Hint>,
    /// A JSON pointer to the value, for input that is JSON or has no text.
    pub pointer: Option<String>,
    /// In a scene that was built or edited in code: the value, for example
    /// `objects[3].material.ior`.
    pub path: Option<String>,
    text: String,
}

/// A position with a short text.
///
/// ```
/// use rtc::Scene;
///
/// let text = "Objects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
/// let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), text.into())])?;
/// let found = scene.check();
/// let typo = found.iter().find(|found| found.code == "SC001").unwrap();
/// let label = typo.primary.as_ref().unwrap();
/// assert_eq!(&text[label.location.bytes.clone()], "raduis");
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Label {
    /// The position.
    pub location: Location,
    /// A short description of the text at this position; may be empty.
    pub text: String,
}

/// A range of bytes in a file.
///
/// ```
/// use rtc::Scene;
///
/// let text = "Objects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
/// let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), text.into())])?;
/// let found = scene.check();
/// let typo = found.iter().find(|found| found.code == "SC001").unwrap();
/// let location = &typo.primary.as_ref().unwrap().location;
/// assert_eq!(location.file, "a.yaml");
/// assert_eq!((location.line, location.column), (Some(2), Some(39)));
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Location {
    /// The name of the file, as it was opened or found.
    pub file: String,
    /// The byte range; empty for a position between two bytes.
    pub bytes: Range<usize>,
    /// The line of the first byte, from 1; `None` for a binary file.
    pub line: Option<u32>,
    /// The column of the first byte in characters, from 1; `None` for a binary file.
    pub column: Option<u32>,
}

/// Advice, with a replacement if there is one.
///
/// ```
/// use rtc::Scene;
///
/// let text = "Objects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
/// let scene = Scene::from_files("a.yaml", [("a.yaml".to_owned(), text.into())])?;
/// let found = scene.check();
/// let typo = found.iter().find(|found| found.code == "SC001").unwrap();
/// let replacement = typo.hints.iter().find_map(|hint| hint.replacement.as_ref()).unwrap();
/// let mut fixed = text.to_owned();
/// fixed.replace_range(replacement.location.bytes.clone(), &replacement.text);
/// assert!(fixed.contains("radius: 1"));
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Hint {
    /// The advice.
    pub text: String,
    /// The range to replace and its new text.
    pub replacement: Option<Label>,
}

/// The width of the displayed text, in columns.
const WIDTH: usize = 100;

impl Diagnostic {
    /// A diagnostic about files, or about a scene that was built.
    pub(super) fn new(found: &diag::Diagnostic, map: &SourceMap, built: Option<&Scene>) -> Self {
        // An entity of a built scene has a path instead of a position.
        let of_pointer = |scene| path(found.pointer.as_deref()?, scene);
        let path = built.and_then(of_pointer);
        let text = match (&path, &found.primary) {
            (Some(path), None) => diag::one(&found.clone().pointer(path), map, WIDTH),
            _ => diag::one(found, map, WIDTH),
        };
        // Copy the parts, with spans as lines and columns.
        let diag::Diagnostic {
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
            path,
            text,
        }
    }

    /// Position, code and message in one line, for example `scene.yaml:3:5: error[VA003]: …`, or
    /// `objects[3].radius: error[VA003]: …`.
    #[must_use]
    pub fn short(&self) -> String {
        let place = self.primary.as_ref().map(|label| &label.location);
        let path = || self.path.iter().map(|path| format!("{path}: ")).collect();
        let place = place.map_or_else(path, |at| match (at.line, at.column) {
            (Some(line), Some(column)) => format!("{}:{line}:{column}: ", at.file),
            _ => format!("{}: ", at.file),
        });
        let Self { code, message, .. } = self;
        format!("{place}{}[{code}]: {message}", self.severity.name())
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text.trim_end())
    }
}

impl Label {
    fn new(span: Span, text: &str, map: &SourceMap) -> Self {
        Self {
            location: Location::new(span, map),
            text: text.to_owned(),
        }
    }
}

impl Location {
    pub(super) fn new(span: Span, map: &SourceMap) -> Self {
        let Span { file, start, end } = span;
        let at = map.is_text(file).then(|| map.line_column(file, start));
        Self {
            file: map.name(file).to_owned(),
            bytes: start as usize..end as usize,
            line: at.map(|at| at.line),
            column: at.map(|at| at.column),
        }
    }
}
