//! What a picture does to files that are there: permissions, links, devices, and what is read-only.

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
fn devices_stay_what_they_are() {
    let folder = folder();
    for name in ["/dev/null", "/dev/../dev/null"] {
        let args = ["compile", "ball.json", "--emit", "ir", "-o", name];
        assert_eq!(code(&rtc(&folder, &args)), 0);
    }
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

/// Wherever a file is meant.
#[test]
fn pipes_and_devices_are_no_files() {
    let folder = folder();
    let pipe = folder.path().join("pipe.png");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    fs::copy(
        pipe.with_file_name("ball.json"),
        folder.path().join("b.json"),
    )
    .unwrap();
    symlink("pipe.png", folder.path().join("pipe.yaml")).unwrap();
    let cases: [&[&str]; 7] = [
        &["check", "pipe.yaml"],
        &["render", "pipe.yaml"],
        &["fmt", "pipe.yaml"],
        &["diff", "pipe.png", "pipe.png"],
        &["diff", "/dev/zero.png", "pipe.png"],
        &["render", "ball.json", "--env", "pipe.png"],
        &["merge", "pipe.png", "-o", "x.png"],
    ];
    for args in cases {
        let refused = rtc(&folder, args);
        let said = stderr(&refused);
        assert_eq!(code(&refused), 2, "{args:?}: {said}");
        assert!(
            said.contains("no regular file") || args[1].starts_with("/dev"),
            "{args:?}: {said}"
        );
    }
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

/// Of a name nothing gets to a terminal or onto a page that commands it or turns a line round.
#[test]
fn names_of_files_are_printed_harmless() {
    let folder = tempfile::tempdir().unwrap();
    let [new, old] = ["a\u{1b}]0;x\u{7}\u{202e}\u{9b}.yaml", "b\u{202e}.yaml"];
    let scene = "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\n\
        Lights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjcts:   []\nObjects:\n\
        - {type: sphere, position: [0, 0, 0], radius: 3, material: \
        {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}}\n";
    let is_harmful = |text: &str| text.contains(['\u{1b}', '\u{7}', '\u{202e}', '\u{9b}']);
    for name in [new, old] {
        fs::write(folder.path().join(name), scene).unwrap();
    }
    let cases: [&[&str]; 12] = [
        &["check", new],
        &["check", "--fix", "--unsafe", "--diff", new],
        &["check", "--message-format", "json", new],
        &["fmt", "--check", new],
        &["fmt", "--diff", new],
        &["render", new, "-v"],
        &["render", new, "--message-format", "json"],
        &["render", new, "none\u{202e}.yaml"],
        &["diff", new, old, "--html", "page.html"],
        &["diff", new, old, "--json"],
        &["info", new],
        &[
            "compile",
            "--explain",
            new,
            "--emit",
            "ir",
            "-o",
            "/dev/null",
        ],
    ];
    for args in cases {
        let output = rtc(&folder, args);
        let said = stderr(&output) + &String::from_utf8_lossy(&output.stdout);
        assert!(!said.is_empty() && !is_harmful(&said), "{args:?}: {said:?}");
    }
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(!is_harmful(&page) && page.contains("\\u{202e}"));
    let printed = rtc(&folder, &["diff", new, old, "--json"]);
    assert!(serde_json::from_slice::<serde_json::Value>(&printed.stdout).is_ok());
}
