//! What a plan of paths tells, beside what its picture counts; and that its rules change no bit.

use rtc::internals::ir::{self, Mode, Scene};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline;
use rtc::internals::plan::{Effect, EffectState, Plan, Rules};
use rtc::internals::render::{Counts, Film, Job, Values};
use rtc::internals::valid::ValidScene;

/// The scene as the path integrator renders it, in few pixels, paths and bounces.
pub(crate) fn traced(mut scene: Scene) -> Scene {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        scene.settings.mode = Mode::Path(ir::PathSettings {
            samples: 2,
            multiple_scattering: true,
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

pub(crate) fn film(scene: &ValidScene, rules: Rules) -> Film {
    let job = Job {
        values: Values::Linear,
        ..Job::default()
    };
    pipeline::render(scene, &Plan::new(scene, rules), &job, 2, &|_| true)
        .unwrap()
        .unwrap()
}

/// How the picture by some rules differs from that without rules, if it does.
pub(crate) fn difference(scene: &ValidScene, unpruned: &Film, rules: Rules) -> Option<String> {
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

/// What verdicts say that the counts of the picture deny.
pub(crate) fn lies(scene: &ValidScene, counts: &Counts) -> Vec<(Effect, EffectState, u64)> {
    let plan = Plan::new(scene, Rules::ALL);
    let is_lie = |state: EffectState, count: u64| (state == EffectState::Needed) != (count > 0);
    let statuses = plan.statuses.iter().filter(|status| status.of.is_none());
    statuses
        .map(|status| (status.effect, status.state, counts.of(status.effect)))
        .filter(|(_, state, count)| is_lie(*state, *count))
        .collect()
}

/// Effects that a scene is told to need and does not show; panics where it shows one that it is
/// told to do without.
pub(crate) fn unmet(name: &str, scene: &ValidScene) -> Vec<String> {
    let counts = film(scene, Rules::ALL).counts;
    let told = |(effect, state, count): (Effect, EffectState, u64)| {
        assert_eq!(
            state,
            EffectState::Needed,
            "{name}: {effect:?} is counted {count} times"
        );
        format!("{name}: {}", effect.name())
    };
    lies(scene, &counts).into_iter().map(told).collect()
}
