//! What lies outside the folder of a scene: which of it is lent, and what no name leads to.

use super::search::found;
use super::{IMAGE, MESH, bring, folder, pixels, png, write};
use rtc::internals::front::FrontOptions;
use rtc::internals::front::course::assets::AssetTarget;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

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
        let outcome = bring(&scene, IMAGE, path, &FrontOptions::default());
        assert!(
            outcome.findings.starts_with("RE002 error"),
            "{path}: {}",
            outcome.findings
        );
    }
    for path in ["zero.png", "A.PNG"] {
        assert!(
            bring(&scene, IMAGE, path, &FrontOptions::default()).errors,
            "{path}"
        );
    }
    let allowed = FrontOptions {
        asset_root: Some(elsewhere.path().to_owned()),
        ..FrontOptions::default()
    };
    assert_eq!(pixels(&bring(&scene, IMAGE, "a.png", &allowed))[0], 9);
    assert_eq!(
        pixels(&bring(
            &scene,
            IMAGE,
            "within.png",
            &FrontOptions::default()
        ))[0],
        3
    );
}

/// Neither by a link to the file itself nor by one on the way.
#[cfg(unix)]
#[test]
fn whether_there_is_anything_outside_is_not_told() {
    let (folder, elsewhere) = (folder(), TempDir::new().unwrap());
    fs::write(elsewhere.path().join("there.png"), png([9; 3])).unwrap();
    write(&folder, "there.png", png([9; 3]));
    let scene = folder.path().join("inner/deep/scene.yaml");
    write(&folder, "inner/deep/scene.yaml", "a: b.c\n");
    let link = |target: &Path, name: &str| {
        std::os::unix::fs::symlink(target, folder.path().join("inner/deep").join(name)).unwrap();
    };
    link(elsewhere.path(), "away");
    link(Path::new("../.."), "up");
    link(Path::new("up"), "twice");
    for name in ["there.png", "absent.png"] {
        link(&elsewhere.path().join(name), &format!("by-{name}"));
    }
    let said = |path: &str| {
        let findings = bring(&scene, IMAGE, path, &FrontOptions::default()).findings;
        assert!(findings.starts_with("RE00"), "{path}: {findings}");
        findings
            .replace("there.png", "NAME")
            .replace("absent.png", "NAME")
    };
    for way in ["away/", "up/", "twice/", "by-", "../../", "/etc/", "up/x/"] {
        let [there, absent] = ["there.png", "absent.png"].map(|name| said(&format!("{way}{name}")));
        assert_eq!(there, absent, "{way}");
    }
}

/// What is said of a mesh named `path`, with this text there.
fn told(place: &str, text: &str, path: &str, options: &FrontOptions) -> String {
    let folder = folder();
    write(&folder, place, text);
    bring(&folder.path().join("inner/scene.yaml"), MESH, path, options).findings
}

#[test]
fn the_folder_above_lends_meshes_and_pictures_alone() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let options = FrontOptions::default();
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
            findings.starts_with("RE001 error") && !findings.contains("secret"),
            "{place}: {findings}"
        );
        let absent = told("other.txt", text, place, &options);
        let first = |said: &str| said.lines().next().map(str::to_owned);
        assert_eq!(
            (first(&findings), findings.lines().count()),
            (first(&absent), absent.lines().count()),
            "whether there is one is not told"
        );
        // The scene's own folder and one that the user allows may hold such a file.
        assert!(
            !told(&format!("inner/{place}"), text, place, &options).starts_with("RE002"),
            "{place}"
        );
    }
    let folder = folder();
    write(&folder, ".env.obj", mesh);
    let allowed = FrontOptions {
        asset_root: Some(folder.path().to_owned()),
        ..FrontOptions::default()
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
    for (name, code) in [("a.png", None), ("a.jpg", None), ("a.txt", Some("RE001"))] {
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
    let home = FrontOptions {
        home: Some(folder.path().to_owned()),
        ..FrontOptions::default()
    };
    let outcome = bring(&scene, IMAGE, "a.png", &home);
    assert!(
        outcome.findings.starts_with("RE001 error"),
        "{}",
        outcome.findings
    );
    assert!(
        !outcome.findings.contains("inner`, ")
            && !bring(&scene, IMAGE, "a.png", &FrontOptions::default()).errors
    );
    let allowed = FrontOptions {
        asset_root: Some(folder.path().to_owned()),
        ..home
    };
    assert_eq!(pixels(&bring(&scene, IMAGE, "a.png", &allowed))[0], 5);
}

/// The scene lies in `/tmp`, so the folder above is `/`.
#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "only Linux has the /proc this asks for"
)]
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
        let findings = bring(scene.path(), MESH, path, &FrontOptions::default()).findings;
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
    let gltf = AssetTarget::Gltf([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]]);
    let findings = bring(&scene, gltf, "a.gltf", &FrontOptions::default()).findings;
    assert_eq!(
        findings,
        "GL046 note a.gltf:1:43 this is unused: nothing refers to it\n  \
        remove it, or refer to it where it is needed\n"
    );
    // Beside the scene a link leaves it, to what is no asset and to what is no file.
    for target in ["/etc/passwd", "/dev/zero"] {
        let link = folder.path().join("real/inner/b.gltf");
        let _ = fs::remove_file(&link);
        std::os::unix::fs::symlink(target, link).unwrap();
        let findings = bring(&scene, gltf, "b.gltf", &FrontOptions::default()).findings;
        assert!(
            findings.starts_with("RE00") && !findings.contains("root:"),
            "{target}: {findings}"
        );
    }
    write(&folder, "real/inner/c.gltf", "TOKEN=secret\n");
    let findings = bring(&scene, gltf, "c.gltf", &FrontOptions::default()).findings;
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
        &FrontOptions::default(),
    )
    .findings;
    assert!(findings.starts_with("RE001 error"), "{findings}");
}
