//! What leaves a surface does not find the surface it leaves, at any scale, place and angle.

use super::random::{Random, rays, tally};
use super::solids::{Form, KINDS, Kind, first, hit, icosphere};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Interaction, PreparedMesh, Ray};
use std::sync::Arc;

/// Scales, and how far from the origin.
const PLACES: [(f64, f64); 10] = [
    (1e-6, 0.0),
    (1e-3, 0.0),
    (1.0, 0.0),
    (1e3, 0.0),
    (1e6, 0.0),
    (1e8, 0.0),
    (1e-3, 1e3),
    (1.0, 1e4),
    (1e3, 1e7),
    (1.0, 1e8),
];

/// Rays of one shape.
const CHUNK: u64 = 64;

/// Half of how far a ray that leaves at `cosine` goes at least before it may meet the shape again;
/// `None` where no such bound is known. Outward from a convex shape that is for ever.
fn least(form: &Form, at: &Interaction, outward: bool, cosine: f64) -> Option<f64> {
    let tilted = cosine.min(0.5);
    // A solid with flat ends is asked about only in the middle of its side, where the ends are far.
    let middle = || {
        let local = at.point - form.center;
        let along = local.dot(form.axis);
        let rho = (local - form.axis * along).length();
        let share = along / form.height;
        let side = at.normal.dot(form.axis).abs() < 0.999;
        (side && (0.3..0.7).contains(&share)).then(|| 0.25 * form.height.min(rho))
    };
    match form.kind {
        kind if outward && kind.is_convex() => Some(f64::INFINITY),
        Kind::Plane | Kind::Triangle | Kind::Quad | Kind::Disc => Some(f64::INFINITY),
        Kind::Sphere => Some(form.radius * tilted),
        Kind::Patch => Some(form.radius * tilted * 0.1),
        Kind::Torus if outward => Some((form.radius - form.minor) * tilted),
        Kind::Torus => Some(form.minor * tilted),
        Kind::Cylinder | Kind::Cone | Kind::Paraboloid => middle().map(|size| size * tilted),
        Kind::Mesh => None,
    }
}

/// Rays asked and false hits of one shape.
fn chunk(kind: Kind, mesh: &Arc<PreparedMesh>, index: u64) -> (u64, u64) {
    let mut random = Random::at(2, index);
    let (size, distance) = PLACES[random.below(PLACES.len())];
    let center = random.direction() * distance + random.cube() * size;
    let form = Form::random(kind, &mut random, size, center, mesh);
    let shape = form.shape();
    let (mut asked, mut bad) = (0, 0);
    for _ in 0..CHUNK {
        let target = form.target(&mut random);
        let origin = target + random.direction() * (size * random.magnitude(1e-2, 1e4));
        let ray = Ray {
            origin,
            direction: target - origin,
        };
        let Some(at) = first(&form, &shape, &ray) else {
            continue;
        };
        let cosine = random.magnitude(1e-6, 1.0);
        let outward = random.uniform() < 0.5;
        let along = at.normal.cross(random.direction()).normalize_or(Vec3::ZERO);
        let up = if outward { at.normal } else { -at.normal };
        let direction = along * (1.0 - cosine * cosine).sqrt() + up * cosine;
        let Some(least) = least(&form, &at, outward, cosine) else {
            continue;
        };
        asked += 1;
        let again = hit(&shape, &at.ray(direction));
        bad += u64::from(again.is_some_and(|(t, _)| t < least));
    }
    (asked, bad)
}

#[test]
fn rays_that_leave_do_not_find_what_they_leave() {
    let mesh = icosphere();
    let bad = KINDS.map(|(kind, name)| {
        tally("false self-hits", name, rays(KINDS.len()) / CHUNK, |k| {
            chunk(kind, &mesh, k)
        })
        .bad
    });
    assert_eq!(bad, [0; KINDS.len()]);
}
