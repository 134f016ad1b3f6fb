//! The main invariant: with and without rules the film has the same bits, in linear and display
//! values, and no rule adds a ray.

use super::dice::Dice;
use super::scenes::{ball, diffuse, disc, first_light, shiny, with};
use super::{bits, file_name, files, film, scene, small, validated};
use proptest::prelude::*;
use rtc::internals::ir::Scene;
use rtc::internals::plan::{Plan, Rule, RuleSet};
use rtc::internals::render::{AnyWorld, RenderSelection, Values};

/// The sets of rules to compare with none: all, each alone, all but each.
fn sets() -> Vec<(String, RuleSet)> {
    let is_of_whitted = |rule: &Rule| *rule != Rule::Cut && !rule.name().starts_with("P-");
    let exact = || Rule::ALL.into_iter().filter(is_of_whitted);
    let mut sets = vec![("all".to_owned(), RuleSet::ALL)];
    sets.extend(exact().map(|rule| (format!("{} alone", rule.name()), RuleSet::NONE.with(rule))));
    sets.extend(exact().map(|rule| {
        (
            format!("all but {}", rule.name()),
            RuleSet::ALL.without(rule),
        )
    }));
    sets
}

/// The sets under which the film differs from that without rules, or takes more rays.
fn faults(scene: &Scene, sets: &[(String, RuleSet)]) -> Vec<String> {
    let scene = validated(scene);
    let mut faults = Vec::new();
    // Clamping can only hide a difference; one set tests that the clamped values agree.
    let kinds: &[Values] = if sets.len() == 1 {
        &[Values::Linear, Values::Display]
    } else {
        &[Values::Linear]
    };
    for values in kinds.iter().copied() {
        let unpruned = film(&scene, RuleSet::NONE, values);
        for (name, rules) in sets {
            let pruned = film(&scene, *rules, values);
            if bits(&pruned) != bits(&unpruned) {
                let same =
                    |(a, b): (&[f64; 3], &[f64; 3])| a.map(f64::to_bits) == b.map(f64::to_bits);
                let pixels = || pruned.image.pixels.iter().zip(&unpruned.image.pixels);
                let first = pixels().position(|pair| !same(pair)).unwrap();
                let (a, b) = (pruned.image.pixels[first], unpruned.image.pixels[first]);
                let count = pixels().filter(|pair| !same(*pair)).count();
                faults.push(format!(
                    "{name}: {count} pixels, the first is {first}: {a:?} instead of {b:?}"
                ));
            }
            // Without this rule the normals of black surfaces decide on shadow rays.
            let is_counted = rules.contains(Rule::ShadowUnlit);
            if is_counted && pruned.counts.rays() > unpruned.counts.rays() {
                faults.push(format!(
                    "{name}: {:?} rays instead of {:?}",
                    pruned.counts, unpruned.counts
                ));
            }
        }
    }
    faults
}

fn obey(folder: &str, sets: &[(String, RuleSet)]) {
    for path in files(folder) {
        let Some(scene) = scene(&path) else { continue };
        let faults = faults(&small(scene), sets);
        assert!(
            faults.is_empty(),
            "{}:\n{}",
            file_name(&path),
            faults.join("\n")
        );
    }
}

#[test]
fn all_rules_together_change_no_bit_of_a_scene_at_hand() {
    obey("scenes", &sets()[..1]);
}

#[test]
fn each_rule_alone_and_all_but_each_change_no_bit_of_the_scenes_of_the_repo() {
    obey("scenes", &sets()[1..]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn all_rules_together_change_no_bit_of_a_random_scene(seed in any::<u64>()) {
        let faults = faults(&Dice::new(seed).scene(), &sets()[..1]);
        prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn each_rule_alone_changes_no_bit_of_a_random_scene(seed in any::<u64>()) {
        let faults = faults(&Dice::new(seed).scene(), &sets()[1..]);
        prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
    }
}

/// If black surfaces may have shadow rays, a normal map without visible effect decides which do.
#[test]
fn a_normal_map_of_a_black_surface_changes_no_bit() {
    let scene = Dice::new(4_654_549_808_109_750_294).scene();
    let faults = faults(&scene, &sets());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Every rule must apply to some scene, otherwise it is not tested.
#[test]
fn each_rule_leaves_something_out_of_some_scene() {
    let mut idle = Rule::ALL.to_vec();
    idle.retain(|rule| !BY_RAYS.contains(rule) && !rule.name().starts_with("P-"));
    for seed in 0..1000 {
        let plan = Plan::new(&validated(&Dice::new(seed).scene()), RuleSet::ALL);
        let fired = |rule: &Rule| {
            plan.statuses
                .iter()
                .any(|status| status.rule == Some(*rule))
        };
        idle.retain(|rule| !fired(rule));
    }
    assert!(idle.is_empty(), "never fired: {idle:?}");
}

/// The rules that remove single rays, for which there is no status.
const BY_RAYS: [Rule; 4] = [
    Rule::ShadowFacing,
    Rule::PixelMiss,
    Rule::PixelFlat,
    Rule::Cut,
];

#[test]
fn the_rules_of_single_rays_leave_out_rays_of_their_kind() {
    let ball_on_wall = with(&[
        (ball([1.0, 0.0, 1.5], 1.0), shiny()),
        (disc([0.0; 3], 1.5), shiny()),
    ]);
    let counts = |scene: &Scene, rules| film(&validated(scene), rules, Values::Linear).counts;
    let saved = |scene: &Scene, rule| {
        let (less, more) = (
            counts(scene, RuleSet::NONE.with(rule)),
            counts(scene, RuleSet::NONE),
        );
        [
            more.camera - less.camera,
            more.shadow - less.shadow,
            more.mirror - less.mirror,
        ]
    };
    let [camera, shadow, mirror] = saved(&ball_on_wall, Rule::ShadowFacing);
    assert!(
        camera == 0 && shadow > 0 && mirror == 0,
        "away from the light a ball asks nobody"
    );
    let [camera, shadow, mirror] = saved(&ball_on_wall, Rule::PixelMiss);
    assert!(
        camera > 0 && shadow == 0 && mirror == 0,
        "where nothing shows there is nothing to shade"
    );
    let mut dark = with(&[(disc([0.0; 3], 9.0), diffuse())]);
    (dark.settings.supersampling, first_light(&mut dark).position) = (3, [0.0, 0.0, -5.0]);
    assert_eq!(
        saved(&dark, Rule::PixelFlat)[0],
        24 * 20 * 8,
        "one of nine rays a pixel"
    );
    let mut deep = with(&[(ball([0.0; 3], 14.0), shiny())]);
    deep.settings.max_depth = 40;
    let [less, more] =
        [RuleSet::ALL.with(Rule::Cut), RuleSet::ALL].map(|rules| counts(&deep, rules));
    assert!(
        less.mirror < more.mirror && less.camera == more.camera,
        "{less:?}, {more:?}"
    );
}

#[test]
fn a_world_that_shows_another_view_keeps_the_law() {
    // The first view removes the disc, which is behind the eye.
    let mut scene = with(&[
        (ball([0.0; 3], 1.0), diffuse()),
        (disc([0.0, 0.0, 30.0], 2.0), diffuse()),
    ]);
    let first = validated(&scene);
    scene.camera.eye = [0.0, 0.0, 60.0];
    let second = validated(&scene);
    let plans = [&first, &second].map(|scene| Plan::new(scene, RuleSet::ALL));
    assert_ne!(plans[0].surfaces, plans[1].surfaces);
    let mut world = AnyWorld::prepare(&first, &plans[0]);
    for scene in [second, first] {
        world.change(scene.clone());
        let seen = world
            .render(
                &RenderSelection {
                    values: Values::Linear,
                    ..RenderSelection::default()
                },
                &|_| true,
            )
            .unwrap();
        assert_eq!(
            bits(&seen),
            bits(&film(&scene, RuleSet::NONE, Values::Linear))
        );
    }
}
