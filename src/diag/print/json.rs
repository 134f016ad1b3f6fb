//! For programs: one JSON object a line, one line a finding. The fields are those of the structs
//! below.
//!
//! If findings were left out, a last line `{"omitted": N}` says how many.

use super::place::FilePlace;
use super::text;
use crate::{Diagnostic, Hint, Label, Replacement};
use rtc_source::{SourceMap, Span};
use serde::Serialize;

/// One finding.
#[derive(Serialize)]
struct Finding<'a> {
    /// The code, as `VA001`.
    code: &'a str,
    /// `error`, `warning` or `note`.
    severity: &'a str,
    /// What is wrong.
    message: &'a str,
    /// The file that was checked.
    file: &'a str,
    /// The culprit, or null.
    primary: Option<Marked<'a>>,
    /// Other places that matter.
    labels: Vec<Marked<'a>>,
    /// What to do.
    hints: Vec<Advice<'a>>,
    /// A JSON pointer to the culprit, or null.
    pointer: Option<&'a str>,
    /// What the glTF validator of Khronos calls it; absent for what it has no name for.
    #[serde(skip_serializing_if = "Option::is_none")]
    alias: Option<&'a str>,
}

/// A place and what is there, or what to put there.
#[derive(Serialize)]
struct Marked<'a> {
    #[serde(flatten)]
    place: FilePlace<'a>,
    /// The words of the label, or the new text of a replacement.
    text: &'a str,
}

/// Advice.
#[derive(Serialize)]
struct Advice<'a> {
    /// In words.
    text: &'a str,
    /// As a change of the source, or null.
    replacement: Option<Change<'a>>,
}

/// A change of the source.
#[derive(Serialize)]
struct Change<'a> {
    #[serde(flatten)]
    mark: Marked<'a>,
    /// Whether it says what was most likely meant, and not the same in the right way.
    guess: bool,
}

/// One finding of the file `name`.
pub(super) fn finding(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> String {
    let Diagnostic {
        code,
        severity: level,
        message,
        primary,
        secondary,
        hints,
        pointer,
        alias,
        cause: _,
    } = diagnostic;
    let finding = Finding {
        code: code.id,
        severity: level.name(),
        message,
        file: name,
        primary: primary.as_ref().map(|label| labelled(map, label)),
        labels: secondary.iter().map(|label| labelled(map, label)).collect(),
        hints: hints.iter().map(|hint| advice(map, hint)).collect(),
        pointer: pointer.as_deref(),
        alias: *alias,
    };
    line(&finding)
}

/// The last line, when `count` findings were left out.
pub(super) fn omitted(count: usize) -> String {
    line(&serde_json::json!({ "omitted": count }))
}

fn labelled<'a>(map: &'a SourceMap, label: &'a Label) -> Marked<'a> {
    let Label { span, text } = label;
    marked(map, *span, text)
}

fn marked<'a>(map: &'a SourceMap, span: Span, text: &'a str) -> Marked<'a> {
    Marked {
        place: FilePlace::new(map, span),
        text,
    }
}

fn advice<'a>(map: &'a SourceMap, hint: &'a Hint) -> Advice<'a> {
    let Hint { text, replacement } = hint;
    let replacement = replacement.as_ref().map(|change| {
        let Replacement {
            span,
            text,
            is_guess,
        } = change;
        Change {
            mark: marked(map, *span, text),
            guess: *is_guess,
        }
    });
    Advice { text, replacement }
}

fn line(value: &impl Serialize) -> String {
    let json = serde_json::to_string(value).expect("strings and integers have a JSON form");
    format!("{}\n", text::clean_json(&json))
}
