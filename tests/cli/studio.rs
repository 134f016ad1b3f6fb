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

/// The mean of all channels of the picture of a scene text, and what is said of it.
fn lit(text: &str) -> (f64, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.yaml"), text).unwrap();
    let output = rtc(
        &folder,
        &["render", "scene.yaml", "-v", "-o", "x.png", "--spp", "64"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    let sum: f64 = picture.as_raw().iter().map(|value| f64::from(*value)).sum();
    (sum / picture.as_raw().len() as f64, stderr(&output))
}

#[test]
fn a_scene_text_that_glows_is_lit_by_that_alone() {
    let text = |shape: &str, radiance: f64| {
        format!(
            "Camera: {{eye: [0, 0, 8], center: [0, 0, 0], up: [0, 0.275, 0], viewSize: [16, 16]}}\nRenderMode: path\n\
             MaxRecursionDepth: 3\nObjects:\n- {{type: quad, position: [-2, -2, -2], up: [0, 0, 4], side: [4, 0, 0], material: \
             {{type: standard, baseColor: [.8, .8, .8, 1], metallic: 0, doubleSided: true}}}}\n- {{{shape}, material: \
             {{type: standard, baseColor: [0, 0, 0, 1], emissive: [{radiance}, {radiance}, {radiance}], doubleSided: true}}}}\n"
        )
    };
    let shapes = [
        "type: sphere, position: [0, 0, 0], radius: .1",
        "type: quad, position: [-.1, 1, -.1], up: [0, 0, .2], side: [.2, 0, 0]",
        "type: sphere, position: [0, 9, 0], radius: .5",
    ];
    for shape in shapes {
        let pictures = [8.0, 1.0, 0.01].map(|radiance| lit(&text(shape, radiance)));
        assert!(
            pictures
                .iter()
                .all(|(_, reported)| !reported.contains("studio")),
            "{shape}: {pictures:?}"
        );
        let means = pictures.map(|(mean, _)| mean);
        assert!(
            means[0] > means[1] && means[1] >= means[2],
            "{shape}: {means:?}"
        );
    }
    // What does not glow stands in the studio still.
    assert!(lit(&text(shapes[0], 0.0)).1.contains("studio"));
}

#[test]
fn the_studio_lights_what_a_glowing_part_of_an_asset_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let asset = include_bytes!("models/emissive-switches-studio-off.glb");
    fs::write(folder.path().join("x.glb"), asset).unwrap();
    let args = [
        "render", "x.glb", "-o", "x.png", "--spp", "16", "--size", "48x48",
    ];
    let output = rtc(&folder, &args);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("filled in by the studio"),
        "{}",
        stderr(&output)
    );
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    let dark = picture
        .pixels()
        .filter(|pixel| pixel.0.iter().all(|value| *value <= 8));
    assert_eq!(dark.count(), 0);
}

/// Closed rooms side by side, four wide, whose walls face inwards or are seen from both sides; with
/// more objects in them.
fn rooms(count: u32, is_double_sided: bool, more: &str) -> String {
    let mut text = format!(
        "Camera: {{eye: [{x}, 5, 14], center: [{x}, 0, 0], up: [0, 0.4, 0], viewSize: [32, 32]}}\n\
         RenderMode: path\nMaxRecursionDepth: 4\n{more}Objects:\n",
        x = 2 * (count - 1)
    );
    let material = format!(
        "{{type: standard, baseColor: [.7, .7, .7, 1], metallic: 0, doubleSided: {is_double_sided}}}"
    );
    for room in 0..count {
        for (axis, side) in [0, 1, 2]
            .into_iter()
            .flat_map(|axis| [(axis, -2), (axis, 2)])
        {
            // Counterclockwise as seen from inside.
            let mut around = [[-2, -2], [2, -2], [2, 2], [-2, 2]];
            if side > 0 {
                around.reverse();
            }
            let corner = |[u, v]: [i32; 2]| {
                let mut corner = [0, 0, 0];
                corner[axis] = side;
                (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v);
                let [x, y, z] = corner;
                format!("[{}, {y}, {z}]", x + 4 * i32::try_from(room).unwrap())
            };
            let [a, b, c, d] = around.map(corner);
            text += &format!(
                "- {{type: quad, v0: {a}, v1: {b}, v2: {c}, v3: {d}, material: {material}}}\n"
            );
        }
    }
    text
}

/// What is told of rooms, and the fraction of their picture that is nearly black.
fn inside(text: &str, args: &[&str]) -> (String, f64) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.yaml"), text).unwrap();
    let few = ["render", "scene.yaml", "-v", "-o", "x.png", "--spp", "16"];
    let output = rtc(&folder, &[&few, args].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    let dark = picture
        .pixels()
        .filter(|pixel| pixel.0.iter().all(|value| *value <= 8));
    (
        stderr(&output),
        dark.count() as f64 / picture.pixels().len() as f64,
    )
}

#[test]
fn lamps_light_closed_rooms_that_the_camera_looks_into() {
    for (count, lamps) in [(1, "a lamp is placed"), (2, "2 lamps are placed")] {
        let text = rooms(count, false, "");
        let (told, dark) = inside(&text, &[]);
        assert!(told.contains(lamps) && dark < 0.02, "{dark}: {told}");
        // What is asked for stays dark, and is told.
        for args in [["--studio", "off"], ["--env-color", "0,0,0"]] {
            let (told, dark) = inside(&text, &args);
            let is_told = told.contains("warning[RD015]") && told.contains("it is dark");
            assert!(is_told && dark > 0.3, "{args:?} {dark}: {told}");
        }
    }
    // Rays of the light pass no wall that the camera does not, and a light inside is enough.
    let own = "Lights:\n- {type: point, position: [0, 1, 0], intensity: [9, 9, 9]}\n";
    for text in [rooms(1, true, ""), rooms(1, false, own)] {
        let (told, _) = inside(&text, &[]);
        assert!(!told.contains("RD015"), "{told}");
    }
}

#[test]
fn a_lamp_does_not_depend_on_the_picture() {
    let text = rooms(1, false, "Environment: {color: [1, 1, 1]}\n");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.yaml"), text).unwrap();
    let scene = |args: &[&str]| {
        let few = [
            "render",
            "scene.yaml",
            "-o",
            "x.png",
            "--size",
            "24x24",
            "--spp",
            "2",
        ];
        assert_eq!(code(&rtc(&folder, &[&few, args].concat())), 0);
        image::open(folder.path().join("x.png")).unwrap().to_rgb8()
    };
    let whole = scene(&["--threads", "1"]);
    assert_eq!(whole, scene(&["--threads", "2"]));
    let part = scene(&["--crop", "8,4,6,9"]);
    assert!(
        part.enumerate_pixels()
            .all(|(x, y, pixel)| pixel == whole.get_pixel(x + 8, y + 4))
    );
}
