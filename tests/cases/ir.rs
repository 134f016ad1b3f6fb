//! The IR text of every scene in `scenes/`, of one for each shape, and of some for textures, lights
//! and settings, beside the last one approved; and laws that hold for each of them.
use crate::suite::{files, name, root, trial};
use libtest_mimic::Trial;
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Scene;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{FileId, Loader, SourceMap};
use std::path::{Path, PathBuf};

pub(crate) fn trials() -> Vec<Trial> {
    let scenes = scenes();
    assert!(scenes.len() >= 32, "the scenes are gone: {scenes:?}");
    let law = |law: &str, check: fn(&str, &Path)| {
        let trial = |(name, path): &(String, PathBuf)| {
            let (label, name, path) = (format!("ir/{name}: {law}"), name.clone(), path.clone());
            trial(label, move || check(&name, &path))
        };
        scenes.iter().map(trial).collect::<Vec<_>>()
    };
    let mut trials = law("as approved", is_as_approved);
    trials.extend(law(
        "the same after both forms",
        is_the_same_after_both_forms,
    ));
    trials.extend(law("meets the schema", meets_the_schema));
    trials.extend(law("opens with what to see", opens_with_what_to_see));
    trials.push(trial("ir: eye and camera of the same view", || {
        eye_and_camera_of_the_same_view_give_the_same_ir();
    }));
    trials
}

/// Scenes of textures, lights and settings.
const OTHERS: [&str; 6] = [
    "texture/patterns",
    "texture/patterns-of-standard",
    "light/area",
    "light/ambient",
    "camera/anaglyph",
    "motion/paths",
];

/// The scenes, by name: those of `scenes/`, one for each shape, and [`OTHERS`].
fn scenes() -> Vec<(String, PathBuf)> {
    let found = [("", "scenes"), ("shape-", "tests/render/record")]
        .into_iter()
        .flat_map(|(prefix, folder)| {
            let folder = root(folder);
            let paths = files(&folder, &["yaml"]).into_iter();
            paths.map(move |path| (format!("{prefix}{}", name(&path, &folder)), path))
        });
    let others = OTHERS.map(|other| {
        let path = root("tests/render").join(other).with_extension("yaml");
        (other.replace('/', "-"), path)
    });
    found.chain(others).collect()
}

/// The proven scene of a text.
fn scene(name: &str, text: Vec<u8>) -> Scene {
    let mut map = SourceMap::default();
    let file = map.add(name, text);
    scene_in(file, map)
}

/// The proven scene of a file. A scene of ours has no finding at all.
fn scene_in(file: FileId, mut map: SourceMap) -> Scene {
    let mut sink = DiagnosticSink::default();
    let name = map.name(file).to_owned();
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let validated = lowered
        .as_ref()
        .and_then(|lowered| pipeline::validate(lowered, &Options::default(), &mut sink));
    assert!(
        validated.is_some() && sink.kept().is_empty(),
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

fn is_as_approved(name: &str, path: &Path) {
    let text = String::from_utf8(codec::encode(Encoding::Json, &scene_of(path)).unwrap()).unwrap();
    insta::with_settings!({ snapshot_path => "../ir/snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!(name, text);
    });
}

fn is_the_same_after_both_forms(name: &str, path: &Path) {
    let expected = scene_of(path);
    for encoding in [Encoding::Json, Encoding::Binary] {
        let found = scene(name, codec::encode(encoding, &expected).unwrap());
        assert_eq!(found, expected, "{encoding:?}");
    }
}

fn meets_the_schema(_: &str, path: &Path) {
    let schema = jsonschema::validator_for(&codec::schema()).unwrap();
    let text = codec::encode(Encoding::Json, &scene_of(path)).unwrap();
    assert!(schema.is_valid(&serde_json::from_slice(&text).unwrap()));
}

fn opens_with_what_to_see(_: &str, path: &Path) {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.starts_with("# "), "it opens with a comment");
}

fn eye_and_camera_of_the_same_view_give_the_same_ir() {
    let [eye, mut camera] = ["mirrors", "camera"].map(|name| {
        let path = root("scenes").join(name).with_extension("yaml");
        scene_of(&path)
    });
    assert_eq!(
        camera.settings.supersampling, 4,
        "the one thing in which the two scenes differ"
    );
    camera.settings.supersampling = 1;
    assert_eq!(eye, camera);
}
