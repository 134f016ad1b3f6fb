//! Writes `scenes/vase.glb`, the asset of `scenes/vases.yaml`: a vase turned on a wheel, of one
//! mesh and one material.
//!
//! `cargo run --example vase`

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a tool stops at the first surprise, and writes"
)]

use rtc::internals::math::{Vec3, cos, sin};
use serde_json::json;
use std::f64::consts::TAU;

/// The radius at heights of equal distance, and that distance.
const PROFILE: [f64; 13] = [
    0.30, 0.42, 0.53, 0.61, 0.65, 0.64, 0.57, 0.46, 0.34, 0.25, 0.22, 0.25, 0.34,
];
const STEP: f64 = 0.13;
/// Corners around the axis.
const AROUND: usize = 20;

/// Positions and outward normals, ring by ring.
fn corners() -> (Vec<Vec3>, Vec<Vec3>) {
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for (ring, radius) in PROFILE.iter().enumerate() {
        let (before, after) = (ring.saturating_sub(1), (ring + 1).min(PROFILE.len() - 1));
        let slope = (PROFILE[after] - PROFILE[before]) / ((after - before) as f64 * STEP);
        for corner in 0..AROUND {
            let angle = TAU * corner as f64 / AROUND as f64;
            positions.push(Vec3::new(
                radius * sin(angle),
                ring as f64 * STEP,
                radius * cos(angle),
            ));
            normals.push(Vec3::new(sin(angle), -slope, cos(angle)).normalize());
        }
    }
    (positions, normals)
}

/// Two triangles a square between one ring and the next.
fn triangles() -> Vec<u16> {
    let at = |ring: usize, corner: usize| u16::try_from(ring * AROUND + corner % AROUND).unwrap();
    let squares =
        (0..PROFILE.len() - 1).flat_map(|ring| (0..AROUND).map(move |corner| (ring, corner)));
    let square = |(r, c)| {
        [
            at(r, c),
            at(r, c + 1),
            at(r + 1, c + 1),
            at(r, c),
            at(r + 1, c + 1),
            at(r + 1, c),
        ]
    };
    squares.flat_map(square).collect()
}

#[expect(clippy::cast_possible_truncation, reason = "a file of floats")]
fn floats(vectors: &[Vec3]) -> Vec<f32> {
    vectors
        .iter()
        .flat_map(|vector| vector.to_array())
        .map(|component| component as f32)
        .collect()
}

/// A chunk of the container: its length, its kind, and its bytes, filled up to a multiple of four.
fn chunk(kind: &[u8; 4], mut bytes: Vec<u8>, fill: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), fill);
    [
        &u32::try_from(bytes.len()).unwrap().to_le_bytes(),
        kind.as_slice(),
        &bytes,
    ]
    .concat()
}

fn main() {
    let (positions, normals) = corners();
    let (positions, normals, indices) = (floats(&positions), floats(&normals), triangles());
    let bound = |pick: fn(f32, f32) -> f32| {
        let axis = |axis: usize| {
            positions
                .iter()
                .skip(axis)
                .step_by(3)
                .copied()
                .reduce(pick)
                .unwrap()
        };
        [axis(0), axis(1), axis(2)]
    };
    let (count, size) = (positions.len() / 3, positions.len() * 4);
    let bytes: Vec<u8> = positions
        .iter()
        .chain(&normals)
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let bytes: Vec<u8> = bytes
        .into_iter()
        .chain(indices.iter().flat_map(|index| index.to_le_bytes()))
        .collect();
    let asset = json!({
        "asset": {"version": "2.0"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "vase"}],
        "meshes": [{"name": "vase", "primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"name": "glaze", "doubleSided": true, "pbrMetallicRoughness":
            {"baseColorFactor": [0.05, 0.22, 0.42, 1], "metallicFactor": 0, "roughnessFactor": 0.25}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": count,
             "min": bound(f32::min), "max": bound(f32::max)},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": count},
            {"bufferView": 2, "componentType": 5123, "type": "SCALAR", "count": indices.len()}],
        "bufferViews": [
            {"buffer": 0, "byteLength": size, "target": 34962},
            {"buffer": 0, "byteOffset": size, "byteLength": size, "target": 34962},
            {"buffer": 0, "byteOffset": 2 * size, "byteLength": 2 * indices.len(), "target": 34963}],
        "buffers": [{"byteLength": bytes.len()}],
    });
    let chunks = [
        chunk(b"JSON", asset.to_string().into_bytes(), b' '),
        chunk(b"BIN\0", bytes, 0),
    ]
    .concat();
    let length = u32::try_from(chunks.len() + 12).unwrap().to_le_bytes();
    let glb = [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length, &chunks].concat();
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/vase.glb"), glb).unwrap();
}
