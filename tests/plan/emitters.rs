//! The light of every emitter, measured on a white floor.

use super::dice::Dice;
use super::path_rules::{traced, white};
use super::scenes::disc;
use super::{film, validated};
use rtc::internals::ir::{Light, Punctual, PunctualKind, Scene};
use rtc::internals::math::Vec3;
use rtc::internals::plan::RuleSet;
use rtc::internals::render::Values;
use std::f64::consts::PI;

/// One narrow pixel at the origin, on a white floor that faces +z.
fn floor(emitter: PunctualKind) -> Scene {
    let mut scene = traced(&[(disc([0.0; 3], 1.0), white())]);
    scene.camera.eye = [0.0, 0.0, 4.0];
    scene.camera.center = [0.0; 3];
    (scene.camera.right, scene.camera.up) = ([1e-9, 0.0, 0.0], [0.0, 1e-9, 0.0]);
    scene.camera.size = [1, 1];
    scene.settings.max_depth = 1;
    let intensity = [3.0, 2.0, 4.0];
    scene.lights = vec![Light::Punctual(Punctual {
        emitter,
        intensity,
        projected: None,
    })];
    scene
}

/// The radiance of a white floor at the origin that faces +z under an emitter of intensity 1:
/// cosine law, inverse-square law, and the range window of `KHR_lights_punctual`.
fn expected(emitter: &PunctualKind) -> f64 {
    let Some(position) = emitter.position().map(Vec3::from_array) else {
        let direction = Vec3::from_array(emitter.direction().unwrap()).normalize();
        return direction.z.max(0.0) / PI;
    };
    let distance = position.length();
    let window = emitter.range().map_or(1.0, |range| {
        let square = (distance / range) * (distance / range);
        (1.0 - square * square).clamp(0.0, 1.0)
    });
    let to = position / distance;
    let factor = emitter.profile().unwrap().factor(-to);
    factor * window * to.z.max(0.0) / (distance * distance * PI)
}

#[test]
fn the_light_of_every_emitter_follows_its_profile() {
    let mut illuminated = 0;
    for seed in 0..400 {
        let mut dice = Dice::new(seed);
        let emitter = dice.emitter_above();
        let found = film(
            &validated(&floor(emitter.clone())),
            RuleSet::ALL,
            Values::Linear,
        );
        let expected = expected(&emitter);
        for (found, intensity) in found.image.pixels[0].into_iter().zip([3.0, 2.0, 4.0]) {
            let difference = (found - intensity * expected).abs();
            assert!(
                difference <= 1e-7 * (1.0 + expected),
                "{seed}: {found} instead of {} of {emitter:?}",
                intensity * expected
            );
        }
        illuminated += u32::from(expected > 1e-3);
    }
    assert!(
        illuminated > 100,
        "only {illuminated} of the lights reach the floor"
    );
}
