//! Counters: the class of rays of an effect that was left out is 0, and where sampling is that of
//! the figures known from elsewhere, so are the rays.

use super::dice::Dice;
use super::{course, film, proven};
use rtc::plan::{Effect, Plan, Rules};
use rtc::render::Values;

#[test]
fn an_effect_that_is_not_needed_traces_no_ray() {
    for seed in 0..400 {
        let scene = proven(&Dice::new(seed).scene());
        let plan = Plan::new(&scene, Rules::ALL);
        let counts = film(&scene, Rules::ALL, Values::Linear).counts;
        let silent = |effect, rays: u64| {
            assert!(
                plan.needs(effect) || rays == 0,
                "{seed}: {effect:?} takes {rays} rays"
            )
        };
        silent(Effect::Shadows, counts.shadow);
        silent(Effect::Depth, counts.secondary());
        silent(Effect::Mirror, counts.mirror);
        silent(Effect::Refraction, counts.refracted);
        silent(Effect::Surfaces, counts.rays());
    }
}

#[test]
fn the_rays_of_the_course_are_those_counted_elsewhere() {
    let Some(mut scene) = course("scene01-reflect-lights-shadows.yaml") else {
        return;
    };
    // Its 200 × 200 pixels in the middle, 16 rays each, one bounce: counted once by a program of
    // its own.
    scene.camera.size = [200, 200];
    (scene.settings.supersampling, scene.settings.max_depth) = (4, 1);
    let counts = film(&proven(&scene), Rules::AT_HITS, Values::Display).counts;
    assert_eq!(counts.rays(), 2_200_208);
}

#[test]
fn a_scene_of_one_light_takes_rays_of_the_camera_alone() {
    let Some(scene) = course("scene01.yaml") else {
        return;
    };
    let counts = film(&proven(&scene), Rules::ALL, Values::Display).counts;
    assert_eq!(counts.rays(), counts.camera);
    assert!(
        counts.camera < 160_000,
        "pixels that show nothing are not traced: {}",
        counts.camera
    );
    assert!(counts.hits > 0);
}
