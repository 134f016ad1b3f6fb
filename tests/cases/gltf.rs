//! Files of glTF that others made: each broken one ends in the finding it must, each sound one is
//! lowered to what it holds.

use crate::suite::{files, name, root, trial};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::ir::{Mesh, Scene};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::Path;
use xxhash_rust::xxh3::xxh3_64;

/// What is found in each file that must be refused; in the others there is no error.
const FOUND: &[(&str, &[&str])] = &[
    ("truncated_header.glb", &["GLB_UNEXPECTED_END_OF_HEADER"]),
    ("truncated_bin.glb", &["GLB_UNEXPECTED_END_OF_CHUNK_DATA"]),
    ("bad_magic.glb", &["GLB_INVALID_MAGIC"]),
    ("index_out_of_range.glb", &["ACCESSOR_INDEX_OOB"]),
    ("nan_position.glb", &["ACCESSOR_INVALID_FLOAT"]),
    ("node_cycle.gltf", &["NODE_PARENT_OVERRIDE", "NODE_LOOP"]),
    ("missing_buffer.gltf", &["IO_ERROR"]),
    (
        "accessor_out_of_bounds.gltf",
        &["ACCESSOR_TOO_LONG", "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT"],
    ),
    ("path_traversal_uri.gltf", &["IO_ERROR"]),
    ("huge_accessor_no_view.gltf", &["GL027"]),
    (
        "required_unknown_extension.gltf",
        &["UNSUPPORTED_EXTENSION"],
    ),
    ("json_truncated.gltf", &["INVALID_JSON"]),
    ("corrupt_png.glb", &["IMAGE_DATA_INVALID"]),
    ("texture_index_unresolved.gltf", &["UNRESOLVED_REFERENCE"]),
    (
        "khronos_two_bin_chunks.glb",
        &["GLB_UNEXPECTED_FIRST_CHUNK", "GLB_DUPLICATE_CHUNK"],
    ),
    (
        "khronos_invalid_elements_float.gltf",
        &["ACCESSOR_INVALID_FLOAT"],
    ),
    (
        "khronos_node_parent_override.gltf",
        &["NODE_PARENT_OVERRIDE"],
    ),
];

pub(crate) fn trials() -> Vec<Trial> {
    let folder = root("tests/gltf/broken");
    let found = files(&folder, &["glb", "gltf"]);
    let known = FOUND.iter().map(|(file, _)| *file);
    for file in known {
        assert!(found.contains(&folder.join(file)), "{file} is gone");
    }
    let broken = found.into_iter().map(|path| {
        let name = format!("gltf/broken/{}", name(&path, &folder));
        trial(name, move || ends_as_it_must(&path))
    });
    let mut trials: Vec<_> = broken.collect();
    for (file, check) in [
        ("torus-draco", is_the_torus as fn(&Scene)),
        ("torus-meshopt", is_the_torus_to_the_bit),
        ("pirate", is_the_pirate),
    ] {
        let path = root("tests/gltf/assets").join(file).with_extension("glb");
        trials.push(trial(format!("gltf/assets/{file}"), move || {
            let (scene, sink) = lower(&path);
            assert!(!sink.has_errors(), "{:?}", sink.kept());
            check(&scene.unwrap());
        }));
    }
    trials
}

fn lower(path: &Path) -> (Option<Scene>, DiagnosticSink) {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    if let Some(lowered) = &lowered {
        pipeline::validate(lowered, &options, &mut sink);
    }
    (lowered.map(|lowered| lowered.scene), sink)
}

fn ends_as_it_must(path: &Path) {
    let (_, sink) = lower(path);
    let file = path.file_name().unwrap().to_str().unwrap();
    let wanted = FOUND.iter().find(|(own, _)| *own == file);
    let errors = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Error);
    let found: BTreeSet<_> = errors
        .clone()
        .map(|finding| finding.alias.unwrap_or(finding.code.id))
        .collect();
    match wanted {
        Some((_, wanted)) => assert!(
            wanted.iter().all(|alias| found.contains(alias)),
            "wanted {wanted:?}, found {found:?}"
        ),
        None => assert!(found.is_empty(), "legal, and found {found:?}"),
    }
    for error in errors {
        assert!(error.primary.is_some(), "an error without its bytes");
    }
}

/// The torus was made of so many corners and faces, however they are stored.
fn is_the_torus(scene: &Scene) {
    let [mesh] = &scene.meshes[..] else {
        panic!("{} meshes", scene.meshes.len())
    };
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4753, 9216));
}

/// Every bit is that of the quantized torus before it was compressed.
fn is_the_torus_to_the_bit(scene: &Scene) {
    is_the_torus(scene);
    assert_eq!(hash(&scene.meshes[0]), 0x0cd1_d8f0_9541_f61b);
}

fn is_the_pirate(scene: &Scene) {
    let triangles: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    assert_eq!(triangles, 5010);
    let ball = scene.bounding_sphere().unwrap();
    assert!(ball.radius.is_finite() && ball.radius > 0.0, "{ball:?}");
}

/// The hash of the triangles by the numbers of their corners, in an order that does not depend on
/// that of the file.
fn hash(mesh: &Mesh) -> u64 {
    let corner = |at: u32| {
        let at = at as usize;
        let numbers = [
            &mesh.positions.at(at)[..],
            &mesh.normals.at(at),
            &mesh.uvs.at(at),
        ]
        .concat();
        numbers.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
    };
    let mut triangles: Vec<[Vec<u64>; 3]> = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(corner))
        .collect();
    triangles.iter_mut().for_each(|triangle| triangle.sort());
    triangles.sort();
    let bits = triangles.iter().flatten().flatten();
    xxh3_64(
        &bits
            .flat_map(|bits| bits.to_le_bytes())
            .collect::<Vec<u8>>(),
    )
}
