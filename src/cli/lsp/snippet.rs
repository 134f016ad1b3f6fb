//! Whole objects with their required keys, as completions.

use super::protocol::{CompletionItem, CompletionItemKind, InsertTextFormat};
use serde_json::{Map, Value};
use std::fmt::Write;

/// The objects that may stand at a value, for YAML or JSON.
pub(super) fn items(
    schemas: &[&Map<String, Value>],
    is_json: bool,
    form: InsertTextFormat,
) -> Vec<CompletionItem> {
    let is_current = |schema: &&&Map<String, Value>| !schema.contains_key("deprecated");
    let all = schemas.iter().filter(is_current);
    let snippets = all.filter_map(|schema| schema.get("defaultSnippets")?.as_array());
    let item = |snippet: &Value| {
        let text = |key: &str| snippet.get(key)?.as_str().map(str::to_owned);
        let mut writer = SnippetWriter {
            text: String::new(),
            is_json,
            has_stops: form == InsertTextFormat::SNIPPET,
            stops: 0,
        };
        writer.value(snippet.get("body")?, true);
        Some(CompletionItem {
            detail: Some("object with its required keys".to_owned()),
            documentation: text("description"),
            insert_text: Some(writer.text),
            insert_text_format: Some(form),
            ..CompletionItem::new(text("label")?, CompletionItemKind::SNIPPET)
        })
    };
    snippets.flatten().filter_map(item).collect()
}

/// Writes a value in flow style, with a tab stop at each scalar and each list of numbers.
struct SnippetWriter {
    text: String,
    is_json: bool,
    has_stops: bool,
    stops: usize,
}

impl SnippetWriter {
    fn value(&mut self, value: &Value, is_open: bool) {
        match value {
            Value::Object(map) => {
                self.text.push('{');
                for (at, (key, value)) in map.iter().enumerate() {
                    self.text.push_str(if at > 0 { ", " } else { "" });
                    self.string(key);
                    self.text.push_str(": ");
                    // The type is what was chosen.
                    self.value(value, key != "type");
                }
                self.text.push('}');
            }
            Value::Array(items) if items.iter().any(Value::is_object) => {
                self.text.push('[');
                for (at, item) in items.iter().enumerate() {
                    self.text.push_str(if at > 0 { ", " } else { "" });
                    self.value(item, true);
                }
                self.text.push(']');
            }
            Value::Array(items) => {
                let items: Vec<String> = items.iter().map(Value::to_string).collect();
                let items = items.join(", ");
                self.text.push('[');
                self.stop(&items);
                self.text.push(']');
            }
            Value::String(text) if is_open => {
                let quote = if self.is_json { "\"" } else { "" };
                self.text.push_str(quote);
                self.stop(text);
                self.text.push_str(quote);
            }
            Value::String(text) => self.string(text),
            Value::Null | Value::Bool(_) | Value::Number(_) => self.stop(&value.to_string()),
        }
    }

    fn string(&mut self, text: &str) {
        match self.is_json {
            true => write!(self.text, "{}", Value::from(text)),
            false => write!(self.text, "{text}"),
        }
        .expect("a string can be written to");
    }

    /// A text that is selected when the one before it is done. The texts of the schemas have no
    /// `$`, `}` or `\\`, which would have to be escaped.
    fn stop(&mut self, text: &str) {
        self.stops += 1;
        match self.has_stops {
            true => write!(self.text, "${{{}:{text}}}", self.stops),
            false => write!(self.text, "{text}"),
        }
        .expect("a string can be written to");
    }
}
