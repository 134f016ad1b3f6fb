//! The course's YAML there and back: what is written again lowers to the same scene, whoever reads it; spellings don't
//! change what a scene means.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use proptest::prelude::*;
use rtc::diag::Sink;
use rtc::front::{Options, course};
use rtc::ir::{self, Scene};
use rtc::math::{Vec3, camera_basis};
use rtc::source::SourceMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The scene of a text without errors.
fn scene(text: &str) -> Option<Scene> {
    let mut map = SourceMap::default();
    let file = map.add("text", text.as_bytes().to_vec());
    let mut sink = Sink::default();
    let lowered = course::lower(file, &map, &Options::default(), &mut sink);
    lowered.filter(|_| !sink.has_errors()).map(|lowered| lowered.scene)
}

fn texts() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut open = vec![root.join("scenes"), root.join("tests/diagnostics")];
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extension == "yaml") {
            found.extend(fs::read_to_string(&path).ok().map(|text| (path, text)));
        }
    }
    found
}

/// Writes the scene and reads it again, ourselves and by way of another YAML reader.
fn comes_back(scene_in: &Scene) {
    let text = course::emit(scene_in).unwrap();
    assert_eq!(scene(&text).as_ref(), Some(scene_in), "{text}");
    let other: serde_json::Value = serde_yaml::from_str(&text).unwrap();
    let unshared = scene(&other.to_string()).unwrap();
    let clothes = |scene: &Scene| {
        let clothed = scene.surfaces.iter().map(|s| (s.shape.clone(), scene.materials[s.material.0 as usize].clone()));
        clothed.collect::<Vec<_>>()
    };
    assert_eq!(clothes(&unshared), clothes(scene_in));
    assert_eq!((unshared.camera, unshared.settings), (scene_in.camera.clone(), scene_in.settings.clone()));
    assert_eq!(unshared.lights, scene_in.lights);
}

#[test]
fn every_scene_comes_back() {
    let mut count = 0;
    for (path, text) in texts() {
        let Some(scene) = scene(&text) else { continue };
        match course::emit(&scene) {
            Ok(_) => comes_back(&scene),
            Err(reason) => assert!(text.contains("Eye:"), "{}: {reason}", path.display()),
        }
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
    assert_eq!((old.materials.len(), old.surfaces.len()), (1, 2), "an alias shares the material");
    comes_back(&old);
}

#[test]
fn what_a_camera_cant_hold_is_said_in_words() {
    let mut seen = scene("Eye: [0, 200, 1000]\n").unwrap();
    assert!(course::emit(&seen).unwrap_err().contains("slant"));
    seen = scene("Eye: [200, 200, 1000]\n").unwrap();
    seen.camera.right = [2.0, 0.0, 0.0];
    assert!(course::emit(&seen).unwrap_err().contains("square"));
    seen.camera.right = [-1.0, 0.0, 0.0];
    assert!(course::emit(&seen).unwrap_err().contains("mirrored"));
    seen.camera.right = [1.0, 0.0, 0.0];
    seen.lights.push(ir::Light::Point(ir::PointLight { position: [f64::NAN, 0.0, 0.0], color: [1.0; 3], radius: 0.0 }));
    assert!(course::emit(&seen).unwrap_err().contains("finite"));
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
        "\u{feff}rendermode: 2\nshadow: TRUE\nMaxIterations: 0x2\nSuperSampling:\t3\nEye: [\n200, 2e2, 1000.\n]\n\
         Objects:\n- {type: plane, n: [0, 0, 2], d: -2, material: &m {color: [1, 1, 1], ka: 1, kd: 1, ks: 0, n: 1}}\n\
         - type: triangle\n  v1: [0, 0, 0]\n  v2: [1, 0, 0]\n  v3: [0, 1, 0]\n  material:\n    <<: *m\n    \
         color: [0, 0, 1]\n",
    );
    assert!(canonical.is_some());
    assert_eq!(canonical, wild);
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
    scene.camera = ir::Camera { eye, center, right, up, size: [640, 480], lens };
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
    fn any_square_camera_comes_back_up_to_rounding(eye in vector(), center in vector(), up in vector()) {
        let Some(mut seen) = seen_from(eye, center, up) else { return Ok(()) };
        let back = scene(&course::emit(&seen).unwrap()).unwrap();
        let far = |a: [f64; 3], b: [f64; 3]| Vec3::from_array(a).distance(Vec3::from_array(b)) / up.length();
        let angle = (center - eye).normalize().cross(up.normalize()).length();
        prop_assert!(far(back.camera.right, seen.camera.right) * angle < 1e-15 * 8.0);
        prop_assert!(far(back.camera.up, seen.camera.up) * angle < 1e-15 * 8.0);
        (seen.camera.right, seen.camera.up) = (back.camera.right, back.camera.up);
        prop_assert_eq!(back, seen);
    }
}
