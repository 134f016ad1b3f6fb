//! The binary from outside: exit codes, streams, outputs that appear whole or not at all, message
//! formats.
//!
//! Scenes are given as the text form of the IR, so that what is tested here depends on no front
//! end.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, and makes the files it needs"
)]
mod looks;
mod numbers;
#[cfg(unix)]
mod outputs;
mod rays;
mod reports;
mod stage;
mod words;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A red ball before a grey wall, 40 × 30 pixels.
const SCENE: &str = r#"{
  "irVersion": 1,
  "camera": {"eye": [0, 0, 50], "center": [0, 0, 0], "right": [1, 0, 0], "up": [0, 1, 0], "size": [40, 30],
    "lens": {"radius": 0, "samples": 1}},
  "settings": {"mode": "phong", "shadows": true, "maxDepth": 1, "supersampling": 2},
  "lights": [{"point": {"position": [30, 40, 60], "color": [1, 1, 1]}}],
  "materials": [
    {"phong": {"color": [1, 0, 0], "ka": 0.2, "kd": 0.7, "ks": 0.5, "n": 16, "kt": 0, "eta": 1, "glossySamples": 1}},
    {"phong": {"color": [0.5, 0.5, 0.5], "ka": 0.2, "kd": 0.7, "ks": 0, "n": 1, "kt": 0, "eta": 1, "glossySamples": 1}}],
  "surfaces": [
    {"shape": {"sphere": {"center": [0, 0, 0], "radius": 10}}, "material": 0},
    {"shape": {"plane": {"center": [0, 0, -20], "normal": [0, 0, 1]}}, "material": 1}]
}"#;

/// The scene with one piece of it replaced.
fn scene_with(old: &str, new: &str) -> String {
    assert!(SCENE.contains(old));
    SCENE.replacen(old, new, 1)
}

/// A folder with the scene, one with an error and one whose camera looks at nothing.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ball.json"), SCENE).unwrap();
    fs::write(
        folder.path().join("bad.json"),
        scene_with("\"radius\": 10", "\"radius\": -10"),
    )
    .unwrap();
    let away = scene_with(
        "[0, 0, 50], \"center\": [0, 0, 0]",
        "[0, 0, 50], \"center\": [0, 0, 90]",
    );
    fs::write(folder.path().join("away.json"), away).unwrap();
    folder
}

fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    command
        .current_dir(folder)
        .args(args)
        .env_remove("NO_COLOR")
        .stdin(Stdio::null());
    command
}

fn rtc(folder: &TempDir, args: &[&str]) -> Output {
    command(folder.path(), args).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn exit_codes_say_whose_fault_it_is() {
    let folder = folder();
    let code = |args: &[&str]| code(&rtc(&folder, args));
    assert_eq!(code(&["check", "ball.json", "--asset-root", "."]), 0);
    assert_eq!(code(&["check", "ball.json", "--asset-root", "nowhere"]), 2);
    assert_eq!(code(&["check", "ball.json"]), 0);
    assert_eq!(code(&["check", "ball.json", "bad.json"]), 1);
    assert_eq!(code(&["check", "bad.json", "none.json", "ball.json"]), 2);
    assert_eq!(code(&["check"]), 2);
    assert_eq!(code(&["check", "."]), 2);
    assert_eq!(code(&["render", "ball.json", "-o", "x.gif"]), 2);
    assert_eq!(
        code(&["render", "ball.json", "-o", "x.exr", "--bits", "16"]),
        2
    );
    assert_eq!(code(&["render", "ball.json", "--crop", "40,0,1,1"]), 2);
    assert_eq!(code(&["compile", "ball.json", "-o", "x.png"]), 2);
    assert_eq!(code(&["explain", "VA999"]), 2);
    assert_eq!(code(&["--help"]), 0);
    assert_eq!(names(folder.path()), ["away.json", "bad.json", "ball.json"]);
}

#[test]
fn results_go_to_stdout_and_talk_to_stderr() {
    let folder = folder();
    let checked = rtc(&folder, &["check", "bad.json"]);
    assert!(checked.stdout.is_empty() && stderr(&checked).contains("error["));
    let rendered = rtc(&folder, &["render", "ball.json", "-o", "-"]);
    assert!(rendered.stdout.starts_with(b"\x89PNG"));
    assert!(
        stderr(&rendered).starts_with("-: 40×30, ") && stderr(&rendered).ends_with(" rays/s\n")
    );
    let quiet = rtc(&folder, &["render", "-q", "away.json", "-o", "-"]);
    assert!(quiet.stdout.starts_with(b"\x89PNG") && quiet.stderr.is_empty());
    let compiled = rtc(&folder, &["compile", "ball.json"]);
    assert!(compiled.stdout.starts_with(b"{\n  \"irVersion\": 3") && compiled.stderr.is_empty());
}

#[test]
fn a_picture_is_named_after_its_scene_and_lands_here() {
    let folder = folder();
    fs::create_dir(folder.path().join("here")).unwrap();
    let rendered = command(&folder.path().join("here"), &["render", "../ball.json"])
        .output()
        .unwrap();
    assert_eq!(
        (code(&rendered), names(&folder.path().join("here"))),
        (0, vec!["ball.png".to_owned()])
    );
}

#[test]
fn stdin_is_a_file_with_the_name_given() {
    let folder = folder();
    let mut child = command(
        folder.path(),
        &[
            "check",
            "-",
            "--stdin-name",
            "sky.json",
            "--message-format",
            "short",
        ],
    )
    .stdin(Stdio::piped())
    .stderr(Stdio::piped())
    .spawn()
    .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(scene_with("\"radius\": 10", "\"radius\": -10").as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 1);
    assert!(
        stderr(&output).starts_with("sky.json:"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn every_form_of_the_ir_renders_to_the_same_bytes() {
    let folder = folder();
    let picture = |scene: &str| rtc(&folder, &["render", scene, "-o", "-", "-q"]).stdout;
    for form in ["copy.json", "copy.rtir"] {
        assert_eq!(
            code(&rtc(&folder, &["compile", "ball.json", "-o", form])),
            0
        );
        assert!(picture(form) == picture("ball.json"), "{form}");
    }
    let binary = rtc(&folder, &["compile", "ball.json", "--emit", "ir-bin"]).stdout;
    assert!(binary == fs::read(folder.path().join("copy.rtir")).unwrap());
}

#[test]
fn a_crop_is_that_part_of_the_whole_on_any_threads() {
    let folder = folder();
    let decode = |args: &[&str]| {
        let output = rtc(
            &folder,
            &[&["render", "ball.json", "-q", "-o", "-"], args].concat(),
        );
        image::load_from_memory(&output.stdout).unwrap().to_rgb16()
    };
    for bits in ["8", "16"] {
        let whole = decode(&["--bits", bits, "--threads", "1"]);
        let part = decode(&["--bits", bits, "--threads", "3", "--crop", "13,7,20,100"]);
        assert_eq!(part.dimensions(), (20, 23));
        assert!(image::imageops::crop_imm(&whole, 13, 7, 20, 23).to_image() == part);
    }
}

#[test]
fn options_override_the_scene() {
    let folder = folder();
    let told = |args: &[&str]| {
        let output = rtc(
            &folder,
            &[
                &["render", "ball.json", "-o", "o.png", "--depth", "0"],
                args,
            ]
            .concat(),
        );
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    assert!(told(&["--size", "20x15", "--supersampling", "1"]).starts_with("o.png: 20×15, "));
    assert_eq!(
        image::open(folder.path().join("o.png")).unwrap().width(),
        20
    );
    let huge = rtc(&folder, &["render", "ball.json", "--size", "70000x70000"]);
    assert_eq!(
        (
            code(&huge),
            names(folder.path()).contains(&"ball.png".to_owned())
        ),
        (1, false)
    );
}

#[test]
fn an_exr_says_where_it_came_from() {
    let folder = folder();
    let exr = |name: &str| {
        assert_eq!(code(&rtc(&folder, &["render", "ball.json", "-o", name])), 0);
        fs::read(folder.path().join(name)).unwrap()
    };
    let first = exr("a.exr");
    assert!(first == exr("b.exr"), "two renders differ");
    for words in [
        "rtc:scene",
        "rtc:settings",
        "\"supersampling\":2",
        concat!("rtc ", env!("CARGO_PKG_VERSION")),
    ] {
        assert!(
            first
                .windows(words.len())
                .any(|window| window == words.as_bytes()),
            "{words}"
        );
    }
}

#[test]
fn a_target_is_met_said_and_the_same_on_any_threads() {
    let folder = folder();
    let render = |args: &[&str]| {
        rtc(
            &folder,
            &[&["render", "ball.json", "-o", "-"], args].concat(),
        )
    };
    let one = render(&["--target-error", "2", "--threads", "1"]);
    let talk = stderr(&one);
    let said = talk
        .lines()
        .nth(1)
        .unwrap()
        .strip_prefix("error ≤ ")
        .unwrap();
    assert!(
        said.split(' ').next().unwrap().parse::<f64>().unwrap() <= 2.0,
        "{talk}"
    );
    assert!(
        said.contains(" grey levels (90 %), ") && said.contains(" samples a pixel on the mean, "),
        "{talk}"
    );
    assert!(render(&["--target-error", "2", "--threads", "3"]).stdout == one.stdout);
    assert_eq!(
        code(&render(&[
            "--target-error",
            "2",
            "--time-budget",
            "1",
            "--crop",
            "3,4,5,6"
        ])),
        0
    );
    for args in [
        &["--supersampling", "2"],
        &["--aperture-samples", "2"],
        &["--target-error", "0"],
    ] {
        assert_eq!(
            code(&render(&[&["--time-budget", "1"], &args[..]].concat())),
            2,
            "{args:?}"
        );
    }
}

#[test]
fn nothing_in_view_is_a_warning_after_the_render() {
    let folder = folder();
    let output = rtc(&folder, &["render", "away.json"]);
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("warning[RD001]: no ray of the camera hit anything"),
        "{}",
        stderr(&output)
    );
    assert!(folder.path().join("away.png").exists());
}

#[test]
fn an_arithmetic_too_coarse_for_the_scene_is_a_warning_at_the_surface() {
    let folder = folder();
    let far = SCENE
        .replace(", 50]", ", 1000050]")
        .replace("[0, 0, 0], \"right\"", "[0, 0, 1000000], \"right\"");
    let far = far
        .replace("[0, 0, 0], \"radius\"", "[0, 0, 1000000], \"radius\"")
        .replace("40, 60]", "40, 1000060]");
    fs::write(folder.path().join("far.json"), far).unwrap();
    let warning = |arithmetic: &str| {
        let output = rtc(&folder, &["render", "far.json", "--arithmetic", arithmetic]);
        assert_eq!(code(&output), 0);
        stderr(&output)
            .lines()
            .find(|line| line.contains("RD002"))
            .map(str::to_owned)
    };
    let found = warning("f32").unwrap();
    assert!(
        found.contains("in f32 this picture will be wrong: surfaces shade or mirror themselves"),
        "{found}"
    );
    assert_eq!((warning("plain"), warning("robust")), (None, None));
}

#[test]
fn color_only_where_wanted() {
    let folder = folder();
    let colored = |command: &mut Command| command.output().unwrap().stderr.contains(&0x1b);
    assert!(
        !colored(&mut command(folder.path(), &["check", "bad.json"])),
        "a pipe is no terminal"
    );
    assert!(colored(&mut command(
        folder.path(),
        &["check", "bad.json", "--color", "always"]
    )));
    assert!(colored(
        command(folder.path(), &["check", "bad.json"]).env("CLICOLOR_FORCE", "1")
    ));
    let both = [("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")];
    assert!(!colored(
        command(folder.path(), &["check", "bad.json"])
            .env_remove("CLICOLOR_FORCE")
            .env("NO_COLOR", "1")
    ));
    assert!(!colored(
        command(folder.path(), &["check", "bad.json", "--color", "never"]).envs(both)
    ));
}

#[test]
fn programs_can_read_what_is_meant_for_them() {
    let folder = folder();
    let stdout = |format| {
        let output = rtc(
            &folder,
            &[
                "check",
                "bad.json",
                "none.json",
                "ball.json",
                "--message-format",
                format,
            ],
        );
        assert!(
            output.stderr.is_empty() || format == "short",
            "{format}: {}",
            stderr(&output)
        );
        String::from_utf8(output.stdout).unwrap()
    };
    let lines: Vec<serde_json::Value> = stdout("json")
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert!(
        lines
            .iter()
            .any(|line| line["file"] == "bad.json" && line["severity"] == "error")
    );
    assert!(
        lines
            .iter()
            .any(|line| line["file"] == "none.json" && line["code"] == "IO001")
    );
    let sarif: serde_json::Value = serde_json::from_str(&stdout("sarif")).unwrap();
    assert_eq!(
        sarif["runs"][0]["results"].as_array().unwrap().len(),
        lines.len()
    );
    assert!(
        stdout("github")
            .lines()
            .all(|line| line.starts_with("::error file="))
    );
    assert!(stdout("short").is_empty());
    for verb in ["render", "compile"] {
        let refused = rtc(&folder, &[verb, "bad.json", "--message-format", "sarif"]);
        let log: serde_json::Value = serde_json::from_slice(&refused.stderr).unwrap();
        assert!(
            code(&refused) == 1
                && refused.stdout.is_empty()
                && log["runs"][0]["results"][0].is_object()
        );
    }
}

#[test]
fn a_failed_render_keeps_the_picture_of_before() {
    let folder = folder();
    fs::write(folder.path().join("bad.png"), "before").unwrap();
    assert_eq!(code(&rtc(&folder, &["render", "bad.json"])), 1);
    assert_eq!(fs::read(folder.path().join("bad.png")).unwrap(), b"before");
    fs::create_dir(folder.path().join("taken.png")).unwrap();
    let refused = rtc(&folder, &["render", "ball.json", "-o", "taken.png"]);
    assert!(
        code(&refused) == 2 && stderr(&refused).contains("can't write `taken.png`"),
        "{}",
        stderr(&refused)
    );
    let nowhere = rtc(
        &folder,
        &["render", "ball.json", "-o", "no/such/folder.png"],
    );
    assert_eq!(
        stderr(&nowhere),
        "error: can't write `no/such/folder.png`: No such file or directory (os error 2)\n"
    );
    assert_eq!(
        names(folder.path()),
        ["away.json", "bad.json", "bad.png", "ball.json", "taken.png"]
    );
}

#[test]
fn a_closed_pipe_is_success() {
    let folder = folder();
    let mut child = command(folder.path(), &["explain", "--all"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let mut child = command(folder.path(), &["check", "bad.json"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(1));
}

#[test]
fn rtc_tells_about_itself() {
    let folder = folder();
    let stdout = |args: &[&str]| String::from_utf8(rtc(&folder, args).stdout).unwrap();
    assert!(stdout(&["-V"]).contains("reads IR versions up to 3"));
    assert!(stdout(&["explain", "rd001"]).starts_with("## RD001 (warning): "));
    assert!(stdout(&["completions", "bash"]).contains("_rtc"));
    assert!(stdout(&["man", "render"]).contains("supersampling"));
    for page in [&["man"][..], &["man", "render"]] {
        let page = stdout(page);
        let head = page.lines().find(|line| line.starts_with(".TH ")).unwrap();
        assert!(
            head.ends_with(concat!("rtc ", env!("CARGO_PKG_VERSION"), "\""))
                || head.contains(env!("CARGO_PKG_VERSION"))
        );
        assert!(
            !page.lines().any(|line| line.starts_with("writes IR")),
            "{head}"
        );
    }
    for format in ["scene", "ir"] {
        serde_json::from_str::<serde_json::Value>(&stdout(&["schema", format])).unwrap();
    }
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn a_new_file_is_for_all_and_an_old_one_keeps_its_permissions() {
        let folder = folder();
        let mode = |name: &str| {
            fs::metadata(folder.path().join(name))
                .unwrap()
                .permissions()
                .mode()
                & 0o777
        };
        fs::write(folder.path().join("plain"), "").unwrap();
        fs::write(folder.path().join("old.png"), "").unwrap();
        fs::set_permissions(
            folder.path().join("old.png"),
            fs::Permissions::from_mode(0o640),
        )
        .unwrap();
        for name in ["new.png", "old.png"] {
            assert_eq!(code(&rtc(&folder, &["render", "ball.json", "-o", name])), 0);
        }
        assert_eq!((mode("new.png"), mode("old.png")), (mode("plain"), 0o640));
    }

    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = folder();
        fs::write(folder.path().join("real.png"), "").unwrap();
        symlink("real.png", folder.path().join("link.png")).unwrap();
        symlink("/dev/null", folder.path().join("null.png")).unwrap();
        for name in ["link.png", "null.png"] {
            assert_eq!(code(&rtc(&folder, &["render", "ball.json", "-o", name])), 0);
            assert!(
                fs::symlink_metadata(folder.path().join(name))
                    .unwrap()
                    .is_symlink()
            );
        }
        assert!(
            fs::read(folder.path().join("real.png"))
                .unwrap()
                .starts_with(b"\x89PNG")
        );
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn what_is_read_only_is_not_replaced() {
        let folder = folder();
        fs::write(folder.path().join("kept.png"), "before").unwrap();
        fs::set_permissions(
            folder.path().join("kept.png"),
            fs::Permissions::from_mode(0o444),
        )
        .unwrap();
        let refused = rtc(&folder, &["render", "ball.json", "-o", "kept.png"]);
        assert_eq!(
            (
                code(&refused),
                fs::read(folder.path().join("kept.png")).unwrap()
            ),
            (2, b"before".to_vec())
        );
    }
}
