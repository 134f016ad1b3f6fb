//! A table of what becomes of the scenes that people wrote, printed by
//! `cargo test --test files -- fates --nocapture`.

use super::scenes::COURSE;
use crate::suite::{files, needs, shared};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Files that render, and not as their own programs show them, for the format means something else:
/// the end of the path, the code of what tells of it, if anything does, and what is meant.
const OTHERWISE: &[(&str, Option<&str>, &str)] = &[
    (
        "ganyuss_advanced_graphics/scene02.yaml",
        Some("SC013"),
        "`type: default` is no mirror there, and shadows are always on",
    ),
    (
        "ganyuss_advanced_graphics/scene07.yaml",
        Some("SC013"),
        "`type: default` is no mirror there, and shadows are always on",
    ),
    (
        "ganyuss_advanced_graphics/scene08.yaml",
        Some("SC013"),
        "`type: default` is no mirror there, and shadows are always on",
    ),
    (
        "ThomasdenH_RayTracer/Scenes/scene03.json",
        Some("VA108"),
        "the edges of its quad cross; `--lenient` mends it",
    ),
    (
        "ThomasdenH_RayTracer/Scenes/scene04.json",
        None,
        "the normals of its mesh do not count there",
    ),
    (
        "MLouvet_RayTracing101/scene03.yaml",
        Some("RD008"),
        "the `d` of its plane has the other sign there, and the length of the normal counts",
    ),
    (
        "MLouvet_RayTracing101/scene04.yaml",
        Some("RD008"),
        "the `d` of its plane has the other sign there, and the length of the normal counts",
    ),
    (
        "MLouvet_RayTracing101/mesh-test-duck.yaml",
        None,
        "the materials of the mesh's own file win there",
    ),
    (
        "cportaneri_RayTracer/scenes/scene01-gooch-shadow-reflection.yaml",
        Some("SC011"),
        "Gooch's shading has shadows and mirrors there",
    ),
    (
        "3DObject/scene01-texture-ss-reflect-lights-shadows-OBJModel.yaml",
        Some("SC011"),
        "its mesh is turned by an angle",
    ),
];

/// What becomes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Fate {
    Silent,
    Warned,
    Refused,
}

/// What is said of a file: its fate, and the codes of its findings, notes included.
fn fate(path: &Path) -> (Fate, BTreeSet<&'static str>) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    if let Some(lowered) = pipeline::load(file, &mut map, &options, &mut sink) {
        pipeline::validate(&lowered, &options, &mut sink);
    }
    let told = sink.kept().iter();
    let is_warned = told
        .clone()
        .any(|finding| finding.severity == Severity::Warning);
    let fate = match (sink.has_errors(), is_warned) {
        (true, _) => Fate::Refused,
        (false, true) => Fate::Warned,
        (false, false) => Fate::Silent,
    };
    (fate, told.map(|finding| finding.code.id).collect())
}

/// A row of the table, and the counts of its fates.
fn row(name: &str, paths: &[PathBuf]) -> BTreeMap<Fate, usize> {
    let (mut fates, mut codes) = (BTreeMap::new(), BTreeMap::new());
    for path in paths {
        let (fate, told) = fate(path);
        *fates.entry(fate).or_insert(0) += 1;
        told.into_iter()
            .for_each(|code| *codes.entry(code).or_insert(0_usize) += 1);
    }
    let count = |fate| fates.get(&fate).copied().unwrap_or_default();
    let codes: Vec<_> = codes
        .iter()
        .map(|(code, n)| format!("{code} {n}"))
        .collect();
    println!(
        "| {name} | {} | {} | {} | {} | {} |",
        paths.len(),
        count(Fate::Silent),
        count(Fate::Warned),
        count(Fate::Refused),
        codes.join(", ")
    );
    fates
}

pub(crate) fn trials() -> Vec<Trial> {
    vec![needs(
        "fates: what is shown otherwise than meant is told",
        "wild-2",
        |_| {
            what_is_shown_otherwise_than_meant_is_told();
        },
    )]
}

fn what_is_shown_otherwise_than_meant_is_told() {
    println!("\n| folder | files | without a word | warned | refused | files with each code |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let (mut all, mut refused, mut untold) = (0, 0, 0);
    let mut otherwise = Vec::new();
    for folder in [COURSE, "wild", "wild-2"] {
        let Some(path) = shared(folder) else { continue };
        let paths = files(&path, &["yaml", "yml", "json"]);
        let fates = row(folder, &paths);
        all += paths.len();
        refused += fates.get(&Fate::Refused).copied().unwrap_or_default();
        let departures = paths.iter().filter_map(|path| {
            let name = path.display().to_string();
            let known = OTHERWISE.iter().find(|(end, ..)| name.ends_with(end));
            known.map(|known| (path, known))
        });
        for (path, (end, code, why)) in departures {
            let (fate, told) = fate(path);
            assert!(
                fate != Fate::Refused && code.is_none_or(|code| told.contains(code)),
                "{end} says {told:?}"
            );
            otherwise.push(format!(
                "{end}: {why}; told by {}",
                code.unwrap_or("nothing")
            ));
            untold += usize::from(code.is_none());
        }
    }
    println!("\n{}\n", otherwise.join("\n"));
    assert_eq!(otherwise.len(), OTHERWISE.len(), "all of them are there");
    // What is refused has a fault of its own, as `wild::REFUSED` says.
    let sound = all - refused;
    println!(
        "{sound} of {all} files are sound; {} mean something else in their own programs, {untold} of them \
         without a word",
        otherwise.len()
    );
    assert!(untold * 100 <= sound * 3, "{untold} of {sound} files");
}
