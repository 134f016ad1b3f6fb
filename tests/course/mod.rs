//! The course's YAML there and back: what is written again lowers to the same scene, whoever reads
//! it; spellings don't change what a scene means.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod meaning;
mod solid;
mod synonym;
mod years;

use crate::repo::{files, root};
use proptest::prelude::*;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::emit;
use rtc::internals::front::course::assets::AssetTarget;
use rtc::internals::front::{FrontOptions, course};
use rtc::internals::ir::{self, Scene};
use rtc::internals::math::{Vec3, camera_basis};
use rtc::internals::source::SourceMap;
use std::fs;
use std::path::PathBuf;

/// The scene of a text without errors.
fn scene(text: &str) -> Option<Scene> {
    let mut map = SourceMap::default();
    let file = map.add("text", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let lowered = course::lower(file, &map, &FrontOptions::default(), &mut sink);
    lowered
        .filter(|_| !sink.has_errors())
        .map(|draft| draft.lowered.scene)
}

fn texts() -> Vec<(PathBuf, String)> {
    let folders = ["scenes", "tests/diagnostics", "tests/render/record"].into_iter();
    let paths = folders.flat_map(|folder| files(&root(folder), &["yaml"]));
    paths
        .filter_map(|path| fs::read_to_string(&path).ok().map(|text| (path, text)))
        .collect()
}

/// Writes the scene and reads it again, ourselves and by way of another YAML reader.
fn comes_back(scene_in: &Scene) {
    let text = emit::course::emit(scene_in).unwrap();
    assert_eq!(scene(&text).as_ref(), Some(scene_in), "{text}");
    let other: serde_json::Value = serde_yaml::from_str(&text).unwrap();
    let unshared = scene(&other.to_string()).unwrap();
    let clothes = |scene: &Scene| {
        let clothed = scene.surfaces.iter().map(|s| {
            (
                s.shape.clone(),
                scene.materials[s.material.0 as usize].clone(),
            )
        });
        clothed.collect::<Vec<_>>()
    };
    assert_eq!(clothes(&unshared), clothes(scene_in));
    assert_eq!(
        (unshared.camera, unshared.settings),
        (scene_in.camera.clone(), scene_in.settings.clone())
    );
    assert_eq!(unshared.lights, scene_in.lights);
}

#[test]
fn every_scene_comes_back() {
    let mut count = 0;
    for (_, text) in texts() {
        let Some(mut seen) = scene(&text) else {
            continue;
        };
        let is_used = |id: usize| seen.surfaces.iter().any(|s| s.material.0 as usize == id);
        if !(0..seen.materials.len()).all(is_used) {
            // What is left out leaves its material behind, which is not written.
            seen = scene(&emit::course::emit(&seen).unwrap()).unwrap();
        }
        comes_back(&seen);
        count += 1;
    }
    assert!(count > 20, "{count}");
}

const OBJECTS: &str = "\
Objects:
- type: sphere
  position: [1, 2, 3]
  radius: 4
  material: &m {color: [1, 0.5, 0], ka: 0.2, kd: 0.7, ks: 0.5, n: 64, kt: 0.5, eta: 1.5, glossySamples: 9}
- type: triangle
  v0: [0, 0, 0]
  v1: [1.5, 0, 1e-7]
  v2: [0, 1e40, -0.0]
  material: *m
";

#[test]
fn both_cameras_of_one_view_are_one() {
    let old = scene(&format!("Eye: [200, 200, 1000]\n{OBJECTS}")).unwrap();
    let new = "Camera: {eye: [200, 200, 1000], center: [200, 200, 0], up: [0, 1, 0], viewSize: [400, 400]}\n";
    assert_eq!(scene(&format!("{new}{OBJECTS}")).unwrap(), old);
    assert_eq!(
        (old.materials.len(), old.surfaces.len()),
        (1, 2),
        "an alias shares the material"
    );
    comes_back(&old);
}

#[test]
fn a_camera_of_any_frame_comes_back() {
    let mut seen = scene("Eye: [0, 200, 1000]\n").unwrap();
    comes_back(&seen);
    assert!(
        emit::course::emit(&seen)
            .unwrap()
            .contains("right: [1, 0, 0]"),
        "it looks at a slant"
    );
    seen = scene("Eye: [200, 200, 1000]\n").unwrap();
    comes_back(&seen);
    assert!(
        !emit::course::emit(&seen).unwrap().contains("right:"),
        "an `up` says it all"
    );
    for right in [[2.0, 0.0, 0.0], [-1.0, 0.0, 0.0]] {
        seen.camera.right = right;
        comes_back(&seen);
    }
}

#[test]
fn what_the_format_cant_hold_is_said_in_words() {
    let mut seen = scene("Eye: [200, 200, 1000]\n").unwrap();
    seen.lights.push(ir::Light::Point(ir::PointLight {
        position: [f64::NAN, 0.0, 0.0],
        color: [1.0; 3],
        radius: 0.0,
    }));
    assert!(emit::course::emit(&seen).unwrap_err().contains("finite"));
}

#[test]
fn spellings_and_merge_keys_mean_the_same() {
    let canonical = scene(
        "Eye: [200, 200, 1000]\nRenderMode: zbuffer\nShadows: true\nMaxRecursionDepth: 2\nSuperSampling: {factor: 3}\n\
         Objects:\n- {type: plane, position: [0, 0, -2], normal: [0, 0, 2], material: {color: [1, 1, 1], ka: 1, kd: 1, \
         ks: 0, n: 1}}\n- {type: triangle, v0: [0, 0, 0], v1: [1, 0, 0], v2: [0, 1, 0], material: {color: [0, 0, 1], \
         ka: 1, kd: 1, ks: 0, n: 1}}\n",
    );
    let wild = scene(
        "\u{feff}rendermode: 1\nshadow: TRUE\nMaxIterations: 0x2\nSuperSampling:\t3\nEye: [\n200, 2e2, 1000.\n]\n\
         Objects:\n- {type: plane, n: [0, 0, 2], d: -2, material: &m {color: [1, 1, 1], ka: 1, kd: 1, ks: 0, n: 1}}\n\
         - type: triangle\n  v1: [0, 0, 0]\n  v2: [1, 0, 0]\n  v3: [0, 1, 0]\n  material:\n    <<: *m\n    \
         color: [0, 0, 1]\n",
    );
    assert!(canonical.is_some());
    assert_eq!(canonical, wild);
}

const CLAY: &str = "material: {color: [1, 1, 1], ka: 1, kd: 1, ks: 0, n: 1}";

/// The lowered scene of one object; its keys stand in braces.
fn object(keys: &str) -> Scene {
    scene(&format!(
        "Eye: [200, 200, 1000]\nObjects:\n- {{{keys}, {CLAY}}}\n"
    ))
    .unwrap()
}

#[test]
fn other_ways_to_say_the_same() {
    for (wild, canonical) in [
        (
            "type: quadrilateral, a: [0, 0, 0], b: [2, 0, 0], c: [2, 1, 0], d: [0, 1, 0]",
            "type: quad, position: [0, 0, 0], up: [0, 1, 0], side: [2, 0, 0]",
        ),
        (
            "type: cylinder, center1: [0, 0, 1], center2: [0, 0, 4], r: 2",
            "type: cylinder, position: [0, 0, 1], direction: [0, 0, 3], height: 3, radius: 2",
        ),
        (
            "type: disk, position: [0, 0, 1], N: [0, 0, 4], r: 2",
            "type: circle, center: [0, 0, 1], normal: [0, 0, 4], radius: 2",
        ),
        (
            "type: bplane, typ: QUAD, center: [0, 0, 5], normal: [0, 0, 9], radius: 1",
            "type: quad, v0: [-1, -1, 5], v1: [1, -1, 5], v2: [1, 1, 5], v3: [-1, 1, 5]",
        ),
        (
            "type: sphere, position: [0, 0, 0], radius: 3, rotation: [0, 2, 0], angle: 5",
            "type: sphere, position: [0, 0, 0], radius: [3, [0, 1, 0]], angle: 5",
        ),
        (
            "type: torus, position: [0, 0, 0], radius: 3, alpha: 1",
            "type: torus, position: [0, 0, 0], radius: 3, alpha: 1, direction: [0, 0, 1]",
        ),
        (
            "type: OBJModel, path: 'a\\b.obj', size: 2",
            "type: mesh, file: a/b.obj, position: [0, 0, 0], scale: 2",
        ),
    ] {
        assert_eq!(object(wild), object(canonical), "{wild}");
    }
}

#[test]
fn other_ways_to_set_the_same() {
    let settings = |text: &str| {
        scene(&format!("Eye: [200, 200, 1000]\n{text}"))
            .unwrap()
            .settings
    };
    assert_eq!(settings("renderMode: 1"), settings("RenderMode: zbuffer"));
    assert_eq!(settings("renderMode: 2"), settings("RenderMode: normal"));
    assert_eq!(
        settings("Reflections: true\nAA: 3\nShadows: 1"),
        settings("MaxRecursionDepth: 2\nSuperSampling: 3\nShadows: true")
    );
    assert_eq!(
        settings("Reflections: true\nMaxRecursionDepth: 5").max_depth,
        5
    );
    assert_eq!(
        settings("Reflections: false\nMaxRecursionDepth: 5").max_depth,
        0
    );
    assert_eq!(
        settings("Lights: [{position: [0, 0, 0], color: [1, 1, 1]}]").light_samples,
        1
    );
    assert_eq!(
        settings("Lights: [{position: [0, 0, 0], color: [1, 1, 1], size: 2}]").light_samples,
        16
    );
    let look =
        scene("CameraEye: [1, 2, 30]\nCameraLookPoint: [1, 2, 3]\nCameraUpVector: [0, 0.5, 0]\n")
            .unwrap();
    let camera =
        "Camera: {eye: [1, 2, 30], center: [1, 2, 3], up: [0, 0.5, 0], viewSize: [400, 400]}\n";
    assert_eq!(Some(look), scene(camera));
}

#[test]
fn files_are_wanted_once_and_their_places_wait() {
    let text = "Eye: [200, 200, 1000]\nObjects:\n\
        - {type: sphere, position: [0, 0, 0], radius: 1, material: {texture: a.png, bump: 'b\\b.png', ka: 1, kd: 1, ks: 0, n: 1}}\n\
        - {type: sphere, position: [0, 0, 0], radius: 1, material: {texture: uv, specularMap: b/b.png, ka: 1, kd: 1, ks: 0, n: 1}}\n\
        - {type: mesh, file: a.png}\n- {type: mesh, file: a.png, scale: 2}\n";
    let mut map = SourceMap::default();
    let file = map.add("text", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let draft = course::lower(file, &map, &FrontOptions::default(), &mut sink).unwrap();
    let pending: Vec<_> = draft
        .pending_assets
        .iter()
        .map(|pending| (pending.target, pending.path.as_str()))
        .collect();
    let (image, mesh) = (
        |id| AssetTarget::Image(ir::ImageId(id)),
        |id| AssetTarget::Mesh(ir::MeshId(id)),
    );
    assert_eq!(
        pending,
        [
            (image(0), "a.png"),
            (image(1), "b\\b.png"),
            (mesh(0), "a.png")
        ]
    );
    let scene = draft.lowered.scene;
    assert_eq!(scene.images[1].name, "b/b.png");
    assert_eq!(
        scene.textures,
        [
            ir::Texture::Image(ir::ImageId(0)),
            ir::Texture::Image(ir::ImageId(1)),
            ir::Texture::Uv
        ]
    );
    assert_eq!(
        scene.materials.len(),
        3,
        "both meshes have the one grey material"
    );
    comes_back(&scene);
}

fn vector() -> impl Strategy<Value = Vec3> {
    let number = || prop_oneof![-10.0..10.0, -1e4..1e4, (-20..20_i32).prop_map(f64::from)];
    (number(), number(), number()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// A scene with a square camera.
fn seen_from(eye: Vec3, center: Vec3, up: Vec3) -> Option<Scene> {
    let (right, above) = camera_basis(eye, center, up).ok()?;
    let mut scene = scene(&format!("Eye: [200, 200, 1000]\n{OBJECTS}")).unwrap();
    let lens = scene.camera.lens;
    let [eye, center, right, up] = [eye, center, right, above].map(|vector| vector.to_array());
    scene.camera = ir::Camera {
        eye,
        center,
        right,
        up,
        size: [640, 480],
        lens,
        projection: ir::Projection::Perspective,
    };
    Some(scene)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_camera_with_an_axis_up_comes_back_to_the_last_bit(
        eye in vector(), center in vector(), axis in 0..3_usize, pixel in 1..100_000_u32,
    ) {
        let up = Vec3::AXES[axis] * (f64::from(pixel) / 1000.0);
        let Some(scene) = seen_from(eye, center, up) else { return Ok(()) };
        comes_back(&scene);
    }

    #[test]
    fn any_camera_comes_back_to_the_last_bit(eye in vector(), center in vector(), up in vector(), fov in 1.0..170.0) {
        let Some(mut seen) = seen_from(eye, center, up) else { return Ok(()) };
        comes_back(&seen);
        seen.camera.open(f64::to_radians(fov));
        comes_back(&seen);
    }

    #[test]
    fn any_turn_of_a_texture_comes_back_to_the_last_bit(
        axis in vector(), angle in prop_oneof![-4000.0..4000.0, -1.0..1.0, (-360..360_i32).prop_map(f64::from)],
    ) {
        let axis = axis.to_array();
        comes_back(&object(&format!("type: sphere, position: [1, 2, 3], radius: 2, axis: {axis:?}, angle: {angle}")));
    }
}

/// Small angles about axes near −z, where rounding leaves the least of them, and an axis that few
/// lengths round to.
#[test]
fn turns_of_textures_that_are_hard_to_find_come_back() {
    for (axis, angle) in [
        ([4.0, -4.0, -8144.089005854859], -0.010117111603251017),
        (
            [-14.0, -7.213325731176495, 7.926324409095862],
            0.00966620092535786,
        ),
        (
            [-373.29104008507056, 1315.6246339647205, 1562.2975077373358],
            -221.0,
        ),
    ] {
        comes_back(&object(&format!(
            "type: sphere, position: [1, 2, 3], radius: 2, axis: {axis:?}, angle: {angle}"
        )));
    }
}

#[test]
fn words_proposed_in_json_keep_their_quotes() {
    let text = r#"{"Eye": [200, 200, 1000], "RenderMode": "phnog", "Lights": [],
        "Objects": [{"type": "spere"}, {"type": "sphere", "postion": [0, 0, 0], "radius": 1}]}"#;
    let mut map = SourceMap::default();
    let file = map.add("scene.json", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let _ = course::lower(file, &map, &FrontOptions::default(), &mut sink);
    let hints = sink.kept().iter().flat_map(|finding| &finding.hints);
    let proposed: Vec<_> = hints
        .filter_map(|hint| Some(hint.replacement.as_ref()?.text.clone()))
        .collect();
    assert_eq!(proposed, [r#""phong""#, r#""sphere""#, r#""position""#]);
}
