//! Light in bodies that refract it: a radiance in a medium of the index n is n² times that outside,
//! so what is emitted inside looks 1/n² as bright from outside; closed paths do not change.

use super::{add_light, add_quad, add_sphere, add_square, lambert, mean, middle, scene, sky};
use super::{render, render_by};
use rtc::internals::ir::{Punctual, PunctualKind, Scene, Standard};
use rtc::internals::math::Vec3;
use rtc::internals::render::SamplingStrategy;

/// Smooth clear glass without a mirror image.
fn clear(ior: f64) -> Standard {
    Standard {
        metallic: 0.0,
        roughness: 0.0,
        transmission: 1.0,
        thickness: 1.0,
        ior,
        specular: 0.0,
        double_sided: true,
        ..Standard::default()
    }
}

fn lamp(radiance: f64) -> Standard {
    Standard {
        emissive: [radiance; 3],
        double_sided: true,
        ..lambert([0.0; 3])
    }
}

/// What is seen straight through the middle of a scene.
fn looking(add: impl Fn(&mut Scene)) -> Vec3 {
    let mut scene = scene(16);
    (scene.camera.right, scene.camera.up) = ([1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]);
    add(&mut scene);
    middle(&render(&scene))
}

fn assert_near(found: Vec3, expected: f64) {
    let error = (found / expected - Vec3::ONE).abs().max_element();
    assert!(error < 1e-9, "{found}, not {expected}");
}

#[test]
fn a_lamp_in_glass_looks_dimmer_by_the_square_of_the_index() {
    for ior in [1.33, 1.5, 2.4] {
        let seen = looking(|scene| {
            add_sphere(scene, [0.0; 3], 1.0, clear(ior));
            add_sphere(scene, [0.0; 3], 0.3, lamp(3.0));
        });
        assert_near(seen, 3.0 / (ior * ior));
    }
}

#[test]
fn a_lamp_behind_an_open_surface_of_glass_is_in_the_glass() {
    let seen = looking(|scene| {
        add_square(scene, 0.0, 1.0, clear(1.5));
        add_square(scene, -1.0, 1.0, lamp(3.0));
    });
    assert_near(seen, 3.0 / 2.25);
    // From inside the glass it is the other way round.
    let seen = looking(|scene| {
        let back = [
            [-1.0, -1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, -1.0, 0.0],
        ];
        add_quad(scene, back, clear(1.5));
        add_square(scene, -1.0, 1.0, lamp(3.0));
    });
    assert_near(seen, 3.0 * 2.25);
}

#[test]
fn a_sky_behind_an_open_surface_is_scaled_and_behind_a_ball_not() {
    let sky_behind = |ball: bool| {
        looking(|scene| {
            scene.environment = sky(2.0);
            if ball {
                add_sphere(scene, [0.0; 3], 1.0, clear(1.5));
            } else {
                add_square(scene, 0.0, 1.0, clear(1.5));
            }
        })
    };
    assert_eq!(sky_behind(true), Vec3::splat(2.0));
    assert_near(sky_behind(false), 2.0 / 2.25);
}

#[test]
fn glass_in_water_counts_for_both() {
    let seen = looking(|scene| {
        add_sphere(scene, [0.0; 3], 1.5, clear(1.3));
        add_sphere(scene, [0.0; 3], 1.0, clear(1.2));
        add_sphere(scene, [0.0; 3], 0.3, lamp(3.0));
    });
    let both = 1.3 * 1.2;
    assert_near(seen, 3.0 / (both * both));
}

/// A ball in a rough glass with a lamp inside, before a floor.
fn lit_from_inside(roughness: f64) -> Scene {
    let mut scene = scene(1024);
    add_square(&mut scene, -1.2, 3.0, lambert([0.7; 3]));
    let glass = Standard {
        roughness,
        attenuation_distance: Some(0.5),
        attenuation_color: [0.5, 0.8, 0.9],
        ..clear(1.5)
    };
    add_sphere(&mut scene, [0.0; 3], 1.0, glass);
    add_sphere(&mut scene, [0.4, 0.0, 0.0], 0.3, lambert([0.8; 3]));
    add_sphere(&mut scene, [-0.4, 0.2, 0.0], 0.3, lamp(4.0));
    scene
}

#[test]
fn all_strategies_find_the_same_light_in_a_body() {
    for roughness in [0.0, 0.4] {
        let scene = lit_from_inside(roughness);
        let seen = |strategy| mean(&render_by(&scene, strategy));
        let both = seen(SamplingStrategy::Mis);
        for strategy in [SamplingStrategy::Nee, SamplingStrategy::BsdfSampling] {
            let found = seen(strategy);
            let error = ((found - both) / both).abs().max_element();
            assert!(error < 0.03, "{roughness} {strategy:?}: {found}, {both}");
        }
    }
}

#[test]
fn a_point_in_glass_lights_what_is_in_the_glass_as_if_nothing_were_around_but_for_the_index() {
    let lit = |glass: bool| {
        looking(|scene| {
            if glass {
                add_sphere(scene, [0.0; 3], 1.0, clear(1.5));
            }
            add_sphere(scene, [0.0; 3], 0.3, lambert([0.8; 3]));
            let light = Punctual {
                emitter: PunctualKind::Point {
                    position: [0.0, 0.0, 0.8],
                    range: None,
                },
                intensity: [3.0; 3],
                projected: None,
            };
            add_light(scene, light);
        })
    };
    let ratio = lit(true) / lit(false);
    assert!(
        (ratio * 2.25 - Vec3::ONE).abs().max_element() < 1e-3,
        "{ratio}"
    );
}
