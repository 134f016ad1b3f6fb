//! Curved shapes against brute force: points along the ray, asked one by one whether they are inside.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use proptest::prelude::*;
use rtc::math::Vec3;
use rtc::render::{Cone, Cylinder, Disc, Ray, Torus};

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

/// Compares a root with the signed distance along the ray: no point before it may be inside, and it lies on the surface.
fn agrees(ray: &Ray, found: Option<f64>, distance: impl Fn(Vec3) -> f64) -> Result<(), TestCaseError> {
    let at = |t: f64| distance(ray.origin + ray.direction * t);
    let nearest = -ray.origin.dot(ray.direction);
    let (low, high) = (nearest - 8.0, nearest + 8.0);
    let end = found.unwrap_or(high);
    let step = (high - low) / f64::from(STEPS);
    let inside = (0..STEPS).map(|k| low + step * f64::from(k)).find(|t| *t > 0.0 && *t < end && at(*t) < -1e-9);
    prop_assert_eq!(inside, None, "inside before the root {:?}", found);
    if let Some(t) = found {
        prop_assert!(at(t).abs() < 1e-11, "the root {} is {:e} off the surface", t, at(t));
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
    fn cylinder(ray in ray(), base in vector(1.0), axis in axis(), height in 0.1..3.0_f64, radius in 0.01..2.0_f64) {
        let unit = axis.normalize();
        agrees(&ray, Cylinder::new(base, axis, height, radius).intersect(&ray), |p| {
            let (z, rho) = along_and_from(p - base, unit);
            (rho - radius).max(-z).max(z - height)
        })?;
    }

    #[test]
    fn cone(ray in ray(), base in vector(1.0), up in axis(), radius in 0.05..2.0_f64) {
        let (unit, height) = (up.normalize(), up.length());
        agrees(&ray, Cone::new(base, up, radius).intersect(&ray), |p| {
            let (z, rho) = along_and_from(p - base, unit);
            let slant = (height * height + radius * radius).sqrt();
            ((rho - radius * (1.0 - z / height)) * height / slant).max(-z)
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

    /// What leaves a surface does not find the surface it leaves.
    #[test]
    fn rays_that_leave_do_not_come_back(ray in ray(), center in vector(1.0), axis in axis(), away in axis()) {
        let (cone, cylinder) = (Cone::new(center, axis, 0.7), Cylinder::new(center, axis, 1.5, 0.6));
        if let Some(t) = cone.intersect(&ray) {
            let interaction = cone.interaction(&ray, t);
            let out = if away.dot(interaction.normal) > 0.0 { away } else { -away };
            prop_assert_eq!(cone.intersect(&interaction.ray(out)), None);
        }
        if let Some(t) = cylinder.intersect(&ray) {
            let interaction = cylinder.interaction(&ray, t);
            let out = if away.dot(interaction.normal) > 0.0 { away } else { -away };
            prop_assert_eq!(cylinder.intersect(&interaction.ray(out)), None);
        }
        let torus = Torus::new(center, axis, 1.0, 0.4);
        if let Some(t) = torus.intersect(&ray) {
            let interaction = torus.interaction(&ray, t);
            let out = if away.dot(interaction.normal) > 0.0 { away } else { -away };
            let again = torus.intersect(&interaction.ray(out));
            prop_assert!(again.is_none_or(|t| t > 1e-6), "{:?}", again);
        }
    }
}
