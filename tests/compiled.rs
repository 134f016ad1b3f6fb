//! What is compiled is rendered to the picture of its source, with the default options: by every
//! form that rtc writes and reads, for scenes, assets and stages.

use crate::suite::{absent, files, name, needs, root, shared, trial};
use libtest_mimic::Trial;
use rtc::{Options, Scene};
use std::path::{Path, PathBuf};

/// The forms that hold all of a scene.
const EXACT: [&str; 3] = ["x.json", "x.rtir", "x.yaml"];
/// The form that has meshes for shapes.
const MESHES: &str = "x.glb";
/// The greatest mean difference of a picture of meshes, in levels of 8 bits.
const LEVELS: f64 = 4.0;

/// All its trials.
pub(crate) fn trials() -> Vec<Trial> {
    let extensions = ["yaml", "gltf", "glb", "usda", "pbrt"];
    let own = ["tests/render", "scenes"].map(|folder| (folder, root(folder)));
    let others = ["gltf/assets", "round-4/models", "round-4/export"];
    let others = others.map(|folder| (folder, shared(folder)));
    let mut trials = Vec::new();
    for (folder, path) in own {
        trials.extend(of_folder(folder, &path, &extensions));
    }
    for (folder, path) in others {
        match path {
            Some(path) => trials.extend(of_folder(
                folder,
                &path,
                &["glb", "gltf", "usda", "xml", "yaml"],
            )),
            None => trials.push(absent(format!("compiled: {folder}"), folder)),
        }
    }
    let dim = "round-4/models/filled-asset-changes-by-yaml-roundtrip.glb";
    trials.push(needs("compiled: light that fills in stays", dim, |path| {
        let scene = Scene::open(path).unwrap();
        let text = scene.export(EXACT[2]).unwrap();
        let text = String::from_utf8(text.bytes().to_vec()).unwrap();
        assert!(text.contains("Environment:"), "{text}");
        assert!(text.contains("ToneMap: pbr-neutral"), "{text}");
    }));
    trials
}

fn of_folder(folder: &str, path: &Path, extensions: &[&str]) -> Vec<Trial> {
    let found = files(path, extensions).into_iter();
    let trials = found.map(|file: PathBuf| {
        let extension = file.extension().unwrap_or_default().to_string_lossy();
        let name = format!("compiled: {folder}/{}.{extension}", name(&file, path));
        trial(name, move || is_the_same_compiled(&file))
    });
    trials.collect()
}

fn options() -> Options {
    Options::new().size(16, 16).samples(16).threads(1)
}

/// The bytes of the picture of a scene; `None` for one that is not rendered.
fn picture(scene: &Scene) -> Option<Vec<u8>> {
    scene.render(&options()).ok().map(|picture| picture.rgba8())
}

fn is_the_same_compiled(path: &Path) {
    let Some((scene, known)) = Scene::open(path)
        .ok()
        .and_then(|scene| picture(&scene).map(|known| (scene, known)))
    else {
        return;
    };
    for form in EXACT {
        let Some((again, _)) = compiled(&scene, form, path) else {
            continue;
        };
        let Some(found) = picture(&again) else {
            // A text in the folder of a text names files of other folders as that does.
            assert_eq!(form, EXACT[2]);
            continue;
        };
        let difference = difference(&found, &known);
        assert!(difference == 0.0, "{form}: {difference} levels");
    }
    let Some((again, is_told)) = compiled(&scene, MESHES, path) else {
        return;
    };
    let difference = difference(&picture(&again).unwrap(), &known);
    assert!(
        is_told || difference <= LEVELS,
        "{MESHES}: {difference} levels"
    );
}

/// A scene as it is read from a form, and whether a warning says that this lacks something; `None`
/// if the scene is refused.
fn compiled(scene: &Scene, form: &str, path: &Path) -> Option<(Scene, bool)> {
    let export = scene.export(form).ok()?;
    let mut findings = export.diagnostics().iter();
    // The square of a plane ends before the horizon.
    let is_told =
        findings.any(|finding| finding.code == "GL052" || finding.message.contains("square"));
    let written = export.files().chain([(form, export.bytes())]);
    let written = written.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
    // A scene of the course still names its own files.
    let all = neighbours(path).into_iter().chain(written);
    let again = Scene::from_files(form, all);
    Some((
        again.unwrap_or_else(|error| panic!("{form}: {error}")),
        is_told,
    ))
}

/// The files beside a scene, by their paths from its folder.
fn neighbours(path: &Path) -> Vec<(String, Vec<u8>)> {
    let folder = path.parent().unwrap();
    let extensions = [
        "png", "jpg", "obj", "off", "ply", "mtl", "ies", "hdr", "exr",
    ];
    let found = files(folder, &extensions).into_iter();
    let named = found.map(|file| {
        let own = file.strip_prefix(folder).unwrap().to_string_lossy();
        (own.replace('\\', "/"), std::fs::read(&file).unwrap())
    });
    named.collect()
}

/// The mean difference of the channels of two pictures, in levels of 8 bits.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.len() as f64
}
