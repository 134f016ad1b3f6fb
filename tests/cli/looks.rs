//! The look of a picture from outside: tone maps, exposure, and what is behind.

use super::*;
use image::DynamicImage;

/// The ball alone.
fn ball(folder: &TempDir) {
    let plane = r#",
    {"shape": {"plane": {"center": [0, 0, -20], "normal": [0, 0, 1]}}, "material": 1}"#;
    fs::write(folder.path().join("alone.json"), scene_with(plane, "")).unwrap();
}

/// A square that shines with radiance 2, 1 and 0.25 in the middle of grey surroundings, by paths.
const SIGN: &str = r#"{
  "irVersion": 3,
  "camera": {"eye": [0, 0, 4], "center": [0, 0, 0], "right": [0.25, 0, 0], "up": [0, 0.25, 0], "size": [8, 8],
    "lens": {"radius": 0, "samples": 1}},
  "settings": {"mode": {"path": {"samples": 4, "multipleScattering": true}}, "shadows": true, "maxDepth": 4,
    "supersampling": 1},
  "lights": [],
  "materials": [{"standard": {"baseColor": [0, 0, 0, 1], "metallic": 0, "specular": 0, "emissive": [2, 1, 0.25]}}],
  "surfaces": [
    {"shape": {"triangle": {"vertices": [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0]]}}, "material": 0},
    {"shape": {"triangle": {"vertices": [[-0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]}}, "material": 0}],
  "environment": {"radiance": [0.25, 0.25, 0.25]}
}"#;

fn render(folder: &TempDir, scene: &str, args: &[&str]) -> DynamicImage {
    let output = rtc(
        folder,
        &[&["render", scene, "-q", "-o", "-"], args].concat(),
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    image::load_from_memory(&output.stdout).unwrap()
}

#[test]
fn the_defaults_are_those_of_the_mode() {
    let folder = folder();
    fs::write(folder.path().join("sign.json"), SIGN).unwrap();
    let same = |scene, args| render(&folder, scene, &[]) == render(&folder, scene, args);
    assert!(same(
        "ball.json",
        &[
            "--tonemap",
            "none",
            "--exposure",
            "0",
            "--background",
            "env"
        ]
    ));
    assert!(same(
        "sign.json",
        &[
            "--tonemap",
            "srgb",
            "--exposure",
            "0",
            "--background",
            "env"
        ]
    ));
    assert!(
        !same("ball.json", &["--tonemap", "srgb"]) && !same("sign.json", &["--tonemap", "none"])
    );
}

#[test]
fn tone_maps_and_exposure_show_what_they_are_defined_to() {
    let folder = folder();
    fs::write(folder.path().join("sign.json"), SIGN).unwrap();
    let shown = |args: &[&str]| {
        let image = render(&folder, "sign.json", args).to_rgb8();
        [image.get_pixel(4, 4).0, image.get_pixel(0, 0).0]
    };
    // Radiance 2, 1, 0.25 and 0.25: ⌊255·v⌋ of the definitions, by hand.
    assert_eq!(shown(&[]), [[255, 255, 136], [136; 3]]);
    assert_eq!(shown(&["--tonemap", "none"]), [[255, 255, 63], [63; 3]]);
    assert_eq!(
        shown(&["--tonemap", "none", "--exposure", "-2"]),
        [[127, 63, 15], [15; 3]]
    );
    assert_eq!(
        shown(&["--exposure", "-2", "--tonemap", "pbr-neutral"])[1],
        [43; 3]
    );
    let [sign, grey] = shown(&["--tonemap", "agx"]);
    assert!(
        sign[0] > sign[1] && sign[1] > sign[2] && sign[0] < 255 && grey[0] > 127,
        "{sign:?} {grey:?}"
    );
}

#[test]
fn a_transparent_picture_is_opaque_where_something_is() {
    let folder = folder();
    ball(&folder);
    let clear = |sampling: &[&str]| {
        let args = [sampling, &["--background", "transparent", "--bits", "16"]].concat();
        render(&folder, "alone.json", &args)
            .as_rgba16()
            .unwrap()
            .clone()
    };
    let (grid, grown) = (["--supersampling", "8"], ["--target-error", "2"]);
    // The outline of a ball of radius 10 at distance 50 is a circle, of radius 50·tan(asin(1/5)) in
    // the plane of the picture.
    let area = std::f64::consts::PI * 2500.0 / 24.0;
    for (sampling, tolerance) in [(grid, 0.005), (grown, 0.02)] {
        let opaque: f64 = clear(&sampling)
            .pixels()
            .map(|pixel| f64::from(pixel.0[3]) / 65535.0)
            .sum();
        assert!((opaque - area).abs() < tolerance * area, "{opaque} {area}");
    }
    let whole = render(&folder, "alone.json", &grid).to_rgb8();
    for (ours, shown) in clear(&grid).pixels().zip(whole.pixels()) {
        let [r, g, b, alpha] = ours.0.map(|v| f64::from(v) / 65535.0);
        let apart = [r, g, b]
            .into_iter()
            .zip(shown.0)
            .map(|(c, shown)| (c * alpha * 255.0 - f64::from(shown)).abs());
        assert!(
            apart.fold(0.0, f64::max) <= 1.01,
            "straight colours, weighed, are those before black"
        );
    }
}

#[test]
fn a_colour_behind_is_what_the_file_holds_and_lights_nothing() {
    let folder = folder();
    fs::write(folder.path().join("sign.json"), SIGN).unwrap();
    let image = render(
        &folder,
        "sign.json",
        &["--background", "1,0.5,0", "--tonemap", "agx"],
    )
    .to_rgb8();
    let plain = render(&folder, "sign.json", &["--tonemap", "agx"]).to_rgb8();
    assert_eq!(
        (image.get_pixel(0, 0).0, image.get_pixel(4, 4)),
        ([255, 127, 0], plain.get_pixel(4, 4))
    );
    let clear = render(&folder, "sign.json", &["--background", "transparent"]).to_rgba8();
    assert_eq!(
        [clear.get_pixel(0, 0).0, clear.get_pixel(4, 4).0],
        [[0; 4], [255, 255, 136, 255]]
    );
}

/// A file of sRGB holds the bytes that were typed; an EXR the linear value, by hand of IEC 61966-2-1.
#[test]
fn a_colour_of_the_screen_is_shown_as_typed() {
    let folder = folder();
    ball(&folder);
    let corner = |color: &str, args: &[&str]| {
        let args = [&["--background", color], args].concat();
        render(&folder, "alone.json", &args)
            .to_rgb16()
            .get_pixel(0, 0)
            .0
    };
    let shown = [0xff_u16, 0x80, 0x01];
    assert_eq!(corner("#ff8001", &[]), shown.map(|v| v * 257));
    assert_eq!(corner("#ff8001", &["--bits", "16"]), shown.map(|v| v * 257));
    assert_eq!(corner("white", &["--tonemap", "agx"]), [65535; 3]);
    assert_eq!(corner("black", &[]), [0; 3]);
    let args = [
        "render",
        "alone.json",
        "-q",
        "-o",
        "a.exr",
        "--background",
        "#ff8001",
    ];
    assert_eq!(code(&rtc(&folder, &args)), 0);
    let read = exr::prelude::read_first_rgba_layer_from_file(
        folder.path().join("a.exr"),
        |_, _| None,
        |first: &mut Option<[f32; 3]>, _, (r, g, b, _): (f32, f32, f32, f32)| {
            first.get_or_insert([r, g, b]);
        },
    );
    let linear = read.unwrap().layer_data.channel_data.pixels.unwrap();
    let wanted = [1.0, 0.215_860_5, 1.0 / 255.0 / 12.92];
    let near = |(own, wanted): (&f32, &f32)| (own - wanted).abs() < 1e-6;
    assert!(linear.iter().zip(&wanted).all(near), "{linear:?}");
}

#[test]
fn an_exr_takes_exposure_and_opacity_but_no_tone_map() {
    let folder = folder();
    fs::write(folder.path().join("sign.json"), SIGN).unwrap();
    let args = [
        "render",
        "sign.json",
        "-o",
        "sign.exr",
        "--exposure",
        "1",
        "--background",
        "transparent",
    ];
    assert_eq!(code(&rtc(&folder, &args)), 0);
    let read = exr::prelude::read_first_rgba_layer_from_file(
        folder.path().join("sign.exr"),
        |size, _| (size.width(), vec![[0.0; 4]; size.area()]),
        |(width, pixels): &mut (usize, Vec<[f32; 4]>), at, (r, g, b, a): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [r, g, b, a];
        },
    );
    let pixels = read.unwrap().layer_data.channel_data.pixels.1;
    assert_eq!(
        [pixels[0], pixels[4 * 8 + 4]],
        [[0.0; 4], [4.0, 2.0, 0.5, 1.0]]
    );
    let refused = rtc(
        &folder,
        &["render", "sign.json", "-o", "sign.exr", "--tonemap", "agx"],
    );
    assert!(
        code(&refused) == 2 && stderr(&refused).contains("an EXR holds linear values"),
        "{}",
        stderr(&refused)
    );
}

#[test]
fn layers_go_into_an_exr_by_their_names() {
    let folder = folder();
    let args = [
        "render",
        "ball.json",
        "-o",
        "ball.exr",
        "--aov",
        "depth,normal,depth",
        "--crop",
        "10,5,20,10",
    ];
    assert_eq!(code(&rtc(&folder, &args)), 0);
    let read = exr::prelude::read_all_data_from_file(folder.path().join("ball.exr")).unwrap();
    let channels = &read.layer_data[0].channel_data.list;
    let names: Vec<_> = channels
        .iter()
        .map(|channel| channel.name.to_string())
        .collect();
    assert_eq!(
        names,
        ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z"]
    );
}

#[test]
fn settings_of_the_ir_are_replaced_by_their_names() {
    let folder = folder();
    let picture = |args: &[&str]| render(&folder, "ball.json", args);
    assert!(
        picture(&["--set", "supersampling=3", "--set", "maxDepth=0"])
            == picture(&["--supersampling", "3", "--depth", "0"])
    );
    let refused = |setting| {
        let output = rtc(&folder, &["render", "ball.json", "--set", setting]);
        assert_eq!(code(&output), 2);
        stderr(&output)
    };
    assert!(
        refused("spp=3").contains("there is no setting `spp`; there are mode, shadows, maxDepth")
    );
    assert!(refused("shadows=perhaps").contains("`shadows` can't be `perhaps`"));
    assert_eq!(
        code(&rtc(
            &folder,
            &["render", "ball.json", "--set", "supersampling=0"]
        )),
        1,
        "that is for the proof to say"
    );
}
