//! Where mistyped commands lead.

use super::*;

/// The words of a refused command.
fn refused(folder: &TempDir, args: &[&str]) -> String {
    let output = rtc(folder, args);
    assert_eq!((code(&output), output.stdout.len()), (2, 0), "{args:?}");
    stderr(&output)
}

/// The ball, its paths traced.
fn folder_with_paths() -> TempDir {
    let folder = folder();
    let paths = r#"{"path": {"samples": 4, "multipleScattering": true}}"#;
    let paths = scene_with("\"phong\", \"shadows\"", &format!("{paths}, \"shadows\""));
    fs::write(
        folder.path().join("paths.json"),
        paths.replacen("1,", "3,", 1),
    )
    .unwrap();
    folder
}

#[test]
fn a_scene_without_a_subcommand_leads_to_render() {
    let folder = folder();
    for args in [&["ball.json"][..], &["ball.json", "-o", "x.png"]] {
        let said = refused(&folder, args);
        assert!(
            said.contains("tip: did you mean `rtc render ball.json`?"),
            "{said}"
        );
    }
    assert!(refused(&folder, &["none.glb"]).contains("`rtc render none.glb`"));
    let said = refused(&folder, &["rendr", "ball.json"]);
    assert!(
        said.contains("'render'") && !said.contains("did you mean"),
        "{said}"
    );
}

#[test]
fn one_number_is_both_sides() {
    let folder = folder();
    let made = rtc(&folder, &["render", "ball.json", "--size", "24", "-o", "-"]);
    let picture = image::load_from_memory(&made.stdout).unwrap();
    assert_eq!((picture.width(), picture.height()), (24, 24));
}

#[test]
fn samples_that_change_nothing_are_told() {
    let folder = folder_with_paths();
    let reported = |args: &[&str]| {
        let output = rtc(
            &folder,
            &[&["render", "--size", "4", "-o", "-"], args].concat(),
        );
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    let wrong = reported(&["ball.json", "--spp", "4"]);
    assert!(
        wrong.contains("warning: `--spp` has no effect") && wrong.contains("`--supersampling N`"),
        "{wrong}"
    );
    let wrong = reported(&["paths.json", "--supersampling", "2"]);
    assert!(
        wrong.contains("warning: `--supersampling` has no effect") && wrong.contains("`--spp N`"),
        "{wrong}"
    );
    for args in [
        &["ball.json", "--supersampling", "2"][..],
        &["paths.json", "--spp", "2"],
        &["ball.json", "--spp", "4", "-q"],
    ] {
        assert!(!reported(args).contains("has no effect"), "{args:?}");
    }
}
