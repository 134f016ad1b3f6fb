//! For code scanning: SARIF 2.1.0, one run, the rules from the table of codes.

use super::location::SourceLocation;
use super::text;
use crate::{Diagnostic, Label, Severity, codes};
use rtc_source::{SourceMap, Span, uri_path};
use serde_json::{Value, json};

/// The whole log of the given results; `omitted` diagnostics were left out.
pub(super) fn log(results: &[Value], omitted: usize) -> String {
    let mut log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "rtc",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": codes::all().map(rule).collect::<Vec<_>>(),
            } },
            "columnKind": "unicodeCodePoints",
            "results": results,
            "properties": { "omitted": omitted },
        }],
    });
    // The page of the project, once its packages name one.
    if let Some(page) = PAGE.filter(|page| !page.is_empty()) {
        log["runs"][0]["tool"]["driver"]["informationUri"] = page.into();
    }
    format!("{}\n", text::clean_json(&log.to_string()))
}

/// The address of the project.
const PAGE: Option<&str> = option_env!("CARGO_PKG_REPOSITORY");

fn rule(code: &'static codes::Code) -> Value {
    json!({
        "id": code.id,
        "shortDescription": { "text": code.summary },
        "fullDescription": { "text": code.explanation() },
        "help": {
            "text": format!("{}\n`rtc explain {}` has an example.", code.explanation(), code.id),
            "markdown": code.page(),
        },
        "defaultConfiguration": { "level": level(code.severity) },
    })
}

fn level(severity: Severity) -> &'static str {
    severity.name()
}

/// One diagnostic; `name` is its file if it has no span.
pub(super) fn result(name: &str, diagnostic: &Diagnostic, map: &SourceMap) -> Value {
    let rule = codes::all().position(|code| code == diagnostic.code);
    let file = json!({ "physicalLocation": { "artifactLocation": { "uri": uri(name) } } });
    let mut location = diagnostic
        .primary
        .as_ref()
        .map_or(file, |label| location(label, map));
    if let Some(pointer) = &diagnostic.pointer {
        location["logicalLocations"] = json!([{ "fullyQualifiedName": pointer }]);
    }
    let related = diagnostic.secondary.iter();
    let related: Vec<Value> = related.map(|label| self::location(label, map)).collect();
    let mut result = json!({
        "ruleId": diagnostic.code.id,
        "ruleIndex": rule,
        "level": level(diagnostic.severity),
        "message": { "text": message(diagnostic) },
        "locations": [location],
        "relatedLocations": related,
    });
    let fixes = fixes(diagnostic, map);
    if !fixes.is_empty() {
        result["fixes"] = fixes.into();
    }
    result
}

/// The message and the advice: viewers show no more than this.
fn message(diagnostic: &Diagnostic) -> String {
    let hints = diagnostic
        .hints
        .iter()
        .map(|hint| format!("\nhelp: {}", hint.text));
    std::iter::once(diagnostic.message.clone())
        .chain(hints)
        .collect()
}

fn location(label: &Label, map: &SourceMap) -> Value {
    let physical = json!({
        "artifactLocation": { "uri": uri(map.name(label.span.file)) },
        "region": region(label.span, map),
    });
    if label.text.is_empty() {
        json!({ "physicalLocation": physical })
    } else {
        json!({ "physicalLocation": physical, "message": { "text": label.text } })
    }
}

fn region(span: Span, map: &SourceMap) -> Value {
    let place = SourceLocation::new(map, span);
    let mut region =
        json!({ "byteOffset": span.start, "byteLength": span.end.saturating_sub(span.start) });
    if let (Some(start), Some(end)) = (place.start, place.end) {
        region["startLine"] = start.line.into();
        region["startColumn"] = start.column.into();
        region["endLine"] = end.line.into();
        region["endColumn"] = end.column.into();
    }
    region
}

fn fixes(diagnostic: &Diagnostic, map: &SourceMap) -> Vec<Value> {
    let changes = diagnostic
        .hints
        .iter()
        .filter_map(|hint| Some((hint, hint.replacement.as_ref()?)));
    let fix = |(hint, change): (&crate::Hint, &crate::Replacement)| {
        json!({
            "description": { "text": hint.text },
            "artifactChanges": [{
                "artifactLocation": { "uri": uri(map.name(change.span.file)) },
                "replacements": [{
                    "deletedRegion": region(change.span, map),
                    "insertedContent": { "text": change.text },
                }],
            }],
        })
    };
    changes.map(fix).collect()
}

/// The path as a URI reference: relative as the user gave it, or with the scheme `file`.
fn uri(path: &str) -> String {
    let scheme = if path.starts_with('/') { "file://" } else { "" };
    format!("{scheme}{}", uri_path(path))
}
