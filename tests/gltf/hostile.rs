//! Hostile assets too large to keep: each ends in the finding it must, or passes if it is legal.

use super::errors;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::SourceMap;

fn check(text: String) -> DiagnosticSink {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
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
