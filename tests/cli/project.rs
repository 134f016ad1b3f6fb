//! `rtc.toml`: where it is found, what it sets, what goes before it, and what is wrong in it.

use super::*;

/// A scene with a misspelt key, which is a warning, in a folder below that of the settings.
const WARNED: &str = "Eye: [0, 0, 50]\nShadws: true\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjects:\n\
- {type: sphere, position: [0, 0, 0], radius: 3, material: {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}}\n";

fn shelf(settings: &str) -> TempDir {
    let shelf = tempfile::tempdir().unwrap();
    fs::create_dir_all(shelf.path().join("set/deep")).unwrap();
    fs::write(shelf.path().join("set/rtc.toml"), settings).unwrap();
    fs::write(shelf.path().join("set/deep/a.yaml"), WARNED).unwrap();
    shelf
}

const SCENE_BELOW: &str = "set/deep/a.yaml";

/// The exit code of a check, and what it says on one line each.
fn checked(shelf: &TempDir, args: &[&str]) -> (i32, String) {
    let fixed = ["check", SCENE_BELOW, "--message-format", "short"];
    let output = rtc(shelf, &[&fixed, args].concat());
    (code(&output), stderr(&output))
}

#[test]
fn the_nearest_above_a_scene_holds_up_to_the_root_of_its_repository() {
    let shelf = shelf("[levels]\nwarnings = \"deny\"\n");
    assert_eq!(checked(&shelf, &[]).0, 1);
    let (exit, said) = checked(&shelf, &["-v", "--warn", "warnings"]);
    assert_eq!(exit, 0, "the command line goes before: {said}");
    assert!(said.contains("settings from `set/rtc.toml`"), "{said}");
    fs::write(shelf.path().join("set/deep/rtc.toml"), "").unwrap();
    assert_eq!(checked(&shelf, &[]).0, 0, "the nearest alone");
    fs::remove_file(shelf.path().join("set/deep/rtc.toml")).unwrap();
    fs::create_dir(shelf.path().join("set/deep/.git")).unwrap();
    assert_eq!(checked(&shelf, &[]).0, 0, "not out of a repository");
}

#[test]
fn levels_and_limits_hold_where_no_flag_does() {
    let shelf = shelf(
        "[limits]\nmemory = \"2GiB\"\nnodes = 3\n[levels]\nSC002 = \"deny\"\nwarnings = \"allow\"\n",
    );
    let (exit, said) = checked(&shelf, &[]);
    assert_eq!(exit, 1);
    assert!(!said.contains("rtc.toml"), "nothing is wrong in it: {said}");
    let pixels = "[limits]\npixels = 5\n";
    fs::write(shelf.path().join("set/rtc.toml"), pixels).unwrap();
    let (exit, said) = checked(&shelf, &[]);
    assert!(exit == 1 && said.contains("pixels"), "{said}");
    assert_eq!(checked(&shelf, &["--limit", "pixels=5000000"]).0, 0);
    assert_eq!(checked(&shelf, &["--allow-huge"]).0, 0);
}

#[test]
fn pictures_are_made_as_it_says_and_compiled_scenes_as_they_say() {
    let shelf = shelf("[render]\nsize = \"8x6\"\nsupersampling = 2\nspp = 4\n");
    let size = |args: &[&str]| {
        let made = rtc(&shelf, &[&["render", "-o", "a.png"], args].concat());
        let said = stderr(&made);
        assert_eq!(code(&made), 0, "{said}");
        assert!(
            !said.contains("changes nothing"),
            "no flag was typed: {said}"
        );
        let line = said
            .lines()
            .find(|line| line.contains('×'))
            .unwrap()
            .to_owned();
        line.split(", ").next().unwrap().to_owned()
    };
    assert_eq!(size(&[SCENE_BELOW]), "a.png: 8×6");
    assert_eq!(size(&[SCENE_BELOW, "--size", "4"]), "a.png: 4×4");
    let whole = "Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [12, 9]}\nLights: []\nObjects: []\n";
    fs::write(shelf.path().join("set/b.yaml"), whole).unwrap();
    let compiled = rtc(&shelf, &["compile", "set/b.yaml", "-o", "set/b.rtir"]);
    assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
    assert_eq!(size(&["set/b.rtir"]), "a.png: 12×9");
}

#[test]
fn files_may_lie_in_its_asset_root_which_lies_with_it() {
    let shelf = shelf("asset-root = \"assets\"\n");
    let scene = WARNED.replace("color: [1, 0, 0]", "texture: ../assets/t.png");
    fs::write(shelf.path().join(SCENE_BELOW), &scene).unwrap();
    assert_eq!(checked(&shelf, &[]).0, 1, "there is no such folder");
    fs::create_dir(shelf.path().join("set/assets")).unwrap();
    let made = rtc(
        &shelf,
        &[
            "render",
            "-q",
            "--size",
            "4",
            "set/deep/b.json",
            "-o",
            "set/assets/t.png",
        ],
    );
    assert_eq!(code(&made), 2);
    fs::write(shelf.path().join("set/deep/b.json"), SCENE).unwrap();
    let made = rtc(
        &shelf,
        &[
            "render",
            "-q",
            "--size",
            "4",
            "set/deep/b.json",
            "-o",
            "set/assets/t.png",
        ],
    );
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    let (exit, said) = checked(&shelf, &[]);
    assert_eq!(exit, 0, "{said}");
    fs::write(
        shelf.path().join("set/rtc.toml"),
        "asset-root = \"../..\"\n",
    )
    .unwrap();
    let (exit, said) = checked(&shelf, &[]);
    assert!(exit == 1 && said.contains("error[IO004]"), "{said}");
}

#[test]
fn mistakes_are_told_all_and_with_their_place() {
    let wrong = "asset_root = \"x\"\nlevels = 3\n[limits]\nmemori = 1\npixels = \"many\"\n[render]\nspp = 0\nsize = [1, 2]\n";
    let shelf = shelf(wrong);
    let (exit, said) = checked(&shelf, &[]);
    assert_eq!(exit, 1);
    for words in [
        "set/rtc.toml:1:1: warning[IO005]: unknown key `asset_root`",
        "set/rtc.toml:2:10: error[IO004]: `levels` is a table",
        "set/rtc.toml:4:1: warning[IO005]: unknown key `memori`",
        "set/rtc.toml:5:10: error[IO004]: `pixels` is a number",
        "set/rtc.toml:7:7: error[IO004]: `spp` is a whole number",
        "set/rtc.toml:8:8: error[IO004]: `size` is the width",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let hints = stderr(&rtc(&shelf, &["check", SCENE_BELOW]));
    assert!(
        hints.contains("`asset-root`") && hints.contains("`memory`"),
        "{hints}"
    );
    for (text, words) in [
        ("[levels]\nVA001 = \"allow\"\n", "`VA001` is an error"),
        ("[levels]\nVA0044 = \"deny\"\n", "did you mean `VA004`?"),
        ("[levels]\nVA004 = \"error\"\n", "a level is"),
        ("[levels\n", "this is no TOML"),
    ] {
        fs::write(shelf.path().join("set/rtc.toml"), text).unwrap();
        let (exit, said) = checked(&shelf, &[]);
        assert!(exit == 1 && said.contains(words), "{text}: {said}");
    }
    fs::write(shelf.path().join("set/rtc.toml"), "#".repeat(70_000)).unwrap();
    assert_eq!(checked(&shelf, &[]).0, 2, "it is too large");
}
