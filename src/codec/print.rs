//! The text form's layout: two levels are broken into lines, all below them stays on one line.
//!
//! So an entity is a line, a setting is a line, and a change to one is a change of one line.

use crate::ir::VERSION;
use serde_json::{Map, Value};

/// Levels that are broken into lines.
const BROKEN: usize = 2;

/// The document of a scene's tree, with `irVersion` first and a line end at the end.
pub(super) fn document(tree: Map<String, Value>) -> String {
    let mut members = Map::new();
    members.insert("irVersion".to_owned(), VERSION.into());
    members.extend(tree);
    let mut out = String::new();
    value(&mut out, &Value::Object(members), 0);
    out.push('\n');
    out
}

fn value(out: &mut String, tree: &Value, level: usize) {
    match tree {
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => out.push_str(&tree.to_string()),
        Value::Array(items) => {
            list(out, ['[', ']'], level, items.iter(), |out, item| value(out, item, level + 1));
        }
        Value::Object(members) => list(out, ['{', '}'], level, members.iter(), |out, (key, member)| {
            out.push_str(&Value::from(key.as_str()).to_string());
            out.push_str(": ");
            value(out, member, level + 1);
        }),
    }
}

fn list<T>(
    out: &mut String,
    [open, close]: [char; 2],
    level: usize,
    items: impl ExactSizeIterator<Item = T>,
    mut write: impl FnMut(&mut String, T),
) {
    let broken = level < BROKEN && items.len() > 0;
    out.push(open);
    for (index, item) in items.enumerate() {
        match (broken, index) {
            (true, 0) => new_line(out, level + 1),
            (true, _) => {
                out.push(',');
                new_line(out, level + 1);
            }
            (false, 0) => {}
            (false, _) => out.push_str(", "),
        }
        write(out, item);
    }
    if broken {
        new_line(out, level);
    }
    out.push(close);
}

fn new_line(out: &mut String, level: usize) {
    out.push('\n');
    out.extend(std::iter::repeat_n("  ", level));
}
