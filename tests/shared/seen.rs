//! What is warned of as never seen is not in the picture: no scene of the course, of those that
//! people published, of ours, and no asset of glTF warns of an object that its instance layer
//! shows.

use super::scenes::{COURSE, each};
use crate::suite::{files, root, trial};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, codes};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options, Renderer};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Aov, RenderSelection};
use rtc::internals::source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let texts = ["yaml", "yml", "json"];
    let mut trials = each("seen", COURSE, &texts, never_seen_is_not_shown);
    trials.extend(each("seen", "wild", &texts, never_seen_is_not_shown));
    trials.extend(each("seen", "wild-2", &texts, never_seen_is_not_shown));
    trials.extend(each(
        "seen",
        "gltf/assets",
        &["glb", "gltf"],
        never_seen_is_not_shown,
    ));
    let own = files(&root("scenes"), &["yaml"]).into_iter();
    trials.extend(own.map(|path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        trial(format!("seen/scenes/{name}"), move || {
            never_seen_is_not_shown(&path);
        })
    }));
    trials
}

/// The surfaces warned of are none of those that the first rays meet.
fn never_seen_is_not_shown(path: &Path) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let Some(mut lowered) = pipeline::load(file, &mut map, &options, &mut sink) else {
        return;
    };
    let small = Overrides {
        size: Some([48, 48]),
        supersampling: Some(1),
        ..Overrides::default()
    };
    small.apply(&mut lowered.scene);
    let Some(scene) = pipeline::validate(&lowered, &options, &mut sink) else {
        return;
    };
    let warned = sink
        .kept()
        .iter()
        .filter(|finding| finding.code == &codes::NEVER_SEEN);
    let numbers: Vec<usize> = warned
        .filter_map(|finding| finding.pointer.as_deref()?.strip_prefix("/surfaces/"))
        .map(|index| index.parse::<usize>().unwrap() + 1)
        .collect();
    println!("{}: never seen: {numbers:?}", path.display());
    if numbers.is_empty() {
        return;
    }
    let whole = RenderSelection::default();
    let renderer = Renderer::new(&scene, &Plan::new(&scene, RuleSet::NONE), 0).unwrap();
    let layers = renderer.layers(&[Aov::Instance], &whole, &|| true).unwrap();
    let shown: BTreeSet<String> = layers.values.iter().map(f32::to_string).collect();
    for number in numbers {
        assert!(!shown.contains(&number.to_string()), "{number} is shown");
    }
}
