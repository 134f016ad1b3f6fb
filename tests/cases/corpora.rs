//! What the fuzzers found interesting, and the seeds they start from, run through the same lines as
//! the targets.

#[expect(unreachable_pub, reason = "it is the library of the fuzz targets")]
#[path = "../../fuzz/src/lib.rs"]
mod inputs;

use crate::suite::{root, trial};
use libtest_mimic::Trial;
use rtc::internals::cli;
use rtc::internals::pipeline::trial as run;
use std::path::PathBuf;

/// The folders every target starts from.
const SEEDS: &[&str] = &[
    "fuzz/seeds",
    "scenes",
    "tests/codec/v0",
    "tests/codec/v1",
    "tests/codec/v2",
    "tests/codec/v3",
];

/// What a target does with bytes.
type Target = (&'static str, fn(&[u8]));

const TARGETS: &[Target] = &[
    ("scene_parser", run::lower),
    ("check", run::check),
    ("ir_decode", run::decode),
    ("validate", run::validate_any),
    ("render_tiny", run::picture),
    ("gltf", run::gltf),
    ("glb", run::glb),
    ("mesh", inputs::mesh),
    ("image", inputs::image),
    ("folder", inputs::folder),
    ("part", run::part),
    ("arguments", cli::trial::arguments),
    ("fix", run::fix),
    ("lsp", cli::trial::messages),
    ("ies", inputs::ies),
    ("mtl", inputs::mtl),
    ("ply", inputs::ply),
    ("stl", inputs::stl),
    ("written", run::written),
    ("pbrt", inputs::pbrt),
    ("usd", inputs::usd),
    ("mitsuba", inputs::mitsuba),
];

/// A trial for the seeds of each target, and for each file of its corpus.
pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = vec![trial("corpora: every target is replayed", || {
        every_target_is_replayed();
    })];
    for (target, replay) in TARGETS {
        trials.push(trial(format!("corpora/{target}: seeds"), || {
            replay_seeds(*replay)
        }));
        let corpus = files(&format!("fuzz/corpus/{target}"));
        assert!(!corpus.is_empty(), "{target}: the corpus is gone");
        trials.extend(corpus.into_iter().map(|path| {
            let file = path.file_name().unwrap().to_string_lossy().into_owned();
            trial(format!("corpora/{target}/{file}"), move || {
                replay(&std::fs::read(&path).unwrap());
            })
        }));
    }
    trials
}

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = root(folder);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .collect();
    files.sort();
    files
}

/// Of a failure the last name printed is the culprit.
fn replay_seeds(replay: fn(&[u8])) {
    let seeds: Vec<_> = SEEDS.iter().copied().flat_map(files).collect();
    assert!(seeds.len() > 20, "the seeds are gone");
    for path in seeds {
        println!("{}", path.display());
        replay(&std::fs::read(path).unwrap());
    }
}

/// A target without a replay would be a target whose finds come back unseen.
fn every_target_is_replayed() {
    for target in files("fuzz/fuzz_targets") {
        let name = target.file_stem().unwrap().to_string_lossy().into_owned();
        assert!(
            TARGETS.iter().any(|(own, _)| *own == name),
            "{name} is not replayed"
        );
    }
}
