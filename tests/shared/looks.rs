//! Assets as they are shown without a word about it: little of the subject is blown out or black, and
//! where the view is ours, it is as large as it is to be.

use super::scenes::each;
use libtest_mimic::Trial;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

pub(crate) fn trials() -> Vec<Trial> {
    each("looks", "gltf/assets", &["glb", "gltf"], is_shown_well)
}

/// The sides of the pictures.
const SIDE: u32 = 96;
/// At most so much of the subject is white in a channel, and black.
const WHITE: f64 = 0.15;
const BLACK: f64 = 0.7;
/// The span of the subject where the view is ours.
const SPAN: [f64; 2] = [0.8, 0.9];

/// What a picture of an asset may fail, and why.
const EXCEPTIONS: &[(&str, &str, &str)] = &[(
    "UnlitTest.gltf",
    "white",
    "its colours are unlit, with a channel of 1, and are shown as they are",
)];

/// A picture of the asset.
fn picture(path: &Path, folder: &TempDir, name: &str, args: &[&str]) -> image::RgbaImage {
    let output: PathBuf = folder.path().join(name);
    let size = format!("{SIDE}x{SIDE}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    command.arg("render").arg(path).arg("-o").arg(&output);
    command
        .args(["-q", "--spp", "16", "--size", &size])
        .args(args);
    let done = command.output().unwrap();
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    image::open(output).unwrap().to_rgba8()
}

fn is_shown_well(path: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let shown = picture(path, &folder, "shown.png", &[]);
    let cut = picture(path, &folder, "cut.png", &["--background", "transparent"]);
    let subject: Vec<(u32, u32)> = cut
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel[3] >= 128)
        .map(|(x, y, _)| (x, y))
        .collect();
    assert!(!subject.is_empty(), "nothing is shown");
    let part = |is: &dyn Fn([u8; 3]) -> bool| {
        let [count, all] = [
            subject
                .iter()
                .filter(|(x, y)| {
                    let [r, g, b, _] = shown.get_pixel(*x, *y).0;
                    is([r, g, b])
                })
                .count(),
            subject.len(),
        ];
        count as f64 / all as f64
    };
    let white = part(&|pixel| pixel.contains(&255));
    let black = part(&|pixel| pixel.iter().all(|value| *value <= 5));
    let span = |axis: fn(&(u32, u32)) -> u32| {
        let (least, most) = (
            subject.iter().map(axis).min(),
            subject.iter().map(axis).max(),
        );
        f64::from(most.unwrap() + 1 - least.unwrap()) / f64::from(SIDE)
    };
    let span = span(|(x, _)| *x).max(span(|(_, y)| *y));
    let name = path.file_name().unwrap().to_string_lossy();
    println!("{name}: white {white:.3}, black {black:.3}, span {span:.2}");
    let gates = [
        ("white", white <= WHITE),
        ("black", black <= BLACK),
        (
            "span",
            has_camera(path) || (SPAN[0]..=SPAN[1]).contains(&span),
        ),
    ];
    for (gate, holds) in gates {
        let is_excepted = EXCEPTIONS
            .iter()
            .any(|(asset, one, _)| *asset == name && *one == gate);
        assert!(
            holds != is_excepted,
            "{name}: {gate} {}: white {white:.3}, black {black:.3}, span {span:.2}",
            if holds {
                "holds, though it is excepted"
            } else {
                "fails"
            }
        );
    }
}

/// Whether the view of an asset is its own: that is told by a camera somewhere in its JSON.
fn has_camera(path: &Path) -> bool {
    let bytes = std::fs::read(path).unwrap();
    let wanted = b"\"cameras\"";
    bytes.windows(wanted.len()).any(|window| window == wanted)
}
