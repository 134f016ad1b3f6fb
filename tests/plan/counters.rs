//! Counters: the class of rays of an effect that was left out is 0.

use super::dice::Dice;
use super::{film, proven};
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
