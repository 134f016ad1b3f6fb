//! Counters: no rays are traced for a removed effect.

use super::dice::Dice;
use super::{film, validated};
use crate::ray_counts::contradictions;
use rtc::internals::plan::{Effect, EffectState, Plan, RuleSet};
use rtc::internals::render::Values;

#[test]
fn what_is_told_absent_is_never_simulated() {
    for seed in 0..400 {
        let scene = validated(&Dice::new(seed).scene());
        let counts = film(&scene, RuleSet::ALL, Values::Linear).counts;
        let mut contradictions = contradictions(&scene, &counts);
        // Equal vertex normals are still looked up and counted.
        let is_told = |effect: Effect| effect != Effect::NormalInterpolation;
        contradictions
            .retain(|(effect, state, _)| *state != EffectState::Needed && is_told(*effect));
        assert!(
            contradictions.is_empty(),
            "scene {seed}: {contradictions:?}"
        );
    }
}

#[test]
fn an_effect_that_is_not_needed_traces_no_ray() {
    for seed in 0..400 {
        let scene = validated(&Dice::new(seed).scene());
        let plan = Plan::new(&scene, RuleSet::ALL);
        let counts = film(&scene, RuleSet::ALL, Values::Linear).counts;
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
