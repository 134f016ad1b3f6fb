//! Models that other programs show as they are meant: each is shown so, or what is missing is told.

use crate::suite::needs;
use libtest_mimic::Trial;
use std::path::Path;
use std::process::Command;

/// The folder of the models.
const FOLDER: &str = "round-4/models";

pub(crate) fn trials() -> Vec<Trial> {
    let one = |name: &str, check: fn(&Path)| {
        let path = format!("{FOLDER}/{name}");
        needs(format!("models/{name}"), &path, check)
    };
    vec![
        one("closed-single-sided-room-is-black.glb", is_lit),
        one("normalmap-texture-transform-mirror.glb", is_as_baked),
        one(
            "gaussian-splat-ply-drawn-as-grey-dots-nothing-said.ply",
            are_colored_splats,
        ),
        one("gaussian-splatting.gltf", are_colored_splats),
        one(
            "obj-normal-index-without-normals-refused-even-lenient.obj",
            is_read_leniently,
        ),
    ]
}

/// A picture of a file, and what is told of it.
fn shown(path: &Path, args: &[&str]) -> (image::RgbImage, String) {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("x.png");
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    command.arg("render").arg(path).arg("-o").arg(&output);
    command.args(["-v", "--size", "64x64", "--spp", "16"]);
    let done = command.args(args).output().unwrap();
    let told = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(done.status.success(), "{told}");
    (image::open(output).unwrap().to_rgb8(), told)
}

fn is_lit(path: &Path) {
    let dark = |args: &[&str]| {
        let (picture, told) = shown(path, args);
        let dark = picture
            .pixels()
            .filter(|pixel| pixel.0.iter().all(|value| *value <= 8));
        (dark.count() as f64 / picture.pixels().len() as f64, told)
    };
    let (lit, told) = dark(&[]);
    assert!(lit < 0.05 && told.contains("placed in it"), "{lit}: {told}");
    let (unlit, told) = dark(&["--studio", "off", "--env-color", "1"]);
    assert!(
        unlit > 0.3 && told.contains("warning[RD015]"),
        "{unlit}: {told}"
    );
}

fn is_as_baked(path: &Path) {
    let [transformed, baked] = [
        path,
        &path.with_file_name("normalmap-texture-transform-baked-uv.glb"),
    ]
    .map(|path| shown(path, &[]).0);
    assert_eq!(transformed, baked);
}

/// The fraction of the pixels whose channels differ much.
fn colored(picture: &image::RgbImage) -> f64 {
    let is_colored = |pixel: &&image::Rgb<u8>| {
        let [least, most] = [pixel.0.iter().min(), pixel.0.iter().max()];
        most.zip(least)
            .is_some_and(|(most, least)| most - least > 40)
    };
    picture.pixels().filter(is_colored).count() as f64 / picture.pixels().len() as f64
}

fn are_colored_splats(path: &Path) {
    let (picture, told) = shown(path, &[]);
    assert!(
        told.contains("Gaussian splats are drawn as opaque ellipsoids"),
        "{told}"
    );
    assert!(colored(&picture) > 0.02, "{}", colored(&picture));
}

fn is_read_leniently(path: &Path) {
    let (picture, told) = shown(path, &["--lenient"]);
    assert!(
        told.contains("refers to normal 1") && told.contains("warning["),
        "{told}"
    );
    assert!(picture.get_pixel(32, 32).0.iter().all(|value| *value > 60));
}
