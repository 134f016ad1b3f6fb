//! Writes `scenes/ball.obj`, the mesh of `scenes/terminator.yaml`: an icosahedron split twice, 320
//! faces, with the normals of the unit sphere.
//!
//! `cargo run --example ball`

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a tool stops at the first surprise, and writes"
)]

use rtc::internals::math::Vec3;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The faces of an icosahedron, whose corners are the even turns of (0, ±1, ±φ): for each, two
/// signs.
fn icosahedron() -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let signs = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let turned = |axis: usize, [a, b]: [f64; 2]| {
        let (a, b) = (a, b * golden);
        [
            Vec3::new(0.0, a, b),
            Vec3::new(b, 0.0, a),
            Vec3::new(a, b, 0.0),
        ][axis]
            .normalize()
    };
    let corners: Vec<_> = (0..3)
        .flat_map(|axis| signs.map(|signs| turned(axis, signs)))
        .collect();
    let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 1.1;
    let mut faces = Vec::new();
    for (a, b, c) in (0..12).flat_map(|a| (0..a).flat_map(move |b| (0..b).map(move |c| (a, b, c))))
    {
        if near(a, b) && near(b, c) && near(c, a) {
            let outward = (corners[b] - corners[a])
                .cross(corners[c] - corners[a])
                .dot(corners[a])
                > 0.0;
            faces.push(if outward { [a, b, c] } else { [a, c, b] });
        }
    }
    (corners, faces)
}

/// Each face split in four, the new corners moved out to the sphere.
fn split(corners: &mut Vec<Vec3>, faces: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: usize, b: usize| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            corners.push((corners[a] + corners[b]).normalize());
            corners.len() - 1
        })
    };
    let mut split = Vec::new();
    for [a, b, c] in faces.iter().copied() {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    split
}

fn main() {
    let (mut corners, mut faces) = icosahedron();
    for _ in 0..2 {
        faces = split(&mut corners, &faces);
    }
    let mut text =
        "# A ball of 320 faces with the normals of a sphere: cargo run --example ball\n".to_owned();
    for kind in ["v", "vn"] {
        for Vec3 { x, y, z } in &corners {
            writeln!(text, "{kind} {x:.6} {y:.6} {z:.6}").unwrap();
        }
    }
    for face in faces {
        let [a, b, c] = face.map(|corner| corner + 1);
        writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").unwrap();
    }
    std::fs::write("scenes/ball.obj", text).unwrap();
}
