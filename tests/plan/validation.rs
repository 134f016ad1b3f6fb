//! Verification: the work that the plan removes from each test scene is simulated and contributes
//! nothing; a plan that removes too much is detected, with effect and pixel.

use super::dice::Dice;
use super::scenes::{ball, diffuse, disc, shiny, with};
use super::{file_name, files, scene, small, validated};
use proptest::prelude::*;
use rtc::internals::ir::Scene;
use rtc::internals::plan::{Effect, LightPlan, Plan, Rule, RuleSet};
use rtc::internals::render::{PlanMismatch, RenderSelection, verify};
use rtc::internals::valid::CourseLightId;

fn validate(scene: &Scene, change: impl FnOnce(&mut Plan)) -> Result<(), PlanMismatch> {
    let scene = validated(scene);
    let mut plan = Plan::new(&scene, RuleSet::ALL);
    change(&mut plan);
    verify(&scene, &plan, &RenderSelection::default(), &|_| true)
        .unwrap()
        .map(drop)
}

#[test]
fn nothing_is_left_out_that_would_show_in_a_scene_at_hand() {
    for path in files("scenes") {
        let scene = scene(&path).unwrap();
        assert_eq!(
            validate(&small(scene), |_| ()),
            Ok(()),
            "{}",
            file_name(&path)
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn nothing_is_left_out_that_would_show_in_a_random_scene(seed in any::<u64>()) {
        prop_assert_eq!(validate(&Dice::new(seed).scene(), |_| ()), Ok(()));
    }
}

/// A sphere before a disc that receives its shadow and reflects it.
fn busy() -> Scene {
    with(&[
        (ball([1.5, 0.0, 3.0], 1.0), diffuse()),
        (disc([0.0; 3], 4.0), shiny()),
    ])
}

/// The plan of the first light.
fn lamp(plan: &mut Plan) -> &mut LightPlan {
    &mut plan.lights[CourseLightId::new(0)]
}

fn is_found(effect: Effect, change: impl FnOnce(&mut Plan)) {
    let mismatch = validate(&busy(), change).expect_err("it shows");
    assert_eq!(mismatch.effect, Some(effect), "{mismatch:?}");
}

#[test]
fn a_plan_that_leaves_out_too_much_is_found_out() {
    assert_eq!(validate(&busy(), |_| ()), Ok(()));
    is_found(Effect::Shadows, |plan| lamp(plan).shadowed[1] = false);
    is_found(Effect::Surfaces, |plan| plan.surfaces[0] = false);
    is_found(Effect::Depth, |plan| plan.max_depth = 0);
}

#[test]
fn a_light_left_out_is_found_at_the_first_pixel_it_shines_on() {
    let mismatch = validate(&busy(), |plan| lamp(plan).direct = false).unwrap_err();
    assert_eq!(
        (mismatch.effect, mismatch.what),
        (Some(Effect::DirectLight), "a light left out shines")
    );
    let dark = validate(&busy(), |plan| lamp(plan).is_used = false).unwrap_err();
    assert!(
        dark.pixel[1] <= mismatch.pixel[1],
        "its ambient term shows no later"
    );
}

/// Only the requested approximation changes the picture, by at most half a level of 8 bits.
#[test]
fn what_is_cut_off_is_too_small_to_see() {
    let mut scene = with(&[
        (ball([-1.2, 0.0, 0.0], 1.0), shiny()),
        (ball([1.2, 0.0, 0.0], 1.0), shiny()),
    ]);
    scene.settings.max_depth = 60;
    let scene = validated(&scene);
    let exact = Plan::new(&scene, RuleSet::ALL);
    let cut = Plan::new(&scene, RuleSet::ALL.with(Rule::Cut));
    assert_eq!((exact.max_depth, cut.max_depth), (60, 10));
    assert_eq!(cut.rule_of(Effect::Depth), Some(Rule::Cut));
    let picture = |plan: &Plan| {
        rtc::internals::render::render(&scene, plan, &RenderSelection::default(), &|_| true)
            .unwrap()
            .image
            .pixels
    };
    let pairs = picture(&exact).into_iter().zip(picture(&cut));
    let most = pairs
        .flat_map(|(a, b)| [0, 1, 2].map(|k| (a[k] - b[k]).abs()))
        .fold(0.0, f64::max);
    assert!(most <= 0.5 / 255.0, "{most}");
}
