//! The statuses of a path plan compared with the ray counts of its picture, and the check that
//! rules change no bit.

use rtc::internals::ir::{self, Mode, Scene};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline;
use rtc::internals::plan::{Effect, EffectState, Plan, RuleSet};
use rtc::internals::render::{Film, RayCounts, RenderSelection, Values};
use rtc::internals::valid::ValidScene;

/// The scene as the path integrator renders it, in few pixels, paths and bounces.
pub(crate) fn traced(mut scene: Scene) -> Scene {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        scene.settings.mode = Mode::Path(ir::PathSettings {
            samples: 2,
            multiple_scattering: true,
            caustics: false,
            ..ir::PathSettings::default()
        });
    }
    Overrides {
        size: Some([22, 18]),
        depth: Some(scene.settings.max_depth.min(4)),
        spp: Some(2),
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene
}

pub(crate) fn film(scene: &ValidScene, rules: RuleSet) -> Film {
    let job = RenderSelection {
        values: Values::Linear,
        ..RenderSelection::default()
    };
    pipeline::render(scene, &Plan::new(scene, rules), &job, 2, &|_| true)
        .unwrap()
        .unwrap()
}

/// The difference of the picture with some rules from that without rules, if there is any.
pub(crate) fn difference(scene: &ValidScene, unpruned: &Film, rules: RuleSet) -> Option<String> {
    let pruned = film(scene, rules);
    let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
    let mut pairs = pruned.image.pixels.iter().zip(&unpruned.image.pixels);
    if let Some(pixel) = pairs.position(|(a, b)| bits(a) != bits(b)) {
        let [a, b] = [&pruned, unpruned].map(|film| film.image.pixels[pixel]);
        return Some(format!("pixel {pixel} is {a:?} instead of {b:?}"));
    }
    let [less, more] = [&pruned, unpruned].map(|film| film.counts.rays());
    (less > more).then(|| format!("{less} rays instead of {more}"))
}

/// The statuses that the ray counts of the picture contradict.
pub(crate) fn contradictions(
    scene: &ValidScene,
    counts: &RayCounts,
) -> Vec<(Effect, EffectState, u64)> {
    let plan = Plan::new(scene, RuleSet::ALL);
    let is_contradiction =
        |state: EffectState, count: u64| (state == EffectState::Needed) != (count > 0);
    let statuses = plan.statuses.iter().filter(|status| status.of.is_none());
    statuses
        .map(|status| (status.effect, status.state, counts.of(status.effect)))
        .filter(|(_, state, count)| is_contradiction(*state, *count))
        .collect()
}

/// The effects with status needed that the picture does not count; panics if it counts one that is
/// not needed.
pub(crate) fn unused_effects(name: &str, scene: &ValidScene) -> Vec<String> {
    let counts = film(scene, RuleSet::ALL).counts;
    let name_of = |(effect, state, count): (Effect, EffectState, u64)| {
        assert_eq!(
            state,
            EffectState::Needed,
            "{name}: {effect:?} is counted {count} times"
        );
        format!("{name}: {}", effect.name())
    };
    contradictions(scene, &counts)
        .into_iter()
        .map(name_of)
        .collect()
}
