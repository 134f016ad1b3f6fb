//! Runs rtc with little memory and time: 256 MiB of addresses, 20 CPU-seconds (the build for tests is not optimised), two threads. Linux
//! alone has both limits.

use super::make::{self, Repro};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// How a run ended.
#[derive(Debug)]
struct Outcome {
    /// The exit code; none if a signal ended it.
    code: Option<i32>,
    /// What it said.
    words: String,
}

impl Outcome {
    /// True if it ended by itself with a finding of this code.
    fn is_refused(&self, finding: &str) -> bool {
        self.code == Some(1) && self.words.contains(&format!("error[{finding}]"))
    }
}

/// A folder with these files in it.
fn folder(files: &[(String, Vec<u8>)]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// Runs `rtc` with these arguments in a folder, within the limits.
fn run(folder: &Path, arguments: &[String]) -> Outcome {
    let program = env!("CARGO_BIN_EXE_rtc");
    let output = Command::new("sh")
        .args([
            "-c",
            "ulimit -v 262144; ulimit -t 20; exec \"$@\"",
            "sh",
            program,
        ])
        .args(arguments)
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .unwrap();
    /// So many of the first words are looked at: there may be very many.
    const MOST: usize = 1 << 12;
    let words = String::from_utf8_lossy(&output.stderr);
    Outcome {
        code: output.status.code(),
        words: words.chars().take(MOST).collect(),
    }
}

/// Runs each, and complains of those that did not end as expected.
fn try_all(repros: Vec<Repro>) {
    let mut faults = String::new();
    for Repro {
        name,
        files,
        arguments,
        expected,
    } in repros
    {
        let outcome = run(folder(&files).path(), &arguments);
        let is_fine = expected.map_or(outcome.code == Some(0), |finding| {
            outcome.is_refused(finding)
        });
        if !is_fine {
            writeln!(faults, "{name}: {outcome:?}").unwrap();
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn hostile_assets_are_refused_or_harmless() {
    try_all(make::gltf::all());
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn many_of_one_thing_take_no_longer_than_they_are() {
    try_all(make::many::all());
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn hostile_scenes_of_mitsuba_are_refused_or_harmless() {
    try_all(make::mitsuba::all());
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn hostile_scenes_of_pbrt_are_refused_or_harmless() {
    try_all(make::pbrt::all());
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn hostile_stages_of_usd_are_refused_or_harmless() {
    try_all(make::usd::all());
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn pictures_that_there_is_no_memory_for_are_refused_in_words() {
    let scene = b"Camera: {eye: [0, 0, 10], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\nObjects: []\n";
    let folder = folder(&[("scene.yaml".to_owned(), scene.to_vec())]);
    for size in ["65535x65535", "3000x3000"] {
        for output in ["out.png", "out.exr"] {
            let words = [
                "render",
                "scene.yaml",
                "-q",
                "--allow-huge",
                "--size",
                size,
                "-o",
                output,
            ];
            let outcome = run(folder.path(), &words.map(str::to_owned));
            let is_told = outcome
                .words
                .contains("there is no memory for a picture of ");
            assert!(
                outcome.code == Some(2) && is_told,
                "{size} {output}: {outcome:?}"
            );
        }
    }
    let words = [
        "render",
        "scene.yaml",
        "-q",
        "--size",
        "400x400",
        "-o",
        "out.png",
    ]
    .map(str::to_owned);
    assert_eq!(run(folder.path(), &words).code, Some(0));
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn a_picture_that_there_is_no_memory_for_is_rendered_in_strips() {
    let scene = b"Camera: {eye: [0, 0, 90], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\n\
        Objects:\n- type: sphere\n  position: [0, 0, 0]\n  radius: 1\n\
        \x20 material: {color: [1, 0, 0], ka: 0.2, kd: 0.7, ks: 0, n: 1}\n";
    let folder = folder(&[("scene.yaml".to_owned(), scene.to_vec())]);
    let words = ["render", "scene.yaml", "-q"];
    let path = [
        "--size",
        "1100x999",
        "--integrator",
        "path",
        "--spp",
        "1",
        "--env-color",
        "1,1,1",
    ];
    for (more, output) in [
        (&["--size", "1500x1333"][..], "out.png"),
        (&path[..], "out.exr"),
    ] {
        let words = [&words[..], more, &["-o", output]].concat();
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        let outcome = run(folder.path(), &words);
        let is_told = outcome.words.contains("`--strips=16` holds 16 rows");
        assert!(outcome.code == Some(2) && is_told, "{output}: {outcome:?}");
        assert!(!folder.path().join(output).exists());
        let outcome = run(
            folder.path(),
            &[&words[..], &["--strips=64".to_owned()]].concat(),
        );
        assert_eq!(outcome.code, Some(0), "{output}: {outcome:?}");
    }
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn hostile_images_meshes_and_scenes_are_refused_or_harmless() {
    try_all(make::media::all());
}
