//! All ways of looking for light find the same; the picture does not depend on threads.

use super::{
    add_light, add_quad, add_sphere, add_square, lambert, mean, render, render_by, scene, validate,
};
use rtc::internals::ir::{
    Environment, Image, ImageId, Pixels, Punctual, PunctualKind, Scene, Standard,
};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{RenderSelection, SamplingStrategy};

/// A glossy floor and a ball under a shining square, all kinds of scattering among them.
fn room(samples: u32) -> Scene {
    let mut scene = scene(samples);
    add_square(
        &mut scene,
        -1.0,
        3.0,
        Standard {
            metallic: 0.5,
            roughness: 0.7,
            ..lambert([0.7, 0.6, 0.5])
        },
    );
    add_sphere(
        &mut scene,
        [0.3, 0.2, 0.0],
        0.6,
        Standard {
            specular: 1.0,
            roughness: 0.6,
            ..lambert([0.8; 3])
        },
    );
    let light = Standard {
        emissive: [4.0, 3.0, 2.0],
        ..lambert([0.0; 3])
    };
    add_quad(
        &mut scene,
        [
            [-3.0, 1.5, 2.0],
            [3.0, 1.5, 2.0],
            [3.0, 1.5, 0.0],
            [-3.0, 1.5, 0.0],
        ],
        light,
    );
    scene
}

/// An image that is bright in one place, where one way of looking for light does well and the other
/// badly.
fn bright_spot() -> Image {
    let mut bytes = Vec::new();
    for y in 0..8 {
        for x in 0..16 {
            let value = if (10..13).contains(&x) && (2..4).contains(&y) {
                8.0_f32
            } else {
                0.2
            };
            bytes.extend(
                [value, value * 0.8, value * 0.5]
                    .iter()
                    .flat_map(|channel| channel.to_le_bytes()),
            );
        }
    }
    Image {
        name: String::new(),
        width: 16,
        height: 8,
        kind: Pixels::Rgb32f,
        pixels: bytes.into(),
    }
}

fn assert_agree(scene: &Scene, tolerance: f64) {
    let both = mean(&render_by(scene, SamplingStrategy::Mis));
    for strategy in [SamplingStrategy::Nee, SamplingStrategy::BsdfSampling] {
        let found = mean(&render_by(scene, strategy));
        let error = ((found - both) / both).abs().max_element();
        assert!(error < tolerance, "{strategy:?}: {found}, both: {both}");
    }
}

#[test]
fn aiming_and_scattering_agree_on_a_shining_square() {
    assert_agree(&room(1024), 0.01);
}

#[test]
fn aiming_and_scattering_agree_on_surroundings() {
    let mut scene = room(1024);
    scene.images.push(bright_spot());
    let rotation = [[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]];
    scene.environment = Some(Environment {
        radiance: [1.0; 3],
        image: Some(ImageId(0)),
        image_from_world: Some(rotation),
    });
    assert_agree(&scene, 0.015);
}

#[test]
fn aiming_and_scattering_agree_on_a_white_sky() {
    let mut scene = room(1024);
    scene.environment = super::sky(0.5);
    assert_agree(&scene, 0.015);
}

#[test]
fn the_mean_does_not_depend_on_the_number_of_samples() {
    let few = mean(&render(&room(64)));
    let many = mean(&render(&room(512)));
    assert!(
        ((few - many) / many).abs().max_element() < 0.01,
        "{few} {many}"
    );
}

#[test]
fn one_thread_and_several_give_the_same_bytes() {
    let mut scene = room(8);
    add_light(
        &mut scene,
        Punctual {
            emitter: PunctualKind::Sun {
                direction: [1.0, 2.0, 3.0],
            },
            intensity: [1.0; 3],
            projected: None,
        },
    );
    let proof = validate(&scene);
    let plan = Plan::new(&proof, RuleSet::ALL);
    let on = |threads| {
        rtc::internals::pipeline::render(
            &proof,
            &plan,
            &RenderSelection::default(),
            threads,
            &|_| true,
        )
        .unwrap()
        .unwrap()
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one.image.pixels, three.image.pixels);
    assert_eq!(one.counts, three.counts);
}
