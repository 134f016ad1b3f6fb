//! Where the files a scene names are looked for.

use super::{IMAGE, MESH, bring, folder, lowered, pixels, png, write};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::front::FrontOptions;
use rtc::internals::front::course::UnfinishedScene;
use rtc::internals::front::course::assets::{self, PendingAsset};
use rtc::internals::ir::TextureId;
use rtc::internals::source::{SourceMap, Span};

/// Brings a picture named `path`, with these files around; the first byte of what was found, and
/// the findings with the folder called `F`.
pub(super) fn found(files: &[(&str, u8)], path: &str, root: Option<&str>) -> (Option<u8>, String) {
    let folder = folder();
    for (name, grey) in files {
        write(&folder, name, png([*grey; 3]));
    }
    let options = FrontOptions {
        asset_root: root.map(|root| folder.path().join(root)),
        ..FrontOptions::default()
    };
    let path = path.replace("F/", &format!("{}/", folder.path().display()));
    let outcome = bring(
        &folder.path().join("inner/scene.yaml"),
        IMAGE,
        &path,
        &options,
    );
    let findings = outcome
        .findings
        .replace(&folder.path().display().to_string(), "F");
    ((!outcome.errors).then(|| pixels(&outcome)[0]), findings)
}

#[test]
fn names_are_looked_for_beside_the_scene_and_then_above_it() {
    let both = [("inner/a.png", 1), ("a.png", 2)];
    assert_eq!(found(&both, "a.png", None), (Some(1), String::new()));
    assert_eq!(found(&both[1..], "a.png", None), (Some(2), String::new()));
    assert_eq!(
        found(&[("inner/t/a.png", 3)], "t\\a.png", None),
        (Some(3), String::new())
    );
    assert_eq!(
        found(&[("inner/t/a.png", 3)], "./x/../t/a.png", None),
        (Some(3), String::new())
    );
}

#[test]
fn names_of_other_places_are_replaced_by_their_tails_with_a_note() {
    let note = |written: &str, taken: &str| {
        format!("RE003 note scene.yaml:1:3 `{written}` is taken from `F/{taken}`\n")
    };
    let beside = [("inner/earth.png", 4)];
    for path in [
        "C:\\Users\\x\\earth.png",
        "/usr/share/earth.png",
        "../../earth.png",
        "textures/earth.png",
        "earth.png\t",
    ] {
        let shown = path.replace('\t', "\\t");
        assert_eq!(
            found(&beside, path, None),
            (Some(4), note(&shown, "inner/earth.png")),
            "{path}"
        );
    }
    let deeper = [("maps/earth.png", 5), ("earth.png", 6)];
    assert_eq!(
        found(&deeper, "../maps/earth.png", None),
        (Some(5), note("../maps/earth.png", "maps/earth.png"))
    );
    assert_eq!(
        found(&[("inner/Earth.PNG", 7)], "earth.png", None),
        (Some(7), note("earth.png", "inner/Earth.PNG"))
    );
}

#[test]
fn what_is_not_there_is_told_with_the_places() {
    let absent = "RE001 error scene.yaml:1:3 there is no file `t/a.png`\n  \
                  searched at `F/inner/t/a.png`, `F/t/a.png`, \
                  `F/inner/a.png`, `F/a.png`\n  \
                  put the file beside the scene, or allow its folder with `--asset-root`\n";
    assert_eq!(found(&[], "t/a.png", None), (None, absent.to_owned()));
    let outside = "RE002 error scene.yaml:1:3 `/etc/a.png` leaves the folder of the scene\n  \
                   searched at \
                   `F/inner/etc/a.png`, `F/etc/a.png`, `F/inner/a.png`, `F/a.png`\n  \
                  put the file beside the scene, or \
                   allow its folder with `--asset-root`\n";
    assert_eq!(found(&[], "/etc/a.png", None), (None, outside.to_owned()));
    assert_eq!(
        found(&[("other/a.png", 1)], "../other/../../a.png", None).0,
        None
    );
    for nothing in ["", " ", ".", "..", "/", "C:\\", "a\0b", "inner"] {
        assert!(
            found(&[], nothing, None).1.starts_with("RE00"),
            "{nothing:?}"
        );
    }
}

#[test]
fn a_folder_the_user_allows_is_looked_in_too() {
    let files = [("other/a.png", 8)];
    assert_eq!(
        found(&files, "a.png", Some("other")),
        (Some(8), String::new())
    );
    assert_eq!(
        found(&files, "../other/a.png", Some("other")),
        (Some(8), String::new())
    );
    let (grey, note) = found(&files, "F/other/a.png", Some("other"));
    assert!(grey == Some(8) && note.starts_with("RE003 note"), "{note}");
    assert_eq!(
        found(&files, "../other/a.png", Some("inner"))
            .1
            .lines()
            .count(),
        1,
        "by its tail, with a note"
    );
}

#[test]
fn a_scene_from_a_stream_has_only_the_folder_that_is_allowed() {
    let folder = folder();
    write(&folder, "a.png", png([5; 3]));
    for (root, expected) in [(None, None), (Some(folder.path().to_owned()), Some(5))] {
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let lowered = lowered(&mut map);
        let file = map.add("<stdin>", b"x".to_vec());
        let pending = vec![PendingAsset {
            target: IMAGE,
            path: "a.png".to_owned(),
            span: Some(Span::new(file, 0, 1)),
        }];
        let options = FrontOptions {
            asset_root: root,
            ..FrontOptions::default()
        };
        let draft = UnfinishedScene::new(lowered, pending);
        let lowered = assets::load(draft, file, &options, &mut map, &mut sink);
        let codes: Vec<_> = sink.kept().iter().map(|finding| finding.code.id).collect();
        assert_eq!(
            codes,
            if expected.is_none() {
                vec!["RE002"]
            } else {
                Vec::new()
            }
        );
        assert_eq!(lowered.scene.images[0].pixels[0], expected.unwrap_or(0));
    }
}

#[test]
fn lenient_leaves_textures_and_objects_out_and_says_so() {
    let folder = folder();
    let scene = folder.path().join("inner/scene.yaml");
    let lenient = FrontOptions {
        lenient: true,
        ..FrontOptions::default()
    };
    let outcome = bring(&scene, IMAGE, "a.png", &lenient);
    let message =
        "RE001 warning scene.yaml:1:3 there is no file `a.png`; the texture is left out\n";
    assert!(
        outcome.findings.starts_with(message),
        "{}",
        outcome.findings
    );
    let phong = outcome.lowered.scene.materials[0].phong().unwrap();
    assert_eq!(
        (phong.color_map, phong.specular_map, &phong.bump),
        (None, Some(TextureId(0)), &None)
    );
    write(&folder, "inner/cat.obj", "v 1 2 x\nv 1 2 y\n");
    let outcome = bring(&scene, MESH, "cat", &lenient);
    let expected = "RE006 warning cat.obj:1:7 `x` is not a number; the object is left out\n";
    assert!(
        outcome.findings.ends_with(expected) && !outcome.errors,
        "{}",
        outcome.findings
    );
}

/// A path relative to the folder in which a program was run: the root that the hint names finds it.
#[test]
fn a_path_that_climbs_is_told_of_the_root_that_finds_it() {
    let files = [("far/pictures/floor.png", 9)];
    let (none, told) = found(&files, "../pictures/floor.png", None);
    assert_eq!(none, None);
    assert!(
        told.contains("allow its folder with `--asset-root`"),
        "{told}"
    );
    assert_eq!(
        found(&files, "../pictures/floor.png", Some("far")).0,
        Some(9)
    );
}
