//! Describes how two shards belong to different pictures.

use super::super::ShardBy;
use super::ShardHeader;
use serde_json::Value;
use std::fmt;

impl ShardHeader {
    /// The first difference between the pictures of two shards, as a message.
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        let of = |name: &str, here: &dyn fmt::Display, there: &dyn fmt::Display| {
            Some(format!("{name}: {here} here, {there} there"))
        };
        if self.software != other.software {
            return of("program", &other.software, &self.software);
        }
        if let Some((name, here, there)) = differing(&other.settings, &self.settings) {
            return of(&name, &here, &there);
        }
        if self.scene != other.scene {
            return of("scene", &other.scene, &self.scene);
        }
        if (self.by, self.count) != (other.by, other.count) {
            let shares = |head: &Self| match head.by {
                ShardBy::Tiles => format!("{} by tiles", head.count),
                ShardBy::Samples => format!("{} by samples", head.count),
            };
            return of("shares", &shares(other), &shares(self));
        }
        let other_settings = |head: &Self| {
            (
                head.look.clone(),
                head.arithmetic,
                head.window,
                head.layers.clone(),
            )
        };
        let differ = other_settings(self) != other_settings(other);
        differ.then(|| "its look, its arithmetic or its layers".to_owned())
    }
}

/// The first member in which two JSON objects differ, with both values.
fn differing(here: &Value, there: &Value) -> Option<(String, String, String)> {
    if here == there {
        return None;
    }
    let (Value::Object(a), Value::Object(b)) = (here, there) else {
        return Some((String::new(), here.to_string(), there.to_string()));
    };
    let names = a.keys().chain(b.keys());
    let value = |map: &serde_json::Map<String, Value>, name: &String| {
        map.get(name).cloned().unwrap_or(Value::Null)
    };
    let mut differences = names.filter_map(|name| {
        let (inner, here, there) = differing(&value(a, name), &value(b, name))?;
        let dot = if inner.is_empty() { "" } else { "." };
        Some((format!("{name}{dot}{inner}"), here, there))
    });
    differences.next()
}
