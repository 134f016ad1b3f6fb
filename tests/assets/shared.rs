//! The pictures and meshes that people's scenes name, where they are at hand.

use super::{IMAGE, MESH, bring};
use rtc::front::Options;
use std::fs;
use std::path::{Path, PathBuf};

/// The files below `folder` with one of these extensions.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let (mut open, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extensions.iter().any(|wanted| extension == *wanted)) {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn every_picture_and_mesh_of_the_wild_is_read() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared");
    if !shared.exists() {
        println!("skipped: no ../shared here");
        return;
    }
    for folder in ["wild", "course/scenes"] {
        for path in files(&shared.join(folder), &["png", "obj", "off"]) {
            let asset = if path.extension().unwrap() == "png" { IMAGE } else { MESH };
            // Any file beside it serves as the scene that names it.
            let outcome = bring(&path, asset, path.file_name().unwrap().to_str().unwrap(), &Options::default());
            let (image, mesh) = (&outcome.lowered.scene.images[0], &outcome.lowered.scene.meshes[0]);
            println!("{}: {} × {}, {} triangles", path.display(), image.width, image.height, mesh.triangles.len());
            println!("{}", outcome.findings);
            assert!(!outcome.errors && (image.width > 1 || mesh.triangles.len() > 1), "{}", outcome.findings);
        }
    }
}
