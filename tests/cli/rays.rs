//! The limit of rays: what is refused before a render, what ends one, and what is harmless.

use super::{code, command, stderr};
use std::fs;
use tempfile::TempDir;

const GLOSSY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/glossy.yaml");

/// Two brushed planes that face each other, seen from between.
const LOBES: &str = "MaxRecursionDepth: 12
Camera: {eye: [0, 0, 2], center: [0, 0, 0], up: [0, 1, 0], viewSize: [12, 9], fov: 40}
Objects:
- type: plane
  position: [0, 0, -5]
  normal: [0, 0, 1]
  material: {color: [1, 1, 1], ka: 1, kd: 0, ks: 1, n: 9, glossySamples: 20}
- type: plane
  position: [0, 0, 5]
  normal: [0, 0, -1]
  material: {color: [1, 1, 1], ka: 1, kd: 0, ks: 1, n: 9}
";

#[test]
fn the_pixel_at_which_rays_run_out_is_the_same_on_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("lobes.yaml"), LOBES).unwrap();
    let told = |threads: &str, limit: &str| {
        let words = [
            "render",
            "lobes.yaml",
            "-o",
            "out.png",
            "--limit",
            limit,
            "--threads",
            threads,
        ];
        let output = command(folder.path(), &words).output().unwrap();
        assert_eq!(code(&output), 1, "{}", stderr(&output));
        stderr(&output)
    };
    for (limit, pixel) in [("rays=20000", "0, 0"), ("rays=200", "0, 0")] {
        let one = told("1", limit);
        assert!(
            one.contains("error[RD006]") && one.contains(&format!("they run out at pixel {pixel}")),
            "{one}"
        );
        assert!(
            one.contains("lobes.yaml:7:") && one.contains("`glossySamples` is 20"),
            "{one}"
        );
        assert_eq!((told("2", limit), told("3", limit)), (one.clone(), one));
    }
    assert!(!folder.path().join("out.png").exists());
}

#[test]
fn rays_that_end_are_counted_to_the_last() {
    let folder = TempDir::new().unwrap();
    fs::write(
        folder.path().join("lobes.yaml"),
        LOBES.replace("Depth: 12", "Depth: 2"),
    )
    .unwrap();
    let render = |words: &str| {
        let words = ["render", "lobes.yaml", "-o", "out.png"]
            .into_iter()
            .chain(words.split_whitespace());
        command(folder.path(), &words.collect::<Vec<_>>())
            .output()
            .unwrap()
    };
    let free = render("--allow-huge");
    let rays: u64 = stderr(&free)
        .split(", ")
        .nth(1)
        .unwrap()
        .replace([',', ' ', 'r', 'a', 'y', 's'], "")
        .parse()
        .unwrap();
    let at = |limit: u64| render(&format!("--limit rays={limit} --threads 2"));
    assert_eq!(
        (code(&free), code(&at(rays)), code(&at(rays - 1))),
        (0, 0, 1),
        "{rays}"
    );
    assert!(
        stderr(&at(rays - 1)).contains("they run out at pixel 11, 8"),
        "{}",
        stderr(&at(rays - 1))
    );
}

#[test]
fn what_does_not_branch_without_end_is_rendered() {
    let folder = TempDir::new().unwrap();
    for words in [
        "--integrator path --spp 1 --size 16x10",
        "--depth 8 --glossy-samples 24 --size 8x5",
        "--target-error 20 --size 8x5",
    ] {
        let words = ["render", GLOSSY, "-o", "out.png"]
            .into_iter()
            .chain(words.split_whitespace());
        let output = command(folder.path(), &words.collect::<Vec<_>>())
            .output()
            .unwrap();
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
}
