//! Rays that start exactly on a shape do not hit the point they start from, but hit the far side.

use super::Shape;
use super::cone::Cone;
use super::csg::Csg;
use super::cylinder::{Cylinder, InfiniteCylinder};
use super::disc::Disc;
use super::ellipsoid::Ellipsoid;
use super::geometry::Intersect;
use super::paraboloid::Paraboloid;
use super::plane::Plane;
use super::quad::Quad;
use super::sphere::{Sphere, TexturedSphere};
use super::torus::Torus;
use super::triangle::{Triangle, WatertightRay};
use crate::ray::Ray;
use rtc_math::{OrthonormalBasis, SetStep, Vec3};

/// Scales of a shape, powers of two: all points of this file stay exactly on their shapes.
const SCALES: [f64; 3] = [1.0 / 1_048_576.0, 1.0, 1_073_741_824.0];

/// The first root of a ray.
type FirstRoot = Box<dyn Fn(&Ray) -> Option<f64>>;

/// A point and the normal there.
type Eye = ([f64; 3], [f64; 3]);

/// Directions spread over the sphere: a spiral of the golden angle.
fn directions() -> impl Iterator<Item = Vec3> {
    const COUNT: u32 = 500;
    (0..COUNT).map(|k| {
        let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(COUNT);
        let angle = f64::from(k) * 2.399_963_229_728_653;
        let across = (1.0 - z * z).sqrt();
        Vec3::new(across * libm::cos(angle), across * libm::sin(angle), z)
    })
}

/// Asks a shape, which `make` builds about a centre and in a scale, from eyes given in its own
/// frame. Outwards a convex shape is not seen, any other not at once; inwards its far side is.
fn check_eyes(name: &str, make: impl Fn(Vec3, f64) -> FirstRoot, is_convex: bool, eyes: &[Eye]) {
    for scale in SCALES {
        let center = Vec3::new(3.0, -7.0, 9.0) * scale;
        let first = make(center, scale);
        for (point, normal) in eyes {
            let origin = center + Vec3::from_array(*point) * scale;
            for direction in directions() {
                let slope = direction.dot(Vec3::from_array(*normal));
                let t = first(&Ray { origin, direction });
                let reported =
                    format!("{name} × {scale}, from {point:?} along {direction:?}: {t:?}");
                let is_far = t.is_none_or(|t| t > 0.001 * scale);
                assert!(slope.abs() < 0.01 || is_far, "{reported}");
                assert!(slope < 0.01 || !is_convex || t.is_none(), "{reported}");
                assert!(slope > -0.01 || t.is_some(), "{reported}");
            }
        }
    }
}

fn boxed<S: Intersect + 'static>(shape: S) -> FirstRoot {
    Box::new(move |ray| {
        shape
            .intersect(ray, &WatertightRay::new(ray), f64::INFINITY)
            .map(|(t, _)| t)
    })
}

#[test]
fn spheres_and_solids_are_seen_from_within_alone() {
    let ball: Vec<Eye> = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]
        .map(|p| (p, p))
        .into();
    check_eyes(
        "sphere",
        |center, radius| {
            let sphere = Sphere { center, radius };
            Box::new(move |ray| sphere.intersect(ray))
        },
        true,
        &ball,
    );
    check_eyes(
        "cylinder",
        |base, s| boxed(Cylinder::new(base, Vec3::X, 10.0 * s, s)),
        true,
        &[
            ([5.0, 0.0, -1.0], [0.0, 0.0, -1.0]),
            ([5.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
            ([0.0, 0.5, 0.0], [-1.0, 0.0, 0.0]),
            ([10.0, 0.0, 0.25], [1.0, 0.0, 0.0]),
        ],
    );
    let slant = [0.8, 0.6, 0.0];
    check_eyes(
        "cone",
        |base, s| boxed(Cone::new(base, Vec3::Y * (4.0 * s), 3.0 * s)),
        true,
        &[
            ([1.5, 2.0, 0.0], slant),
            ([0.0, 1.0, 2.25], [0.0, 0.6, 0.8]),
            ([0.5, 0.0, 0.5], [0.0, -1.0, 0.0]),
        ],
    );
    check_eyes(
        "paraboloid",
        |base, s| boxed(Paraboloid::new(base, Vec3::Y * s, s)),
        true,
        &[
            ([0.5, 0.75, 0.0], [0.5, 0.5, 0.0]),
            ([0.0, 0.75, -0.5], [0.0, 0.5, -0.5]),
            ([0.25, 0.0, 0.0], [0.0, -1.0, 0.0]),
        ],
    );
    check_eyes(
        "infinite cylinder",
        |center, s| boxed(InfiniteCylinder::new(center, Vec3::X, s)),
        true,
        &[
            ([5.0, 0.0, -1.0], [0.0, 0.0, -1.0]),
            ([-3.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
        ],
    );
    check_eyes(
        "ellipsoid",
        |center, s| {
            boxed(Ellipsoid::new(
                center,
                [Vec3::X * (4.0 * s), Vec3::Y * s, Vec3::Z * (2.0 * s)],
            ))
        },
        true,
        &[
            ([4.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, -1.0, 0.0], [0.0, -1.0, 0.0]),
            ([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
        ],
    );
}

/// A round shape of some height and radius about an axis from a base.
type Round = fn(Vec3, Vec3, [f64; 2]) -> Shape;

/// A point of a round shape in the frame of its axis and a direction across it, and the normal
/// there.
type RoundEye = fn([f64; 2]) -> ([f64; 2], [f64; 2]);

/// Round shapes, each with points on every part.
const ROUND: [(&str, Round, &[RoundEye]); 4] = [
    (
        "cylinder",
        |base, axis, [height, radius]| {
            Shape::Cylinder(Cylinder::new(base, axis * 1.375, height, radius))
        },
        &[
            |[height, radius]| ([0.375 * height, radius], [0.0, 1.0]),
            |[height, radius]| ([0.875 * height, radius], [0.0, 1.0]),
            |[_, radius]| ([0.0, 0.3 * radius], [-1.0, 0.0]),
            |[height, radius]| ([height, 0.7 * radius], [1.0, 0.0]),
        ],
    ),
    (
        "infinite cylinder",
        |base, axis, [_, radius]| {
            Shape::InfiniteCylinder(InfiniteCylinder::new(base, axis * 1.375, radius))
        },
        &[
            |[height, radius]| ([10.0 * height, radius], [0.0, 1.0]),
            |[height, radius]| ([-0.3 * height, radius], [0.0, 1.0]),
        ],
    ),
    (
        "cone",
        |base, axis, [height, radius]| Shape::Cone(Cone::new(base, axis * height, radius)),
        &[
            |[height, radius]| ([0.25 * height, 0.75 * radius], [radius, height]),
            |[height, radius]| ([0.7 * height, 0.3 * radius], [radius, height]),
            |[_, radius]| ([0.0, 0.3 * radius], [-1.0, 0.0]),
        ],
    ),
    (
        "paraboloid",
        |base, axis, [height, radius]| {
            Shape::Paraboloid(Paraboloid::new(base, axis * height, radius))
        },
        &[
            |[height, radius]| ([0.75 * height, 0.5 * radius], [radius, height]),
            |[height, radius]| ([0.36 * height, 0.8 * radius], [radius, 1.6 * height]),
            |[_, radius]| ([0.0, 0.3 * radius], [-1.0, 0.0]),
        ],
    ),
];

/// Every 7th of the directions.
fn some_directions() -> impl Iterator<Item = Vec3> {
    directions().step_by(7)
}

/// Asks a shape, and a solid of it and a ball around it, from a point to within rounding on both.
fn check_eye(name: &str, shape: &Shape, radius: f64, origin: Vec3, normal: Vec3) {
    let around = Shape::Sphere(TexturedSphere {
        sphere: Sphere {
            center: origin,
            radius: 1e6 * radius,
        },
        texture_from_world: Vec3::AXES,
    });
    let steps = vec![SetStep::Operand, SetStep::Operand, SetStep::Intersection];
    let solid = Shape::Csg(Box::new(Csg::new(vec![shape.clone(), around], steps, 1)));
    let normal = normal.normalize();
    for direction in some_directions() {
        let slope = direction.dot(normal);
        let ray = Ray { origin, direction };
        for (kind, shape) in [("alone", shape), ("solid", &solid)] {
            let hit = shape.intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY);
            let reported = format!("{name}, {kind}, from {origin:?} along {direction:?}: {hit:?}");
            assert!(slope < 0.01 || hit.is_none(), "{reported}");
            let is_far = hit.is_some_and(|(t, _)| t > 1e-7 * radius);
            // Along its axis, an infinite cylinder is far.
            assert!(slope > -0.01 || is_far, "{reported}");
        }
    }
}

#[test]
fn round_shapes_about_any_axis_are_seen_from_within_alone() {
    let sizes = [[2.0, 1.0], [0.7, 2.3], [31.0, 0.17], [0.001, 3.7]];
    for (name, make, eyes) in ROUND {
        for (k, axis) in some_directions().enumerate() {
            let scale = SCALES[k % 3] * (1.0 + 0.01 * k as f64);
            let base = Vec3::new(3.1, -7.7, 9.3) * scale;
            let size = sizes[k % 4].map(|length| length * scale);
            let shape = make(base, axis, size);
            let basis = OrthonormalBasis::around(axis);
            for (turn, eye) in eyes.iter().enumerate() {
                let angle = (k + 5 * turn) as f64;
                let across = basis.tangent * libm::cos(angle) + basis.bitangent * libm::sin(angle);
                let ([along, off], normal) = eye(size);
                let point = base + axis * along + across * off;
                let normal = axis * normal[0] + across * normal[1];
                check_eye(name, &shape, size[1], point, normal);
            }
        }
    }
}

#[test]
fn an_ellipsoid_of_any_axes_is_seen_from_within_alone() {
    for (k, axis) in some_directions().enumerate() {
        let scale = SCALES[k % 3];
        let basis = OrthonormalBasis::around(axis);
        let lengths = [1.7, 0.3, 0.9].map(|length| length * scale);
        let axes = [axis, basis.tangent, basis.bitangent];
        let center = Vec3::new(3.1, -7.7, 9.3) * scale;
        let [x, y, z] = [0, 1, 2].map(|k| axes[k] * lengths[k]);
        let shape = Shape::Ellipsoid(Box::new(Ellipsoid::new(center, [x, y, z])));
        for unit in some_directions().step_by(9) {
            let point = center + x * unit.x + y * unit.y + z * unit.z;
            let [u, v, w] = [0, 1, 2].map(|k| axes[k] * (scale / lengths[k]));
            let normal = u * unit.x + v * unit.y + w * unit.z;
            check_eye("ellipsoid", &shape, scale, point, normal);
        }
    }
}

#[test]
fn a_torus_is_seen_from_its_tube_across_the_tube_or_the_hole() {
    check_eyes(
        "torus",
        |center, s| boxed(Torus::new(center, Vec3::Z, 2.0 * s, 0.5 * s)),
        false,
        &[
            ([2.5, 0.0, 0.0], [1.0, 0.0, 0.0]),
            ([0.0, -1.5, 0.0], [0.0, 1.0, 0.0]),
            ([2.0, 0.0, 0.5], [0.0, 0.0, 1.0]),
            ([0.0, 2.0, -0.5], [0.0, 0.0, -1.0]),
        ],
    );
}

#[test]
fn what_is_flat_is_not_seen_from_its_own_plane() {
    let corners = |c: Vec3, s: f64| {
        [
            c,
            c + Vec3::X * s,
            c + (Vec3::X + Vec3::Y) * s,
            c + Vec3::Y * s,
        ]
    };
    let mut all: Vec<(&str, FirstRoot)> = Vec::new();
    for scale in SCALES {
        let center = Vec3::new(3.0, -7.0, 9.0) * scale;
        all.push(("plane", boxed(Plane::new(center, Vec3::Z))));
        all.push(("disc", boxed(Disc::new(center, Vec3::Z, scale))));
        let [a, b, c, d] = corners(center - (Vec3::X + Vec3::Y) * (0.5 * scale), scale);
        all.push(("quad", boxed(Quad::new([a, b, c, d]))));
        let triangle = Triangle::new([a, b, c]).expect("it has an area");
        let first = move |ray: &Ray| triangle.intersect(ray, &WatertightRay::new(ray));
        all.push(("triangle", Box::new(first)));
        for (name, first) in all.drain(..) {
            for direction in directions() {
                let ray = Ray {
                    origin: center + Vec3::new(0.25, -0.25, 0.0) * scale,
                    direction,
                };
                assert_eq!(first(&ray), None, "{name} × {scale} along {direction:?}");
            }
        }
    }
}
