//! The limit of rays: what is refused before a render, what ends one, and what is harmless.

use super::{code, command, stderr};
use std::fs;
use std::process::Output;
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
    let reported = |threads: &str, limit: &str| {
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
        let one = reported("1", limit);
        assert!(
            one.contains("error[RD006]") && one.contains(&format!("they run out at pixel {pixel}")),
            "{one}"
        );
        assert!(
            one.contains("lobes.yaml:7:") && one.contains("`glossySamples` is 20"),
            "{one}"
        );
        assert_eq!(
            (reported("2", limit), reported("3", limit)),
            (one.clone(), one)
        );
    }
    assert!(!folder.path().join("out.png").exists());
}

#[test]
fn rays_that_end_are_counted_to_the_last() {
    let folder = TempDir::new().unwrap();
    let render = |words: &str| render_lobes(&folder, 2, words);
    let free = render("--allow-huge");
    let rays = u64::from(rays_of(&free));
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

/// Guides and probes take rays like all others.
#[test]
fn rays_of_a_denoised_picture_are_counted_to_the_last() {
    let folder = TempDir::new().unwrap();
    let render = |words: &str| {
        let words = format!("--integrator path --spp 4 --threads 2 {words}");
        render_lobes(&folder, 2, &words)
    };
    let [plain, free] =
        ["--allow-huge", "--denoise --allow-huge"].map(|words| rays_of(&render(words)));
    let at = |limit: u32| render(&format!("--denoise --limit rays={limit}"));
    // The guides of both halves take four camera rays per pixel; edges take more.
    assert!(free > plain + 4 * 12 * 9, "{plain} {free}");
    assert_eq!((code(&at(free)), code(&at(free - 1))), (0, 1));
    let words = stderr(&at(free));
    assert!(
        words.contains("error ") && words.contains("without denoising "),
        "{words}"
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

/// Runs `rtc render` on the lobes, seen through as many bounces.
fn render_lobes(folder: &TempDir, bounces: u32, words: &str) -> Output {
    render(folder, LOBES, bounces, words)
}

/// The same below a soft light.
fn render_lit(folder: &TempDir, bounces: u32, words: &str) -> Output {
    let light = "LightSamples: 4
Lights:
- {position: [1, 1, 1], color: [0.2, 0.2, 0.2], radius: 1}
Objects:";
    let lit = LOBES
        .replace("Objects:", light)
        .replace("ka: 1, kd: 0, ks: 1", "ka: 0, kd: 1, ks: 0.5");
    render(folder, &lit, bounces, words)
}

fn render(folder: &TempDir, scene: &str, bounces: u32, words: &str) -> Output {
    let scene = scene.replace("Depth: 12", &format!("Depth: {bounces}"));
    fs::write(folder.path().join("lobes.yaml"), scene).unwrap();
    let words = ["render", "lobes.yaml", "-o", "out.png"]
        .into_iter()
        .chain(words.split_whitespace());
    command(folder.path(), &words.collect::<Vec<_>>())
        .output()
        .unwrap()
}

#[test]
fn each_render_of_a_verification_has_the_limit() {
    let folder = TempDir::new().unwrap();
    let reported = |threads: u32, bounces: u32, rays: u32| {
        let words = format!("--verify-effects --limit rays={rays} --threads {threads}");
        let output = render_lobes(&folder, bounces, &words);
        (code(&output), stderr(&output))
    };
    let (status, one) = reported(1, 12, 20_000);
    assert!(
        status == 1 && one.contains("error[RD006]") && one.contains("run out at pixel 0, 0"),
        "{one}"
    );
    assert_eq!(
        (reported(2, 12, 20_000).1, reported(3, 12, 20_000).1),
        (one.clone(), one)
    );
    // Both together take more.
    let picture = rays_of(&render_lobes(&folder, 2, "--allow-huge"));
    let (status, words) = reported(2, 2, picture * 3 / 2);
    assert_eq!(status, 0, "{words}");
}

/// How many rays a picture took.
fn rays_of(output: &Output) -> u32 {
    let words = stderr(output);
    let reported = words.lines().find(|line| line.contains(" rays")).unwrap();
    let digits = reported.split(", ").nth(1).unwrap().chars();
    let digits: String = digits.filter(char::is_ascii_digit).collect();
    digits.parse().unwrap()
}

#[test]
fn a_time_to_be_used_has_the_limit() {
    let folder = TempDir::new().unwrap();
    let endless = render_lobes(&folder, 12, "--time-budget 100 --limit rays=20000");
    assert_eq!(code(&endless), 1, "{}", stderr(&endless));
    assert!(
        stderr(&endless).contains("error[RD006]"),
        "{}",
        stderr(&endless)
    );
    // A round is done: the picture stands.
    let ended = render_lit(
        &folder,
        2,
        "--glossy-samples 2 --time-budget 100 --limit rays=200000",
    );
    assert_eq!(code(&ended), 0, "{}", stderr(&ended));
    assert!(
        stderr(&ended).contains(", ended by `--limit rays`"),
        "{}",
        stderr(&ended)
    );
    let rays = rays_of(&ended);
    assert!(rays <= 200_000, "{rays}");
    // An error that is asked for is not reached.
    let missed = render_lit(
        &folder,
        2,
        "--glossy-samples 2 --target-error 0.01 --limit rays=200000",
    );
    assert_eq!(code(&missed), 1, "{}", stderr(&missed));
}

#[test]
fn the_choice_of_points_on_lights_has_the_limit() {
    let folder = TempDir::new().unwrap();
    let output = render_lit(&folder, 12, "--target-error 1 --limit rays=20000");
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("error[RD006]"),
        "{}",
        stderr(&output)
    );
}

/// A lamp and what it shines on: the exposure is found by a small picture of its own.
fn render_stage(folder: &TempDir, body: &str, limit: u32) -> Output {
    let text = format!(
        "#usda 1.0\n(\n metersPerUnit = 1\n)\n{body}\
         def DistantLight \"lamp\" {{}}\n"
    );
    fs::write(folder.path().join("lit.usda"), text).unwrap();
    let limit = format!("rays={limit}");
    let words = [
        "render", "lit.usda", "-o", "out.png", "--size", "4x4", "--spp", "1", "--limit", &limit,
    ];
    command(folder.path(), &words).output().unwrap()
}

#[test]
fn the_search_for_an_exposure_has_the_limit() {
    let folder = TempDir::new().unwrap();
    let render = |limit| render_stage(&folder, "def Sphere \"ball\" {}\n", limit);
    let (few, many) = (render(20_000), render(4_000_000));
    assert_eq!(code(&many), 0, "{}", stderr(&many));
    assert_eq!(code(&few), 1, "{}", stderr(&few));
    assert!(stderr(&few).contains("error[RD006]"), "{}", stderr(&few));
}

/// A ray that goes on behind a clear surface is one more.
#[test]
fn rays_through_clear_surfaces_are_counted() {
    let folder = TempDir::new().unwrap();
    let render = |panes: usize| {
        let pane = |n: usize| {
            format!(
                "def Plane \"p{n}\" {{ rel material:binding = </clear>\n\
                 double3 xformOp:translate = (0, 0, 0.{n:02})\n\
                 uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}}\n"
            )
        };
        let body = (0..panes).map(pane).collect::<String>()
            + "def Material \"clear\" { token outputs:surface.connect = </clear/s.outputs:surface>\n\
               def Shader \"s\" { uniform token info:id = \"UsdPreviewSurface\"\n\
               float inputs:opacity = 0\nfloat inputs:opacityThreshold = 0.5\n} }\n";
        render_stage(&folder, &body, 400_000)
    };
    let (one, many) = (render(1), render(60));
    assert_eq!(code(&one), 0, "{}", stderr(&one));
    assert_eq!(code(&many), 1, "{}", stderr(&many));
    assert!(stderr(&many).contains("error[RD006]"), "{}", stderr(&many));
}
