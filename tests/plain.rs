//! The plain arithmetics: right where rays are benign, wrong where the books are, and warned of
//! there.

#![expect(clippy::unwrap_used, reason = "a test stops at a surprise")]

use rtc::internals::math::{Id, Positive, Vec3};
use rtc::internals::render::{
    BaselineShape, Intersect, Prepare, Ray, Real, Shape, SimdLevel, WatertightRay,
};
use rtc::internals::valid;
use std::sync::Arc;

fn length(x: f64) -> Positive {
    Positive::new(x).unwrap()
}

/// One shape of each kind within about 2 of the origin, with its name.
#[expect(clippy::too_many_lines, reason = "a table, one row a shape")]
fn shapes() -> Vec<(&'static str, valid::Shape)> {
    let (center, axis, radius) = (
        Vec3::new(0.2, -0.3, 0.1),
        Vec3::new(0.3, 0.5, -1.0),
        length(0.9),
    );
    let corners = [
        Vec3::new(-1.0, -1.1, 0.2),
        Vec3::new(1.2, -0.9, 0.1),
        Vec3::new(0.9, 1.0, -0.2),
    ];
    let opposite = corners[0] + corners[2] - corners[1];
    let quad = |last: Vec3| valid::Quad {
        vertices: [corners[0], corners[1], corners[2], last],
    };
    let sides = [
        Vec3::new(1.1, 0.2, 0.0),
        Vec3::new(-0.2, 0.9, 0.1),
        Vec3::new(0.1, 0.0, 1.3),
    ];
    let world_from_object = [sides[0], sides[1], sides[2], center];
    vec![
        (
            "sphere",
            valid::Shape::Sphere(valid::Sphere {
                center,
                radius,
                texture_from_world: None,
            }),
        ),
        (
            "plane",
            valid::Shape::Plane(valid::Plane {
                center,
                normal: axis,
            }),
        ),
        (
            "triangle",
            valid::Shape::Triangle(valid::Triangle {
                vertices: corners,
                uvs: None,
            }),
        ),
        ("flat quad", valid::Shape::Quad(Box::new(quad(opposite)))),
        (
            "patch",
            valid::Shape::Quad(Box::new(quad(opposite + Vec3::Z))),
        ),
        (
            "disc",
            valid::Shape::Disc(valid::Disc {
                center,
                normal: axis,
                radius,
            }),
        ),
        (
            "cylinder",
            valid::Shape::Cylinder(valid::Cylinder {
                base: center,
                axis,
                height: length(1.2),
                radius,
            }),
        ),
        (
            "cone",
            valid::Shape::Cone(valid::Cone {
                base: center,
                up: axis,
                radius,
            }),
        ),
        (
            "torus",
            valid::Shape::Torus(valid::Torus {
                center,
                axis,
                major: radius,
                minor: length(0.35),
            }),
        ),
        (
            "instance",
            valid::Shape::Instance(Box::new(valid::Instance {
                mesh: Id::new(0),
                world_from_object,
            })),
        ),
    ]
}

/// A tetrahedron.
fn mesh() -> valid::Mesh {
    valid::Mesh {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]
            .map(|corner| corner.to_array())
            .into_iter()
            .collect(),
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].into(),
        ..valid::Mesh::default()
    }
}

fn prepare<S: Prepare>(shape: &valid::Shape) -> S {
    S::prepare(
        shape,
        &vec![Arc::new(S::prepare_mesh(&mesh(), SimdLevel::best()))].into(),
    )
    .unwrap()
}

/// Rays from points at 3 to 6 from the origin towards points within 1 of it, with directions of
/// many lengths.
fn rays(count: usize) -> impl Iterator<Item = Ray> {
    let mut state = 1_u64;
    let mut number = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut point = move || Vec3::new(number(), number(), number());
    (0..count).map(move |_| {
        let origin = point().normalize() * (4.5 + 1.5 * point().x);
        Ray {
            origin,
            direction: (point() - origin) * (1.5 + point().x),
        }
    })
}

/// The largest error of t (relative) and of the normal over benign rays: those that meet the shape
/// at more than 15°.
fn worst_error<R: Real>(name: &str, shape: &valid::Shape) -> f64 {
    let (plain, robust) = (prepare::<BaselineShape<R>>(shape), prepare::<Shape>(shape));
    let (mut worst, mut hits) = (0.0_f64, 0);
    for ray in rays(2000) {
        let watertight = WatertightRay::new(&ray);
        let Some((t, part)) = robust.intersect(&ray, &watertight, f64::INFINITY) else {
            continue;
        };
        let right = robust.interaction(&ray, t, part);
        if right.normal.dot(ray.direction.normalize()).abs() < 0.25 {
            continue;
        }
        let (found, part) = plain
            .intersect(&ray, &watertight, f64::INFINITY)
            .unwrap_or_else(|| panic!("{name}: {ray:?}"));
        let interaction = plain.interaction(&ray, found, part);
        assert_eq!(
            interaction.start(Vec3::X),
            interaction.point,
            "{name}: rays start off the point"
        );
        worst = worst
            .max((found - t).abs() / t)
            .max(interaction.normal.distance(right.normal));
        hits += 1;
    }
    assert!(hits > 100, "{name}: {hits} rays hit");
    worst
}

#[test]
fn benign_rays_meet_the_same_shapes_by_any_arithmetic() {
    for (name, shape) in shapes() {
        let (double, single) = (
            worst_error::<f64>(name, &shape),
            worst_error::<f32>(name, &shape),
        );
        println!("{name:<10} plain {double:.1e}, f32 {single:.1e}");
        // Near the apex a small step turns the normal; the roots of the quartic lose most of the
        // digits of f32.
        let bar = match name {
            "cone" => 1e-3,
            "torus" => 0.1,
            _ => 1e-4,
        };
        assert!(
            double < 1e-9 && single < bar,
            "{name}: {double:e} {single:e}"
        );
        assert!(single > 1e-9, "{name}: f32 is no f32");
    }
}

#[test]
fn hits_within_the_threshold_are_ignored_whatever_the_length_of_the_direction() {
    let plain = prepare::<BaselineShape<f64>>(&shapes()[1].1);
    let above = |height: f64, size: f64| {
        let normal = Vec3::new(0.3, 0.5, -1.0).normalize();
        let ray = Ray {
            origin: Vec3::new(0.2, -0.3, 0.1) + normal * height,
            direction: -normal * size,
        };
        plain
            .intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY)
            .is_some()
    };
    for size in [1e-3, 1.0, 1e6] {
        assert!(!above(0.9e-5, size) && above(1.1e-5, size), "{size}");
    }
}
