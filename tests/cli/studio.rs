//! The studio: when it fills in beside the light of an asset, and the ground it stands on.

use super::*;

pub(super) const LEAF: &str = include_str!("../render/light/leaf.gltf");
const SUNNY: &str = include_str!("../render/light/directional.gltf");

fn holding(asset: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("asset.gltf"), asset).unwrap();
    folder
}

/// What is said of a picture, and the part of its pixels that are nearly black.
fn shown(folder: &TempDir, args: &[&str]) -> (String, f64) {
    let few = ["render", "asset.gltf", "-o", "x.png", "--spp", "16"];
    let output = rtc(folder, &[&few, args].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    let is_dark = |pixel: &&image::Rgb<u8>| pixel.0.iter().all(|value| *value <= 8);
    let dark = picture.pixels().filter(is_dark).count();
    (stderr(&output), dark as f64 / picture.pixels().len() as f64)
}

const SMALL: [&str; 2] = ["--size", "48x48"];

#[test]
fn the_studio_fills_in_where_the_own_light_of_an_asset_shows_little_of_it() {
    let folder = holding(LEAF);
    let (text, dark) = shown(&folder, &SMALL);
    assert!(text.contains("filled in by the studio"), "{text}");
    assert!(dark < 0.1, "{dark}");
    let (text, alone) = shown(&folder, &["--size", "48x48", "--studio", "off"]);
    assert!(
        !text.contains("filled in") && alone > 0.7,
        "{alone}: {text}"
    );
}

#[test]
fn what_its_own_light_shows_needs_no_studio_unless_it_is_asked_for() {
    let folder = holding(SUNNY);
    let (text, _) = shown(&folder, &SMALL);
    assert!(!text.contains("filled in"), "{text}");
    let (text, _) = shown(&folder, &["--size", "48x48", "--studio", "fill"]);
    assert!(text.contains("filled in by the studio"), "{text}");
}

/// Whether it fills in, and how, is found from the whole view: size, part and samples change nothing.
#[test]
fn the_fill_light_does_not_depend_on_the_picture() {
    let folder = holding(LEAF);
    let scene = |args: &[&str]| {
        let all = [&["render", "asset.gltf", "-v", "-o", "x.exr"], args].concat();
        let output = rtc(&folder, &all);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let text = stderr(&output);
        let line = text.lines().find(|line| line.contains("RD009"));
        line.map(str::to_owned)
    };
    let first = scene(&["--size", "40x40", "--spp", "1"]);
    assert!(first.is_some());
    assert_eq!(
        first,
        scene(&["--size", "64x64", "--spp", "2", "--crop", "3,3,9,9"])
    );
    assert_eq!(
        first,
        scene(&["--size", "16x16", "--spp", "3", "--threads", "1"])
    );
}

/// A square on its edge, without camera and lights.
fn square() -> TempDir {
    let asset: serde_json::Value = serde_json::from_str(LEAF).unwrap();
    let mut asset = asset.as_object().unwrap().clone();
    // Without its camera and the light of its leaf.
    asset.remove("cameras");
    let nodes = asset["nodes"].as_array_mut().unwrap();
    nodes.iter_mut().for_each(|node| {
        node.as_object_mut().unwrap().remove("camera");
    });
    for material in asset["materials"].as_array_mut().unwrap() {
        material.as_object_mut().unwrap().remove("emissiveFactor");
    }
    holding(&serde_json::to_string(&asset).unwrap())
}

#[test]
fn an_asset_in_the_studio_casts_its_shadow_on_a_ground() {
    let folder = square();
    let picture = |args: &[&str]| {
        shown(&folder, &[&SMALL, args].concat());
        image::open(folder.path().join("x.png")).unwrap().to_rgb8()
    };
    let (with, without) = (picture(&[]), picture(&["--ground", "off"]));
    assert_eq!(picture(&["--ground", "on"]), with);
    // Below the asset the picture changes; above it nothing does, but for the light sent up.
    let changed = |rows: std::ops::Range<u32>| {
        let pixels = rows.flat_map(|y| (0..48).map(move |x| (x, y)));
        let apart = |(x, y): &(u32, u32)| {
            let [a, b] = [&with, &without].map(|picture| picture.get_pixel(*x, *y).0);
            (0..3).any(|k| a[k].abs_diff(b[k]) > 4)
        };
        pixels.filter(apart).count()
    };
    assert!(changed(38..48) > 200, "{}", changed(38..48));
    assert_eq!(changed(0..4), 0);
    // Other surroundings and a transparent background have no ground.
    for args in [&["--env-color", "1"][..], &["--background", "transparent"]] {
        let off = picture(&[args, &["--ground", "off"]].concat());
        assert_eq!(picture(args), off, "{args:?}");
    }
}
