//! The scenes other people wrote: every file of `../shared/wild` and of the course renders, or is
//! refused for a fault of its own, which this test names.
//!
//! Prints one line a file. Skips where the files are not beside this checkout.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test stops at the first surprise, reads what it checks, and tells what it did"
)]
use rtc::diag::{Severity, Sink};
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Plan, Rules};
use rtc::render::Job;
use rtc::source::{Loader, SourceMap};
use std::fs;
use std::path::{Path, PathBuf};

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
];

fn shared() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared")
}

/// All scene files of a folder and the folders in it.
fn scenes(folder: &Path) -> Vec<PathBuf> {
    files(folder, &["yaml", "yml"])
}

/// All files of a folder and the folders in it with one of these extensions.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let (mut open, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(
                fs::read_dir(path)
                    .unwrap()
                    .map(|entry| entry.unwrap().path()),
            );
        } else if path
            .extension()
            .is_some_and(|extension| extensions.iter().any(|wanted| extension == *wanted))
        {
            found.push(path);
        }
    }
    found.sort();
    found
}

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
    let (mut map, mut sink, options) = (SourceMap::default(), Sink::default(), Options::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered.and_then(|mut lowered| {
        small().apply(&mut lowered.scene);
        pipeline::prove(&lowered, &options, &mut sink)
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
        &Plan::new(&scene, Rules::ALL),
        &Job::default(),
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

/// Renders all files of a folder; how many there are, and how many rendered.
fn render_all(folder: &Path) -> (usize, usize) {
    let files = scenes(folder);
    let mut rendered = 0;
    for path in &files {
        let name = path.strip_prefix(shared()).unwrap().display().to_string();
        let known = REFUSED.iter().find(|(end, ..)| name.ends_with(end));
        match (outcome(path), known) {
            (Ok(warnings), None) => {
                println!("{name}: rendered; {}", warnings.join("; "));
                rendered += 1;
            }
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
    (files.len(), rendered)
}

#[test]
fn the_files_of_the_wild_render_or_are_refused_for_their_faults() {
    if !shared().join("wild").exists() {
        println!("skipped: there is no ../shared/wild");
        return;
    }
    let (all, rendered) = render_all(&shared().join("wild"));
    assert!(rendered >= 70 && all >= 74, "{rendered} of {all} rendered");
}

#[test]
fn the_files_of_the_course_render() {
    if !shared().join("course/scenes").exists() {
        println!("skipped: there is no ../shared/course/scenes");
        return;
    }
    let (all, rendered) = render_all(&shared().join("course/scenes"));
    assert_eq!(rendered, all);
}

/// What is said of where the files lie that a scene names, a line each.
fn places(path: &Path) -> Vec<String> {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = Loader.file(path, &mut map).unwrap();
    pipeline::load(file, &mut map, &Options::default(), &mut sink);
    let name = path.strip_prefix(shared()).unwrap().display();
    let of_places = sink
        .kept()
        .iter()
        .filter(|finding| ["RE001", "RE002", "RE003"].contains(&finding.code.id));
    let line =
        |finding: &rtc::diag::Diagnostic| format!("{} {name}: {}", finding.code, finding.message);
    of_places
        .map(|finding| line(finding).replace(&format!("{}/", shared().display()), ""))
        .collect()
}

/// The table was made before the folder above a scene's lent only what is asked for.
#[test]
fn the_files_that_scenes_name_are_found_where_they_were() {
    if !shared().join("wild").exists() {
        println!("skipped: there is no ../shared/wild");
        return;
    }
    let folders = ["course", "wild", "wild-2"]
        .map(|folder| files(&shared().join(folder), &["yaml", "yml", "json"]));
    let mut told: Vec<String> = folders
        .iter()
        .flatten()
        .flat_map(|path| places(path))
        .collect();
    told.sort();
    let table = include_str!("wild-files.txt")
        .lines()
        .filter(|line| !line.starts_with('#'));
    assert_eq!(told, table.collect::<Vec<_>>());
}
