//! The invariants and statuses of path tracing: no rule changes a bit of the picture, and no status
//! contradicts the ray counts of the picture.

use super::dice::Dice;
use super::{file_name, files, scene, validated};
use crate::ray_counts::{contradictions, difference, film, traced, unused_effects};
use rtc::internals::ir::Scene;
use rtc::internals::plan::{EffectState, Plan, Rule, RuleSet};
use std::env;

/// The number of generated scenes: `RTC_SCENES=1000 cargo test --test suites plan::paths` tries
/// more.
fn scenes() -> u64 {
    env::var("RTC_SCENES").map_or(64, |count| count.parse().unwrap())
}

/// The sets of rules to test with a scene: each rule alone that removes something, and all of them.
fn sets(scene: &Scene) -> Vec<(String, RuleSet)> {
    let plan = Plan::new(&validated(scene), RuleSet::ALL);
    let mut applied: Vec<_> = plan
        .statuses
        .iter()
        .filter_map(|status| status.rule)
        .collect();
    applied.sort_unstable();
    applied.dedup();
    let alone = applied
        .into_iter()
        .map(|rule| (rule.name().to_owned(), RuleSet::NONE.with(rule)));
    alone.chain([("all".to_owned(), RuleSet::ALL)]).collect()
}

#[test]
fn no_rule_changes_a_bit_of_a_made_up_scene() {
    // In scene 658 two maps of one texture have different sets of coordinates.
    for seed in (0..scenes()).chain([658]) {
        let scene = Dice::new(seed).path_scene();
        let proof = validated(&scene);
        let unpruned = film(&proof, RuleSet::NONE);
        for (name, rules) in sets(&scene) {
            let difference = difference(&proof, &unpruned, rules);
            assert_eq!(difference, None, "scene {seed}, {name}");
        }
    }
}

#[test]
fn what_is_told_absent_is_never_simulated() {
    for seed in 0..scenes() {
        let proof = validated(&Dice::new(seed).path_scene());
        let mut contradictions = contradictions(&proof, &film(&proof, RuleSet::ALL).counts);
        contradictions.retain(|(_, state, _)| *state != EffectState::Needed);
        assert!(
            contradictions.is_empty(),
            "scene {seed}: {contradictions:?}"
        );
    }
}

#[test]
fn the_scenes_of_the_repo_obey_the_law_and_show_what_they_are_told_to_need() {
    let mut all = Vec::new();
    for path in files("scenes") {
        let Some(scene) = scene(&path) else { continue };
        let proof = validated(&traced(scene));
        let difference = difference(&proof, &film(&proof, RuleSet::NONE), RuleSet::ALL);
        assert_eq!(difference, None, "{}", file_name(&path));
        all.extend(unused_effects(&file_name(&path), &proof));
    }
    assert!(all.len() <= 3, "needed, but not met:\n{}", all.join("\n"));
}

#[test]
fn each_rule_for_paths_leaves_something_out_of_some_scene() {
    let is_for_paths = |rule: &Rule| rule.name().starts_with("P-");
    let mut idle: Vec<_> = Rule::ALL.into_iter().filter(is_for_paths).collect();
    for seed in 0..2000 {
        if idle.is_empty() {
            break;
        }
        let plan = Plan::new(&validated(&Dice::new(seed).path_scene()), RuleSet::ALL);
        idle.retain(|rule| {
            plan.statuses
                .iter()
                .all(|status| status.rule != Some(*rule))
        });
    }
    assert!(idle.is_empty(), "never fired: {idle:?}");
}
