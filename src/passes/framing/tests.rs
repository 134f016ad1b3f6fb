//! Tests of framing.

use super::*;
use rtc_ir::{Ambient, Instance, MaterialId, MeshId, Mode, Pattern, Settings, Triangle};
use std::f64::consts::PI;

fn empty() -> Scene {
    let camera = Camera {
        eye: [0.0, 0.0, 1.0],
        center: [0.0; 3],
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        size: [1; 2],
        lens: Lens {
            radius: 0.0,
            samples: 1,
        },
        projection: Projection::Perspective,
    };
    let settings = Settings {
        mode: Mode::Phong,
        shadows: false,
        max_depth: 0,
        supersampling: 1,
        pattern: Pattern::Grid,
        light_samples: 1,
        toon: false,
        ambient: Ambient::PerLight,
    };
    Scene::new(camera, settings)
}

/// A scene of boxes, each with two opposite corners.
fn scene(boxes: &[[[f64; 3]; 2]]) -> Scene {
    let mut scene = empty();
    for [low, high] in boxes {
        let pick = |corner: usize, k: usize| {
            if corner >> k & 1 == 0 {
                low[k]
            } else {
                high[k]
            }
        };
        let positions: Vec<_> = (0..8)
            .map(|corner| [0, 1, 2].map(|k| pick(corner, k)))
            .collect();
        let mesh = MeshId(u32::try_from(scene.meshes.len()).expect("few"));
        scene.meshes.push(Mesh {
            positions: positions.into(),
            triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 0]].into(),
            ..Mesh::default()
        });
        let world_from_object = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
        scene.surfaces.push(Surface {
            shape: Shape::Instance(Instance {
                mesh,
                world_from_object,
            }),
            material: MaterialId(0),
            casts_no_shadow: false,
        });
    }
    scene
}

/// The projected corners of some boxes, −1 to 1 across the picture: minimum and maximum.
fn shown(scene: &Scene, boxes: &[[[f64; 3]; 2]]) -> [[f64; 2]; 2] {
    let camera = &scene.camera;
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let z = (eye - center).normalize();
    let mut shown = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for corner in boxes
        .iter()
        .flat_map(|corners| (0..8).map(move |corner| (corners, corner)))
    {
        let (corners, bits) = corner;
        let at = Vec3::from_array([0, 1, 2].map(|k| corners[bits >> k & 1][k])) - eye;
        let scale = (eye - center).length() / -at.dot(z);
        for ((range, step), size) in shown.iter_mut().zip([right, up]).zip(camera.size) {
            let along = at.dot(step) * scale / step.length_squared() / (f64::from(size) / 2.0);
            *range = [range[0].min(along), range[1].max(along)];
        }
    }
    shown
}

fn framed(boxes: &[[[f64; 3]; 2]], framing: Framing) -> Scene {
    let mut scene = scene(boxes);
    framing.apply(&mut scene);
    scene
}

#[test]
fn a_subject_spans_85_percent_and_stands_in_the_middle() {
    let sizes = [None, Some([300, 100]), Some([100, 300])];
    for ((stretch, size), yfov) in [[1.0, 1.0, 1.0], [9.0, 0.5, 1.0], [0.2, 5.0, 0.2]]
        .iter()
        .zip(sizes)
        .zip([None, Some(0.1), Some(2.0)])
    {
        let far = [7000.0, -300.0, 40.0];
        let corner = |sign: f64| [0, 1, 2].map(|k| far[k] + sign * stretch[k]);
        let boxes = [[corner(-1.0), corner(1.0)]];
        let framing = Framing {
            yfov,
            size,
            ..Framing::default()
        };
        let [x, y] = shown(&framed(&boxes, framing), &boxes);
        let spans = [x, y].map(|[from, to]| (to - from) / 2.0);
        assert!(
            (spans[0].max(spans[1]) - SUBJECT_FRACTION).abs() < 1e-9,
            "{spans:?}"
        );
        for [from, to] in [x, y] {
            assert!(
                (from + to).abs() < 0.3
                    && from >= -SUBJECT_FRACTION - 1e-9
                    && to <= SUBJECT_FRACTION + 1e-9
            );
        }
        let widest = if spans[0] > spans[1] { x } else { y };
        assert!(
            (widest[0] + widest[1]).abs() < 1e-9,
            "{widest:?} is in the middle"
        );
    }
}

#[test]
fn a_wide_ground_is_no_subject_but_a_floor_alone_is() {
    let sphere = [[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]];
    let ground = [[-90.0, -0.01, -90.0], [90.0, 0.0, 90.0]];
    let (alone, on_ground) = (
        framed(&[sphere], Framing::default()),
        framed(&[sphere, ground], Framing::default()),
    );
    let distance = |scene: &Scene| scene.camera.distance();
    assert!((distance(&alone) - distance(&on_ground)).abs() < 1e-9);
    assert!(distance(&framed(&[ground], Framing::default())) > 100.0);
    // A roof of the same size and a small floor are part of the subject.
    let (roof, floor) = (
        [[-90.0, 5.0, -90.0], [90.0, 5.1, 90.0]],
        [[-1.5, -0.01, -1.5], [1.5, 0.0, 1.5]],
    );
    assert!(distance(&framed(&[sphere, roof], Framing::default())) > 100.0);
    assert!(distance(&framed(&[sphere, floor], Framing::default())) > 1.05 * distance(&alone));
}

#[test]
fn an_orbit_goes_to_the_right_and_up_and_rolls_clockwise() {
    let at = |azimuth: f64, elevation: f64, roll: f64| {
        let orbit = Orbit {
            azimuth,
            elevation,
            roll,
        };
        let [x, y, z] = orbit.axes();
        assert!((x.cross(y) - z).length() < 1e-12);
        (y, z)
    };
    let near =
        |(a, b): (Vec3, Vec3), (c, d): (Vec3, Vec3)| (a - c).length() + (b - d).length() < 1e-12;
    assert!(near(at(0.0, 0.0, 0.0), (Vec3::Y, Vec3::Z)));
    assert!(near(at(PI / 2.0, 0.0, 0.0), (Vec3::Y, Vec3::X)));
    assert!(near(at(0.0, PI / 2.0, 0.0), (-Vec3::Z, Vec3::Y)));
    // The camera rolls clockwise: the up direction leans to its left.
    assert!(near(at(0.0, 0.0, PI / 2.0), (Vec3::X, Vec3::Z)));
}

#[test]
fn what_has_no_extent_keeps_its_camera() {
    let mut point = scene(&[]);
    point.surfaces.push(Surface {
        shape: Shape::Triangle(Triangle {
            vertices: [[1.0; 3]; 3],
            uvs: None,
        }),
        material: MaterialId(0),
        casts_no_shadow: false,
    });
    for mut scene in [scene(&[]), point] {
        let before = scene.camera.clone();
        Framing::default().apply(&mut scene);
        assert_eq!(scene.camera, before);
    }
}

#[test]
fn the_ground_of_the_studio_takes_no_part() {
    let flat = [[[-1.0, 0.0, -1.0], [1.0, 0.0, 1.0]]];
    let mut scene = scene(&flat);
    let [low, high] = flat[0].map(Vec3::from_array);
    let ground = crate::ground::add_ground(&mut scene, [low, high]);
    assert_eq!(ground, Some(1));
    let framing = Framing {
        ground,
        ..Framing::default()
    };
    framing.apply(&mut scene);
    let spans = shown(&scene, &flat).map(|[least, most]| (most - least) / 2.0);
    assert!(
        (spans[0].max(spans[1]) - SUBJECT_FRACTION).abs() < 1e-9,
        "{spans:?}"
    );
}
