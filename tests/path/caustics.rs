//! Caustics by manifold sampling: the mean is that of plain paths where these find the light, and a
//! closed form where they do not; the plan and the threads do not change the bytes.

use super::{add_light, add_sphere, add_square, lambert, mean, render, scene, validate};
use rtc::internals::ir::{Mode, Punctual, PunctualKind, Scene, Standard};
use rtc::internals::pipeline;
use rtc::internals::plan::{Effect, EffectState, Plan, RuleSet};
use rtc::internals::render::RenderSelection;

fn with_caustics(mut scene: Scene, are_on: bool) -> Scene {
    if let Mode::Path(path) = &mut scene.settings.mode {
        path.caustics = are_on;
    }
    scene
}

fn glass() -> Standard {
    Standard {
        base_color: [1.0; 4],
        metallic: 0.0,
        roughness: 0.0,
        transmission: 1.0,
        thickness: 1.0,
        ior: 1.5,
        ..Standard::default()
    }
}

fn mirror() -> Standard {
    Standard {
        base_color: [1.0; 4],
        metallic: 1.0,
        roughness: 0.0,
        ..Standard::default()
    }
}

/// A floor under a ball and a lamp, not too small for plain paths to find it.
fn ball(samples: u32, material: Standard) -> Scene {
    let mut scene = scene(samples);
    add_square(&mut scene, -1.0, 2.0, lambert([0.8, 0.7, 0.6]));
    add_sphere(&mut scene, [0.2, 0.1, -0.3], 0.5, material);
    let lamp = Standard {
        emissive: [40.0; 3],
        ..lambert([0.0; 3])
    };
    add_sphere(&mut scene, [0.9, 0.4, 2.2], 0.35, lamp);
    scene
}

#[test]
fn the_mean_is_that_of_plain_paths() {
    for material in [glass(), mirror()] {
        let expected = mean(&render(&with_caustics(ball(2048, material.clone()), false)));
        let found = mean(&render(&with_caustics(ball(256, material.clone()), true)));
        let error = ((found - expected) / expected).abs().max_element();
        assert!(error < 0.03, "{found} {expected} {material:?}");
    }
}

/// A floor beside a large mirror at x = −2, and a point light.
fn wall(has_mirror: bool, lights: &[[f64; 3]]) -> Scene {
    let mut scene = scene(256);
    add_square(&mut scene, 0.0, 1.0, lambert([1.0; 3]));
    if has_mirror {
        let corners = [
            [-2.0, -9.0, -9.0],
            [-2.0, 9.0, -9.0],
            [-2.0, 9.0, 9.0],
            [-2.0, -9.0, 9.0],
        ];
        super::add_quad(&mut scene, corners, mirror());
    }
    for position in lights {
        let emitter = PunctualKind::Point {
            position: *position,
            range: None,
        };
        let intensity = [3.0; 3];
        add_light(&mut scene, Punctual::new(emitter, intensity));
    }
    with_caustics(scene, true)
}

#[test]
fn a_flat_mirror_shows_the_image_of_a_point_light() {
    let (light, image) = ([0.5, 0.3, 1.5], [-4.5, 0.3, 1.5]);
    // One bounce: light that the floor sends to the mirror and back is left away.
    let shown = |mut scene: Scene| {
        scene.settings.max_depth = 2;
        mean(&render(&scene))
    };
    let expected = shown(wall(false, &[light, image]));
    let found = shown(wall(true, &[light]));
    assert!(
        ((found - expected) / expected).abs().max_element() < 1e-3,
        "{found} {expected}"
    );
    assert!(expected.x > 1.02 * shown(wall(false, &[light])).x);
}

#[test]
fn the_plan_and_the_threads_do_not_change_the_bytes() {
    let scene = validate(&with_caustics(ball(8, glass()), true));
    let draw = |rules, threads| {
        let plan = Plan::new(&scene, rules);
        let job = RenderSelection::default();
        let film = pipeline::render(&scene, &plan, &job, threads, &|_| true);
        film.unwrap().unwrap().image.pixels
    };
    let expected = draw(RuleSet::ALL, 1);
    assert_eq!(draw(RuleSet::ALL, 3), expected);
    assert_eq!(draw(RuleSet::NONE, 1), expected);
}

#[test]
fn without_a_smooth_surface_or_the_setting_nothing_changes() {
    let drawn = |scene: &Scene| render(scene).image.pixels.clone();
    for material in [glass(), lambert([0.5; 3])] {
        let is_glass = material.transmission > 0.0;
        let [on, off] = [true, false].map(|on| with_caustics(ball(4, material.clone()), on));
        assert_eq!(drawn(&on) != drawn(&off), is_glass);
        let state = |scene: &Scene| {
            let plan = Plan::new(&validate(scene), RuleSet::ALL);
            let mut statuses = plan.statuses.iter();
            statuses
                .find(|status| status.effect == Effect::Caustics)
                .map(|status| status.state)
        };
        let expected = if is_glass {
            EffectState::Needed
        } else {
            EffectState::Absent
        };
        assert_eq!(state(&on), Some(expected));
        assert_eq!(state(&off), Some(EffectState::Absent));
    }
}
