//! What strangers' scenes, names and files do to the hosts: comparisons, folders, audits, the
//! cache, the language server.

use crate::suite::needs;
use libtest_mimic::Trial;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_rtc");

/// The name of an input, and its test.
type NamedTest = (&'static str, fn(&Path));

/// The inputs, each in a folder of `../shared`.
const INPUTS: [NamedTest; 16] = [
    ("diff/a.gltf", |new| differ(new, "c.gltf")),
    ("diff/diff-scenes-without-lights-B.obj", |new| {
        differ(new, "diff-scenes-without-lights-A.obj");
    }),
    ("hosts/folder-same-stem", pictures_of_one_name),
    ("hosts/check-claims-homeassistant.yaml", is_skipped),
    ("hosts/check-claims-threejs.json", is_skipped),
    ("hosts/lsp-claims-k8s.yaml", |path| {
        let said = editor(path, (0, 2));
        assert!(!said.contains("\"severity\""), "{said}");
    }),
    ("hosts/lsp-hover-alias-in-effect-0.yaml", |path| {
        let said = editor(path, (11, 14));
        assert!(
            said.contains("material") && !said.contains("in effect `0`"),
            "{said}"
        );
    }),
    ("hosts/target-error-unmet-exit-0.yaml", target_is_unmet),
    ("hosts/cost-off-front.yaml", cost_is_no_better),
    (
        "hostile/audit-passes-apng-that-shows-red.png",
        other_frames_fail,
    ),
    ("hostile/audit-forgeries-png.py", forgeries_fail),
    (
        "hostile/cache-entry-forged-lengths-internal-error.py",
        forged_entries_are_damaged,
    ),
    (
        "hostile/hang-render-usd-camera-focal-length-9e18.usda",
        the_search_for_an_exposure_ends,
    ),
    ("hostile/mitsuba-serialized-name-bomb.make.py", |path| {
        made_file_is_refused(path, "m.xml", "MI002");
    }),
    ("hostile/pbrt-gz-lifts-limits.make.py", |path| {
        made_file_is_refused(path, "n.pbrt", "IO003");
    }),
    (
        "promises/parts-of-huge-scene-do-not-merge.yaml",
        parts_are_the_picture,
    ),
];

pub(crate) fn trials() -> Vec<Trial> {
    let trial =
        |(name, test): NamedTest| needs(format!("hosts/{name}"), &format!("round-4/{name}"), test);
    INPUTS.into_iter().map(trial).collect()
}

fn rtc(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(args).stdin(Stdio::null());
    command.output().unwrap()
}

/// The exit code, and all that was printed.
fn told(output: &Output) -> (i32, String) {
    let text = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    (output.status.code().unwrap(), text.concat())
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Two models without lights differ in light.
fn differ(new: &Path, old: &str) {
    let old = new.with_file_name(old);
    let files = [new, &old].map(|path| path.to_str().unwrap());
    let small = ["--size", "32x32", "--spp", "16", "--gate", "rmse<=2"];
    let (code, said) = told(&rtc(
        Path::new("."),
        &[&["diff"], &files[..], &small].concat(),
    ));
    assert!(
        code == 1 && said.contains("gate failed") && !said.contains("RD016"),
        "{said}"
    );
}

fn pictures_of_one_name(path: &Path) {
    let out = folder();
    let args = [
        "render",
        path.to_str().unwrap(),
        "-q",
        "--size",
        "8x8",
        "-o",
        "out/",
    ];
    let (code, said) = told(&rtc(out.path(), &args));
    assert_eq!((code, said.as_str()), (0, ""));
    for name in ["out/x/scene.png", "out/y/scene.png"] {
        assert!(out.path().join(name).exists(), "{name}");
    }
}

fn is_skipped(path: &Path) {
    let args = ["check", "--skip-others", path.to_str().unwrap()];
    let (code, said) = told(&rtc(Path::new("."), &args));
    assert!(code == 0 && said.contains("1 file skipped"), "{said}");
}

/// What the language server says of a file that is open, and of a position in it.
fn editor(path: &Path, (line, character): (u32, u32)) -> String {
    let uri = "file:///a.yaml";
    let text = fs::read_to_string(path).unwrap();
    let file = serde_json::json!({"uri": uri, "languageId": "yaml", "version": 1, "text": text});
    let place = serde_json::json!({"textDocument": {"uri": uri},
        "position": {"line": line, "character": character}});
    let nothing = serde_json::Value::Null;
    let messages = [
        (
            Some(1),
            "initialize",
            serde_json::json!({"capabilities": {}}),
        ),
        (
            None,
            "textDocument/didOpen",
            serde_json::json!({"textDocument": file}),
        ),
        (Some(2), "textDocument/hover", place.clone()),
        (
            Some(3),
            "textDocument/codeAction",
            serde_json::json!({"textDocument": {"uri": uri},
            "range": {"start": place["position"], "end": place["position"]},
            "context": {"diagnostics": []}}),
        ),
        (Some(4), "textDocument/hover", place),
        (Some(5), "shutdown", nothing.clone()),
        (None, "exit", nothing),
    ];
    let mut server = Command::new(PROGRAM)
        .arg("lsp")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = server.stdin.take().unwrap();
    for (id, method, params) in messages {
        let mut body = serde_json::json!({"jsonrpc": "2.0", "method": method, "params": params});
        id.into_iter().for_each(|id: u32| body["id"] = id.into());
        let body = body.to_string();
        write!(input, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
    }
    drop(input);
    let output = server.wait_with_output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

fn target_is_unmet(path: &Path) {
    let out = folder();
    let scene = path.to_str().unwrap();
    let args = ["render", scene, "--target-error", "0.5", "-o", "a.png"];
    let (code, said) = told(&rtc(out.path(), &args));
    assert!(code == 0 && said.contains("warning[RD017]"), "{said}");
    fs::remove_file(out.path().join("a.png")).unwrap();
    let (code, said) = told(&rtc(
        out.path(),
        &[&args[..], &["--deny", "RD017", "-q"]].concat(),
    ));
    assert!(code == 1 && said.contains("error[RD017]"), "{said}");
    assert!(out.path().join("a.png").exists(), "the picture is not lost");
}

fn cost_is_no_better(path: &Path) {
    let args = ["cost", path.to_str().unwrap(), "--effort", "quick"];
    let (code, said) = told(&rtc(Path::new("."), &args));
    let said = said.replace('\n', " ");
    assert!(code == 0 && said.contains("own setting"), "{said}");
    for times in ["0.99×", "1.00×", "1.01×", "1.02×"] {
        assert!(!said.contains(&format!("same error for {times}")), "{said}");
    }
}

fn other_frames_fail(path: &Path) {
    let scene = path.with_file_name("audit-scene.yaml");
    let files = [path, &scene].map(|path| path.to_str().unwrap());
    let (code, said) = told(&rtc(
        Path::new("."),
        &["audit", files[0], files[1], "--tiles", "99"],
    ));
    assert!(code == 1, "{said}");
}

/// Runs a script of Python in a folder where it finds `rtc`; what it prints.
fn script(path: &Path, folder: &Path) -> String {
    let programs = Path::new(PROGRAM).parent().unwrap();
    let others = std::env::var("PATH").unwrap_or_default();
    let output = Command::new("python3")
        .arg(path)
        .current_dir(folder)
        .env("PATH", format!("{}:{others}", programs.display()))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

fn forgeries_fail(path: &Path) {
    let out = folder();
    fs::copy(
        path.with_file_name("audit-scene.yaml"),
        out.path().join("s.yaml"),
    )
    .unwrap();
    let made = rtc(
        out.path(),
        &["render", "s.yaml", "--size", "64x64", "-o", "a.png"],
    );
    assert!(made.status.success());
    let said = script(path, out.path());
    let lines = said.lines().filter(|line| line.contains(" rc="));
    for line in lines {
        let passes = line.contains(" rc=0 ");
        assert_eq!(passes, line.starts_with("id.png"), "{line}");
    }
    assert!(
        said.contains("id.png") && said.contains("exif.png"),
        "{said}"
    );
}

fn the_search_for_an_exposure_ends(path: &Path) {
    let out = folder();
    let scene = path.to_str().unwrap();
    let words = "--size 4x3 --spp 1 --limit rays=2000 -o a.png";
    let args: Vec<&str> = ["render", scene]
        .into_iter()
        .chain(words.split(' '))
        .collect();
    let said = rtc(out.path(), &args);
    let words = String::from_utf8_lossy(&said.stderr);
    assert!(
        said.status.code() == Some(1) && words.contains("RD006"),
        "{words}"
    );
}

/// The file that a script makes is refused with a code.
fn made_file_is_refused(path: &Path, made: &str, code: &str) {
    let out = folder();
    script(path, out.path());
    let said = rtc(out.path(), &["check", made]);
    let words = String::from_utf8_lossy(&said.stderr);
    assert!(
        said.status.code() == Some(1) && words.contains(&format!("error[{code}]")),
        "{words}"
    );
}

fn parts_are_the_picture(path: &Path) {
    let out = folder();
    fs::copy(path, out.path().join("s.yaml")).unwrap();
    for words in [
        "render -q s.yaml -o whole.png",
        "render -q s.yaml --part 1/2 -o 1.rtp",
        "render -q s.yaml --part 2/2 -o 2.rtp",
        "merge 1.rtp 2.rtp -o merged.png",
    ] {
        let args: Vec<&str> = words.split(' ').collect();
        let said = rtc(out.path(), &args);
        let told = String::from_utf8_lossy(&said.stderr);
        assert!(said.status.success(), "{words}: {told}");
    }
    let bytes = |name: &str| fs::read(out.path().join(name)).unwrap();
    assert!(bytes("whole.png") == bytes("merged.png"));
}

fn forged_entries_are_damaged(path: &Path) {
    let out = folder();
    fs::copy(
        path.with_file_name("audit-scene.yaml"),
        out.path().join("s.yaml"),
    )
    .unwrap();
    let args = [
        "render", "s.yaml", "--size", "32x32", "-o", "a.png", "--cache", "c", "-v",
    ];
    assert!(rtc(out.path(), &args).status.success());
    let said = script(path, out.path());
    assert!(said.contains("identity"), "{said}");
    for word in ["internal error", "panicked", "\\x1b", " 101 ", " 2 b'"] {
        assert!(!said.contains(word), "{word}: {said}");
    }
}
