//! The plan: removed work contributes nothing, remaining work contributes something, and the
//! reported reasons are correct.
//!
//! The strength of this suite and of the unit tests of the rules is measured by
//! `benches/mutants.sh`: surviving mutants need a test. The expectations for the scenes of the
//! course and of others are in `tests/shared`.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod approved;
mod counters;
mod cut;
mod dice;
mod effort;
mod emitters;
mod extreme;
mod features;
mod law;
mod need;
mod path_effects;
mod path_materials;
mod path_reports;
mod path_rules;
mod path_scenes;
mod paths;
mod precision;
mod scenes;
mod sensitivity;
mod solids;
mod validation;
mod written;

use crate::repo::root;
use crate::small::{bits, validated};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Scene;
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Effect, EffectState, EffectStatus, Plan, Rule, RuleSet};
use rtc::internals::render::{Film, RenderSelection, Values};
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::valid::ValidScene;
use std::path::{Path, PathBuf};

/// The scene files of a folder and the folders in it.
fn files(folder: &str) -> Vec<PathBuf> {
    crate::repo::files(&root(folder), &["yaml", "yml"])
}

/// A scene unchanged; `None` if it is rejected.
fn scene(path: &Path) -> Option<Scene> {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink)?;
    (!sink.has_errors()).then_some(lowered.scene)
}

/// The scene with few pixels, samples and bounces.
fn small(mut scene: Scene) -> Scene {
    let (sampling, depth) = (
        scene.settings.supersampling.min(2),
        scene.settings.max_depth.min(4),
    );
    let size = Some([22, 18]);
    Overrides {
        size,
        supersampling: Some(sampling),
        depth: Some(depth),
        spp: Some(2),
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene.camera.lens.samples = scene.camera.lens.samples.min(3);
    scene.settings.light_samples = scene.settings.light_samples.min(4);
    scene
}

fn film(scene: &ValidScene, rules: RuleSet, values: Values) -> Film {
    let job = RenderSelection {
        values,
        ..RenderSelection::default()
    };
    pipeline::render(scene, &Plan::new(scene, rules), &job, 2, &|_| true)
        .unwrap()
        .unwrap()
}

/// The status of an effect of the whole scene.
fn status(plan: &Plan, effect: Effect) -> &EffectStatus {
    let mut all = plan
        .statuses
        .iter()
        .filter(|status| status.effect == effect && status.of.is_none());
    let first = all
        .next()
        .unwrap_or_else(|| panic!("there is a verdict on {effect:?}"));
    assert!(all.next().is_none(), "there is one verdict on {effect:?}");
    first
}

/// The state of an effect, and the rule.
fn fate(scene: &Scene, effect: Effect) -> (EffectState, Option<Rule>) {
    let plan = Plan::new(&validated(scene), RuleSet::ALL);
    let EffectStatus { state, rule, .. } = status(&plan, effect);
    (*state, *rule)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}
