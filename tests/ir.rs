//! The IR text of every scene in `scenes/`, and of one for each shape, beside the last one
//! approved; and laws that hold for each of them.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use rtc::codec::{self, Form};
use rtc::diag::Sink;
use rtc::ir::Scene;
use rtc::pipeline::{self, Options};
use rtc::source::{FileId, Loader, SourceMap};
use std::path::{Path, PathBuf};

/// The scenes, by name: those of `scenes/`, and one for each shape.
fn scenes() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for (prefix, folder) in [("", "scenes"), ("shape-", "tests/ir/shapes")] {
        let paths = std::fs::read_dir(root.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path());
        let paths = paths.filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "yaml")
        });
        found.extend(paths.map(|path| {
            (
                format!("{prefix}{}", path.file_stem().unwrap().to_string_lossy()),
                path,
            )
        }));
    }
    found.sort();
    assert!(found.len() >= 32, "the scenes are gone: {found:?}");
    found
}

/// The proven scene of a text.
fn scene(name: &str, text: Vec<u8>) -> Scene {
    let mut map = SourceMap::default();
    let file = map.add(name, text);
    scene_in(file, map)
}

/// The proven scene of a file. A scene of ours has no finding at all.
fn scene_in(file: FileId, mut map: SourceMap) -> Scene {
    let mut sink = Sink::default();
    let name = map.name(file).to_owned();
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let proven = lowered
        .as_ref()
        .and_then(|lowered| pipeline::prove(lowered, &Options::default(), &mut sink));
    assert!(
        proven.is_some() && sink.kept().is_empty(),
        "{name}: {:#?}",
        sink.kept()
    );
    lowered.unwrap().scene
}

fn scene_of(path: &Path) -> Scene {
    let mut map = SourceMap::default();
    let file = Loader.file(path, &mut map).unwrap();
    scene_in(file, map)
}

#[test]
fn the_ir_of_every_scene_is_as_approved() {
    insta::with_settings!({ snapshot_path => "ir/snapshots", prepend_module_to_snapshot => false }, {
        for (name, path) in scenes() {
            let text = String::from_utf8(codec::encode(Form::Text, &scene_of(&path)).unwrap()).unwrap();
            insta::assert_snapshot!(name, text);
        }
    });
}

#[test]
fn every_scene_is_the_same_after_both_forms() {
    for (name, path) in scenes() {
        let expected = scene_of(&path);
        for form in [Form::Text, Form::Binary] {
            assert_eq!(
                scene(&name, codec::encode(form, &expected).unwrap()),
                expected,
                "{name}, {form:?}"
            );
        }
    }
}

#[test]
fn every_scene_meets_the_schema() {
    let schema = jsonschema::validator_for(&codec::schema()).unwrap();
    for (name, path) in scenes() {
        let text = codec::encode(Form::Text, &scene_of(&path)).unwrap();
        assert!(
            schema.is_valid(&serde_json::from_slice(&text).unwrap()),
            "{name}"
        );
    }
}

#[test]
fn eye_and_camera_of_the_same_view_give_the_same_ir() {
    let scenes = scenes();
    let find = |wanted: &str| scene_of(&scenes.iter().find(|(name, _)| name == wanted).unwrap().1);
    let (eye, mut camera) = (find("mirrors"), find("camera"));
    assert_eq!(
        camera.settings.supersampling, 4,
        "the one thing in which the two scenes differ"
    );
    camera.settings.supersampling = 1;
    assert_eq!(eye, camera);
}

#[test]
fn every_scene_opens_with_what_to_see() {
    for (name, path) in scenes() {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.starts_with("# "), "{name} opens with a comment");
    }
}
