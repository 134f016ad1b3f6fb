//! What `rtc compile -o scene.glb` writes: sound by our own check, and read back the scene that it
//! was; and what front/gltf reads beside what the crate `gltf` reads.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod forms;
mod laws;
mod peer;
#[path = "../suite/mod.rs"]
mod suite;

use rtc::internals::diag::{Severity, Sink};
use rtc::internals::emit;
use rtc::internals::ir::Lowered;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Budget, Limits, Loader, SourceMap};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let suites = [forms::trials(), laws::trials(), peer::trials()];
    suite::run(suites.into_iter().flatten().collect())
}

/// A scene that was proven; none if it has errors.
fn proven(mut map: SourceMap, file: rtc::internals::source::FileId) -> Option<Lowered> {
    let (options, mut sink) = (Options::default(), Sink::default());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink)?;
    pipeline::prove(&lowered, &options, &mut sink).map(|_| lowered)
}

/// The scene in a file.
fn open(path: &Path) -> Option<Lowered> {
    let mut map = SourceMap::default();
    let file = Loader.file(path, &mut map).unwrap();
    proven(map, file)
}

/// The scene in a text.
fn scene(text: &str) -> Lowered {
    let mut map = SourceMap::default();
    let file = map.add("scene.yaml", text.as_bytes().to_vec());
    proven(map, file).unwrap()
}

/// A scene as .glb, with what is found.
fn write(lowered: &Lowered, tolerance: Option<f64>) -> (Option<Vec<u8>>, Sink) {
    let (budget, mut sink) = (Budget::new(Limits::NONE), Sink::default());
    let Lowered { scene, origins } = lowered;
    let asset = emit::gltf::emit(scene, origins, tolerance, &budget, &mut sink);
    let bytes = asset.map(|asset| {
        let mut bytes = Vec::new();
        asset.write(&mut bytes).unwrap();
        bytes
    });
    (bytes, sink)
}

/// What a .glb says, which must be sound.
fn read(bytes: &[u8]) -> Lowered {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("scene.glb", bytes.to_vec());
    let options = Options::default();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered
        .as_ref()
        .and_then(|lowered| pipeline::prove(lowered, &options, &mut sink));
    let errors = sink.kept().iter();
    let errors: Vec<_> = errors
        .filter(|finding| finding.severity == Severity::Error)
        .collect();
    assert!(proof.is_some(), "{errors:#?}");
    lowered.unwrap()
}

/// Whether numbers are the same to 32 bits, beside one of this size.
fn is_near(a: f64, b: f64, size: f64) -> bool {
    (a - b).abs() <= 1e-6 * size.max(a.abs()).max(b.abs())
}
