//! What the fuzzers found interesting, and the seeds they start from, run through the same lines as
//! the targets.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, names it, and reads what it checks"
)]
#[expect(unreachable_pub, reason = "it is the library of the fuzz targets")]
#[path = "../fuzz/src/lib.rs"]
mod inputs;

use rtc::cli;
use rtc::pipeline::trial;
use std::path::{Path, PathBuf};

/// The folders every target starts from.
const SEEDS: &[&str] = &[
    "fuzz/seeds",
    "scenes",
    "tests/codec/v0",
    "tests/codec/v1",
    "tests/codec/v2",
    "tests/codec/v3",
];

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .collect();
    files.sort();
    files
}

/// Runs every seed and every file of the target's corpus; of a failure the last name printed is the
/// culprit.
fn replay(target: &str, trial: fn(&[u8])) {
    let corpus = format!("fuzz/corpus/{target}");
    let inputs: Vec<_> = SEEDS
        .iter()
        .copied()
        .chain([corpus.as_str()])
        .flat_map(files)
        .collect();
    assert!(inputs.len() > 20, "{target}: the corpus is gone");
    for path in inputs {
        println!("{}", path.display());
        trial(&std::fs::read(path).unwrap());
    }
}

#[test]
fn scene_parser() {
    replay("scene_parser", trial::lower);
}

#[test]
fn check() {
    replay("check", trial::check);
}

#[test]
fn ir_decode() {
    replay("ir_decode", trial::decode);
}

#[test]
fn validate() {
    replay("validate", trial::validate);
}

#[test]
fn render_tiny() {
    replay("render_tiny", trial::picture);
}

#[test]
fn gltf() {
    replay("gltf", trial::gltf);
}

#[test]
fn glb() {
    replay("glb", trial::glb);
}

#[test]
fn mesh() {
    replay("mesh", inputs::mesh);
}

#[test]
fn image() {
    replay("image", inputs::image);
}

#[test]
fn folder() {
    replay("folder", inputs::folder);
}

#[test]
fn arguments() {
    replay("arguments", cli::trial::arguments);
}

/// A target without a replay would be a target whose finds come back unseen.
#[test]
fn every_target_is_replayed() {
    let source =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpora.rs"))
            .unwrap();
    for target in files("fuzz/fuzz_targets") {
        let name = target.file_stem().unwrap().to_string_lossy().into_owned();
        assert!(
            source.contains(&format!("replay(\"{name}\"")),
            "{name} is not replayed"
        );
    }
}
