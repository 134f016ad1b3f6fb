//! Diffuse transmission along paths: light from behind, what stands in its way, a medium inside.

use super::{
    add_light, add_sphere, add_square, lambert, mean, middle, render, render_by, scene, sky,
};
use rtc::internals::ir::{Punctual, PunctualKind, Scene, Standard};
use rtc::internals::math::Vec3;
use rtc::internals::render::SamplingStrategy;
use std::f64::consts::PI;

const COLOR: [f64; 3] = [0.9, 0.6, 0.3];

/// A matt surface that lets a fraction of the diffuse light through.
fn leaf(fraction: f64) -> Standard {
    Standard {
        diffuse_transmission: fraction,
        diffuse_transmission_color: COLOR,
        ..lambert([0.2, 0.4, 0.8])
    }
}

/// A leaf before the camera, and a sun of irradiance 3 in a direction.
fn in_the_sun(direction: [f64; 3]) -> Scene {
    let mut scene = scene(16);
    add_square(&mut scene, 0.0, 1.0, leaf(0.25));
    let sun = Punctual {
        emitter: PunctualKind::Sun { direction },
        intensity: [3.0; 3],
        projected: None,
    };
    add_light(&mut scene, sun);
    scene
}

fn assert_near(found: Vec3, expected: Vec3, tolerance: f64) {
    let error = (found - expected).abs().max_element();
    assert!(error < tolerance, "{found}, not {expected}");
}

#[test]
fn a_leaf_reflects_the_light_before_it_and_lets_that_behind_it_through() {
    let before = middle(&render(&in_the_sun([0.6, 0.0, 0.8])));
    let reflected = Vec3::new(0.2, 0.4, 0.8) * 0.75;
    assert_near(before, reflected * (3.0 * 0.8 / PI), 1e-12);
    let behind = middle(&render(&in_the_sun([0.6, 0.0, -0.8])));
    let transmitted = Vec3::from_array(COLOR) * 0.25;
    assert_near(behind, transmitted * (3.0 * 0.8 / PI), 1e-12);
}

#[test]
fn what_stands_behind_a_leaf_hides_the_light_there() {
    let mut scene = in_the_sun([0.0, 0.0, -1.0]);
    add_square(&mut scene, -1.0, 1.0, lambert([0.0; 3]));
    assert_eq!(middle(&render(&scene)), Vec3::ZERO);
}

/// A convex body alone casts no shadow on its own outside, but on the light that goes through it.
#[test]
fn a_translucent_ball_alone_hides_the_light_behind_it() {
    let mut scene = scene(16);
    scene.settings.max_depth = 1;
    add_sphere(&mut scene, [0.0; 3], 0.75, leaf(0.5));
    let sun = |z| Punctual {
        emitter: PunctualKind::Sun {
            direction: [0.0, 0.0, z],
        },
        intensity: [3.0; 3],
        projected: None,
    };
    add_light(&mut scene, sun(-1.0));
    assert_eq!(middle(&render(&scene)), Vec3::ZERO);
    add_light(&mut scene, sun(1.0));
    assert!(middle(&render(&scene)).min_element() > 0.0);
}

#[test]
fn a_shining_square_behind_a_leaf_is_found_by_all_strategies() {
    let mut scene = scene(1024);
    add_square(&mut scene, 0.0, 1.0, leaf(0.6));
    let light = Standard {
        emissive: [4.0, 3.0, 2.0],
        ..lambert([0.0; 3])
    };
    add_square(&mut scene, -0.8, 0.7, light);
    let both = mean(&render_by(&scene, SamplingStrategy::Mis));
    for strategy in [SamplingStrategy::Nee, SamplingStrategy::BsdfSampling] {
        let found = mean(&render_by(&scene, strategy));
        let error = ((found - both) / both).abs().max_element();
        assert!(error < 0.015, "{strategy:?}: {found}, both: {both}");
    }
}

#[test]
fn a_translucent_ball_absorbs_along_its_chords() {
    let mut scene = scene(1024);
    scene.environment = sky(1.0);
    (scene.camera.right, scene.camera.up) = ([0.001, 0.0, 0.0], [0.0, 0.001, 0.0]);
    let ball = Standard {
        diffuse_transmission: 1.0,
        thickness: 1.0,
        attenuation_distance: Some(0.5),
        attenuation_color: [0.5, 0.25, 1.0],
        ..lambert([1.0; 3])
    };
    add_sphere(&mut scene, [0.0; 3], 0.75, ball);
    // A chord at the angle θ to the normal is 2R·cos θ long: with a = 2Rσ the mean of e^(−a·cos θ)
    // over a cosine lobe is 2(1 − (1 + a)e^(−a))/a².
    let passed = |color: f64| {
        let a = -1.5 * libm::log(color) / 0.5;
        2.0 * (1.0 - (1.0 + a) * libm::exp(-a)) / (a * a)
    };
    let expected = Vec3::new(passed(0.5), passed(0.25), 1.0);
    assert_near(mean(&render(&scene)), expected, 2e-3);
}
