//! Files of many names.

use super::{folder, png, write};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{ImageId, MeshId, Scene, Shape, Texture};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::fs;
use tempfile::TempDir;

/// A picture and a mesh, each a file of two names.
fn write_assets(folder: &TempDir) {
    write(folder, "inner/a.png", png([1, 2, 3]));
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write(folder, "inner/a.obj", triangle);
    let inner = folder.path().join("inner");
    for (from, to) in [("a.png", "b.png"), ("a.obj", "b.obj")] {
        fs::hard_link(inner.join(from), inner.join(to)).unwrap();
    }
}

/// A scene that calls both files by all their names.
fn text() -> String {
    let mut text =
        "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n"
            .to_owned();
    for (picture, mesh) in [
        ("a.png", "a.obj"),
        ("./a.png", "././a.obj"),
        ("../inner/a.png", "a.obj"),
        ("b.png", "b.obj"),
    ] {
        text += &format!(
            "- {{type: mesh, file: {mesh}, material: {{color: [1, 1, 1], texture: {picture}, ka: 1, kd: 1, ks: 0, n: \
             1}}}}\n"
        );
    }
    text
}

fn read(folder: &TempDir) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let path = folder.path().join("inner/scene.yaml");
    let file = Loader.file(&path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    lowered.unwrap().scene
}

#[test]
fn a_file_of_many_names_is_read_once() {
    let folder = folder();
    write_assets(&folder);
    write(&folder, "inner/scene.yaml", text());
    let scene = read(&folder);
    let textures: Vec<_> = scene
        .textures
        .iter()
        .map(|texture| texture == &Texture::Image(ImageId(0)))
        .collect();
    let meshes: Vec<_> = scene
        .surfaces
        .iter()
        .map(|surface| {
            let Shape::Instance(instance) = &surface.shape else {
                panic!("{:?}", surface.shape)
            };
            instance.mesh
        })
        .collect();
    assert_eq!(textures, [true; 4]);
    assert_eq!(meshes, [MeshId(0); 4]);
    assert!(
        scene.meshes[1..]
            .iter()
            .all(|mesh| mesh.triangles.is_empty())
    );
}
