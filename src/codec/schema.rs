//! The JSON Schema of the JSON encoding, generated from the types that the decoder fills.

use rtc_ir::{Scene, VERSION};
use serde_json::{Map, Value, json};

/// The JSON Schema (2020-12) of the JSON encoding.
#[must_use]
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Scene).to_value();
    tidy(&mut schema);
    if let Some(root) = schema.as_object_mut() {
        root.insert(
            "title".to_owned(),
            format!("rtc scene IR, version {VERSION}").into(),
        );
        put_first(root, "properties", version_property());
        if let Some(required) = root.get_mut("required").and_then(Value::as_array_mut) {
            required.insert(0, "irVersion".into());
        }
    }
    schema
}

fn version_property() -> (String, Value) {
    let description = "The version of the representation; the first key of the document.";
    (
        "irVersion".to_owned(),
        json!({ "description": description, "const": VERSION }),
    )
}

fn put_first(root: &mut Map<String, Value>, key: &str, (name, value): (String, Value)) {
    if let Some(members) = root.get_mut(key).and_then(Value::as_object_mut) {
        let rest = std::mem::take(members);
        members.insert(name, value);
        members.extend(rest);
    }
}

/// Replaces Rust integer formats by ranges, and drops formats that editors don't know.
fn tidy(schema: &mut Value) {
    match schema {
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
        Value::Array(items) => items.iter_mut().for_each(tidy),
        Value::Object(members) => {
            let format = members
                .get("format")
                .and_then(Value::as_str)
                .map(str::to_owned);
            match format.as_deref() {
                Some("uint32") => drop(members.insert("maximum".to_owned(), u32::MAX.into())),
                Some("double") => {}
                _ => return members.values_mut().for_each(tidy),
            }
            members.shift_remove("format");
            whole_number(members);
            members.values_mut().for_each(tidy);
        }
    }
}

/// Writes a minimum of 0.0 as 0.
fn whole_number(members: &mut Map<String, Value>) {
    if let Some(minimum) = members.get_mut("minimum")
        && minimum.as_f64() == Some(0.0)
    {
        *minimum = 0.into();
    }
}
