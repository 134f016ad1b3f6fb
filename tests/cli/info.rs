//! `rtc info`.

use super::*;
use serde_json::{Value, json};

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn facts(name: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let reported = rtc(&folder, &["info", &scene(name), "--json"]);
    assert!(reported.status.success(), "{}", stderr(&reported));
    serde_json::from_slice(&reported.stdout).unwrap()
}

#[test]
fn a_scene_of_the_course_is_counted() {
    let facts = facts("five-spheres.yaml");
    assert_eq!(facts["schema"], "rtc-info/1");
    let expected = json!({"surfaces": 5, "triangles": 0, "meshes": 0, "materials": 5, "textures": 0, "images": 0,
        "lights": 1});
    assert_eq!(facts["counts"], expected);
    assert_eq!(facts["shapes"], json!({"sphere": 5}));
    let bounds = json!({"low": [40.0, 80.0, 50.0], "high": [340.0, 370.0, 450.0]});
    assert_eq!(facts["bounds"], bounds);
    assert_eq!(facts["asset"], Value::Null);
    assert_eq!(facts["picture"]["mode"], "phong");
    let effects = facts["effects"].as_array().unwrap();
    let of = |name: &str| effects.iter().find(|row| row["effect"] == name).unwrap();
    assert_eq!(of("highlight")["verdict"], "needed");
    assert_eq!(of("refraction")["verdict"], "absent");
}

#[test]
fn an_asset_is_counted_without_what_is_put_around_it() {
    let facts = facts("vase.glb");
    assert_eq!(facts["counts"]["surfaces"], 1);
    assert_eq!(facts["counts"]["triangles"], 480);
    assert_eq!(facts["counts"]["lights"], 0);
    // 260 positions and normals of three 32-bit numbers, 480 triangles of three indices.
    assert_eq!(facts["meshBytes"], 260 * 2 * 12 + 480 * 12);
    assert_eq!(facts["asset"]["counts"]["accessors"], 3);
    assert_eq!(facts["asset"]["animations"], json!([]));
    // An asset that stands twice in a scene is one mesh.
    let twice = self::facts("vases.yaml");
    assert_eq!(twice["counts"]["triangles"], 960);
    assert_eq!(twice["meshBytes"], facts["meshBytes"]);
}

#[test]
fn animations_last_as_long_as_their_keyframes() {
    let folder = tempfile::tempdir().unwrap();
    let asset = json!({
        "asset": {"version": "2.0", "generator": "a hand"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "turning"}],
        "buffers": [{"byteLength": 40, "uri": format!("data:application/octet-stream;base64,{}", moves())}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [2.5]},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 2}],
        "animations": [{"name": "lift", "samplers": [{"input": 0, "output": 1}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
    });
    fs::write(folder.path().join("a.gltf"), asset.to_string()).unwrap();
    let reported = rtc(&folder, &["info", "a.gltf"]);
    let text = String::from_utf8(reported.stdout).unwrap();
    assert!(
        reported.status.success(),
        "{}",
        String::from_utf8_lossy(&reported.stderr)
    );
    assert!(
        text.contains("animation   lift, 2.5 s, channels: 1\n"),
        "{text}"
    );
    assert!(text.contains("glTF        2.0 a hand\n"), "{text}");
}

/// Two moments, 0 and 2.5 s, and two places, both 0.
fn moves() -> String {
    // 0.0f32, then 2.5f32 = 0x40200000 in little-endian order.
    format!("AAAAAAAAIEA{}==", "A".repeat(43))
}

#[test]
fn what_has_errors_has_no_facts() {
    let folder = folder();
    let reported = rtc(&folder, &["info", "bad.json"]);
    assert_eq!(code(&reported), 1);
    assert!(reported.stdout.is_empty() && stderr(&reported).contains("error["));
}
