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
    assert!(
        said.contains("note[IO006]: settings from `set/rtc.toml`"),
        "{said}"
    );
    assert_eq!(
        stderr(&rtc(&shelf, &["check", "-q", SCENE_BELOW]))
            .matches("IO006")
            .count(),
        0
    );
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
    assert!(exit == 0 && said.contains("warning[IO007]"), "{said}");
    let (exit, said) = checked(&shelf, &["--trust-project"]);
    assert!(exit == 0 && !said.contains("IO007"), "{said}");
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
}

/// A scene whose picture has more pixels than it may have by default, and an `rtc.toml` that lifts
/// all limits.
fn greedy() -> TempDir {
    let shelf = shelf(
        "[limits]\nmemory = \"4000GiB\"\npixels = \"4000GiB\"\nnodes = \"4000GiB\"\nrays = \"4000GiB\"\n",
    );
    let camera =
        "Camera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [20000, 20000]}";
    let scene = WARNED.replace("Eye: [0, 0, 50]", camera);
    fs::write(shelf.path().join(SCENE_BELOW), scene).unwrap();
    shelf
}

#[test]
fn a_strangers_file_lifts_no_limits() {
    let shelf = greedy();
    let (exit, said) = checked(&shelf, &[]);
    assert!(exit == 1 && said.contains("error[VA009]"), "{said}");
    assert_eq!(said.matches("warning[IO007]").count(), 4, "{said}");
    let (exit, said) = checked(&shelf, &["--trust-project"]);
    assert!(exit == 0 && !said.contains("IO007"), "{said}");
}

#[cfg(unix)]
#[test]
fn the_user_trusts_folders_by_settings_of_their_own() {
    use std::os::unix::fs::PermissionsExt;
    let (shelf, home) = (greedy(), tempfile::tempdir().unwrap());
    let config = home.path().join("rtc/config.toml");
    fs::create_dir(home.path().join("rtc")).unwrap();
    let check = |text: &str, mode: u32| {
        fs::write(&config, text).unwrap();
        fs::set_permissions(&config, fs::Permissions::from_mode(mode)).unwrap();
        let made = Command::new(env!("CARGO_BIN_EXE_rtc"))
            .args(["check", SCENE_BELOW])
            .current_dir(shelf.path())
            .env("XDG_CONFIG_HOME", home.path())
            .output();
        code(&made.unwrap())
    };
    let list = |folder: &Path| format!("trusted-projects = [\"/none\", {folder:?}]\n");
    assert_eq!(check(&list(&shelf.path().join("set")), 0o600), 0);
    assert_eq!(check(&list(shelf.path()), 0o664), 0);
    assert_eq!(check(&list(shelf.path()), 0o666), 1, "others may write it");
    assert_eq!(check(&list(&shelf.path().join("set/deep")), 0o600), 1);
    for wrong in [
        "trusted = []",
        "trusted-projects = 1",
        "trusted-projects = [1]",
        "[",
    ] {
        assert_eq!(check(wrong, 0o600), 2, "{wrong}");
    }
}

#[cfg(unix)]
#[test]
fn what_others_may_have_written_is_not_read() {
    use std::os::unix::fs::PermissionsExt;
    let shelf = shelf("[levels]\nwarnings = \"deny\"\n");
    let file = shelf.path().join("set/rtc.toml");
    assert_eq!(checked(&shelf, &[]).0, 1);
    fs::set_permissions(&file, fs::Permissions::from_mode(0o666)).unwrap();
    let (exit, said) = checked(&shelf, &[]);
    assert!(
        exit == 0 && said.contains("warning[IO007]: `set/rtc.toml` is not read"),
        "{said}"
    );
    assert_eq!(checked(&shelf, &["--trust-project"]).0, 1);
}

/// Nothing of what it leads to is told, not even whether it is there.
#[cfg(unix)]
#[test]
fn a_link_that_leaves_its_folder_is_not_read() {
    use std::os::unix::fs::symlink;
    let shelf = shelf("");
    let file = shelf.path().join("set/rtc.toml");
    fs::write(shelf.path().join("secret"), "password hunter2\n").unwrap();
    let reported = |target: &str| {
        fs::remove_file(&file).unwrap();
        symlink(target, &file).unwrap();
        let trusted = checked(&shelf, &["--trust-project"]);
        let said = checked(&shelf, &[]);
        assert!(!said.1.contains("hunter2") && said == trusted, "{}", said.1);
        said
    };
    let (exit, said) = reported("../secret");
    assert!(
        exit == 0 && said.contains("it is a link that leaves its folder"),
        "{said}"
    );
    assert_eq!(reported("../absent").1, said);
    assert_eq!(reported("/dev/zero").1, said);
    fs::write(
        shelf.path().join("set/own.toml"),
        "[levels]\nwarnings = \"deny\"\n",
    )
    .unwrap();
    assert_eq!(
        reported("own.toml").0,
        1,
        "within its folder it is followed"
    );
}

/// It may be that of somebody else, in a folder above.
#[cfg(unix)]
#[test]
fn one_that_cannot_be_read_is_a_warning() {
    let shelf = shelf("[levels]\nwarnings = \"deny\"\n");
    let file = shelf.path().join("set/rtc.toml");
    assert_eq!(checked(&shelf, &[]).0, 1);
    fs::write(&file, "#".repeat((64 << 10) + 1)).unwrap();
    let (exit, said) = checked(&shelf, &[]);
    assert_eq!(exit, 0, "{said}");
    assert!(
        said.contains("warning[IO007]: `set/rtc.toml` is not read: it is larger than 64 KiB"),
        "{said}"
    );
    let made = rtc(
        &shelf,
        &["render", SCENE_BELOW, "--size", "4", "-o", "a.png"],
    );
    assert_eq!(code(&made), 0, "{}", stderr(&made));
}
