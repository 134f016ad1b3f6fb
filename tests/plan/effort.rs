//! If a test would take too long, the work stays in the plan, and the reason says so.

use super::scenes::{ball, diffuse, shiny, with};
use super::status;
use rtc::internals::ir::Scene;
use rtc::internals::plan::{Effect, PixelClass, Plan, RuleSet};

/// Small spheres side by side before a wide camera, the first ones reflective.
fn many(count: u32, mirrors: u32) -> Scene {
    let place = |k: u32| {
        [
            f64::from(k % 40) * 0.8 - 16.0,
            f64::from(k / 40) - 14.0,
            0.0,
        ]
    };
    let balls = (0..count).map(|k| {
        (
            ball(place(k), 0.3),
            if k < mirrors { shiny() } else { diffuse() },
        )
    });
    let mut scene = with(&balls.collect::<Vec<_>>());
    (scene.camera.right, scene.camera.up) = ([1.5, 0.0, 0.0], [0.0, 1.5, 0.0]);
    scene
}

/// A plan tests at most 500 000 pairs, and reports it.
#[test]
fn too_many_surfaces_are_kept_without_asking() {
    let plan = |count, lights| {
        let mut scene = many(count, 0);
        scene.lights = vec![scene.lights[0].clone(); lights];
        Plan::new(&super::validated(&scene), RuleSet::ALL)
    };
    let is_asked = |plan: &Plan| !status(plan, Effect::Shadows).reason.contains("too many");
    assert!(is_asked(&plan(500, 2)), "500 times 500 times 2");
    let plan = plan(501, 2);
    assert!(plan.needs(Effect::Shadows) && !is_asked(&plan));
    assert!(!plan.needs(Effect::Mirror) && plan.surfaces.iter().all(|kept| *kept));
}

#[test]
fn too_many_mirrors_are_followed_without_asking() {
    let reason = |count, mirrors| {
        let plan = Plan::new(&super::validated(&many(count, mirrors)), RuleSet::ALL);
        status(&plan, Effect::Depth).reason.clone()
    };
    assert_eq!(
        reason(1000, 500),
        "2 bounces: reflective surfaces are visible in each other"
    );
    assert_eq!(
        reason(1001, 500),
        "2 bounces; too many reflective surfaces to test all pairs"
    );
}

/// The cells of a large picture are several pixels wide.
#[test]
fn a_large_picture_is_looked_at_in_coarse_cells() {
    let mut scene = with(&[(ball([0.0; 3], 1.0), diffuse())]);
    (scene.camera.size, scene.camera.right, scene.camera.up) =
        ([2400, 2000], [2.5e-3, 0.0, 0.0], [0.0, 2.5e-3, 0.0]);
    let pixel_classes = Plan::new(&super::validated(&scene), RuleSet::ALL).pixel_classes;
    let sights = [[0, 0], [1200, 1000], [2399, 1999], [2399, 1000]]
        .map(|pixel| pixel_classes.class_of(pixel));
    assert_eq!(
        sights,
        [
            PixelClass::Nothing,
            PixelClass::Anything,
            PixelClass::Nothing,
            PixelClass::Nothing
        ]
    );
}
