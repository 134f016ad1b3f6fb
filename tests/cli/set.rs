//! What stands on the stage: assets and scenes in a folder, and the pictures of them.

use super::{SCENE, code, command, stderr};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rtc::internals::image::{DecodeError, OpacityUse, PixelFile, Pixels};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// A white Lambert square of side 2 that faces +z, before a camera at (0, 0, 3).
fn square() -> Value {
    let corners: [[f32; 3]; 6] = [
        [-1., -1., 0.],
        [1., -1., 0.],
        [1., 1., 0.],
        [-1., -1., 0.],
        [1., 1., 0.],
        [-1., 1., 0.],
    ];
    let bytes: Vec<u8> = corners
        .as_flattened()
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    json!({
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_specular"],
        "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [
            {"mesh": 0},
            {"camera": 0, "name": "front", "translation": [0, 0, 3]},
            {"camera": 1, "translation": [1, 0, 3]}],
        "cameras": [
            {"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 1.0, "znear": 0.1}},
            {"name": "wide", "type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 1.0, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [{
            "pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": true,
            "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 6, "min": [-1, -1, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 72}],
        "buffers": [{
            "byteLength": 72, "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(bytes))}],
    })
}

/// The square under a directional light of its own that shines along −z.
fn sunny() -> Value {
    let mut asset = square();
    asset["extensionsUsed"] = json!(["KHR_materials_specular", "KHR_lights_punctual"]);
    asset["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 2}]}});
    asset["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    asset
}

/// A scene of the course, seen from `eye`.
pub(super) fn course(eye: &str) -> String {
    format!(
        "Camera: {{eye: {eye}, center: [1, 2, 0], up: [0, 0.5, 0], viewSize: [24, 16]}}\nShadows: true\n\
         Lights:\n- {{position: [30, 40, 60], color: [1, 1, 1]}}\nObjects:\n- type: sphere\n  position: [1, 2, 0]\n  \
         radius: 3\n  material: {{color: [1, 0.5, 0.2], ka: 0.2, kd: 0.7, ks: 0, n: 1}}\n- type: plane\n  position: \
         [0, -3, 0]\n  normal: [0, 1, 0]\n  material: {{color: [0.3, 0.5, 0.7], ka: 0.2, kd: 0.7, ks: 0, n: 1}}\n"
    )
}

/// Two by two pixels of 0.5.
const GREY_SKY: &[u8] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80";

/// A scene of the course that holds an asset, seen as the square is from `eye`, 16 pixels high.
pub(super) fn holding(eye: &str, center: &str, rest: &str) -> String {
    format!(
        "Camera: {{eye: {eye}, center: {center}, up: [0, 1, 0], viewSize: [24, 16], fov: 30}}\n{rest}"
    )
}

pub(super) fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("square.gltf", square().to_string().as_bytes());
    write("sunny.gltf", sunny().to_string().as_bytes());
    write("ball.json", SCENE.as_bytes());
    write("ball.yaml", course("[1, 2, 10]").as_bytes());
    write("beside.yaml", course("[7, 2, 8]").as_bytes());
    write("sky.hdr", GREY_SKY);
    write("broken.hdr", &GREY_SKY[..50]);
    folder
}

pub(super) fn rtc(folder: &Path, words: &str) -> Output {
    command(folder, &words.split_whitespace().collect::<Vec<_>>())
        .output()
        .unwrap()
}

/// The bytes of the picture that `rtc render` makes.
pub(super) fn picture(folder: &Path, words: &str) -> Vec<u8> {
    let output = rtc(folder, &format!("render --no-metadata {words} -q -o -"));
    assert_eq!(code(&output), 0, "{words}: {}", stderr(&output));
    output.stdout
}

pub(super) fn decode(bytes: &[u8]) -> Result<Pixels, DecodeError> {
    PixelFile::open(bytes, OpacityUse::Dropped, u64::MAX)?.decode()
}

/// The values of all channels of a picture.
pub(super) fn values(folder: &Path, words: &str) -> Vec<u8> {
    decode(&picture(folder, &format!("{words} --size 8x8")))
        .unwrap()
        .bytes
}
