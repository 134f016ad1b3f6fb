//! What `rtc compile -o scene.glb` and `-o scene.gltf` write: sound by our own check, and read back
//! the scene that it was; and what front/gltf reads beside what the crate `gltf` reads.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod forms;
mod laws;
mod peer;

use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::emit;
use rtc::internals::emit::gltf::GltfAsset;
use rtc::internals::ir::LoweredScene;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Budget, FileId, Limits, Loader, MemoryFiles, SourceMap};
use std::path::Path;
use std::sync::Arc;

/// All its trials.
pub(crate) fn trials() -> Vec<Trial> {
    [forms::trials(), laws::trials(), peer::trials()]
        .into_iter()
        .flatten()
        .collect()
}

/// A scene that was proven; none if it has errors.
fn validated(mut map: SourceMap, file: FileId) -> Option<LoweredScene> {
    let (options, mut sink) = (Options::default(), DiagnosticSink::default());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink)?;
    pipeline::validate(&lowered, &options, &mut sink).map(|_| lowered)
}

/// The scene in a file.
fn open(path: &Path) -> Option<LoweredScene> {
    let mut map = SourceMap::default();
    let file = Loader.file(path, &mut map).unwrap();
    validated(map, file)
}

/// The scene in a text.
fn scene(text: &str) -> LoweredScene {
    let mut map = SourceMap::default();
    let file = map.add("scene.yaml", text.as_bytes().to_vec());
    validated(map, file).unwrap()
}

/// A scene as .glb, with what is found.
fn write(lowered: &LoweredScene, tolerance: Option<f64>) -> (Option<Vec<u8>>, DiagnosticSink) {
    let (asset, sink) = emitted(lowered, tolerance, None);
    (asset.map(|asset| bytes(&asset)), sink)
}

/// A scene as glTF, with files in a folder if one is given, with what is found.
fn emitted(
    lowered: &LoweredScene,
    tolerance: Option<f64>,
    folder: Option<&str>,
) -> (Option<GltfAsset>, DiagnosticSink) {
    let (budget, mut sink) = (Budget::new(Limits::NONE), DiagnosticSink::default());
    let LoweredScene {
        scene,
        source_spans,
    } = lowered;
    let asset = emit::gltf::emit(scene, source_spans, tolerance, folder, &budget, &mut sink);
    (asset, sink)
}

fn bytes(asset: &GltfAsset) -> Vec<u8> {
    let mut bytes = Vec::new();
    asset.write(&mut bytes).unwrap();
    bytes
}

/// What a .glb says, which must be sound.
fn read(bytes: &[u8]) -> LoweredScene {
    let mut map = SourceMap::default();
    let file = map.add("scene.glb", bytes.to_vec());
    sound(map, file)
}

/// What a .gltf says with the files beside it, which must be sound.
fn read_text(text: &[u8], asset: &GltfAsset) -> LoweredScene {
    let (map, file) = with_files(text, asset);
    sound(map, file)
}

/// A .gltf in memory with the files of an asset.
fn with_files(text: &[u8], asset: &GltfAsset) -> (SourceMap, FileId) {
    let files = asset.files();
    let files = files.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
    let text = ("scene.gltf".to_owned(), text.to_vec());
    let (mut map, files) = (SourceMap::default(), MemoryFiles::new(files.chain([text])));
    let file = Loader.memory("scene.gltf", &Arc::new(files), &mut map);
    (map, file.unwrap())
}

fn sound(mut map: SourceMap, file: FileId) -> LoweredScene {
    let (options, mut sink) = (Options::default(), DiagnosticSink::default());
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered
        .as_ref()
        .and_then(|lowered| pipeline::validate(lowered, &options, &mut sink));
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
