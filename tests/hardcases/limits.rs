//! The ends of ranges: the critical angle, exponents, lenses of no size, lights on surfaces.

use super::random::Random;
use super::scenes::{disc, plane, sphere, triangle, world};
use rtc::internals::math::{U, Vec3, ldexp, view_basis};
use rtc::internals::render::{Intersect, Ray, highlight, refract, vogel};

/// From glass of 1.25 the critical sine is 0.8: one ulp below is refracted along the surface, one
/// above is not.
#[test]
fn the_critical_angle_is_met_to_the_ulp() {
    let out = |sine: f64| {
        refract(
            Vec3::new(sine, -((1.0 - sine) * (1.0 + sine)).sqrt(), 0.0),
            Vec3::Y,
            1.25,
            1.0,
        )
    };
    for sine in [0.8_f64.next_down(), 0.8] {
        let direction = out(sine).unwrap();
        assert!(
            (direction.length() - 1.0).abs() <= 2.0 * U && direction.x > 0.99,
            "{direction}"
        );
        assert!(direction.y <= 0.0 && direction.y >= -1e-7, "{direction}");
    }
    assert_eq!(out(0.8_f64.next_up()), None);
}

/// Exponents from 0 to a million leave a highlight in [0, 1], falling with the exponent, and never
/// −0.
#[test]
fn no_exponent_takes_the_highlight_out_of_range() {
    let cosines = [
        -1.0,
        -0.0,
        0.0,
        5e-324,
        1e-300,
        1e-3,
        0.5,
        1.0 - U,
        1.0,
        1.0 + 2.0 * U,
        2.0,
    ];
    for cosine in cosines {
        let mut before = f64::INFINITY;
        for n in [0.0, 5e-324, 0.5, 1.0, 2.0, 64.0, 1e3, 1e5, 1e6] {
            let value = highlight(cosine, n);
            assert!(
                (0.0..=1.0).contains(&value) && value.is_sign_positive(),
                "{cosine}^{n} = {value}"
            );
            assert!(value <= before, "{cosine}^{n} = {value}");
            before = value;
        }
        assert_eq!(highlight(cosine, 0.0), 1.0);
    }
}

/// Lenses of up to a million points and of any radius, subnormal ones included, keep their points
/// within it.
#[test]
fn lenses_of_any_size_keep_their_points() {
    let mut random = Random::new(8);
    for _ in 0..20_000 {
        let n = random.magnitude(1.0, 1e6) as u32 + 1;
        let k = u32::try_from(random.below(n as usize)).unwrap();
        let radius = ldexp(random.between(0.5, 1.0), -(random.below(1074) as i32));
        let [x, y] = vogel(k, n, radius, 1.0);
        let (x, y) = (x / radius, y / radius);
        // A subnormal rounds by half of the smallest one.
        let rounding = 4.0 * U + 5e-324 / radius;
        assert!(
            (x * x + y * y - f64::from(k) / f64::from(n)).abs() <= 4.0 * rounding,
            "{k} of {n}, radius {radius:e}"
        );
    }
    assert_eq!(
        [1, 2, 1_000_000].map(|n| vogel(0, n, 1.0, 1.0)),
        [[0.0; 2]; 3]
    );
}

/// A camera's basis depends on the lengths of view and `up` by their powers of two alone.
#[test]
fn lengths_of_any_size_give_the_same_basis() {
    let mut random = Random::new(9);
    for _ in 0..2_000 {
        let (gaze, up) = (random.cube(), random.cube());
        let (right, above) = view_basis(gaze, up).unwrap();
        let [i, j] = [(); 2].map(|()| ldexp(1.0, random.below(1900) as i32 - 950));
        assert_eq!(
            view_basis(gaze * i, up * j),
            Ok((right * j, above * j)),
            "{gaze} {up} {i:e} {j:e}"
        );
    }
}

/// A light on a surface is not hidden by that surface from any point that faces it, whatever the
/// scale.
#[test]
fn a_light_on_a_surface_is_not_hidden_by_it() {
    let mut random = Random::new(10);
    for k in 0..20_000 {
        let size = random.magnitude(1e-6, 1e8);
        let center = random.cube() * size;
        let normal = random.direction();
        let corner = |random: &mut Random| (center + random.cube() * size).to_array();
        let shape = match k % 4 {
            0 => sphere(center.to_array(), size * random.between(0.1, 1.0)),
            1 => plane(center.to_array(), normal.to_array()),
            2 => disc(center.to_array(), normal.to_array(), size),
            _ => triangle([
                corner(&mut random),
                corner(&mut random),
                corner(&mut random),
            ]),
        };
        let world = world([shape]);
        let origin = center + random.direction() * (5.0 * size);
        let ray = Ray {
            origin,
            direction: center + random.cube() * (0.3 * size) - origin,
        };
        let Some(hit) = world.closest_hit(&ray) else {
            continue;
        };
        let light = world.surfaces[hit.surface]
            .shape
            .interaction(&ray, hit.t, hit.prim_id);
        let back = -ray.direction.normalize();
        if light.normal.dot(back).abs() < 0.3 {
            continue;
        }
        assert!(!world.occluded(origin, light.point), "{k}: {ray:?}");
        let through = light.point - back * (0.01 * size);
        let solid = k % 4 == 0;
        assert!(solid || world.occluded(origin, through), "{k}: {ray:?}");
    }
}
