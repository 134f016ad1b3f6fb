//! `rtc check --fix`, `--diff` and `--unsafe`.

use super::*;

/// A scene with a slip that has one reading, one that needs a guess, comments, and line ends of
/// another system.
const TYPED: &str = "# A ball.\r\nEye: [0 0 50]  # far away\r\nShadws: true\r\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\r\nObjects:\r\n\
- {type: sphere, position: [0, 0, 0], radius: '3', material: {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}}\r\n";

fn put(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.yaml"), text).unwrap();
    folder
}

fn text(folder: &TempDir) -> String {
    fs::read_to_string(folder.path().join("a.yaml")).unwrap()
}

#[test]
fn what_has_one_reading_is_fixed_and_guesses_wait() {
    let folder = put(TYPED);
    let fixed = rtc(&folder, &["check", "--fix", "a.yaml"]);
    let said = stderr(&fixed);
    assert_eq!(code(&fixed), 0, "{said}");
    let sure = TYPED.replace("[0 0 50]", "[0, 0, 50]").replace("'3'", "3");
    assert_eq!(text(&folder), sure);
    assert!(said.contains("a.yaml: 2 changes made"), "{said}");
    assert!(said.contains("`--unsafe` applies"), "{said}");
    let guessed = rtc(&folder, &["check", "--fix", "--unsafe", "a.yaml"]);
    assert!(guessed.status.success() && !stderr(&guessed).contains("warning["));
    assert_eq!(text(&folder), sure.replace("Shadws", "Shadows"));
    let again = rtc(&folder, &["check", "--fix", "--unsafe", "a.yaml"]);
    assert!(again.status.success() && again.stderr.is_empty());
}

#[test]
fn a_diff_is_shown_and_nothing_is_written() {
    let folder = put(TYPED);
    let before = fs::metadata(folder.path().join("a.yaml")).unwrap();
    let shown = rtc(&folder, &["check", "--fix", "--diff", "-q", "a.yaml"]);
    assert_eq!(code(&shown), 1, "the file is as it was, with its errors");
    let diff = String::from_utf8(shown.stdout).unwrap();
    assert!(diff.starts_with("--- a.yaml\n+++ a.yaml\n@@ -1,6 +1,6 @@\n"));
    assert!(diff.contains("\n-Eye: [0 0 50]  # far away\r\n+Eye: [0, 0, 50]  # far away\r\n"));
    let after = fs::metadata(folder.path().join("a.yaml")).unwrap();
    assert_eq!(text(&folder), TYPED);
    assert_eq!(after.modified().unwrap(), before.modified().unwrap());
}

/// With the colon in place the scene would be read, and has other errors.
#[test]
fn a_change_that_brings_new_errors_is_left_out() {
    let typed = "Eye: [0, 0, 50]\nLights: []\nObjects:\n- type: sphere\n  radius = 3\n";
    let folder = put(typed);
    let left = rtc(&folder, &["check", "--fix", "--unsafe", "a.yaml"]);
    assert_eq!((code(&left), text(&folder)), (1, typed.to_owned()));
    assert!(
        stderr(&left).contains("a.yaml: 1 change left out"),
        "{}",
        stderr(&left)
    );
}

/// The number in a map is mended, and no key is replaced by a value.
#[test]
fn a_value_never_takes_the_place_of_a_key() {
    for (factor, repaired) in [("{factor: 0}", "{factor: 1}"), ("0", "1")] {
        let typed = format!(
            "Eye: [0, 0, 50]\nSuperSampling: {factor}\nLights: [{{position: [9, 9, 90], color: [1, 1, 1]}}]\nObjects: []\n"
        );
        let folder = put(&typed);
        let fixed = rtc(&folder, &["check", "--fix", "--unsafe", "a.yaml"]);
        assert_eq!(code(&fixed), 0, "{}", stderr(&fixed));
        let wanted = typed.replace(
            &format!("Sampling: {factor}"),
            &format!("Sampling: {repaired}"),
        );
        assert_eq!(text(&folder), wanted);
    }
}

#[test]
fn guesses_need_a_fix_and_a_fix_needs_a_file() {
    let folder = put(TYPED);
    assert_eq!(code(&rtc(&folder, &["check", "--unsafe", "a.yaml"])), 2);
    let mut stdin = command(folder.path(), &["check", "--fix", "-"]);
    let piped = fs::File::open(folder.path().join("a.yaml")).unwrap();
    let refused = stdin.stdin(piped).output().unwrap();
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("standard input can't be fixed"));
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = put(TYPED);
    let path = |name: &str| folder.path().join(name);
    fs::rename(path("a.yaml"), path("own.yaml")).unwrap();
    symlink("own.yaml", path("a.yaml")).unwrap();
    fs::set_permissions(path("own.yaml"), fs::Permissions::from_mode(0o640)).unwrap();
    assert!(rtc(&folder, &["check", "--fix", "a.yaml"]).status.success());
    assert!(fs::symlink_metadata(path("a.yaml")).unwrap().is_symlink());
    let own = fs::metadata(path("own.yaml")).unwrap();
    assert_eq!(own.permissions().mode() & 0o777, 0o640);
    assert!(text(&folder).contains("[0, 0, 50]"));
    // What can't be written stays, and is told.
    fs::write(path("own.yaml"), TYPED).unwrap();
    fs::set_permissions(path("own.yaml"), fs::Permissions::from_mode(0o440)).unwrap();
    let refused = rtc(&folder, &["check", "--fix", "a.yaml"]);
    assert_eq!((code(&refused), text(&folder)), (2, TYPED.to_owned()));
    assert_eq!(names(folder.path()), ["a.yaml", "own.yaml"]);
}

/// No edit goes through a link that leaves its folder.
#[cfg(unix)]
#[test]
fn what_a_link_leads_out_to_is_not_edited() {
    let (folder, elsewhere) = (tempfile::tempdir().unwrap(), put(TYPED));
    std::os::unix::fs::symlink(
        elsewhere.path().join("a.yaml"),
        folder.path().join("a.yaml"),
    )
    .unwrap();
    for args in [&["check", "--fix", "a.yaml"][..], &["fmt", "a.yaml"]] {
        let refused = rtc(&folder, args);
        let said = stderr(&refused);
        assert!(
            code(&refused) == 2 && said.contains("it is a link that leaves its folder"),
            "{args:?}: {said}"
        );
        assert_eq!(text(&elsewhere), TYPED);
    }
}

/// Codes and severities of what `rtc check` finds in a file.
fn found(folder: &Path, name: &str) -> Vec<String> {
    let words = [
        "check",
        "--message-format",
        "json",
        "--max-errors",
        "1000",
        name,
    ];
    let output = command(folder, &words).output().unwrap();
    let lines = String::from_utf8(output.stdout).unwrap();
    let objects = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap());
    let reported = objects.filter_map(|own: serde_json::Value| {
        Some(format!(
            "{} {}",
            own["severity"].as_str()?,
            own["code"].as_str()?
        ))
    });
    let mut reported: Vec<_> = reported
        .filter(|reported| !reported.starts_with("note"))
        .collect();
    reported.sort();
    reported
}

/// Every broken text of tests/diagnostics: what is mended is gone, nothing else has come, and what can't be mended is left as
/// it was; mending again changes nothing.
#[test]
fn no_broken_scene_gets_worse() {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    let (mut fixed, mut left) = (0, 0);
    for family in fs::read_dir(all).unwrap().map(Result::unwrap) {
        let folder = tempfile::tempdir().unwrap();
        let mut scenes = Vec::new();
        for entry in fs::read_dir(family.path()).unwrap().map(Result::unwrap) {
            if entry.path().is_file() {
                let name = entry.file_name().into_string().unwrap();
                fs::copy(entry.path(), folder.path().join(&name)).unwrap();
                scenes.extend(name.ends_with(".yaml").then_some(name));
            }
        }
        for name in scenes {
            let own = folder.path().join(&name);
            let (text, before) = (fs::read(&own).unwrap(), found(folder.path(), &name));
            let fix = ["check", "--fix", "--unsafe", "-q", &name];
            rtc(&folder, &fix);
            let (repaired, after) = (fs::read(&own).unwrap(), found(folder.path(), &name));
            let mut rest = before.clone();
            // A scene that has errors no more is looked at more closely.
            let is_read = !after.iter().any(|own| own.starts_with("error"));
            for own in &after {
                match rest.iter().position(|other| other == own) {
                    Some(known) => drop(rest.remove(known)),
                    None => assert!(
                        is_read && own.starts_with("warning"),
                        "{name} has a new {own}: {before:?}"
                    ),
                }
            }
            assert_eq!(
                rest.is_empty(),
                repaired == text,
                "{name}: {before:?} {after:?}"
            );
            (fixed, left) = (
                fixed + usize::from(repaired != text),
                left + usize::from(repaired == text),
            );
            rtc(&folder, &fix);
            assert!(fs::read(&own).unwrap() == repaired, "{name} changes again");
        }
    }
    println!("{fixed} broken scenes mended, {left} left as they were, none worse");
    assert!(fixed >= 20 && left >= 20, "{fixed} {left}");
}
