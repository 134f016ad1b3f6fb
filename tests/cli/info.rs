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

#[test]
fn an_asset_has_a_row_for_each_mesh_material_and_texture() {
    use base64::Engine as _;
    let folder = tempfile::tempdir().unwrap();
    // Two pictures: a file of 1 × 1, and data of 5 × 3.
    let picture = |width, height| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        let pixels = vec![9; (3 * width * height) as usize];
        writer.write_image_data(&pixels).unwrap();
        writer.finish().unwrap();
        bytes
    };
    let (small, wide) = (picture(1, 1), picture(5, 3));
    fs::write(folder.path().join("a b.png"), &small).unwrap();
    let data = base64::engine::general_purpose::STANDARD.encode(&wide);
    let zeros = base64::engine::general_purpose::STANDARD.encode([0; 72]);
    let asset = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"name": "set", "nodes": [0, 1]}],
        "nodes": [{"name": "left", "mesh": 0}, {"name": "right", "mesh": 0, "translation": [1, 0, 0]}],
        "buffers": [{"byteLength": 72, "uri": format!("data:application/octet-stream;base64,{zeros}")}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [0, 0, 0]},
            {"bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 3}],
        "meshes": [{"name": "sail", "primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "images": [{"uri": "a%20b.png"}, {"name": "wide", "uri": format!("data:image/png;base64,{data}")}],
        "textures": [{"name": "dot", "source": 0}, {"source": 1}],
        "extensionsUsed": ["KHR_materials_clearcoat"],
        "materials": [{"name": "cloth", "alphaMode": "MASK", "doubleSided": true,
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
            "emissiveTexture": {"index": 1},
            "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 1}}}}],
    });
    fs::write(folder.path().join("a.gltf"), asset.to_string()).unwrap();
    let reported = rtc(&folder, &["info", "a.gltf", "--format", "json"]);
    let facts: Value = serde_json::from_slice(&reported.stdout).unwrap();
    let facts = &facts["asset"];
    let scene = json!({"name": "set", "roots": ["left", "right"], "nodes": 2, "vertices": 6});
    assert_eq!(facts["scenes"], json!([scene]));
    let mesh = json!({"name": "sail", "modes": [4], "primitives": 1, "elements": 1, "vertices": 3,
        "attributes": ["POSITION", "TEXCOORD_0"], "instances": 2, "bytes": 60});
    assert_eq!(facts["meshes"], json!([mesh]));
    let material = json!({"name": "cloth", "instances": 1, "alphaMode": "MASK", "doubleSided": true,
        "slots": ["baseColorTexture", "clearcoatTexture", "emissiveTexture"]});
    assert_eq!(facts["materials"], json!([material]));
    let dot = json!({"name": "dot", "uri": "a%20b.png", "slots": ["baseColorTexture"], "instances": 1,
        "mimeType": "image/png", "resolution": [1, 1], "bytes": small.len(), "gpuBytes": 4});
    // Levels of 5 × 3, 2 × 1 and 1 × 1 pixels of four bytes.
    let wide = json!({"name": "wide", "uri": "", "slots": ["clearcoatTexture", "emissiveTexture"],
        "instances": 2, "mimeType": "image/png", "resolution": [5, 3], "bytes": wide.len(),
        "gpuBytes": 4 * (15 + 2 + 1)});
    assert_eq!(facts["textures"], json!([dot, wide]));
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
