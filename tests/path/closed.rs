//! Scenes whose radiance is known in closed form.

use super::{add_light, add_sphere, add_square, lambert, mean, middle, render, scene, sky};
use rtc::internals::ir::{Mode, PathSettings, Punctual, PunctualKind, Standard};
use rtc::internals::math::Vec3;
use std::f64::consts::PI;

const ALBEDO: [f64; 3] = [0.8, 0.4, 0.2];

fn albedo() -> Vec3 {
    Vec3::from_array(ALBEDO)
}

/// The radiance in the middle of a Lambert plane under one light.
fn under(emitter: PunctualKind) -> Vec3 {
    let mut scene = scene(16);
    add_square(&mut scene, 0.0, 1.0, lambert(ALBEDO));
    add_light(
        &mut scene,
        Punctual {
            emitter,
            intensity: [3.0; 3],
            projected: None,
        },
    );
    middle(&render(&scene))
}

fn assert_near(found: Vec3, expected: Vec3, tolerance: f64) {
    assert!(
        (found - expected).abs().max_element() < tolerance * expected.max_element(),
        "{found}, not {expected}"
    );
}

#[test]
fn a_sun_gives_e_cos_over_pi() {
    let found = under(PunctualKind::Sun {
        direction: [0.6, 0.0, 0.8],
    });
    assert_near(found, albedo() * (3.0 * 0.8 / PI), 1e-12);
    assert_eq!(
        under(PunctualKind::Sun {
            direction: [0.0, 0.0, -1.0]
        }),
        Vec3::ZERO
    );
}

#[test]
fn a_point_gives_i_cos_over_r_squared() {
    // 16 samples over four pixels of side 1/8 below a point 2 above: the mean of cos/r² is within 1
    // % of its middle.
    let found = under(PunctualKind::Point {
        position: [0.0, 0.0, 2.0],
        range: None,
    });
    assert_near(found, albedo() * (3.0 / 4.0 / PI), 0.01);
    let short = under(PunctualKind::Point {
        position: [0.0, 0.0, 2.0],
        range: Some(4.0),
    });
    assert_near(short, albedo() * (3.0 / 4.0 / PI * (1.0 - 0.0625)), 0.01);
    assert_eq!(
        under(PunctualKind::Point {
            position: [0.0, 0.0, 2.0],
            range: Some(1.5)
        }),
        Vec3::ZERO
    );
}

#[test]
fn a_spot_fades_by_the_square_of_the_ramp_of_cosines() {
    let spot = |direction| PunctualKind::Spot {
        position: [0.0, 0.0, 2.0],
        direction,
        inner_angle: 0.2,
        outer_angle: 0.6,
        range: None,
    };
    let full = albedo() * (3.0 / 4.0 / PI);
    assert_near(under(spot([0.0, 0.0, -3.0])), full, 0.01);
    let turned = |angle: f64| under(spot([libm::sin(angle), 0.0, -libm::cos(angle)]));
    let ramp = (libm::cos(0.4) - libm::cos(0.6)) / (libm::cos(0.2) - libm::cos(0.6));
    assert_near(turned(0.4), full * (ramp * ramp), 0.02);
    assert_eq!(turned(0.8), Vec3::ZERO);
}

#[test]
fn a_white_sphere_in_a_white_sky_is_not_seen() {
    for (standard, tolerance) in [
        (lambert([1.0; 3]), 1e-9),
        (
            Standard {
                roughness: 0.0,
                ..Standard::default()
            },
            1e-9,
        ),
        (
            Standard {
                metallic: 0.0,
                roughness: 0.0,
                transmission: 1.0,
                thickness: 1.0,
                ..Standard::default()
            },
            1e-9,
        ),
    ] {
        let mut scene = scene(64);
        scene.environment = sky(0.7);
        scene.settings.max_depth = 64;
        add_sphere(&mut scene, [0.0; 3], 0.8, standard);
        for pixel in render(&scene).image.pixels {
            assert_near(Vec3::from_array(pixel), Vec3::splat(0.7), tolerance);
        }
    }
}

#[test]
fn a_lambert_sphere_in_a_sky_shows_its_albedo() {
    let mut scene = scene(16);
    scene.environment = sky(1.0);
    add_sphere(&mut scene, [0.0; 3], 1.5, lambert(ALBEDO));
    assert_near(mean(&render(&scene)), albedo(), 1e-9);
}

#[test]
fn a_shining_room_is_as_bright_as_its_geometric_series_though_paths_end_at_random() {
    let mut scene = scene(256);
    scene.settings.max_depth = 12;
    let shining = Standard {
        emissive: [1.0; 3],
        double_sided: true,
        ..lambert([0.5, 0.25, 0.125])
    };
    // The camera is inside.
    add_sphere(&mut scene, [0.0; 3], 8.0, shining);
    let series = |albedo: f64| (1.0 - libm::pow(albedo, 13.0)) / (1.0 - albedo);
    let expected = Vec3::new(series(0.5), series(0.25), series(0.125));
    assert_near(mean(&render(&scene)), expected, 0.003);
}

#[test]
fn a_shining_square_gives_its_form_factor() {
    // A square of half side a = 1 seen from 1 below its middle: F = 4/π·a/√(1 + a²)·atan(a/√(1 +
    // a²)).
    let a = 1.0 / 2.0_f64.sqrt();
    let form_factor = 4.0 / PI * a * libm::atan(a);
    let mut scene = scene(256);
    scene.camera.center = [0.0, 0.0, -1.0];
    scene.camera.eye = [0.0, 0.0, -0.5];
    scene.camera.right = [0.001, 0.0, 0.0];
    scene.camera.up = [0.0, 0.001, 0.0];
    add_square(&mut scene, -1.0, 0.1, lambert(ALBEDO));
    add_square(
        &mut scene,
        0.0,
        1.0,
        Standard {
            emissive: [2.0; 3],
            ..lambert([0.0; 3])
        },
    );
    assert_near(mean(&render(&scene)), albedo() * (2.0 * form_factor), 0.005);
}

#[test]
fn a_light_is_as_bright_as_it_says() {
    let mut scene = scene(4);
    add_square(
        &mut scene,
        0.0,
        1.0,
        Standard {
            emissive: [5.0, 3.0, 1.0],
            ..lambert([0.0; 3])
        },
    );
    assert_eq!(middle(&render(&scene)), Vec3::new(5.0, 3.0, 1.0));
}

#[test]
fn what_is_inside_a_body_fades_with_the_way() {
    let mut scene = scene(16);
    scene.environment = sky(1.0);
    // Of the index of air, so that the way through the middle is the diameter.
    let body = Standard {
        ior: 1.0,
        transmission: 1.0,
        roughness: 0.0,
        thickness: 1.0,
        attenuation_distance: Some(0.5),
        attenuation_color: [0.5, 0.25, 1.0],
        ..lambert([1.0; 3])
    };
    scene.camera.right = [0.001, 0.0, 0.0];
    scene.camera.up = [0.0, 0.001, 0.0];
    add_sphere(&mut scene, [0.0; 3], 0.75, body);
    assert_near(
        mean(&render(&scene)),
        Vec3::new(0.125, 0.015_625, 1.0),
        1e-3,
    );
}

#[test]
fn a_white_metal_of_any_roughness_vanishes_in_a_white_furnace() {
    let seen = |roughness: f64, multiple_scattering: bool| {
        let mut scene = scene(64);
        scene.settings.mode = Mode::Path(PathSettings {
            samples: 64,
            multiple_scattering,
            ..PathSettings::default()
        });
        scene.environment = sky(1.0);
        add_sphere(
            &mut scene,
            [0.0; 3],
            0.75,
            Standard {
                roughness,
                base_color: [1.0; 4],
                ..Standard::default()
            },
        );
        let film = render(&scene);
        let inside = film
            .image
            .pixels
            .iter()
            .zip(&film.coverage)
            .filter(|(_, share)| **share == 1.0);
        let inside: Vec<_> = inside.map(|(pixel, _)| pixel[0]).collect();
        inside.iter().sum::<f64>() / inside.len() as f64
    };
    for roughness in [0.0, 0.3, 0.6, 1.0] {
        let mean = seen(roughness, true);
        assert!((mean - 1.0).abs() < 0.01, "roughness {roughness}: {mean}");
    }
    let lost = 1.0 - seen(1.0, false);
    assert!(
        lost > 0.1,
        "without the light between the facets a rough metal is dark: {lost}"
    );
}
