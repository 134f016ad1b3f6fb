//! What must not be visible: light through closed meshes, glass with an index of 1, and which of
//! two coplanar surfaces was found first.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod closed;
mod coplanar;
mod glass;

use crate::small::validated;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Scene;
use rtc::internals::math::Vec3;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, RenderSelection, Values, render};
use rtc::internals::source::SourceMap;
use std::path::Path;

/// A scene of the course, by its text; assets are those of the repo.
fn scene(text: &str) -> Scene {
    let (mut map, mut sink, mut options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = map.add("unseen", text.as_bytes().to_vec());
    options.front.asset_root = Some(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"));
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    lowered.unwrap().scene
}

fn film(scene: &Scene, rules: RuleSet) -> Film {
    let proof = validated(scene);
    render(
        &proof,
        &Plan::new(&proof, rules),
        &RenderSelection {
            values: Values::Linear,
            ..RenderSelection::default()
        },
        &|_| true,
    )
    .unwrap()
}

/// Pseudorandom numbers from −1 to 1.
fn noise(index: u64) -> f64 {
    let x = (index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((x ^ (x >> 31)) >> 12) as f64 / (1_u64 << 51) as f64 - 1.0
}

fn random(index: u64) -> Vec3 {
    Vec3::new(noise(3 * index), noise(3 * index + 1), noise(3 * index + 2))
}

/// Gives the mesh of a scene the normals of a sphere, each moved by up to `tilt` along each axis.
fn smooth(scene: &mut Scene, tilt: f64) {
    let mesh = &mut scene.meshes[0];
    let corners: Vec<_> = mesh.positions.iter().map(Vec3::from_array).collect();
    let center = corners.iter().copied().sum::<Vec3>() / corners.len() as f64;
    let tilted = |(index, corner): (u64, &Vec3)| {
        ((*corner - center).normalize() + random(index) * tilt).to_array()
    };
    mesh.normals = (0..).zip(&corners).map(tilted).collect();
}
