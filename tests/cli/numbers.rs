//! Numbers from outside: what no file can hold, a tiny direction under `--verify-effects`, and text
//! that was written again.

use super::*;
use exr::prelude::{ReadChannels, ReadLayers};

const MATERIAL: &str = "material: {color: [0.8, 0.5, 0.3], ka: 0.2, kd: 0.6, ks: 0.3, n: 20}";

/// The values of all channels of an EXR, by name.
fn channels(file: &Path) -> Vec<(String, Vec<f32>)> {
    let reader = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer();
    let read = reader.all_attributes().from_file(file).unwrap();
    let list = &read.layer_data.channel_data.list;
    list.iter()
        .map(|channel| {
            (
                channel.name.to_string(),
                channel.sample_data.values_as_f32().collect(),
            )
        })
        .collect()
}

/// Writes a ball of such a radius, seen from six times as far.
fn ball(folder: &TempDir, radius: &str) {
    let text = format!(
        "Camera: {{eye: [0, 0, 6{radius}], center: [0, 0, 0], up: [0, 0.2{radius}, 0], viewSize: [16, 16]}}\n\
         Lights: [{{position: [5{radius}, 5{radius}, 9{radius}], color: [1, 1, 1]}}]\n\
         Objects: [{{type: sphere, position: [0, 0, 0], radius: 1{radius}, {MATERIAL}}}]\n"
    );
    fs::write(folder.path().join("ball.yaml"), text).unwrap();
}

#[test]
fn layers_beyond_a_float_are_told_and_finite() {
    let folder = folder();
    ball(&folder, "e+45");
    let output = rtc(
        &folder,
        &[
            "render",
            "ball.yaml",
            "-o",
            "ball.exr",
            "--aov",
            "depth,position",
        ],
    );
    let reported = stderr(&output);
    assert_eq!(code(&output), 0, "{reported}");
    let names = "in `depth.Z`, `position.X`, `position.Y`, `position.Z`";
    assert!(
        reported.contains(&format!(
            "warning[RD004]: values beyond the range of the file {names}"
        )),
        "{reported}"
    );
    let channels = channels(&folder.path().join("ball.exr"));
    assert!(
        channels
            .iter()
            .all(|(_, values)| values.iter().all(|value| value.is_finite()))
    );
    assert!(
        channels
            .iter()
            .any(|(name, values)| name == "depth.Z" && values.contains(&f32::MAX))
    );
    ball(&folder, "e+30");
    let output = rtc(
        &folder,
        &[
            "render",
            "ball.yaml",
            "-o",
            "ball.exr",
            "--aov",
            "depth,position",
        ],
    );
    assert!(!stderr(&output).contains("RD004"), "{}", stderr(&output));
    ball(&folder, "e+45");
    assert!(!stderr(&rtc(&folder, &["render", "ball.yaml", "-o", "ball.png"])).contains("RD004"));
}

/// The triangles of a mesh are met in its own space; their normals in the world are a square too
/// small for 32 bits.
#[test]
fn pixels_that_are_no_number_are_told_and_black() {
    let folder = folder();
    ball(&folder, "e+30");
    let text = fs::read_to_string(folder.path().join("ball.yaml")).unwrap();
    let text = text.replace(
        "type: sphere, position: [0, 0, 0], radius",
        "type: mesh, file: wall.obj, scale",
    );
    fs::write(folder.path().join("mesh.yaml"), text).unwrap();
    fs::write(
        folder.path().join("wall.obj"),
        "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    for file in ["mesh.exr", "mesh.png"] {
        let output = rtc(
            &folder,
            &["render", "mesh.yaml", "--arithmetic", "f32", "-o", file],
        );
        let reported = stderr(&output);
        assert_eq!(code(&output), 0, "{reported}");
        assert!(
            reported.contains("warning[RD005]")
                && reported.contains("leave out `--arithmetic f32`"),
            "{reported}"
        );
        let reported = stderr(&rtc(&folder, &["render", "mesh.yaml", "-o", file]));
        assert!(!reported.contains("RD00"), "{reported}");
    }
    let layers = "albedo,normal,depth,uv,instance,position";
    let args = [
        "render",
        "mesh.yaml",
        "--arithmetic",
        "f32",
        "-o",
        "mesh.exr",
        "--aov",
        layers,
    ];
    assert_eq!(code(&rtc(&folder, &args)), 0);
    let channels = channels(&folder.path().join("mesh.exr"));
    assert!(
        channels
            .iter()
            .all(|(_, values)| values.iter().all(|value| value.is_finite()))
    );
}

/// Colours whose products leave the range of f64.
#[test]
fn light_without_end_is_told_and_finite() {
    let folder = folder();
    let text = "Camera: {eye: [0, 0, 6], center: [0, 0, 0], up: [0, 0.2, 0], viewSize: [16, 16]}\nMaxRecursionDepth: 20\n\
        Lights: [{position: [5, 5, 9], color: [1e60, -0.0, 1e60]}]\nObjects:\n\
        - {type: sphere, position: [0, 0, 0], radius: 9, material: {color: [1e60, 0, 0], ka: 1, kd: 1e60, ks: 1e60, n: 1}}\n";
    fs::write(folder.path().join("bright.yaml"), text).unwrap();
    let output = rtc(&folder, &["render", "bright.yaml", "-o", "bright.exr"]);
    let reported = stderr(&output);
    assert_eq!(code(&output), 0, "{reported}");
    assert!(
        reported.contains("RD004") || reported.contains("RD005"),
        "{reported}"
    );
    let channels = channels(&folder.path().join("bright.exr"));
    assert!(
        channels
            .iter()
            .all(|(_, values)| values.iter().all(|value| value.is_finite()))
    );
}

#[test]
fn a_tiny_direction_is_verified() {
    let folder = folder();
    let text = format!(
        "Camera: {{eye: [0.5, 3, 7], center: [0, 1, 0], up: [0, 0.2, 0], viewSize: [32, 28]}}\nShadows: true\n\
         Lights: [{{position: [0.5, 3, 7], color: [1, 1, 1]}}]\nObjects:\n- {{type: cylinder, position: [0, 1, 0], \
         direction: [-8e-163, -1.7e-162, 1e-161], height: 2, radius: 1.5, {MATERIAL}}}\n"
    );
    fs::write(folder.path().join("tiny.yaml"), text).unwrap();
    let output = rtc(
        &folder,
        &[
            "render",
            "tiny.yaml",
            "--verify-effects",
            "-o",
            "verified.png",
        ],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(
        code(&rtc(
            &folder,
            &["render", "tiny.yaml", "--no-prune", "-o", "whole.png"]
        )),
        0
    );
    let bytes = |name| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("verified.png") == bytes("whole.png"));
}

/// What is written again renders to the same file, the hash of the scene included.
#[test]
fn the_canonical_text_makes_the_same_bytes() {
    let folder = folder();
    for camera in [
        "Camera: {eye: [3.7, 2.9, 7.1], center: [0.3, 0.1, -0.7], up: [0.13, 0.971, 0.31], viewSize: [24, 20]}",
        "Camera: {eye: [3.7, 2.9, 7.1], center: [0.3, 0.1, -0.7], up: [0.1, 1, 0.2], fov: 41.7, viewSize: [24, 20]}",
        "Eye: [13, 250, 970]",
    ] {
        let text = format!(
            "{camera}\nLights: [{{position: [5, 5, 9], color: [1, 1, 1]}}]\nObjects:\n- {{type: sphere, position: \
             [0, 0, 0], radius: 1.7, axis: [0.3, 1.1, -0.7], angle: 33.3, material: {{texture: uv, ka: 1, kd: 0, ks: 0, \
             n: 1}}}}\n- {{type: plane, position: [0, 0, -50], normal: [0.1, 0.2, 3], {MATERIAL}}}\n"
        );
        fs::write(folder.path().join("scene.yaml"), text).unwrap();
        for args in [
            ["render", "scene.yaml", "-o", "first.exr"],
            ["compile", "scene.yaml", "-o", "again.yaml"],
            ["render", "again.yaml", "-o", "second.exr"],
        ] {
            let output = rtc(&folder, &args);
            assert_eq!(code(&output), 0, "{}", stderr(&output));
        }
        let bytes = |name| fs::read(folder.path().join(name)).unwrap();
        let again = String::from_utf8(bytes("again.yaml")).unwrap();
        assert!(bytes("first.exr") == bytes("second.exr"), "{again}");
    }
}
