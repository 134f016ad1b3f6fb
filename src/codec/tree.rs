//! Parts of a scene as JSON trees, whose numbers are finite.

use serde::Serialize;
use serde_json::Value;

/// A scene that can't be encoded because a number is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NonFiniteNumber;

/// A part of a scene as a JSON tree.
pub(super) fn tree(part: &impl Serialize) -> Result<Value, NonFiniteNumber> {
    let tree = serde_json::to_value(part)
        .expect("a scene is structs, lists and numbers, which JSON holds");
    if has_null(&tree) {
        Err(NonFiniteNumber)
    } else {
        Ok(tree)
    }
}

/// `serde_json` writes null for a number that is not finite, and the IR has no other nulls.
fn has_null(tree: &Value) -> bool {
    match tree {
        Value::Null => true,
        Value::Bool(_) | Value::Number(_) | Value::String(_) => false,
        Value::Array(items) => items.iter().any(has_null),
        Value::Object(members) => members.values().any(has_null),
    }
}
