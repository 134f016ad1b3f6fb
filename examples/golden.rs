//! A golden-picture test for a crate that makes meshes: the picture of a mesh is compared with a
//! file. Pictures are the same bytes on every machine, so there is no tolerance.
//! `cargo run --example golden` runs it; with `UPDATE_PICTURES=1` it writes the file.

#![expect(clippy::disallowed_methods, reason = "a test reads what it compares")]

use rtc::{Camera, Light, Mesh, Options, Phong, Picture, SceneBuilder, Shape, Transform};
use std::fs;
use std::path::Path;

fn main() {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/golden.png");
    assert_picture(&picture(&octasphere(3)), &golden);
}

/// Fails if a picture is not that of a file, and leaves it beside the file.
pub(crate) fn assert_picture(picture: &Picture, golden: &Path) {
    if std::env::var_os("UPDATE_PICTURES").is_some() {
        picture.save(golden).expect("the picture can be written");
        return;
    }
    let is_same = fs::read(golden).ok() == picture.encode().ok();
    if !is_same {
        let actual = golden.with_extension("actual.png");
        picture.save(&actual).expect("the picture can be written");
        let [golden, actual] = [golden, &actual].map(Path::display);
        panic!("{actual} is not {golden}; UPDATE_PICTURES=1 accepts it");
    }
}

/// A mesh from the front and above, each face of its own brightness.
pub(crate) fn picture((positions, faces): &(Vec<[f64; 3]>, Vec<[u32; 3]>)) -> Picture {
    let camera = Camera::look_at([2.0, 2.0, 5.0], [0.0; 3]);
    let mut scene = SceneBuilder::new(camera.fov(26.0).size(64, 64));
    scene.light(Light::plain([4.0, 6.0, 5.0], [1.0; 3], 0.0));
    let mesh = scene.mesh(Mesh::new(positions, faces));
    let shape = Shape::instance(mesh, Transform::new());
    scene.add(shape, Phong::default().ka(0.15).kd(0.8));
    let scene = scene.build().expect("the mesh is sound");
    let options = Options::new().supersampling(3).transparent();
    scene.render(&options).expect("it can be rendered")
}

/// What is tested: a sphere of an octahedron whose faces are cut in four, again and again.
pub(crate) fn octasphere(cuts: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut positions = vec![
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
    ];
    let mut faces = vec![
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    for _ in 0..cuts {
        let mut middle = |a: u32, b: u32| {
            let [a, b]: [[f64; 3]; 2] = [a, b].map(|index| positions[index as usize]);
            let sum = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
            let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
            positions.push(sum.map(|x| x / length));
            (positions.len() - 1) as u32
        };
        let cut = |[a, b, c]: [u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(cut).collect();
    }
    (positions, faces)
}
