//! Automatic exposure: what it is for, what it depends on, and that it is told.

use super::*;

/// A spot light on the ground and on a card.
const SPOT: &str = include_str!("../render/light/spot.gltf");

/// A folder with the asset, its light of so many candela.
fn lit(candela: f64) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    assert!(
        SPOT.contains("\"intensity\": 40,"),
        "the light of the asset"
    );
    let asset = SPOT.replace("\"intensity\": 40,", &format!("\"intensity\": {candela},"));
    fs::write(folder.path().join("spot.gltf"), asset).unwrap();
    folder
}

/// What is said of a picture, and its mean, 0 to 255.
fn shown(folder: &TempDir, args: &[&str]) -> (String, f64) {
    let few = ["render", "spot.gltf", "-o", "x.png"];
    let output = rtc(folder, &[&few, args].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let picture = image::open(folder.path().join("x.png")).unwrap().to_rgb8();
    let sum: f64 = picture.as_raw().iter().copied().map(f64::from).sum();
    (stderr(&output), sum / picture.as_raw().len() as f64)
}

/// The exposure that is told, in stops.
fn reported(text: &str) -> Option<f64> {
    let (_, rest) = text.split_once("exposed by ")?;
    rest.split_once(" stops")?.0.parse().ok()
}

#[test]
fn an_asset_looks_alike_however_bright_its_lights_are() {
    let small = ["--size", "32x32", "--spp", "4"];
    let (text, dim) = shown(&lit(40.0), &small);
    let (bright_text, bright) = shown(&lit(40.0 * 4096.0), &small);
    let stops = reported(&bright_text).unwrap();
    let apart = reported(&text).unwrap_or(0.0) - stops;
    assert!((apart - 12.0).abs() < 0.01, "{text}{bright_text}");
    assert!((dim - bright).abs() < 2.0, "{dim}, {bright}");
    // A sixth of a stop from the third that is nearest.
    assert!(
        (3.0 * stops - (3.0 * stops).round()).abs() < 0.02,
        "{stops}"
    );
}

/// The error of a picture is that of what is shown: light 4096 times as bright, twelve stops darker,
/// takes the same samples.
#[test]
fn a_target_error_is_that_of_the_exposed_picture() {
    let quality = |candela: f64, stops: &str| {
        let args = [
            "--size",
            "16x16",
            "--target-error",
            "8",
            "--exposure",
            stops,
        ];
        let (text, mean) = shown(&lit(candela), &args);
        let line = text.lines().find(|line| line.contains("grey levels"));
        (line.unwrap().to_owned(), mean)
    };
    assert_eq!(quality(40.0, "0"), quality(40.0 * 4096.0, "-12"));
    assert_ne!(quality(40.0, "0"), quality(40.0, "-3"));
}

#[test]
fn the_exposure_does_not_depend_on_what_is_rendered_of_the_view() {
    let folder = lit(54_000.0);
    let stops = |args: &[&str]| reported(&shown(&folder, args).0).unwrap();
    let whole = stops(&["--size", "32x32", "--spp", "4"]);
    for args in [
        &["--size", "48x20", "--spp", "2"][..],
        &["--size", "32x32", "--crop", "0,0,4,4", "--spp", "2"],
        &["--size", "32x32", "--spp", "1", "--threads", "1"],
        &["--size", "32x32", "--target-error", "60"],
    ] {
        assert_eq!(stops(args), whole, "{args:?}");
    }
    let bytes = fs::read(folder.path().join("x.png")).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let (_, said) = text.split_once("\"exposure\":").expect("the file says it");
    let end = said.find([',', '}']).unwrap();
    let said: f64 = said.split_at(end).0.parse().unwrap();
    assert!((said - whole).abs() < 0.006, "{said}, {whole}");
}

#[test]
fn an_exposure_is_found_for_pngs_of_lit_assets_alone() {
    let folder = lit(54_000.0);
    let small = ["--size", "16x16", "--spp", "2"];
    let is_exposed =
        |args: &[&str]| reported(&shown(&folder, &[&small, args].concat()).0).is_some();
    assert!(is_exposed(&[]));
    assert!(!is_exposed(&["--exposure", "0"]));
    assert!(!is_exposed(&["--no-scene-lights", "--sun", "1,2,3,50000"]));
    assert!(is_exposed(&[
        "--no-scene-lights",
        "--sun",
        "1,2,3,50000",
        "--exposure",
        "auto"
    ]));
    let exr = [
        "render",
        "spot.gltf",
        "--size",
        "16x16",
        "--spp",
        "1",
        "-o",
        "x.exr",
    ];
    let output = rtc(&folder, &exr);
    assert!(code(&output) == 0 && reported(&stderr(&output)).is_none());
    let output = rtc(&folder, &[&exr[..], &["--exposure", "auto"]].concat());
    assert_eq!(code(&output), 2);
    fs::write(
        folder.path().join("spot.yaml"),
        "Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\n\
        Objects:\n- {type: gltf, file: spot.gltf}\n",
    )
    .unwrap();
    let output = rtc(&folder, &["render", "spot.yaml", "-o", "y.png"]);
    assert!(
        code(&output) == 0 && reported(&stderr(&output)).is_none(),
        "{}",
        stderr(&output)
    );
}
