//! Scenes small enough to be rendered many times, and their films, for suites that state laws of
//! pictures.
#![allow(dead_code, reason = "no suite needs all of it")]

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{LoweredScene, Scene, SourceSpans};
use rtc::internals::passes::Overrides;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{
    Background, Film, PixelStride, RenderSelection, SamplingSeeds, Values,
};
use rtc::internals::source::{FileId, Loader, SourceMap};
use rtc::internals::valid::ValidScene;
use std::path::{Path, PathBuf};

/// The scenes of the repo.
pub(crate) fn paths() -> Vec<PathBuf> {
    let paths = scenes_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"));
    assert!(paths.len() >= 10, "the repo has scenes");
    paths
}

/// The scenes of a folder, in order; none if it is not there.
pub(crate) fn scenes_in(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "yaml")
    });
    paths.sort();
    paths
}

/// A scene of a file, made small.
pub(crate) fn small(path: &Path) -> Scene {
    let mut map = SourceMap::default();
    let file = Loader.file(path, &mut map).unwrap();
    reduced(file, &mut map, &Options::default())
}

/// A scene of a source, made small: 48 × 40 pixels, at most 4 sub-samples or paths, 4 points of the
/// lens and 8 bounces.
pub(crate) fn reduced(file: FileId, map: &mut SourceMap, options: &Options) -> Scene {
    let mut sink = DiagnosticSink::default();
    let scene = pipeline::load(file, map, options, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    let mut scene = scene.unwrap().scene;
    let sampling = scene.settings.supersampling.min(2);
    let depth = scene.settings.max_depth.min(8);
    // The view keeps its height.
    let camera = &mut scene.camera;
    let ratio = f64::from(camera.size[1]) / 40.0;
    camera.right = camera.right.map(|component| component * ratio);
    camera.up = camera.up.map(|component| component * ratio);
    camera.size = [48, 40];
    Overrides {
        supersampling: Some(sampling),
        depth: Some(depth),
        spp: Some(4),
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene.camera.lens.samples = scene.camera.lens.samples.min(4);
    scene
}

pub(crate) const WHOLE: RenderSelection = RenderSelection {
    crop: None,
    values: Values::Linear,
    tiles: None,
    seeds: SamplingSeeds::NONE,
    stride: PixelStride::EVERY,
    background: Background::Environment,
    samples: None,
    clamp: None,
    monitor: None,
};

pub(crate) fn validated(scene: &Scene) -> ValidScene {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = LoweredScene {
        scene: scene.clone(),
        source_spans: SourceSpans::default(),
    };
    pipeline::validate(&lowered, &options, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

pub(crate) fn film(scene: &Scene, job: &RenderSelection, threads: usize) -> Film {
    let valid = validated(scene);
    pipeline::render(
        &valid,
        &Plan::new(&valid, RuleSet::ALL),
        job,
        threads,
        &|_| true,
    )
    .unwrap()
    .unwrap()
}

/// The bits of every value.
pub(crate) fn bits(film: &Film) -> Vec<u64> {
    film.image
        .pixels
        .iter()
        .flatten()
        .map(|value| value.to_bits())
        .collect()
}
