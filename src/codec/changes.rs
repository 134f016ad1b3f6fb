//! The differences between two scenes, value by value, each with its path in the IR as in `rtc
//! schema ir`. Vertices and pixels are compared by count and hash.

use super::tree::{NonFiniteNumber, tree};
use rtc_ir::{Image, Mesh, Scene, VertexColumn};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::{Xxh3Default, xxh3_64};

/// A value that differs.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ValueChange {
    /// The path, for example `materials[2].phong.kd`. Its index is that in the new scene, or in the
    /// old scene for a removed value.
    pub path: String,
    /// The value in the new scene; `None` if it was removed.
    pub new: Option<Value>,
    /// The value in the old scene; `None` if it was added.
    pub old: Option<Value>,
}

/// The differences of a new scene from an old one, in the order of the IR. Lists are aligned by a
/// longest common subsequence of equal items; the items between are paired in order.
///
/// # Errors
/// If a number is not finite.
pub fn changes(new: &Scene, old: &Scene) -> Result<Vec<ValueChange>, NonFiniteNumber> {
    let (new, mut old) = (document(new)?, document(old)?);
    rename_materials(&new, &mut old);
    let mut found = Vec::new();
    compare("", &new, &old, &mut found);
    Ok(found)
}

/// Renumbers the materials of the old scene as in the new one, so that an inserted material is one
/// difference.
fn rename_materials(new: &Value, old: &mut Value) {
    let [a, b] =
        [new, &*old].map(|scene| scene["materials"].as_array().map_or(&[][..], Vec::as_slice));
    let pairs = pairs(a, b).into_iter();
    let indices: BTreeMap<u64, usize> = pairs
        .filter_map(|(at, from)| Some((from? as u64, at?)))
        .collect();
    for surface in old["surfaces"].as_array_mut().into_iter().flatten() {
        let index = surface["material"]
            .as_u64()
            .and_then(|from| indices.get(&from));
        if let Some(index) = index {
            surface["material"] = (*index).into();
        }
    }
}

/// A scene as a JSON tree, with count and hash for vertices and pixels.
fn document(scene: &Scene) -> Result<Value, NonFiniteNumber> {
    let Scene {
        camera,
        settings,
        lights,
        images,
        textures,
        meshes,
        materials,
        surfaces,
        names,
        environment,
        medium,
        display,
        trees: _,
    } = scene;
    let mut document = Map::new();
    let mut put = |name: &str, part: Value| document.insert(name.to_owned(), part);
    put("camera", tree(camera)?);
    put("settings", tree(settings)?);
    put("lights", tree(lights)?);
    put("images", images.iter().map(image).collect());
    put("textures", tree(textures)?);
    put("meshes", meshes.iter().map(mesh).collect());
    put("materials", tree(materials)?);
    put("surfaces", tree(surfaces)?);
    put("names", tree(names)?);
    if let Some(environment) = environment {
        put("environment", tree(environment)?);
    }
    if let Some(medium) = medium {
        put("medium", tree(medium)?);
    }
    put("display", tree(display)?);
    Ok(Value::Object(document))
}

fn image(image: &Image) -> Value {
    let Image {
        name,
        width,
        height,
        kind,
        pixels,
    } = image;
    let pixels = summary(pixels.len(), xxh3_64(pixels));
    json!({ "name": name, "width": width, "height": height, "kind": kind, "pixels": pixels })
}

fn mesh(mesh: &Mesh) -> Value {
    let Mesh {
        name,
        part,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    } = mesh;
    let mut hash = Xxh3Default::default();
    triangles
        .iter()
        .flatten()
        .for_each(|index| hash.update(&index.to_le_bytes()));
    json!({
        "name": name,
        "part": part,
        "positions": column(positions),
        "normals": column(normals),
        "uvs": column(uvs),
        "secondUvs": column(second_uvs),
        "tangents": column(tangents),
        "colors": column(colors),
        "triangles": summary(triangles.len(), hash.digest()),
    })
}

fn column<const N: usize>(column: &VertexColumn<N>) -> String {
    let mut hash = Xxh3Default::default();
    let numbers = column.iter().flatten();
    numbers.for_each(|number| hash.update(&number.to_le_bytes()));
    summary(column.len(), hash.digest())
}

/// A count and a hash as a string.
fn summary(count: usize, hash: u64) -> String {
    match count {
        0 => "none".to_owned(),
        count => format!("{count}, xxh3:{hash:016x}"),
    }
}

fn compare(path: &str, new: &Value, old: &Value, found: &mut Vec<ValueChange>) {
    match (new, old) {
        _ if new == old => {}
        (Value::Object(a), Value::Object(b)) => maps(path, a, b, found),
        (Value::Array(a), Value::Array(b)) if !(is_vector(a) && is_vector(b)) => {
            lists(path, a, b, found);
        }
        _ => found.push(change(path, Some(new), Some(old))),
    }
}

fn change(path: &str, new: Option<&Value>, old: Option<&Value>) -> ValueChange {
    ValueChange {
        path: path.to_owned(),
        new: new.cloned(),
        old: old.cloned(),
    }
}

/// Whether the list holds numbers only, which are compared as one value.
fn is_vector(list: &[Value]) -> bool {
    list.iter().all(Value::is_number)
}

fn maps(
    path: &str,
    new: &Map<String, Value>,
    old: &Map<String, Value>,
    found: &mut Vec<ValueChange>,
) {
    let is_gone = |name: &&String| !new.contains_key(*name);
    for name in new.keys().chain(old.keys().filter(is_gone)) {
        let path = match path {
            "" => name.clone(),
            path => format!("{path}.{name}"),
        };
        match (new.get(name), old.get(name)) {
            (Some(a), Some(b)) => compare(&path, a, b, found),
            (a, b) => found.push(change(&path, a, b)),
        }
    }
}

fn lists(path: &str, new: &[Value], old: &[Value], found: &mut Vec<ValueChange>) {
    for pair in pairs(new, old) {
        match pair {
            (Some(at), Some(from)) => {
                compare(&format!("{path}[{at}]"), &new[at], &old[from], found);
            }
            (Some(at), None) => found.push(change(&format!("{path}[{at}]"), new.get(at), None)),
            (None, from) => {
                let from = from.unwrap_or_default();
                found.push(change(&format!("{path}[{from}]"), None, old.get(from)));
            }
        }
    }
}

/// Pairs the items of two lists: those of a longest common subsequence, and the items between in
/// order. An item without a partner was added or removed.
fn pairs(new: &[Value], old: &[Value]) -> Vec<(Option<usize>, Option<usize>)> {
    let same = |pair: &(&Value, &Value)| pair.0 == pair.1;
    let start = new.iter().zip(old).take_while(same).count();
    let (a, b) = (&new[start..], &old[start..]);
    let end = a.iter().rev().zip(b.iter().rev()).take_while(same).count();
    let (a, b) = (&a[..a.len() - end], &b[..b.len() - end]);
    let mut pairs: Vec<_> = (0..start).map(|at| (Some(at), Some(at))).collect();
    let (mut x, mut y) = (0, 0);
    let ends = [(a.len(), b.len())];
    for (i, j) in common(a, b).into_iter().chain(ends) {
        for at in 0..(i - x).max(j - y) {
            let of = |from: usize, to: usize| (from + at < to).then_some(start + from + at);
            pairs.push((of(x, i), of(y, j)));
        }
        if (i, j) != ends[0] {
            pairs.push((Some(start + i), Some(start + j)));
        }
        (x, y) = (i + 1, j + 1);
    }
    let (a, b) = (new.len() - end, old.len() - end);
    pairs.extend((0..end).map(|at| (Some(a + at), Some(b + at))));
    pairs
}

/// The index pairs of a longest common subsequence, in order; empty if the lists are too long.
fn common(a: &[Value], b: &[Value]) -> Vec<(usize, usize)> {
    /// The maximum number of item comparisons.
    const MOST: usize = 1 << 22;
    if a.len().saturating_mul(b.len()) > MOST {
        return Vec::new();
    }
    let width = b.len() + 1;
    // The length of a longest common subsequence of each pair of suffixes.
    let mut longest = vec![0_u32; (a.len() + 1) * width];
    for i in (0..a.len()).rev() {
        for j in (0..b.len()).rev() {
            let at = i * width + j;
            longest[at] = if a[i] == b[j] {
                longest[at + width + 1] + 1
            } else {
                longest[at + width].max(longest[at + 1])
            };
        }
    }
    let (mut i, mut j, mut indices) = (0, 0, Vec::new());
    while i < a.len() && j < b.len() {
        if a[i] == b[j] {
            indices.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if longest[(i + 1) * width + j] >= longest[i * width + j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(new: &Value, old: &Value) -> Vec<String> {
        let mut found = Vec::new();
        compare("", new, old, &mut found);
        let summary = |value: &Option<Value>| value.as_ref().map_or("-".into(), Value::to_string);
        let line = |c: &ValueChange| format!("{} {} {}", c.path, summary(&c.new), summary(&c.old));
        found.iter().map(line).collect()
    }

    #[test]
    fn values_are_named_by_their_paths_and_vectors_are_one() {
        let new = json!({ "a": [1.0, 2.0], "b": [{ "c": 1 }], "e": 5 });
        let old = json!({ "a": [1.0, 3.0], "b": [{ "c": 2, "d": "x" }] });
        assert_eq!(
            paths(&new, &old),
            [
                "a [1.0,2.0] [1.0,3.0]",
                "b[0].c 1 2",
                "b[0].d - \"x\"",
                "e 5 -"
            ]
        );
        assert!(paths(&new, &new).is_empty());
    }

    #[test]
    fn one_more_in_a_list_is_one_difference() {
        let list = |names: &[&str]| json!({ "list": names });
        let (three, four) = (list(&["a", "b", "c"]), list(&["a", "x", "b", "c"]));
        assert_eq!(paths(&four, &three), ["list[1] \"x\" -"]);
        assert_eq!(paths(&three, &four), ["list[1] - \"x\""]);
        let twice = list(&["a", "a"]);
        assert_eq!(paths(&twice, &list(&["a"])), ["list[1] \"a\" -"]);
        let (new, old) = (
            list(&["x", "b", "C", "d"]),
            list(&["a", "y", "b", "c", "z"]),
        );
        let expected = [
            "list[0] \"x\" \"a\"",
            "list[1] - \"y\"",
            "list[2] \"C\" \"c\"",
            "list[3] \"d\" \"z\"",
        ];
        assert_eq!(paths(&new, &old), expected);
    }

    #[test]
    fn surfaces_keep_their_materials_where_one_is_put_before() {
        let scene = |materials: &[&str], numbers: &[u32]| {
            let surfaces: Value = numbers.iter().map(|n| json!({ "material": n })).collect();
            json!({ "materials": materials, "surfaces": surfaces })
        };
        let (new, mut old) = (
            scene(&["x", "a", "b"], &[1, 2, 0]),
            scene(&["a", "b"], &[0, 1]),
        );
        rename_materials(&new, &mut old);
        let added = ["materials[0] \"x\" -", "surfaces[2] {\"material\":0} -"];
        assert_eq!(paths(&new, &old), added);
    }
}
