//! Files of many names.

use super::{folder, png, write};
use rtc::diag::Sink;
use rtc::ir::{ImageId, MeshId, Shape, Texture};
use rtc::source::{Loader, SourceMap};
use std::fs;

#[test]
fn a_file_of_many_names_is_read_once() {
    let folder = folder();
    write(&folder, "inner/a.png", png([1, 2, 3]));
    write(
        &folder,
        "inner/a.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    );
    for (from, to) in [("a.png", "b.png"), ("a.obj", "b.obj")] {
        fs::hard_link(
            folder.path().join("inner").join(from),
            folder.path().join("inner").join(to),
        )
        .unwrap();
    }
    let mut scene =
        "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\nObjects:\n"
            .to_owned();
    for (picture, mesh) in [
        ("a.png", "a.obj"),
        ("./a.png", "././a.obj"),
        ("../inner/a.png", "a.obj"),
        ("b.png", "b.obj"),
    ] {
        scene += &format!(
            "- {{type: mesh, file: {mesh}, material: {{color: [1, 1, 1], texture: {picture}, ka: 1, kd: 1, ks: 0, n: \
             1}}}}\n"
        );
    }
    write(&folder, "inner/scene.yaml", scene);
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = Loader
        .file(&folder.path().join("inner/scene.yaml"), &mut map)
        .unwrap();
    let scene = rtc::pipeline::load(
        file,
        &mut map,
        &rtc::pipeline::Options::default(),
        &mut sink,
    )
    .unwrap()
    .scene;
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
