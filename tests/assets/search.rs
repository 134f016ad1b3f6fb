//! Where the files a scene names are looked for, and which are refused.

use super::{IMAGE, MESH, bring, folder, lowered, pixels, png, write};
use rtc::diag::Sink;
use rtc::front::Options;
use rtc::front::course::assets::{self, Asset, Wanted};
use rtc::ir::TextureId;
use rtc::source::{SourceMap, Span};
use std::fs;
use tempfile::TempDir;

/// Brings a picture named `path`, with these files around; the first byte of what was found, and
/// the findings with the folder called `F`.
fn found(files: &[(&str, u8)], path: &str, root: Option<&str>) -> (Option<u8>, String) {
    let folder = folder();
    for (name, grey) in files {
        write(&folder, name, png([*grey; 3]));
    }
    let options = Options {
        asset_root: root.map(|root| folder.path().join(root)),
        ..Options::default()
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
    let absent = "RE001 error scene.yaml:1:3 there is no file `t/a.png`\n  looked for it at `F/inner/t/a.png`, `F/t/a.png`, \
                  `F/inner/a.png`, `F/a.png`\n";
    assert_eq!(found(&[], "t/a.png", None), (None, absent.to_owned()));
    let outside = "RE002 error scene.yaml:1:3 `/etc/a.png` leads out of the folder of the scene\n  looked for it at \
                   `F/inner/etc/a.png`, `F/etc/a.png`, `F/inner/a.png`, `F/a.png`\n  put the file beside the scene, or \
                   allow its folder by `--asset-root`\n";
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

#[cfg(unix)]
#[test]
fn links_that_leave_the_folder_and_what_is_no_file_are_refused() {
    let (folder, elsewhere) = (folder(), TempDir::new().unwrap());
    fs::write(elsewhere.path().join("a.png"), png([9; 3])).unwrap();
    std::os::unix::fs::symlink(
        elsewhere.path().join("a.png"),
        folder.path().join("inner/a.png"),
    )
    .unwrap();
    std::os::unix::fs::symlink(elsewhere.path(), folder.path().join("inner/away")).unwrap();
    std::os::unix::fs::symlink("real.png", folder.path().join("inner/within.png")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("inner/zero.png")).unwrap();
    write(&folder, "inner/real.png", png([3; 3]));
    let scene = folder.path().join("inner/scene.yaml");
    for path in ["a.png", "away/a.png"] {
        let outcome = bring(&scene, IMAGE, path, &Options::default());
        assert!(
            outcome.findings.starts_with("RE002 error"),
            "{path}: {}",
            outcome.findings
        );
    }
    for path in ["zero.png", "A.PNG"] {
        assert!(
            bring(&scene, IMAGE, path, &Options::default()).errors,
            "{path}"
        );
    }
    let allowed = Options {
        asset_root: Some(elsewhere.path().to_owned()),
        ..Options::default()
    };
    assert_eq!(pixels(&bring(&scene, IMAGE, "a.png", &allowed))[0], 9);
    assert_eq!(
        pixels(&bring(&scene, IMAGE, "within.png", &Options::default()))[0],
        3
    );
}

/// What is said of a mesh named `path`, with this text there.
fn told(place: &str, text: &str, path: &str, options: &Options) -> String {
    let folder = folder();
    write(&folder, place, text);
    bring(&folder.path().join("inner/scene.yaml"), MESH, path, options).findings
}

#[test]
fn the_folder_above_lends_meshes_and_pictures_alone() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let options = Options::default();
    assert_eq!(told("a.obj", mesh, "a.obj", &options), "");
    assert_eq!(
        told("deep/a.OBJ", mesh, "deep/a", &options)
            .split(' ')
            .next(),
        Some("RE003")
    );
    for (place, text) in [
        ("a.txt", mesh),
        ("a", mesh),
        ("a.obj", "secret: 1\n"),
        ("a.obj", ""),
        (".a.obj", mesh),
        (".deep/a.obj", mesh),
        (".deep/.a/a.obj", mesh),
    ] {
        let findings = told(place, text, place, &options);
        assert!(
            findings.starts_with("RE002 error") && !findings.contains("secret"),
            "{place}: {findings}"
        );
        // The scene's own folder and one that the user allows may hold such a file.
        assert!(
            !told(&format!("inner/{place}"), text, place, &options).starts_with("RE002"),
            "{place}"
        );
    }
    let folder = folder();
    write(&folder, ".env.obj", mesh);
    let allowed = Options {
        asset_root: Some(folder.path().to_owned()),
        ..Options::default()
    };
    assert_eq!(
        bring(
            &folder.path().join("inner/scene.yaml"),
            MESH,
            ".env.obj",
            &allowed
        )
        .findings,
        ""
    );
    for (name, code) in [("a.png", None), ("a.jpg", None), ("a.txt", Some("RE002"))] {
        let (grey, findings) = found(&[(name, 7)], name, None);
        assert_eq!(
            (grey.is_none(), findings.get(..5)),
            (code.is_some(), code),
            "{name}"
        );
    }
}

#[test]
fn a_home_lends_nothing_to_the_scenes_in_its_folders() {
    let folder = folder();
    write(&folder, "a.png", png([5; 3]));
    let scene = folder.path().join("inner/scene.yaml");
    let home = Options {
        home: Some(folder.path().to_owned()),
        ..Options::default()
    };
    let outcome = bring(&scene, IMAGE, "a.png", &home);
    assert!(
        outcome.findings.starts_with("RE001 error"),
        "{}",
        outcome.findings
    );
    assert!(
        !outcome.findings.contains("inner`, ")
            && !bring(&scene, IMAGE, "a.png", &Options::default()).errors
    );
    let allowed = Options {
        asset_root: Some(folder.path().to_owned()),
        ..home
    };
    assert_eq!(pixels(&bring(&scene, IMAGE, "a.png", &allowed))[0], 5);
}

/// The scene lies in `/tmp`, so the folder above is `/`.
#[cfg(target_os = "linux")]
#[test]
fn the_root_lends_nothing() {
    let scene = tempfile::Builder::new()
        .suffix(".yaml")
        .tempfile_in("/tmp")
        .unwrap();
    fs::write(scene.path(), "a: b.c\n").unwrap();
    for path in [
        "proc/self/environ",
        "etc/passwd",
        "/proc/self/environ",
        "../../../proc/self/environ",
    ] {
        let findings = bring(scene.path(), MESH, path, &Options::default()).findings;
        assert!(
            findings.starts_with("RE00") && findings.lines().count() <= 3,
            "{path}: {findings}"
        );
        let looked = findings.lines().nth(1).unwrap();
        assert!(
            !findings.contains("PATH=") && !looked.contains("`/proc"),
            "{path}: {findings}"
        );
    }
}

/// By the links as they are written `a.gltf` lies in one folder, by where they lead in another.
#[cfg(unix)]
#[test]
fn an_asset_is_read_where_it_was_judged() {
    let asset = |uri: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 4, "uri": "{uri}"}}]}}"#
        )
    };
    let folder = folder();
    write(&folder, "real/inner/scene.yaml", "a: b.c\n");
    write(&folder, "real/a.gltf", asset("near.bin"));
    write(&folder, "real/near.bin", "1234");
    write(&folder, "a.gltf", "TOKEN=secret\n");
    std::os::unix::fs::symlink("real/inner", folder.path().join("link")).unwrap();
    let scene = folder.path().join("link/scene.yaml");
    let gltf = Asset::Gltf([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]]);
    let findings = bring(&scene, gltf, "a.gltf", &Options::default()).findings;
    assert_eq!(findings, "GL046 note a.gltf:1:43 nothing refers to this\n");
    // Beside the scene a link leads out, to what is no asset and to what is no file.
    for target in ["/etc/passwd", "/dev/zero"] {
        let link = folder.path().join("real/inner/b.gltf");
        let _ = fs::remove_file(&link);
        std::os::unix::fs::symlink(target, link).unwrap();
        let findings = bring(&scene, gltf, "b.gltf", &Options::default()).findings;
        assert!(
            findings.starts_with("RE00") && !findings.contains("root:"),
            "{target}: {findings}"
        );
    }
    write(&folder, "real/inner/c.gltf", "TOKEN=secret\n");
    let findings = bring(&scene, gltf, "c.gltf", &Options::default()).findings;
    assert!(
        findings.starts_with("GL004 error scene.yaml:1:3 `") && !findings.contains("secret"),
        "{findings}"
    );
}

#[cfg(unix)]
#[test]
fn a_pipe_is_no_file() {
    let folder = folder();
    let pipe = folder.path().join("inner/a.png");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let findings = bring(
        &folder.path().join("inner/scene.yaml"),
        IMAGE,
        "a.png",
        &Options::default(),
    )
    .findings;
    assert!(findings.starts_with("RE001 error"), "{findings}");
}

#[test]
fn a_scene_from_a_stream_has_only_the_folder_that_is_allowed() {
    let folder = folder();
    write(&folder, "a.png", png([5; 3]));
    for (root, expected) in [(None, None), (Some(folder.path().to_owned()), Some(5))] {
        let (mut map, mut sink) = (SourceMap::default(), Sink::default());
        let mut lowered = lowered(&mut map);
        let file = map.add("<stdin>", b"x".to_vec());
        let wanted = vec![Wanted {
            asset: IMAGE,
            path: "a.png".to_owned(),
            span: Some(Span::new(file, 0, 1)),
        }];
        let options = Options {
            asset_root: root,
            ..Options::default()
        };
        assets::bring(&mut lowered, wanted, file, &options, &mut map, &mut sink);
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
    let lenient = Options {
        lenient: true,
        ..Options::default()
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
