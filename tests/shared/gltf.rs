//! The sound assets of `../shared`: each is lowered and proven; and one torus in three forms.

use super::scenes::{accepted, each};
use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::Mesh;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = each(
        "gltf",
        "gltf/assets",
        &["glb", "gltf"],
        is_lowered_and_proven,
    );
    trials.push(needs(
        "gltf: compressed tori are the same torus",
        "gltf/assets",
        compressed_tori_are_the_same_torus,
    ));
    trials
}

fn is_lowered_and_proven(path: &Path) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let proof = pipeline::validate(&lowered, &options, &mut sink);
    assert!(proof.is_some() && !sink.has_errors(), "{:?}", sink.kept());
}

/// The torus as Draco, meshopt and quantized data; the last two hold the same numbers.
fn compressed_tori_are_the_same_torus(folder: &Path) {
    let mesh = |name: &str| {
        let scene = accepted(&folder.join(name)).unwrap();
        scene.meshes.into_iter().next().unwrap()
    };
    let (draco, meshopt) = (mesh("own_TorusDraco.glb"), mesh("own_TorusMeshopt.glb"));
    let quantized = mesh("own_TorusQuantized.glb");
    assert!(
        corners(&meshopt) == corners(&quantized),
        "meshopt keeps every bit, in another order"
    );
    assert_eq!(
        (draco.positions.len(), draco.triangles.len()),
        (quantized.positions.len(), quantized.triangles.len())
    );
}

/// The triangles by the numbers of their corners, in an order that does not depend on that of the
/// file.
fn corners(mesh: &Mesh) -> Vec<[Vec<u64>; 3]> {
    let corner = |at: u32| {
        let at = at as usize;
        let numbers = [
            &mesh.positions.at(at)[..],
            &mesh.normals.at(at),
            &mesh.uvs.at(at),
        ]
        .concat();
        numbers.into_iter().map(f64::to_bits).collect()
    };
    let mut triangles: Vec<[Vec<u64>; 3]> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect();
    triangles.iter_mut().for_each(|triangle| triangle.sort());
    triangles.sort();
    triangles
}
