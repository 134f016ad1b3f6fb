//! The effective value in the IR, where it differs from the written one: with defaults, in the
//! units of the renderer.

use super::open_text::OpenText;
use rtc_ir::{EntityField, EntityKind, Scene, ValuePath};
use rtc_math::shortest;
use rtc_source::Span;
use rtc_source::tree::{NodeId, SyntaxTree};
use serde::Serialize;
use serde_json::Value;

/// The maximum length of the reported value, in bytes.
const MOST: usize = 1000;

/// The effective value of a key, in Markdown; `None` if the document has errors, or the effective
/// value is the written one.
pub(super) fn value(
    document: &OpenText,
    tree: &SyntaxTree<'_>,
    [key, value]: [NodeId; 2],
) -> Option<String> {
    let checked = document.scene()?;
    let lowered = checked.lowered.as_ref()?;
    let (target, file) = (tree.target(value), checked.file()?);
    // A map in a scene is known by its key.
    let key = tree.is_map(target).then_some(key);
    let spans = std::iter::once(target)
        .chain(key)
        .map(|node| tree.span(node));
    let spans = spans.map(|own| Span::new(file, own.start, own.end));
    let places = spans.flat_map(|span| lowered.source_spans.paths(span));
    // A map that is one of a list is also known by its index.
    let is_index = |found: &Value| tree.is_map(target) && found.is_number();
    let values = places.filter_map(|path| of(&lowered.scene, path));
    let mut values = values.filter(|found| !is_index(found));
    let found = plain(values.next()?);
    let written = tree.written(target);
    let is_same = match serde_json::from_str(written) {
        Ok(value) => plain(value) == found,
        Err(_) => found == *written,
    };
    let line = found.to_string();
    let is_shown = !is_same && line.len() <= MOST;
    is_shown.then(|| match found.is_object() {
        true => format!("in effect\n```json\n{found:#}\n```"),
        false => format!("in effect `{line}`"),
    })
}

/// The value at a path of the IR; `None` for values that may be large.
fn of(scene: &Scene, path: ValuePath) -> Option<Value> {
    let at = path.index as usize;
    let whole = match path.entity {
        EntityKind::Camera => json(&scene.camera),
        EntityKind::Settings => json(&scene.settings),
        EntityKind::Light => json(scene.lights.get(at)?),
        EntityKind::Texture => json(scene.textures.get(at)?),
        EntityKind::Material => json(scene.materials.get(at)?),
        EntityKind::Surface => json(scene.surfaces.get(at)?),
        EntityKind::Environment => json(scene.environment.as_ref()?),
        EntityKind::Medium => json(scene.medium.as_ref()?),
        EntityKind::Image | EntityKind::Mesh => None,
    }?;
    let entity = ValuePath {
        field: EntityField::Whole,
        ..path
    };
    let pointer = path.to_string();
    let pointer = pointer.strip_prefix(&entity.to_string())?;
    whole.pointer(pointer).cloned()
}

/// A JSON value whose whole numbers are written as integers, `1` and not `1.0`.
fn plain(value: Value) -> Value {
    let number = |value: f64| serde_json::from_str(&shortest(value)).ok();
    match value {
        Value::Number(own) => own.as_f64().and_then(number).unwrap_or_default(),
        Value::Array(items) => items.into_iter().map(plain).collect(),
        Value::Object(map) => {
            let pairs = map.into_iter().map(|(key, value)| (key, plain(value)));
            Value::Object(pairs.collect())
        }
        other @ (Value::Null | Value::Bool(_) | Value::String(_)) => other,
    }
}

fn json(value: &impl Serialize) -> Option<Value> {
    serde_json::to_value(value).ok()
}
