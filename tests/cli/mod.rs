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
#[cfg(unix)]
mod action;
mod audit;
mod cache;
mod checkpoints;
mod diff;
mod exposure;
mod farm;
mod files;
mod fixes;
mod forms;
mod framing;
mod info;
mod interplay;
mod layouts;
mod levels;
#[cfg(unix)]
mod links;
mod looks;
#[cfg(unix)]
mod lsp;
mod mesh;
mod new;
mod numbers;
#[cfg(unix)]
mod outputs;
mod parts;
#[cfg(unix)]
mod preview;
mod project;
mod rays;
mod render;
mod reports;
#[cfg(unix)]
mod running;
mod schemas;
mod set;
#[cfg(unix)]
mod settings;
mod stage;
mod strips;
mod studio;
mod suggestions;
mod texts;
mod to_gltf;
mod twins;
#[cfg(unix)]
mod unix;
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
    assert_eq!(code(&["check", "."]), 1);
    assert_eq!(code(&["render", "ball.json", "-o", "x.bmp"]), 2);
    assert_eq!(
        code(&["render", "ball.json", "-o", "x.exr", "--bits", "8"]),
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
    assert!(compiled.stdout.starts_with(b"{\n  \"irVersion\": 5") && compiled.stderr.is_empty());
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
    assert!(stdout(&["-V"]).contains("reads IR versions up to 5"));
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
