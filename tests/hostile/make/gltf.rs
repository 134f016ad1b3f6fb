//! Assets that are small and ask for much.

mod geometry;
mod packed;
mod parts;

use super::Repro;

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    [geometry::all(), packed::all(), parts::all()]
        .into_iter()
        .flatten()
        .collect()
}

/// An asset of this JSON, without its braces, that is checked.
fn check(name: &'static str, expected: Option<&'static str>, json: &str, chunk: &[u8]) -> Repro {
    let file = "a.glb".to_owned();
    let arguments = ["check", &file].map(str::to_owned).to_vec();
    Repro {
        name,
        files: vec![(file, glb(json, chunk))],
        arguments,
        expected,
    }
}

/// A `.glb` of an asset of this JSON, without its braces and its version.
pub(super) fn glb(json: &str, chunk: &[u8]) -> Vec<u8> {
    let json = format!(r#"{{"asset":{{"version":"2.0"}},{json}}}"#).into_bytes();
    let mut bytes = [b"glTF".as_slice(), &2_u32.to_le_bytes(), &[0; 4]].concat();
    for (kind, own, filler) in [(b"JSON", json.as_slice(), b' '), (b"BIN\0", chunk, 0)] {
        let length = own.len().next_multiple_of(4);
        if own.is_empty() {
            continue;
        }
        bytes.extend(u32::try_from(length).unwrap().to_le_bytes());
        bytes.extend(kind);
        bytes.extend(own);
        bytes.resize(bytes.len() + length - own.len(), filler);
    }
    let length = u32::try_from(bytes.len()).unwrap();
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

/// So many of these, with commas between them.
fn list(count: usize, item: impl Fn(usize) -> String) -> String {
    (0..count).map(item).collect::<Vec<_>>().join(",")
}

/// A key with a list of so many of these.
fn many(key: &str, count: usize, item: impl Fn(usize) -> String) -> String {
    format!(r#""{key}":[{}]"#, list(count, item))
}

/// A scene of the first so many nodes.
fn scene(count: usize) -> String {
    format!(
        r#""scene":0,"scenes":[{{"nodes":[{}]}}]"#,
        list(count, |node| node.to_string())
    )
}

/// Vertices that are all zero, and have no data.
fn zeros(count: usize, kind: &str) -> String {
    let components = kind
        .strip_prefix("VEC")
        .map_or(1, |count| count.parse().unwrap());
    let bound = list(components, |_| "0".to_owned());
    format!(
        r#"{{"componentType":5126,"type":"{kind}","count":{count},"min":[{bound}],"max":[{bound}]}}"#
    )
}

/// A primitive with positions alone.
fn primitive(positions: usize) -> String {
    format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#)
}
