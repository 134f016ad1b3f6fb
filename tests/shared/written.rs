//! The sound assets of `../shared` as scene texts: each comes back from its text and the files
//! beside it, with its own camera and light or in the studio.

use super::scenes::each;
use crate::texts::assert_comes_back;
use libtest_mimic::Trial;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{EntityField, EntityKind, ValuePath};
use rtc::internals::passes::{SceneKind, ViewAndLight};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    each("texts", "gltf/assets", &["glb", "gltf"], comes_back)
}

fn comes_back(path: &Path) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let mut lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink).unwrap();
    let camera = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
    let kind = match lowered.source_spans.span(camera) {
        Some(_) => SceneKind::Asset,
        None => SceneKind::BareAsset,
    };
    pipeline::stage(&mut lowered, &ViewAndLight::default(), kind, &mut sink).unwrap();
    assert_comes_back(&lowered.scene);
}
