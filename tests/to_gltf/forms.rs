//! Meshes that stand for shapes: no point of them is farther from its shape than the tolerance,
//! their normals point outwards, and they are whole.

use super::{read, scene, write};
use crate::suite::trial;
use libtest_mimic::Trial;
use rtc::internals::ir::{LoweredScene, Mesh, Shape};
use std::collections::BTreeMap;

type Point = [f64; 3];

/// How far a point is from the surface of a shape, in its own coordinates.
type Distance = fn(Point) -> f64;

/// Shapes with the axis z: how a scene says them, and how far a point is from them.
const SHAPES: &[(&str, Distance)] = &[
    ("type: sphere, position: [0, 0, 0], radius: 2", |p| {
        (length(p) - 2.0).abs()
    }),
    (
        "type: torus, position: [0, 0, 0], direction: [0, 0, 1], radius: 2, alpha: 0.5",
        |[x, y, z]| ((x.hypot(y) - 2.0).hypot(z) - 0.5).abs(),
    ),
    (
        "type: cylinder, position: [0, 0, 0], direction: [0, 0, 1], height: 3, radius: 1",
        |[x, y, z]| inside(x.hypot(y) - 1.0, z - 3.0, -z),
    ),
    (
        "type: cone, position: [0, 0, 0], up: [0, 0, 3], radius: 1",
        |[x, y, z]| {
            let side = (3.0 * (x.hypot(y) - 1.0) + z) / 10.0_f64.sqrt();
            inside(side, z - 3.0, -z)
        },
    ),
    (
        "type: paraboloid, position: [0, 0, 0], up: [0, 0, 3], radius: 1",
        // A point is no farther than it is along z, or away from the axis.
        |[x, y, z]| {
            let (out, rim) = (x.hypot(y), (1.0 - z / 3.0).max(0.0).sqrt());
            let along = (z - 3.0 * (1.0 - out * out)).abs();
            along.min((out - rim).abs()).min(z.abs())
        },
    ),
    (
        "type: circle, center: [0, 0, 0], normal: [0, 0, 1], radius: 2",
        |[x, y, z]| z.abs().max(x.hypot(y) - 2.0),
    ),
    (
        "type: quad, curved: true, v0: [0, 0, 0], v1: [1, 0, 0], v2: [1, 1, 1], v3: [0, 1, 0]",
        |[x, y, z]| (z - x * y).abs(),
    ),
];

fn length(p: Point) -> f64 {
    p.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// How far a point is from the border of a body whose parts of the border are so far off, below 0
/// inside.
fn inside(side: f64, top: f64, bottom: f64) -> f64 {
    side.max(top).max(bottom).abs()
}

pub(crate) fn trials() -> Vec<Trial> {
    let each = SHAPES.iter().map(|(text, distance)| {
        let kind = text.split([' ', ',']).nth(1).unwrap();
        trial(format!("to glTF: the form of a {kind}"), move || {
            for tolerance in [0.1, 0.01, 0.001] {
                is_within(text, *distance, tolerance);
            }
        })
    });
    let whole = trial("to glTF: round bodies have no holes", bodies_are_whole);
    let plane = trial("to glTF: planes go on far beyond the scene", planes_go_far);
    let shared = trial("to glTF: equal shapes share a mesh", equal_shapes_share);
    each.chain([whole, plane, shared]).collect()
}

fn placed(text: &str) -> LoweredScene {
    scene(&format!(
        "Eye: [3, 4, 20]\nObjects: [{{{text}, material: {{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}}}]\n"
    ))
}

/// The mesh of the one surface, in the world.
fn mesh(lowered: &LoweredScene, tolerance: f64) -> (Mesh, Vec<Point>) {
    let (bytes, _) = write(lowered, Some(tolerance));
    let after = read(&bytes.unwrap()).scene;
    let Shape::Instance(own) = &after.surfaces[0].shape else {
        panic!("no mesh")
    };
    let [x, y, z, origin] = own.world_from_object;
    let mesh = after.meshes[own.mesh.0 as usize].clone();
    let world =
        |[a, b, c]: Point| std::array::from_fn(|at| x[at] * a + y[at] * b + z[at] * c + origin[at]);
    let corners = mesh.positions.iter().map(world).collect();
    (mesh, corners)
}

fn is_within(text: &str, distance: Distance, tolerance: f64) {
    let (mesh, corners) = mesh(&placed(text), tolerance);
    let mut worst = 0.0_f64;
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
        for (u, v) in [
            (0.0, 0.0),
            (0.5, 0.5),
            (0.5, 0.0),
            (0.0, 0.5),
            (0.34, 0.33),
            (0.2, 0.7),
        ] {
            let point = std::array::from_fn(|at| a[at] + u * (b[at] - a[at]) + v * (c[at] - a[at]));
            worst = worst.max(distance(point));
        }
    }
    assert!(
        worst <= tolerance * 1.001 + 1e-6,
        "{text}: {worst} > {tolerance}"
    );
    // Four times as fine is at most about so many triangles more: no shape is cut needlessly.
    assert!(worst >= tolerance / 40.0 || worst < 1e-6, "{text}: {worst}");
}

/// Each edge of a closed body belongs to two triangles that run along it in opposite directions,
/// and normals point where the fronts of triangles are.
fn bodies_are_whole() {
    let closed = SHAPES.iter().take(5);
    for (text, _) in closed {
        let (mesh, corners) = mesh(&placed(text), 0.05);
        let bits = |corner: u32| {
            corners[corner as usize].map(|part| ((part * 1e5).round() + 0.0).to_bits())
        };
        let mut edges = BTreeMap::new();
        for triangle in mesh.triangles.iter() {
            for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                let (from, to) = (bits(triangle[from]), bits(triangle[to]));
                *edges.entry((from.min(to), from.max(to))).or_insert(0) +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|sum| *sum == 0), "{text}");
        let mut volume = 0.0;
        for triangle in mesh.triangles.iter() {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0;
        }
        assert!(volume > 0.0, "{text} is turned inside out");
    }
}

fn planes_go_far() {
    let text = "type: plane, position: [0, -1, 0], normal: [0, 1, 0]";
    let (_, corners) = mesh(&placed(text), 0.1);
    let eye = length([3.0, 4.0, 20.0]);
    assert!(corners.iter().all(|corner| corner[1] == -1.0));
    assert!(
        corners.iter().all(|corner| length(*corner) > 2.0 * eye),
        "{corners:?}"
    );
}

fn equal_shapes_share() {
    let ball = |x: i32, radius: f64| {
        format!(
            "{{type: sphere, position: [{x}, 0, 0], radius: {radius}, material: {{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}}}"
        )
    };
    let balls = [ball(0, 1.0), ball(5, 2.0), ball(-5, 0.5)].join(", ");
    let lowered = scene(&format!("Eye: [0, 0, 20]\nObjects: [{balls}]\n"));
    let shared = read(&write(&lowered, None).0.unwrap()).scene;
    assert_eq!((shared.surfaces.len(), shared.meshes.len()), (3, 1));
}
