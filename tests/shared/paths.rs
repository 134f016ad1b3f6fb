//! Paths through the assets of glTF: no rule changes a bit, and what is told of a picture is what
//! is counted.

use super::scenes::{accepted, each, validated};
use crate::ray_counts::{difference, film, traced, unused_effects};
use crate::suite::{files, needs};
use libtest_mimic::Trial;
use rtc::internals::plan::RuleSet;
use std::path::Path;

const ASSETS: &str = "gltf/assets";
const GLTF: [&str; 2] = ["glb", "gltf"];

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = each("paths: law", ASSETS, &GLTF, obeys_the_law);
    let name = format!("paths: told and counted/{ASSETS}");
    trials.push(needs(name, ASSETS, is_told_rightly));
    trials
}

/// All rules together change no bit, and cost no ray.
fn obeys_the_law(path: &Path) {
    let Some(scene) = accepted(path) else { return };
    let proof = validated(traced(scene));
    let unpruned = film(&proof, RuleSet::NONE);
    assert_eq!(difference(&proof, &unpruned, RuleSet::ALL), None);
}

/// An effect told absent is never counted; of those told needed all but a few are.
fn is_told_rightly(folder: &Path) {
    let mut all = Vec::new();
    for path in files(folder, &GLTF) {
        let Some(scene) = accepted(&path) else {
            continue;
        };
        all.extend(unused_effects(
            &path.display().to_string(),
            &validated(traced(scene)),
        ));
    }
    assert!(all.len() <= 3, "needed, but not met:\n{}", all.join("\n"));
}
