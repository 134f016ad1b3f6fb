//! Participating media against closed forms and quadrature.

use super::{add_light, add_sphere, add_square, lambert, mean, render, scene, sky, validate};
use rtc::internals::ir::{
    Environment, Medium, Projection, Punctual, PunctualKind, Scene, Standard,
};
use rtc::internals::math::{Vec3, exp};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::Film;
use std::f64::consts::PI;

/// A scene of parallel rays, which go down −z from a square of side 2 at z = 4.
fn parallel(samples: u32, medium: Option<Medium>) -> Scene {
    let mut scene = scene(samples);
    scene.camera.projection = Projection::Orthographic;
    scene.medium = medium;
    scene
}

/// A surface that light passes, around a medium.
fn around(medium: Medium) -> Standard {
    Standard::null().interior(medium)
}

/// Asserts that a mean is as expected, up to a part of it.
fn assert_near(found: Vec3, expected: Vec3, tolerance: f64) {
    let error = ((found - expected) / expected).abs().max_element();
    assert!(error < tolerance, "{found}, not {expected}: {error:.2e}");
}

/// Asserts that a scene has the same bytes without any rule; returns its picture.
fn same_without_rules(scene: &Scene) -> Film {
    let proof = validate(scene);
    let by = |rules| {
        let plan = Plan::new(&proof, rules);
        rtc::internals::render::render(&proof, &plan, &super::JOB, &|_| true).unwrap()
    };
    let [with, without] = [RuleSet::ALL, RuleSet::NONE].map(by);
    assert_eq!(with.image.pixels, without.image.pixels);
    with
}

const COLORED: Medium = Medium {
    sigma_a: [0.0; 3],
    sigma_s: [0.5, 2.0, 6.0],
    g: 0.4,
};

#[test]
fn a_medium_that_absorbs_nothing_shows_the_furnace_around_it() {
    let glass = Standard {
        transmission: 1.0,
        thickness: 1.0,
        roughness: 0.0,
        ..lambert([1.0; 3])
    };
    let index_matched = Standard { ior: 1.0, ..glass }.interior(COLORED);
    for (material, tolerance) in [(around(COLORED), 0.02), (index_matched, 0.02)] {
        let mut scene = scene(16);
        scene.environment = sky(1.0);
        scene.settings.max_depth = 500;
        add_sphere(&mut scene, [0.0; 3], 1.5, material);
        let found = mean(&same_without_rules(&scene));
        assert_near(found, Vec3::ONE, tolerance);
    }
}

#[test]
fn light_is_absorbed_by_beer_and_lambert() {
    let medium = Medium {
        sigma_a: [0.1, 0.25, 0.0],
        ..Medium::default()
    };
    let expected = medium.sigma_a.map(|sigma| 3.0 * exp(-4.0 * sigma));
    let light = lambert([0.0; 3]).emissive([3.0; 3]);
    // Around the camera.
    let mut fog = parallel(1, Some(medium));
    add_square(&mut fog, 0.0, 2.0, light.clone());
    assert_near(mean(&same_without_rules(&fog)), expected.into(), 1e-12);
    // From surface to surface: of two planes at a distance of 4.
    let mut slab = parallel(1, None);
    add_square(&mut slab, 2.0, 2.0, around(medium));
    let exit = Standard::null().exterior(medium);
    add_square(&mut slab, -2.0, 2.0, exit);
    add_square(&mut slab, -3.0, 2.0, light);
    assert_near(mean(&same_without_rules(&slab)), expected.into(), 1e-12);
}

#[test]
fn the_part_that_is_not_scattered_is_that_of_beer_and_lambert() {
    let medium = Medium {
        sigma_a: [0.02, 0.0, 0.1],
        sigma_s: [0.1, 0.25, 0.0],
        g: 0.0,
    };
    let mut fog = parallel(256, Some(medium));
    fog.settings.max_depth = 0;
    add_square(&mut fog, 0.0, 2.0, lambert([0.0; 3]).emissive([1.0; 3]));
    let expected = [0.12, 0.25, 0.1].map(|sigma: f64| exp(-4.0 * sigma));
    assert_near(mean(&same_without_rules(&fog)), expected.into(), 0.005);
}

/// Henyey and Greenstein's phase function, for the cosine of the scattering angle.
fn henyey_greenstein(g: f64, cosine: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))
}

/// The light of a lamp at (0, 3, 0) that is scattered once along the rays of [`parallel`], by
/// quadrature; `inside` gives the lengths from a point along a direction that are in the medium.
fn scattered_once(medium: &Medium, inside: impl Fn(Vec3, Vec3, f64) -> f64) -> Vec3 {
    const STEPS: u32 = 400;
    const LENGTH: f64 = 7.0;
    let lamp = Vec3::new(0.0, 3.0, 0.0);
    let mut sum = Vec3::ZERO;
    for pixel in 0..256 {
        let place = |k: u32| (f64::from(k) + 0.5) / 8.0 - 1.0;
        let eye = Vec3::new(place(pixel % 16), place(pixel / 16), 4.0);
        for step in 0..STEPS {
            let t = (f64::from(step) + 0.5) * LENGTH / f64::from(STEPS);
            let point = eye - Vec3::Z * t;
            let is_inside = inside(point, Vec3::Z, 1e-9) > 0.0;
            let (to_lamp, distance) = ((lamp - point).normalize(), lamp.distance(point));
            let before = inside(point, Vec3::Z, t) + inside(point, to_lamp, distance);
            let phase = henyey_greenstein(medium.g, -to_lamp.z);
            let sigma_s = if is_inside {
                Vec3::from_array(medium.sigma_s)
            } else {
                Vec3::ZERO
            };
            let sigma_t = sigma_s + Vec3::from_array(medium.sigma_a);
            let passed = sigma_t.map(|sigma| exp(-sigma * before));
            sum += sigma_s * passed * (phase / (distance * distance));
        }
    }
    sum * (LENGTH / f64::from(STEPS) / 256.0)
}

#[test]
fn light_that_is_scattered_once_is_that_of_a_quadrature() {
    let medium = Medium {
        sigma_a: [0.0, 0.1, 0.3],
        sigma_s: [0.2, 0.4, 0.1],
        g: 0.5,
    };
    let lit = |mut scene: Scene| {
        scene.settings.max_depth = 1;
        let lamp = Punctual {
            emitter: PunctualKind::Point {
                position: [0.0, 3.0, 0.0],
                range: None,
            },
            intensity: [1.0; 3],
            projected: None,
        };
        add_light(&mut scene, lamp);
        mean(&same_without_rules(&scene))
    };
    // In fog before a black wall.
    let mut fog = parallel(128, Some(medium));
    add_square(&mut fog, -3.0, 4.0, lambert([0.0; 3]));
    let expected = scattered_once(&medium, |_, _, length| length);
    assert_near(lit(fog), expected, 0.01);
    // In a sphere.
    let mut ball = parallel(128, None);
    add_sphere(&mut ball, [0.0; 3], 2.0, around(medium));
    let inside = |from: Vec3, direction: Vec3, length: f64| {
        let half = from.dot(direction);
        let root = half * half - from.length_squared() + 4.0;
        if root <= 0.0 {
            return 0.0;
        }
        let [enter, exit] = [-half - root.sqrt(), -half + root.sqrt()];
        (exit.min(length) - enter.max(0.0)).max(0.0)
    };
    assert_near(lit(ball), scattered_once(&medium, inside), 0.01);
}

#[test]
fn a_box_of_mirrors_with_the_densest_medium_ends_with_its_depth() {
    for sigma in [1e-30, 1.0, 1e30] {
        let medium = Medium {
            sigma_s: [sigma; 3],
            g: -0.999_999,
            ..Medium::default()
        };
        let mut scene = scene(1);
        scene.medium = Some(medium);
        scene.settings.max_depth = 1000;
        let mirror = Standard {
            metallic: 1.0,
            roughness: 0.0,
            ..lambert([1.0; 3])
        };
        add_sphere(&mut scene, [0.0; 3], 5.0, mirror);
        scene.environment = sky(1.0);
        assert_eq!(mean(&render(&scene)), Vec3::ZERO, "{sigma}");
    }
}

#[test]
fn clear_media_change_nothing() {
    let shown = |medium: Option<Medium>| {
        let mut scene = scene(4);
        scene.medium = medium;
        scene.environment = Some(Environment {
            radiance: [0.5, 0.75, 1.0],
            ..sky(1.0).unwrap()
        });
        let mut skin = lambert([0.8, 0.6, 0.4]);
        (skin.interior, skin.exterior) = (medium, medium);
        add_sphere(&mut scene, [0.0; 3], 1.0, skin);
        add_sphere(&mut scene, [0.0; 3], 1.2, Standard::null());
        same_without_rules(&scene).image.pixels
    };
    assert_eq!(shown(Some(Medium::default())), shown(None));
}
