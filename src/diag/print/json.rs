//! For programs: one JSON object for each diagnostic, each on a line.
//!
//! If diagnostics were left out, a last line `{"omitted": N}` gives their number.

use super::location::SourceLocation;
use super::text;
use crate::{Diagnostic, Hint, Label, Replacement};
use rtc_source::{SourceMap, Span};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::Serialize;

/// One diagnostic.
#[derive(Serialize, JsonSchema)]
struct JsonDiagnostic<'a> {
    /// The code, as `VA001`.
    code: &'a str,
    /// `error`, `warning` or `note`.
    #[schemars(extend("enum" = ["error", "warning", "note"]))]
    severity: &'a str,
    /// The message.
    message: &'a str,
    /// The file that was checked.
    file: &'a str,
    /// The span that is wrong, or null.
    primary: Option<JsonLabel<'a>>,
    /// Other spans that matter.
    labels: Vec<JsonLabel<'a>>,
    /// The hint.
    hints: Vec<JsonHint<'a>>,
    /// A JSON pointer to the value, or null.
    pointer: Option<&'a str>,
    /// The code of Khronos' glTF validator; absent if it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    alias: Option<&'a str>,
}

/// A location with the text of a label, or with the new text of a replacement.
#[derive(Serialize, JsonSchema)]
struct JsonLabel<'a> {
    #[serde(flatten)]
    location: SourceLocation<'a>,
    /// The text of the label, or the new text of a replacement.
    text: &'a str,
}

/// Advice.
#[derive(Serialize, JsonSchema)]
struct JsonHint<'a> {
    /// The hint.
    text: &'a str,
    /// As a change of the source, or null.
    replacement: Option<JsonChange<'a>>,
}

/// A change of the source.
#[derive(Serialize, JsonSchema)]
struct JsonChange<'a> {
    #[serde(flatten)]
    mark: JsonLabel<'a>,
    /// Whether it is a guess.
    guess: bool,
}

/// The last line, if diagnostics were left out.
#[derive(Serialize, JsonSchema)]
struct OmittedCount {
    /// The number of diagnostics left out.
    omitted: usize,
}

/// One line of the JSON format.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "only its schema is used")]
enum JsonLine<'a> {
    Diagnostic(JsonDiagnostic<'a>),
    Omitted(OmittedCount),
}

/// The schema of one line of the JSON format.
pub(super) fn schema(settings: SchemaSettings) -> Schema {
    settings
        .into_generator()
        .into_root_schema_for::<JsonLine<'_>>()
}

/// One diagnostic of the file `name`.
pub(super) fn diagnostic(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> String {
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
    let object = JsonDiagnostic {
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
    line(&object)
}

/// The last line, if `count` diagnostics were left out.
pub(super) fn omitted(count: usize) -> String {
    line(&OmittedCount { omitted: count })
}

fn labelled<'a>(map: &'a SourceMap, label: &'a Label) -> JsonLabel<'a> {
    let Label { span, text } = label;
    marked(map, *span, text)
}

fn marked<'a>(map: &'a SourceMap, span: Span, text: &'a str) -> JsonLabel<'a> {
    JsonLabel {
        location: SourceLocation::new(map, span),
        text,
    }
}

fn advice<'a>(map: &'a SourceMap, hint: &'a Hint) -> JsonHint<'a> {
    let Hint { text, replacement } = hint;
    let replacement = replacement.as_ref().map(|change| {
        let Replacement {
            span,
            text,
            is_guess,
        } = change;
        JsonChange {
            mark: marked(map, *span, text),
            guess: *is_guess,
        }
    });
    JsonHint { text, replacement }
}

fn line(value: &impl Serialize) -> String {
    let json = serde_json::to_string(value).expect("strings and integers have a JSON form");
    format!("{}\n", text::clean_json(&json))
}
