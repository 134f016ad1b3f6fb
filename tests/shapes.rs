//! Curved shapes against brute force: points along the ray, asked one by one whether they are
//! inside.

mod solids;

use proptest::prelude::*;
use rtc::internals::math::Vec3;
use rtc::internals::render::{
    Attributes, Disc, Instance, Intersect, PreparedMesh, Quad, Ray, Torus, Triangle, WatertightRay,
};
use std::sync::Arc;

/// Steps of the brute force over the stretch near the shape.
const STEPS: u32 = 4000;

fn vector(size: f64) -> impl Strategy<Value = Vec3> {
    let component = || -size..size;
    (component(), component(), component()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn axis() -> impl Strategy<Value = Vec3> {
    vector(1.0).prop_filter("an axis has a length", |v| v.length() > 0.1)
}

prop_compose! {
    /// A ray from outside that passes the origin within about 3.
    fn ray()(from in axis(), distance in 4.0..50.0_f64, target in vector(3.0)) -> Ray {
        let origin = from.normalize() * distance;
        Ray { origin, direction: (target - origin).normalize() }
    }
}

/// Compares a root with the signed distance along the ray: no point before it may be inside, and it
/// lies on the surface.
fn agrees(
    ray: &Ray,
    found: Option<f64>,
    distance: impl Fn(Vec3) -> f64,
) -> Result<(), TestCaseError> {
    let at = |t: f64| distance(ray.origin + ray.direction * t);
    let nearest = -ray.origin.dot(ray.direction);
    let (low, high) = (nearest - 8.0, nearest + 8.0);
    let end = found.unwrap_or(high);
    let step = (high - low) / f64::from(STEPS);
    let inside = (0..STEPS)
        .map(|k| low + step * f64::from(k))
        .find(|t| *t > 0.0 && *t < end && at(*t) < -1e-9);
    prop_assert_eq!(inside, None, "inside before the root {:?}", found);
    if let Some(t) = found {
        prop_assert!(
            at(t).abs() < 1e-11,
            "the root {} is {:e} off the surface",
            t,
            at(t)
        );
    }
    Ok(())
}

/// Distances along and from a unit axis.
fn along_and_from(p: Vec3, axis: Vec3) -> (f64, f64) {
    let along = p.dot(axis);
    (along, (p - axis * along).length())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn torus(ray in ray(), center in vector(1.0), axis in axis(), major in 0.2..2.0_f64, minor in 0.01..1.0_f64) {
        let unit = axis.normalize();
        agrees(&ray, Torus::new(center, axis, major, minor).intersect(&ray), |p| {
            let (z, rho) = along_and_from(p - center, unit);
            ((rho - major) * (rho - major) + z * z).sqrt() - minor
        })?;
    }

    #[test]
    fn disc(ray in ray(), center in vector(1.0), normal in axis(), radius in 0.05..2.0_f64) {
        let unit = normal.normalize();
        let t = (center - ray.origin).dot(unit) / ray.direction.dot(unit);
        let wanted = (ray.origin + ray.direction * t).distance(center) <= radius;
        let found = Disc::new(center, normal, radius).intersect(&ray);
        prop_assert_eq!(found.is_some(), wanted && t > 0.0);
        if let Some(found) = found {
            prop_assert!((found - t).abs() < 1e-9 * t.abs());
        }
    }

    /// What leaves a torus does not find at once the torus it leaves.
    #[test]
    fn rays_that_leave_do_not_come_back(ray in ray(), center in vector(1.0), axis in axis(), away in axis()) {
        let torus = Torus::new(center, axis, 1.0, 0.4);
        if let Some(t) = torus.intersect(&ray) {
            let interaction = torus.interaction(&ray, t);
            let out = if away.dot(interaction.normal) > 0.0 { away } else { -away };
            let again = torus.intersect(&interaction.ray(out));
            prop_assert!(again.is_none_or(|t| t > 1e-6), "{:?}", again);
        }
    }

    /// A ray at a point of a quadrilateral finds it, there or before, and what it finds lies on the ray and the surface.
    #[test]
    fn quads_are_hit_where_they_are(
        ray in ray(), corners in [vector(2.0), vector(2.0), vector(2.0), vector(2.0)], u in 0.01..0.99_f64, v in 0.01..0.99_f64
    ) {
        let [a, b, c, d] = corners;
        let target = a.lerp(b, u).lerp(d.lerp(c, u), v);
        let ray = Ray { origin: ray.origin, direction: target - ray.origin };
        let quad = Quad::new(corners);
        let Some((t, prim_id)) = quad.intersect(&ray, &WatertightRay::new(&ray)) else {
            return Err(TestCaseError::fail("missed"));
        };
        prop_assert!(t <= 1.0 + 1e-9, "found at {}", t);
        let at = ray.origin + ray.direction * t;
        prop_assert!(quad.interaction(&ray, t, prim_id).point.distance(at) < 1e-9);
    }

    /// A flat quadrilateral is its two triangles, whichever way it is cut.
    #[test]
    fn flat_quads_are_hit_inside_and_missed_outside(
        ray in ray(), corner in vector(1.0), side in axis(), other in axis(), x in -0.5..1.5_f64, y in -0.5..1.5_f64
    ) {
        prop_assume!(side.normalize().cross(other.normalize()).length() > 0.1);
        prop_assume!([x, y].iter().all(|w| w.abs() > 1e-6 && (w - 1.0).abs() > 1e-6));
        let target = corner + side * x + other * y;
        let direction = target - ray.origin;
        prop_assume!(direction.normalize().dot(side.cross(other).normalize()).abs() > 1e-3);
        let ray = Ray { origin: ray.origin, direction };
        let quad = Quad::new([corner, corner + side, corner + side + other, corner + other]);
        let inside = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
        prop_assert_eq!(quad.intersect(&ray, &WatertightRay::new(&ray)).is_some(), inside);
    }

    /// A placed mesh is hit where its triangles, placed one by one, are.
    #[test]
    fn placed_meshes_are_their_triangles(
        ray in ray(), corners in prop::collection::vec(vector(1.0), 3..30), x in axis(), y in axis(), z in axis(), to in vector(1.0)
    ) {
        prop_assume!(x.normalize().dot(y.normalize().cross(z.normalize())).abs() > 0.1);
        let triangles = (0..u32::try_from(corners.len()).unwrap() - 2).map(|k| [k, k + 1, k + 2]).collect::<Vec<_>>();
        let place = |p: Vec3| x * p.x + y * p.y + z * p.z + to;
        let nearest = triangles.iter().filter_map(|t| {
            Triangle::new(t.map(|k| place(corners[k as usize])))?.intersect(&ray, &WatertightRay::new(&ray))
        });
        let nearest = nearest.min_by(f64::total_cmp);
        let positions = corners.iter().map(|corner| corner.to_array()).collect();
        let level = rtc::internals::render::SimdLevel::best();
        let mesh = PreparedMesh::new(&positions, &triangles.into(), Attributes::default(), level);
        let instance = Instance::new(&Arc::new(mesh), [x, y, z, to]);
        let found = instance.intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY).map(|(t, _)| t);
        match (found, nearest) {
            (Some(found), Some(nearest)) => prop_assert!((found - nearest).abs() < 1e-9 * nearest, "{} {}", found, nearest),
            (None, None) => {}
            // Rays through an edge may fall on either side after rounding; they are rare and near.
            (found, nearest) => prop_assert!(false, "{:?} instead of {:?}", found, nearest),
        }
    }
}
