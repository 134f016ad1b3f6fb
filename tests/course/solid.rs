//! Solids of triangles: closed, of the volume they should have, and turned as they are told.

use super::*;

/// The corners of the triangles that a scene is made of.
fn triangles(scene: &Scene) -> Vec<[Vec3; 3]> {
    let corners = scene.surfaces.iter().map(|ir::Surface { shape, .. }| {
        let ir::Shape::Triangle(ir::Triangle { vertices, uvs: _ }) = shape else {
            panic!("{shape:?}")
        };
        vertices.map(Vec3::from_array)
    });
    corners.collect()
}

/// The volume that triangles enclose, counted from their windings; and the sum of their area
/// vectors, which is 0 for a closed surface.
fn enclosed(scene: &Scene) -> (f64, Vec3) {
    let mut sums = (0.0, Vec3::ZERO);
    for [a, b, c] in triangles(scene) {
        sums.0 += a.dot(b.cross(c)) / 6.0;
        sums.1 += (b - a).cross(c - a);
    }
    sums
}

#[test]
fn solids_are_closed_and_face_outwards() {
    for (keys, count, volume) in [
        ("type: box, min: [1, 2, 3], max: [2, 4, 6]", 12, 6.0),
        ("type: box, min: [2, 2, 6], max: [1, 4, 3]", 12, 6.0),
        (
            "type: box, position: [5, 5, 5], dimension: [1, 2, 3]",
            12,
            6.0,
        ),
        (
            "type: box, position: [5, 5, 5], dimension: [1, 2, 3], rotation: [1, 2, 3]",
            12,
            6.0,
        ),
        (
            "type: box, position: [1, 1, 1], up: [0, 2, 0], side: [3, 1, 0], depth: [0, 0, 1]",
            12,
            6.0,
        ),
        (
            "type: box, position: [1, 1, 1], up: [0, 2, 0], side: [3, 1, 0], depth: [0, 0, -1]",
            12,
            6.0,
        ),
        (
            "type: tetrahedron, v0: [1, 1, 1], v1: [3, 1, 1], v2: [1, 4, 1], v3: [1, 1, 2]",
            4,
            1.0,
        ),
        (
            "type: tetrahedron, v0: [1, 1, 1], v1: [1, 4, 1], v2: [3, 1, 1], v3: [1, 1, 2]",
            4,
            1.0,
        ),
        (
            "type: prism, v0: [1, 1, 1], v1: [3, 1, 1], v2: [1, 3, 1], up: [5, 0, 3]",
            8,
            6.0,
        ),
        (
            "type: prism, v0: [1, 1, 1], v1: [3, 1, 1], v2: [1, 3, 1], up: [5, 0, -3]",
            8,
            6.0,
        ),
    ] {
        let scene = object(keys);
        let (found, open) = enclosed(&scene);
        assert!((found - volume).abs() < 1e-12, "{keys}: {found}");
        assert!(
            open.length() < 1e-12 && scene.surfaces.len() == count,
            "{keys}: {open}"
        );
        assert_eq!(scene.materials.len(), 1, "all faces have the one material");
    }
}

#[test]
fn a_box_is_turned_about_x_then_y_then_z() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let keys = format!(
        "type: box, position: [0, 0, 0], dimension: [2, 4, 6], rotation: [{quarter}, 0, {quarter}]"
    );
    let corners = triangles(&object(&keys));
    let far = corners
        .iter()
        .flatten()
        .fold(Vec3::ZERO, |far, corner| far.max(corner.abs()));
    assert!(
        far.distance(Vec3::new(3.0, 1.0, 2.0)) < 1e-15,
        "y goes to z, then x to y and z to −x: {far}"
    );
}
