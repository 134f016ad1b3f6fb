//! The scenes other people wrote: every file of `../shared/wild`, `../shared/wild-2` and of the
//! course renders, or is refused for a fault of its own, which this test names.

use super::scenes::{COURSE, each};
use crate::suite::{files, needs};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::RenderSelection;
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

const SCENES: &[&str] = &["yaml", "yml"];

/// The files with a fault: the end of the path, the code, and what is wrong.
const REFUSED: &[(&str, &str, &str)] = &[
    (
        "upsud/scene01-3D-model.yaml",
        "RE001",
        "its mesh `teapot.obj` was never published with it",
    ),
    (
        "upsud/scene01-texture-coordinate-basic.yaml",
        "SC005",
        "`basic` is no render mode of the format",
    ),
    (
        "upsud/scene01-texture-coordinate-ss-reflect-lights-shadows-800x800-2x2.yaml",
        "SY007",
        "a material has two textures, so that one of them would be lost",
    ),
    (
        "Graphics/scene01-texture-ss-reflect-lights-shadows-OBJModel.yml",
        "RE006",
        "it names a PNG as its mesh",
    ),
    (
        "Scenes/scene01-texture-ss-reflect-lights-shadows.json",
        "RE001",
        "its texture was never published with it",
    ),
    (
        "ganyuss_advanced_graphics/scene01-camera-ss-reflect-lights-shadows.yaml",
        "RE001",
        "its textures above its folder were not published with it",
    ),
    (
        "ganyuss_advanced_graphics/scene05.yaml",
        "RE001",
        "its texture above its folder was not published with it",
    ),
];

/// Small enough to be quick, large enough to meet every object in view.
fn small() -> Overrides {
    Overrides {
        size: Some([24, 24]),
        supersampling: Some(1),
        depth: Some(2),
        ..Overrides::default()
    }
}

/// What became of a file: the warnings of one that rendered, or the errors of one that did not.
fn outcome(path: &Path) -> Result<Vec<String>, Vec<(&'static str, String)>> {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered.and_then(|mut lowered| {
        small().apply(&mut lowered.scene);
        pipeline::validate(&lowered, &options, &mut sink)
    });
    let Some(scene) = proof else {
        let errors = sink
            .kept()
            .iter()
            .filter(|finding| finding.severity == Severity::Error);
        for error in errors.clone() {
            assert!(
                error.primary.is_some(),
                "{}: {} has no place",
                path.display(),
                error.message
            );
        }
        return Err(errors
            .map(|error| (error.code.id, error.message.clone()))
            .collect());
    };
    let film = pipeline::render(
        &scene,
        &Plan::new(&scene, RuleSet::ALL),
        &RenderSelection::default(),
        1,
        &|_| true,
    )
    .unwrap()
    .unwrap();
    drop(film);
    let warnings = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Warning);
    Ok(warnings
        .map(|warning| format!("{} {}", warning.code, warning.message))
        .collect())
}

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = each("wild", "wild", SCENES, render);
    trials.extend(each("wild", "wild-2", &["yaml", "yml", "json"], render));
    trials.extend(each("wild", COURSE, SCENES, render));
    trials.push(needs("wild: all files", "wild", |folder| {
        let count = files(folder, SCENES).len();
        assert_eq!(count, 74, "files that people published");
    }));
    trials.push(needs(
        "wild: the files that scenes name are found where they were",
        "wild",
        |folder| the_files_that_scenes_name_are_found_where_they_were(folder.parent().unwrap()),
    ));
    trials
}

/// A file renders, or is refused for the fault that the table names.
fn render(path: &Path) {
    let name = path.display().to_string();
    let known = REFUSED.iter().find(|(end, ..)| name.ends_with(end));
    match (outcome(path), known) {
        (Ok(warnings), None) => println!("{name}: rendered; {}", warnings.join("; ")),
        (Err(errors), Some((_, code, why))) => {
            println!("{name}: refused: {why}: {errors:?}");
            assert!(
                errors.iter().any(|(found, _)| found == code),
                "{name} is refused for something else: {errors:?}"
            );
        }
        (Ok(_), Some((_, _, why))) => panic!("{name} renders, in spite of this: {why}"),
        (Err(errors), None) => panic!("{name} is refused: {errors:?}"),
    }
}

/// What is said of where the files lie that a scene names, a line each.
fn places(path: &Path, shared: &Path) -> Vec<String> {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let name = path.strip_prefix(shared).unwrap().display();
    let of_places = sink
        .kept()
        .iter()
        .filter(|finding| ["RE001", "RE002", "RE003"].contains(&finding.code.id));
    let line = |finding: &rtc::internals::diag::Diagnostic| {
        format!("{} {name}: {}", finding.code, finding.message)
    };
    of_places
        .map(|finding| line(finding).replace(&format!("{}/", shared.display()), ""))
        .collect()
}

/// The table was made before the folder above a scene's lent only what is asked for.
fn the_files_that_scenes_name_are_found_where_they_were(shared: &Path) {
    let folders = ["course", "wild", "wild-2"]
        .map(|folder| files(&shared.join(folder), &["yaml", "yml", "json"]));
    let mut told: Vec<String> = folders
        .iter()
        .flatten()
        .flat_map(|path| places(path, shared))
        .collect();
    told.sort();
    let table = include_str!("wild-files.txt")
        .lines()
        .filter(|line| !line.starts_with('#'));
    assert_eq!(told, table.collect::<Vec<_>>());
}
