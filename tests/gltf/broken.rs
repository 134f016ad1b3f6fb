//! Broken and hostile assets: each ends in the finding it must, or passes if it is legal.

use super::{errors, findings, shared};
use rtc::diag::{Severity, Sink};
use rtc::pipeline::{self, Options};
use rtc::source::SourceMap;
use std::fmt::Write as _;

/// What is found in each broken file that must be refused.
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

#[test]
fn broken_files_end_as_they_must() {
    let Some(folder) = shared("broken") else {
        return;
    };
    let expected: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("expected.json")).unwrap()).unwrap();
    let mut faults = String::new();
    for case in expected.as_array().unwrap() {
        let name = case["file"].as_str().unwrap();
        let sink = findings(&folder.join(name));
        if (case["expect"] == "error") != sink.has_errors() {
            writeln!(
                faults,
                "{name}: expected {}, found {:?}",
                case["expect"],
                errors(&sink)
            )
            .unwrap();
        }
        let wanted = FOUND
            .iter()
            .find(|(own, _)| *own == name)
            .map_or(&[][..], |(_, wanted)| wanted);
        let found = errors(&sink);
        if !wanted.iter().all(|alias| found.contains(*alias)) {
            writeln!(faults, "{name}: wanted {wanted:?}, found {found:?}").unwrap();
        }
        let placed = |finding: &rtc::diag::Diagnostic| finding.primary.is_some();
        let errors = sink
            .kept()
            .iter()
            .filter(|finding| finding.severity == Severity::Error);
        assert!(
            errors.clone().all(placed),
            "{name}: every error has its bytes"
        );
    }
    assert!(faults.is_empty(), "{faults}");
}

fn check(text: String) -> Sink {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("hostile.gltf", text.into_bytes());
    pipeline::load(file, &mut map, &Options::default(), &mut sink);
    sink
}

#[test]
fn a_chain_of_200_000_nodes_is_legal() {
    let count = 200_000;
    let mut nodes: String = (1..count)
        .map(|child| format!("{{\"children\":[{child}]}},"))
        .collect();
    nodes.push_str("{}");
    let scene = r#""scene":0,"scenes":[{"nodes":[0]}]"#;
    let sink = check(format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},{scene},\"nodes\":[{nodes}]}}"
    ));
    assert!(!sink.has_errors(), "{:?}", errors(&sink));
}

#[test]
fn deep_nesting_is_one_error_where_it_passes_the_limit() {
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"extras\":{}{}}}",
        "[".repeat(100_000),
        "]".repeat(100_000)
    );
    let sink = check(text);
    assert_eq!(
        (errors(&sink).len(), sink.kept().len()),
        (1, 1),
        "{:?}",
        errors(&sink)
    );
}

#[test]
fn accessors_that_cover_the_same_bytes_again_and_again_are_refused() {
    let bytes = 1 << 20;
    let data = "A".repeat(bytes / 3 * 4);
    let accessor = format!(
        r#"{{"bufferView":0,"componentType":5121,"type":"SCALAR","count":{}}}"#,
        bytes / 3 * 3
    );
    let accessors = vec![accessor; 200].join(",");
    let sink = check(format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"accessors\":[{accessors}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":{0}}}],\
         \"buffers\":[{{\"byteLength\":{0},\"uri\":\"data:application/octet-stream;base64,{data}\"}}]}}",
        bytes / 3 * 3
    ));
    assert!(errors(&sink).contains("GL027"), "{:?}", errors(&sink));
}
