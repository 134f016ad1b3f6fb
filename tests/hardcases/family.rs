//! Families of random rays and shapes, each hard in one way; every number comes from a seed and an
//! index.

use super::random::Random;
use super::scenes::{cone, cylinder, paraboloid, plane, sphere, torus, triangle};
use rtc::internals::ir;
use rtc::internals::math::Vec3;
use rtc::internals::render::Ray;

type Row = (ir::Shape, Ray);

/// A shape, what is hard about it, and rows of both.
pub(crate) type Family = (&'static str, &'static str, fn(&mut Random) -> Row);

pub(crate) const FAMILIES: [Family; 30] = [
    ("sphere", "generic", |r| {
        round(r, (0.3, 3.0), (3.0, 30.0), 0.95)
    }),
    ("sphere", "far_small", |r| {
        round(r, (1e-6, 0.1), (1e3, 1e8), 0.95)
    }),
    ("sphere", "huge_near", huge_near),
    ("sphere", "grazing", |r| tangent_sphere(r, -1.0)),
    ("sphere", "near_miss", |r| tangent_sphere(r, 1.0)),
    ("sphere", "inside", inside),
    ("triangle", "generic", |r| {
        flat(r, [1.0, 1.0], Vec3::ZERO, (0.1, 1.0))
    }),
    ("triangle", "sliver", |r| {
        flat(r, [1e-12, 1e-3], Vec3::ZERO, (0.1, 1.0))
    }),
    ("triangle", "offset1e7", |r| {
        flat(r, [1.0, 1.0], Vec3::new(1e7, -1e7, 1e7), (0.1, 1.0))
    }),
    ("triangle", "grazing", |r| {
        flat(r, [1.0, 1.0], Vec3::ZERO, (1e-9, 1e-1))
    }),
    ("plane", "generic", |r| level(r, 10.0, (0.1, 1.0))),
    ("plane", "near_parallel", |r| level(r, 10.0, (1e-12, 1e-1))),
    ("plane", "offset1e8", |r| level(r, 1e9, (0.1, 1.0))),
    ("cylinder", "generic", |r| {
        pillar(r, as_cylinder, (0.3, 2.0), (5.0, 30.0))
    }),
    ("cylinder", "thin_far", |r| {
        pillar(r, as_cylinder, (1e-5, 1e-3), (1e2, 1e4))
    }),
    ("cylinder", "near_axis", |r| along_axis(r, as_cylinder)),
    ("cone", "generic", |r| {
        pillar(r, as_cone, (0.3, 2.0), (5.0, 30.0))
    }),
    ("cone", "thin_far", |r| {
        pillar(r, as_cone, (1e-5, 1e-3), (1e2, 1e4))
    }),
    ("cone", "near_axis", |r| along_axis(r, as_cone)),
    ("paraboloid", "generic", |r| {
        pillar(r, as_paraboloid, (0.3, 2.0), (5.0, 30.0))
    }),
    ("paraboloid", "thin_far", |r| {
        pillar(r, as_paraboloid, (1e-5, 1e-3), (1e2, 1e4))
    }),
    ("paraboloid", "flat_far", |r| {
        pillar(r, as_paraboloid, (1e3, 1e5), (1e6, 1e8))
    }),
    ("paraboloid", "far_small", tiny_paraboloid),
    ("paraboloid", "near_axis", |r| along_axis(r, as_paraboloid)),
    ("paraboloid", "grazing", tangent_paraboloid),
    ("torus", "generic", |r| {
        ring(r, false, (0.1, 0.9), (5.0, 30.0))
    }),
    ("torus", "axis_z", |r| {
        ring(r, true, (0.1, 0.9), (5.0, 30.0))
    }),
    ("torus", "far", |r| ring(r, false, (0.1, 0.9), (1e2, 1e6))),
    ("torus", "thin", |r| {
        ring(r, false, (1e-4, 1e-1), (5.0, 30.0))
    }),
    ("torus", "grazing", tangent_torus),
];

/// A ray through `target` from `distance` away, with a direction of any length.
fn towards(random: &mut Random, target: Vec3, back: Vec3, distance: f64) -> Ray {
    let origin = target + back * distance;
    let direction = (target - origin).normalize();
    Ray {
        origin,
        direction: if random.uniform() < 0.5 {
            direction
        } else {
            direction * random.magnitude(1e-3, 1e3)
        },
    }
}

fn round(random: &mut Random, radius: (f64, f64), distance: (f64, f64), inside: f64) -> Row {
    let (center, radius) = (random.cube() * 10.0, random.magnitude(radius.0, radius.1));
    let target = center + random.direction() * (radius * inside * random.uniform());
    let (back, distance) = (
        random.direction(),
        random.magnitude(distance.0, distance.1).max(2.0 * radius),
    );
    (
        sphere(center.to_array(), radius),
        towards(random, target, back, distance),
    )
}

/// A ground that is a sphere, and an eye just above it.
fn huge_near(random: &mut Random) -> Row {
    let (up, radius) = (random.direction(), random.magnitude(1e5, 1e9));
    let center = random.cube() * 100.0 - up * radius;
    let origin = center + up * (radius + random.magnitude(1e-3, 10.0));
    let level = up.cross(random.direction()).normalize();
    let direction = level - up * random.magnitude(1e-3, 10.0);
    (sphere(center.to_array(), radius), Ray { origin, direction })
}

/// The ray's distance from the centre differs from the radius by a share of 10⁻¹⁴ to 10⁻¹ on the
/// side given.
fn tangent_sphere(random: &mut Random, side: f64) -> Row {
    let (center, radius) = (random.cube() * 10.0, random.magnitude(0.3, 3.0));
    let (normal, share) = (random.direction(), random.magnitude(1e-14, 1e-1));
    let target = center + normal * (radius * (1.0 + side * share));
    let (back, distance) = (
        normal.cross(random.direction()).normalize(),
        random.magnitude(3.0, 30.0),
    );
    (
        sphere(center.to_array(), radius),
        towards(random, target, back, distance),
    )
}

fn inside(random: &mut Random) -> Row {
    let (center, radius) = (random.cube() * 10.0, random.magnitude(0.3, 10.0));
    let depth = random.magnitude(1e-12, 1.0);
    let origin = center + random.direction() * (radius * (1.0 - depth));
    (
        sphere(center.to_array(), radius),
        Ray {
            origin,
            direction: random.direction(),
        },
    )
}

/// A triangle of the height given, and a ray that meets it at the slope given.
fn flat(random: &mut Random, height: [f64; 2], offset: Vec3, slope: (f64, f64)) -> Row {
    let (a, b) = (random.cube() + offset, random.cube() + offset);
    let height = random.magnitude(height[0], height[1]);
    let c = a + (b - a) * random.between(-0.2, 1.2) + random.direction() * height;
    let (u, v) = (random.between(0.1, 0.45), random.between(0.1, 0.45));
    let target = a + (b - a) * u + (c - a) * v;
    let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
    let back =
        normal.cross(random.direction()).normalize() + normal * random.magnitude(slope.0, slope.1);
    let distance = random.magnitude(1.0, 20.0);
    (
        triangle([a, b, c].map(|p| p.to_array())),
        towards(random, target, back, distance),
    )
}

/// A plane about `size` from the origin, and a ray that starts near it and meets it, or leaves it,
/// at the slope given.
fn level(random: &mut Random, size: f64, slope: (f64, f64)) -> Row {
    let (center, normal) = (random.cube() * size, random.direction());
    let origin = center + random.cube() * 10.0;
    let side = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
    let direction = normal.cross(random.direction()).normalize()
        + normal * (side * random.magnitude(slope.0, slope.1));
    let raw = normal * random.magnitude(1e-3, 1e3);
    (
        plane(center.to_array(), raw.to_array()),
        Ray { origin, direction },
    )
}

/// A shape that stands on a disc: base, axis, height and radius.
type Upright = fn(&mut Random, Vec3, Vec3, f64, f64) -> ir::Shape;

fn as_cylinder(random: &mut Random, base: Vec3, axis: Vec3, height: f64, radius: f64) -> ir::Shape {
    let axis = axis * random.between(0.5, 1.5);
    cylinder(base.to_array(), axis.to_array(), height, radius)
}

fn as_cone(_: &mut Random, base: Vec3, axis: Vec3, height: f64, radius: f64) -> ir::Shape {
    cone(base.to_array(), (axis * height).to_array(), radius)
}

fn as_paraboloid(_: &mut Random, base: Vec3, axis: Vec3, height: f64, radius: f64) -> ir::Shape {
    paraboloid(base.to_array(), (axis * height).to_array(), radius)
}

/// A shape that stands on a disc, and a ray at its middle.
fn pillar(random: &mut Random, upright: Upright, radius: (f64, f64), distance: (f64, f64)) -> Row {
    let (base, axis) = (random.cube() * 10.0, random.direction());
    let (height, radius) = (
        random.between(0.5, 5.0),
        random.magnitude(radius.0, radius.1),
    );
    let shape = upright(random, base, axis, height, radius);
    let target = base
        + axis * (height * random.between(0.05, 0.95))
        + random.direction() * (radius * random.uniform());
    let (back, distance) = (random.direction(), random.magnitude(distance.0, distance.1));
    (shape, towards(random, target, back, distance))
}

/// A shape that stands on a disc, and a ray that is parallel to its axis but for an angle of 10⁻⁹ to 10⁻².
fn along_axis(random: &mut Random, upright: Upright) -> Row {
    let (base, axis) = (random.cube() * 10.0, random.direction());
    let (height, radius) = (random.between(0.5, 5.0), random.between(0.3, 2.0));
    let shape = upright(random, base, axis, height, radius);
    let target = base
        + axis * (height * random.uniform())
        + random.direction() * (1.2 * radius * random.uniform());
    let side = if random.uniform() < 0.5 { axis } else { -axis };
    let back = side + random.direction() * random.magnitude(1e-9, 1e-2);
    let distance = random.magnitude(6.0, 30.0);
    (shape, towards(random, target, back, distance))
}

/// A paraboloid of 10⁻⁶ to 10⁻¹, up to 10⁸ away.
fn tiny_paraboloid(random: &mut Random) -> Row {
    let (base, axis) = (random.cube() * 10.0, random.direction());
    let (height, radius) = (random.magnitude(1e-6, 0.1), random.magnitude(1e-6, 0.1));
    let target = base
        + axis * (height * random.uniform())
        + random.direction() * (radius * random.uniform());
    let (back, distance) = (random.direction(), random.magnitude(1e3, 1e8));
    (
        paraboloid(base.to_array(), (axis * height).to_array(), radius),
        towards(random, target, back, distance),
    )
}

/// A ray along the side of a paraboloid: its distance from the axis differs from that of the side
/// by a fraction of 10⁻¹² to 10⁻², on either side.
fn tangent_paraboloid(random: &mut Random) -> Row {
    let (base, axis) = (random.cube() * 10.0, random.direction());
    let (height, radius) = (random.between(0.5, 5.0), random.between(0.3, 2.0));
    // A point of the side: at the depth m below the vertex, ρ² = m·radius²/height.
    let depth = height * random.between(0.05, 0.95);
    let rho = radius * (depth / height).sqrt();
    let around = axis.cross(random.direction()).normalize();
    let normal = (around * (2.0 * rho) + axis * (radius * radius / height)).normalize();
    let sign = if random.uniform() < 0.7 { -1.0 } else { 1.0 };
    let offset = 1.0 + sign * random.magnitude(1e-12, 1e-2);
    let target = base + axis * (height - depth) + around * (rho * offset);
    let (back, distance) = (
        normal.cross(random.direction()).normalize(),
        random.magnitude(5.0, 30.0),
    );
    (
        paraboloid(base.to_array(), (axis * height).to_array(), radius),
        towards(random, target, back, distance),
    )
}

/// A torus whose tube has the share given of its radius, and a ray at the tube.
fn ring(random: &mut Random, upright: bool, share: (f64, f64), distance: (f64, f64)) -> Row {
    let (center, major) = (random.cube() * 10.0, random.between(0.5, 5.0));
    let axis = if upright {
        Vec3::Z
    } else {
        random.direction() * random.between(0.5, 1.5)
    };
    let minor = major * random.magnitude(share.0, share.1);
    let around = axis.cross(random.direction()).normalize();
    let target = center + around * major + random.direction() * (minor * random.uniform());
    let (back, distance) = (
        random.direction(),
        random.magnitude(distance.0, distance.1) + major,
    );
    (
        torus(center.to_array(), axis.to_array(), major, minor),
        towards(random, target, back, distance),
    )
}

/// A ray that touches the tube but for a share of 10⁻¹² to 10⁻² of its radius, on either side.
fn tangent_torus(random: &mut Random) -> Row {
    let (center, major, axis) = (
        random.cube() * 10.0,
        random.between(0.5, 5.0),
        random.direction(),
    );
    let minor = major * random.between(0.1, 0.7);
    let around = axis.cross(random.direction()).normalize();
    let normal =
        (around * random.between(-0.2, 1.0) + axis * random.between(-1.0, 1.0)).normalize();
    let side = if random.uniform() < 0.7 { -1.0 } else { 1.0 };
    let depth = minor * (1.0 + side * random.magnitude(1e-12, 1e-2));
    let back = normal.cross(random.direction()).normalize();
    let distance = random.magnitude(5.0, 30.0);
    let target = center + around * major + normal * depth;
    (
        torus(center.to_array(), axis.to_array(), major, minor),
        towards(random, target, back, distance),
    )
}
