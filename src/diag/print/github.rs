//! GitHub workflow commands, which become annotations of the lines of a pull request.

use super::location::{SourceLocation, TextPosition};
use super::text::clean_except;
use crate::{Diagnostic, Severity};
use rtc_source::SourceMap;

/// One diagnostic; `name` is its file if it has no span.
pub(super) fn diagnostic(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> String {
    let command = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "notice",
    };
    let place = diagnostic
        .primary
        .as_ref()
        .map(|label| SourceLocation::new(map, label.span));
    let file = property(place.as_ref().map_or(name, |place| place.file));
    let at = place
        .and_then(|place| Some(position(place.start?, place.end?)))
        .unwrap_or_default();
    format!(
        "::{command} file={file}{at},title={}::{}\n",
        diagnostic.code,
        data(&body(diagnostic))
    )
}

/// A notice that `count` diagnostics of the file `name` are not printed.
pub(super) fn more(name: &str, count: usize) -> String {
    format!("::notice file={}::and {count} more\n", property(name))
}

fn position(start: TextPosition, end: TextPosition) -> String {
    let lines = format!(",line={},endLine={}", start.line, end.line);
    // Columns are understood only within one line.
    if start.line == end.line {
        format!("{lines},col={},endColumn={}", start.column, end.column)
    } else {
        lines
    }
}

/// The message; the label, the pointer and the hints follow on separate lines.
fn body(diagnostic: &Diagnostic) -> String {
    let label = diagnostic
        .primary
        .iter()
        .map(|label| label.text.clone())
        .filter(|text| !text.is_empty());
    let pointer = diagnostic
        .pointer
        .iter()
        .map(|pointer| format!("at `{pointer}`"));
    let hints = diagnostic.hints.iter().map(|hint| match &hint.replacement {
        Some(replacement) => format!("help: {}: `{}`", hint.text, replacement.text),
        None => format!("help: {}", hint.text),
    });
    let lines = std::iter::once(diagnostic.message.clone())
        .chain(label)
        .chain(pointer)
        .chain(hints);
    lines.collect::<Vec<_>>().join("\n")
}

fn data(text: &str) -> String {
    clean_except(text, &['\n', '\r'])
        .replace('%', "%25")
        .replace('\r', "%0D")
        .replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
