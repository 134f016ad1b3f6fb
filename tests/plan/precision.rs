//! The precision losses of the non-robust arithmetics: estimates by hand for each shape and
//! symptom.

use super::scenes::{ball, diffuse, first_light, material, plane, with};
use super::validated;
use rtc::internals::ir::{self, Mode, Phong, Scene, Shape, Surface};
use rtc::internals::plan::{Arithmetic, MIN_HIT_DISTANCE, PrecisionArtifact, PrecisionLoss, loss};

/// The unit of rounding of f32.
const UNIT: f64 = f32::EPSILON as f64 / 2.0;

fn one(shape: Shape) -> Scene {
    with(&[(shape, diffuse())])
}

fn lost(scene: &Scene) -> Option<PrecisionLoss> {
    loss(&validated(scene), Arithmetic::F32)
}

fn is_near(found: f64, wanted: f64) {
    assert!(
        (found / wanted - 1.0).abs() < 1e-9,
        "{found:e}, not {wanted:e}"
    );
}

/// Below the eye at (0, 0, 10), 1000 away, 990 from the origin.
const DEEP: [f64; 3] = [0.0, 0.0, -990.0];

/// A mesh of one triangle with its first vertex at the origin of object space, rotated, stretched
/// and moved to `origin`.
fn instance(origin: [f64; 3]) -> Scene {
    let mut scene = one(ball([0.0; 3], 1.0));
    scene.meshes.push(ir::Mesh {
        name: "triangle".to_owned(),
        positions: vec![[0.0; 3], [3.0, -1.0, 1.0], [1.0, 2.0, -2.0]].into(),
        triangles: vec![[0, 1, 2]].into(),
        ..ir::Mesh::default()
    });
    let [x, y, z] = [[1.0, 2.0, 0.0], [-3.0, 0.0, 0.0], [0.0, 1.0, 1.0]];
    let shape = Shape::Instance(ir::Instance {
        mesh: ir::MeshId(0),
        world_from_object: [x, y, z, origin],
    });
    scene.surfaces[0] = Surface {
        shape,
        ..scene.surfaces[0].clone()
    };
    scene
}

/// Flat shapes that touch the point below the eye.
fn flat() -> [Shape; 3] {
    let corner = |x: f64, y: f64| [x, y, -990.0];
    [
        Shape::Triangle(ir::Triangle {
            vertices: [DEEP, corner(9.0, 0.0), corner(0.0, 9.0)],
            uvs: None,
        }),
        Shape::Quad(ir::Quad {
            vertices: [DEEP, corner(9.0, 0.0), corner(9.0, 9.0), corner(0.0, 9.0)],
        }),
        Shape::Disc(ir::Disc {
            center: DEEP,
            normal: [1.0, 0.0, 0.0],
            radius: 9.0,
        }),
    ]
}

/// Planes and round shapes, each with the error of its points in units of rounding.
fn planes_and_round() -> [(Shape, f64); 9] {
    let up = [0.0, 1.0, 0.0];
    let slanted = ir::Plane {
        center: DEEP,
        normal: [0.0, 6.0, 8.0],
    };
    let cylinder = ir::Cylinder {
        base: DEEP,
        axis: up,
        height: 9.0,
        radius: 50.0,
    };
    let cone = ir::Cone {
        base: DEEP,
        up,
        radius: 50.0,
    };
    let torus = |major: f64, minor: f64| {
        Shape::Torus(ir::Torus {
            center: DEEP,
            axis: up,
            major,
            minor,
        })
    };
    [
        (plane(-1000.0), 1000.0 + 1000.0),
        // Its nearest point is (0, −480, −630).
        (Shape::Plane(slanted), 630.0 + 800.0),
        (ball(DEEP, 50.0), 990.0 + 1000.0 * 20.0),
        (ball(DEEP, 5000.0), 990.0 + 1000.0),
        (Shape::Cylinder(cylinder), 990.0 + 1000.0 * 20.0),
        (Shape::Cone(cone), 990.0 + 1000.0 * 20.0),
        (
            torus(40.0, 10.0),
            990.0 + 16.0 * 1000.0 * 10.0 * 10.0 * 50.0,
        ),
        (torus(400.0, 300.0), 990.0 + 16.0 * 1000.0 / 0.6),
        (torus(4000.0, 900.0), 990.0 + 16.0 * 1000.0),
    ]
}

#[test]
fn points_are_off_by_the_rounding_of_their_coordinates_and_of_the_polynomial_over_its_slope() {
    let flat = flat().map(|shape| (shape, 990.0 + 1000.0));
    let rows = flat.into_iter().chain(planes_and_round());
    for (shape, units) in rows {
        let loss = lost(&one(shape.clone())).unwrap_or_else(|| panic!("{shape:?} loses something"));
        is_near(loss.error, units * UNIT);
        is_near(loss.excess, units * UNIT / MIN_HIT_DISTANCE);
        assert_eq!(
            (loss.symptom, loss.surface, loss.surfaces),
            (PrecisionArtifact::SelfHit, 0, 1)
        );
    }
    is_near(lost(&instance(DEEP)).unwrap().error, 1990.0 * UNIT);
    let precise = loss(
        &validated(&one(ball([0.0, 0.0, -1e6], 1e-3))),
        Arithmetic::Plain,
    )
    .unwrap();
    let distance = 1e6 + 10.0;
    is_near(
        precise.error,
        (1e6 + distance * distance / 1e-3) * f64::EPSILON / 2.0,
    );
    assert!(loss(&validated(&one(ball(DEEP, 50.0))), Arithmetic::Robust).is_none());
}

#[test]
fn a_surface_is_skipped_as_a_whole_if_it_is_no_larger_than_what_is_skipped_before_rays() {
    let corner = |x: f64, y: f64| [x * 1e-4, y * 1e-4, 0.0];
    let triangle = |b, c| {
        Shape::Triangle(ir::Triangle {
            vertices: [corner(0.0, 0.0), b, c],
            uvs: None,
        })
    };
    let quad = |b, c, d| {
        Shape::Quad(ir::Quad {
            vertices: [corner(0.0, 0.0), b, c, d],
        })
    };
    let disc = |radius| {
        Shape::Disc(ir::Disc {
            center: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            radius,
        })
    };
    let excess = |scene: &Scene, size: f64| {
        let loss = lost(scene).unwrap();
        assert_eq!(loss.symptom, PrecisionArtifact::Skipped);
        is_near(loss.excess, 100.0 * MIN_HIT_DISTANCE / size);
    };
    excess(&one(triangle(corner(3.0, 4.0), corner(1.0, 0.0))), 5e-4);
    excess(&one(triangle(corner(1.0, 0.0), corner(-3.0, 4.0))), 5e-4);
    excess(
        &one(quad(corner(1.0, 0.0), corner(3.0, 4.0), corner(0.0, 2.0))),
        5e-4,
    );
    excess(&one(disc(4e-4)), 4e-4);
    assert!(
        lost(&one(disc(1.001e-3))).is_none() && lost(&one(disc(0.999e-3))).is_some(),
        "from a hundredth on"
    );
    let mut mesh = instance([0.0; 3]);
    let Shape::Instance(instance) = &mut mesh.surfaces[0].shape else {
        panic!("a mesh")
    };
    instance.world_from_object = instance
        .world_from_object
        .map(|axis| axis.map(|value| value * 1e-4));
    // Its corners are at (6, 7, 1) and (−5, 0, −2).
    excess(&mesh, 86.0_f64.sqrt() * 1e-4);
}

/// A disc smaller than the epsilon, if rays started on it.
fn sends_rays(change: impl FnOnce(&mut Scene)) -> bool {
    let mut scene = one(Shape::Disc(ir::Disc {
        center: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
        radius: 1e-4,
    }));
    change(&mut scene);
    lost(&scene).is_some()
}

#[test]
fn only_surfaces_that_send_rays_meet_themselves() {
    fn mirror(scene: &mut Scene, max_depth: u32, ks: f64, kt: f64) {
        (scene.settings.shadows, scene.settings.max_depth) = (false, max_depth);
        *material(scene, 0) = Phong {
            ks,
            kt,
            ..diffuse()
        };
    }
    assert!(
        sends_rays(|scene| scene.settings.max_depth = 0),
        "shadow rays"
    );
    assert!(!sends_rays(|scene| scene.lights.clear()), "to no light");
    assert!(!sends_rays(|scene| scene.settings.shadows = false));
    assert!(!sends_rays(|scene| scene.settings.mode = Mode::Normal));
    assert!(sends_rays(|scene| mirror(scene, 1, 0.5, 0.0)), "mirrored");
    assert!(sends_rays(|scene| mirror(scene, 1, 0.0, 0.5)), "refracted");
    assert!(!sends_rays(|scene| mirror(scene, 0, 0.5, 0.5)), "no bounce");
    assert!(
        !sends_rays(|scene| mirror(scene, 1, 0.0, 0.0)),
        "nothing to mirror"
    );
}

#[test]
fn round_things_lose_their_shape_by_a_part_of_their_size() {
    let round = |radius: f64| {
        let mut scene = one(ball(DEEP, radius));
        scene.settings.mode = Mode::Normal;
        lost(&scene)
    };
    let loss = round(2.0).unwrap();
    assert_eq!(loss.symptom, PrecisionArtifact::Shape);
    is_near(loss.excess, (990.0 + 1000.0 * 500.0) * UNIT * 512.0 / 2.0);
    assert!(round(100.0).is_none());
    // The tube of a torus determines its shading.
    let mut torus = one(Shape::Torus(ir::Torus {
        center: DEEP,
        axis: [0.0, 1.0, 0.0],
        major: 40.0,
        minor: 10.0,
    }));
    torus.settings.mode = Mode::Normal;
    is_near(
        lost(&torus).unwrap().excess,
        (990.0 + 8e7) * UNIT * 512.0 / 10.0,
    );
}

#[test]
fn the_worst_of_the_surfaces_that_lose_something_is_named_and_all_are_counted() {
    let balls = [4.0, 0.5, 1e-3, 1e-2].map(|radius| (ball([0.0; 3], radius), diffuse()));
    let mut scene = with(&balls);
    first_light(&mut scene).position = [0.0, 0.0, 20.0];
    let loss = lost(&scene).unwrap();
    assert_eq!((loss.surface, loss.surfaces), (2, 3));
    // Of two equal losses the first is reported.
    let scene = with(&[balls[3].clone(), balls[3].clone()]);
    assert_eq!(
        lost(&scene).map(|loss| (loss.surface, loss.surfaces)),
        Some((0, 2))
    );
}
