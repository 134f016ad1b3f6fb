//! The meaning of a key, with its default and range, and of the code of a diagnostic.

use super::completion::words;
use super::effective;
use super::foreign;
use super::open_text::OpenText;
use super::path_at::{PathStep, path_at};
use super::protocol::{Hover, MarkupContent, MarkupKind, Position, Range};
use super::text::Columns;
use super::vocabulary::{MERGE, Vocabulary};
use rtc_pipeline::explain_code;
use rtc_source::tree::{NodeId, SyntaxTree};
use serde_json::{Map, Value};

/// The hover text at a position.
pub(super) fn hover(
    document: &OpenText,
    position: Position,
    vocabulary: &Vocabulary,
    columns: Columns,
) -> Option<Hover> {
    let (lines, mut parts) = (document.lines(columns), Vec::new());
    let offset = lines.offset(position);
    let mut range = Range::new(position, position);
    let found = match foreign::format(document.kind()) {
        Some(format) => foreign::meaning(&document.text, offset, format),
        None => meaning(document, offset, vocabulary),
    };
    if let Some((reported, (start, end))) = found {
        parts.push(reported);
        range = lines.range(start, end);
    }
    parts.extend(codes(document, offset));
    (!parts.is_empty()).then(|| Hover {
        contents: MarkupContent {
            kind: MarkupKind::Markdown,
            value: parts.join("\n\n---\n\n"),
        },
        range,
    })
}

/// The meaning of the key at a byte, or of the key of the value there, and its range in the text.
fn meaning(
    document: &OpenText,
    offset: usize,
    vocabulary: &Vocabulary,
) -> Option<(String, (usize, usize))> {
    let tree = document.tree()?;
    let steps = path_at(&tree, offset);
    let last = steps
        .iter()
        .rposition(|step| matches!(step, PathStep::Key { .. }))?;
    let PathStep::Key { key, value, .. } = steps[last] else {
        return None;
    };
    let schemas = vocabulary.at(&tree, &steps[..=last]);
    let name = tree.text(key)?;
    let text = match (name, description(&schemas)) {
        (MERGE, _) => "The keys of another map; the keys that this map has itself win.".to_owned(),
        (_, Some(text)) => text.to_owned(),
        (_, None) => not_read(&tree, &steps[..last], vocabulary)?,
    };
    let facts = facts(&schemas);
    let word = word(&tree, value, &schemas).unwrap_or_default();
    let here = aliased(&tree, value);
    let value = effective::value(document, &tree, [key, value]).unwrap_or_default();
    let lines = [format!("**`{name}`** {text}"), word, facts, here, value];
    let lines = lines.into_iter().filter(|line| !line.is_empty());
    let span = tree.span(key);
    let reported = lines.collect::<Vec<_>>().join("\n\n");
    Some((reported, (span.start as usize, span.end as usize)))
}

/// The description of a key in its schemas.
fn description<'v>(schemas: &[&'v Map<String, Value>]) -> Option<&'v str> {
    let mut texts = schemas
        .iter()
        .filter_map(|schema| schema.get("description"));
    texts.next()?.as_str()
}

/// What is said of a key within the value of an unknown one.
fn not_read(tree: &SyntaxTree<'_>, steps: &[PathStep], vocabulary: &Vocabulary) -> Option<String> {
    let mut keys = steps
        .iter()
        .enumerate()
        .filter_map(|(at, step)| match step {
            PathStep::Key { key, .. } => Some((at, *key)),
            PathStep::Item { .. } => None,
        });
    let is_unknown = |at: usize| vocabulary.at(tree, &steps[..=at]).is_empty();
    let (_, unknown) = keys.find(|(at, _)| is_unknown(*at))?;
    let unknown = tree.text(unknown)?;
    Some(format!(
        "Not read, as it is within `{unknown}`, which is no key here."
    ))
}

/// The word that is written, and its meaning.
fn word(tree: &SyntaxTree<'_>, value: NodeId, schemas: &[&Map<String, Value>]) -> Option<String> {
    let written = tree.text(value)?;
    let words = words(schemas).into_iter();
    let mut known = words.filter(|(word, _)| word.eq_ignore_ascii_case(written));
    let (word, meaning) = known.next()?;
    Some(format!("`{word}`: {}", meaning?))
}

/// The range, the words and the default of a value.
fn facts(schemas: &[&Map<String, Value>]) -> String {
    const LIMIT: f64 = 1e30;
    let mut facts = Vec::new();
    let bounds = [
        ("minimum", "at least"),
        ("exclusiveMinimum", "above"),
        ("maximum", "at most"),
        ("exclusiveMaximum", "below"),
    ];
    for (key, keyword) in bounds {
        let bound = schemas.iter().find_map(|schema| schema.get(key)?.as_f64());
        let bound = bound.filter(|bound| bound.abs() < LIMIT);
        facts.extend(bound.map(|bound| format!("{keyword} {bound}")));
    }
    let words = words(schemas);
    if !words.is_empty() {
        let words: Vec<_> = words.iter().map(|(word, _)| format!("`{word}`")).collect();
        facts.push(format!("one of {}", words.join(", ")));
    }
    facts.extend(unit(schemas).map(|unit| format!("in {unit}")));
    let default = schemas.iter().find_map(|schema| schema.get("default"));
    facts.extend(default.map(|default| format!("default `{}`", plain(default))));
    facts.join("; ")
}

/// The unit of a value, or of the numbers that it is a list of.
pub(super) fn unit<'v>(schemas: &[&'v Map<String, Value>]) -> Option<&'v str> {
    let of_items = |schema: &&'v Map<String, Value>| schema.get("items")?.get("x-unit");
    let unit = schemas.iter().find_map(|schema| schema.get("x-unit"));
    unit.or_else(|| schemas.iter().find_map(of_items))?.as_str()
}

/// The default of a key with its unit, as a scene writes it.
pub(super) fn default(schema: &Value) -> Option<String> {
    let value = plain(schema.get("default")?);
    let unit = schema.as_object().and_then(|own| unit(&[own]));
    Some(unit.map_or_else(|| value.clone(), |unit| format!("{value} {unit}")))
}

/// A value as a scene writes it.
pub(super) fn plain(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

/// The value of an alias.
fn aliased(tree: &SyntaxTree<'_>, value: NodeId) -> String {
    /// The maximum length, in bytes.
    const MOST: usize = 400;
    let target = tree.target(value);
    if target == value {
        return String::new();
    }
    let written = tree.written(target);
    let end = written.floor_char_boundary(MOST.min(written.len()));
    format!("here\n```yaml\n{}\n```", written.split_at(end).0)
}

/// The texts of the codes of the diagnostics at a byte.
fn codes(document: &OpenText, offset: usize) -> Vec<String> {
    let checked = document.scene().into_iter();
    let diagnostics = checked.flat_map(|checked| {
        let covers = |span: rtc_source::Span| {
            let (start, end) = (span.start as usize, span.end as usize);
            checked.is_own(span.file) && (start..=end).contains(&offset)
        };
        let diagnostics = checked.diagnostics.iter();
        diagnostics.filter(move |diagnostic| {
            diagnostic
                .primary
                .as_ref()
                .is_some_and(|label| covers(label.span))
        })
    });
    let mut texts: Vec<String> = diagnostics
        .map(|diagnostic| explain_code(diagnostic.code))
        .collect();
    texts.dedup();
    texts
}
