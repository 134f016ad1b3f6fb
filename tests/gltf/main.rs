//! glTF against what others say: the corpus of the Khronos validator with its reports, broken files
//! with what they must end in, and assets that must pass. They lie in `../shared`; where that is
//! absent, a note says so.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, tells what it saw, and reads what it checks"
)]
use rtc::diag::{Severity, Sink};
use rtc::pipeline::{self, Options};
use rtc::source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

mod broken;
mod corpus;
mod lowering;
mod make;

/// A folder of `../shared/gltf`; a note if there is none.
fn shared(folder: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/gltf")
        .join(folder);
    let found = path.is_dir().then_some(path);
    if found.is_none() {
        println!("skipped: there is no ../shared/gltf/{folder}");
    }
    found
}

/// All files below a folder, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path)
            } else {
                found.push(path)
            }
        }
    }
    found.sort();
    found
}

/// What is found in a file.
fn findings(path: &Path) -> Sink {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let options = Options::default();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    if let Some(lowered) = lowered {
        pipeline::prove(&lowered, &options, &mut sink);
    }
    sink
}

/// The names of the errors among the findings, ours where Khronos has none.
fn errors(sink: &Sink) -> BTreeSet<String> {
    let errors = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Error);
    errors
        .map(|finding| finding.alias.unwrap_or(finding.code.id).to_owned())
        .collect()
}
