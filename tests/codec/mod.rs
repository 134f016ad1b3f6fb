//! The laws of the two forms: what was encoded decodes to the same bits, old files stay readable,
//! and no change of a file goes unnoticed.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
mod container;
mod faults;
mod scenes;
mod sections;
mod versions;

use proptest::prelude::*;
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::{Diagnostic, DiagnosticSink};
use rtc::internals::ir::{
    Display, ImageId, Pixels, Scene, Shape, StoredTree, Texture, VertexColumn,
};
use rtc::internals::source::SourceMap;
use scenes::scene;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_128;

fn frozen(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/codec")
        .join(name)
}

/// The scene or the first finding, and the text the finding points at.
fn decode(encoding: Encoding, bytes: &[u8]) -> Result<Scene, Box<(Diagnostic, String)>> {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("test", bytes.to_vec());
    let scene = codec::decode(encoding, file, &map, &mut sink);
    assert_eq!(
        scene.is_none(),
        sink.has_errors(),
        "no scene without an error, no error with one"
    );
    scene.ok_or_else(|| {
        let finding = sink.kept()[0].clone();
        let place = map
            .slice(
                finding
                    .primary
                    .as_ref()
                    .expect("every fault has a place")
                    .span,
            )
            .into_owned();
        Box::new((finding, place))
    })
}

/// The code, the text pointed at, and the pointer of the finding.
fn fault(encoding: Encoding, bytes: &[u8]) -> (&'static str, String, String) {
    let (finding, place) = *decode(encoding, bytes).unwrap_err();
    (finding.code.id, place, finding.pointer.unwrap_or_default())
}

/// Rewrites the header of a container and its checksum.
fn with_header(file: &[u8], edit: impl Fn(String) -> String) -> Vec<u8> {
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let header = edit(String::from_utf8(file[20..20 + length].to_vec()).unwrap());
    let mut out = file[..12].to_vec();
    out.extend(u32::try_from(header.len()).unwrap().to_le_bytes());
    let crc = crc32fast::hash(&[&out, header.as_bytes()].concat());
    out.extend(crc.to_le_bytes());
    out.extend(header.as_bytes());
    out.resize(out.len().next_multiple_of(64), 0);
    out.extend(&file[(20 + length).next_multiple_of(64)..]);
    out
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn both_forms_give_the_scene_back_to_the_bit(scene in scene()) {
        for encoding in [Encoding::Json, Encoding::Binary] {
            let bytes = codec::encode(encoding, &scene).unwrap();
            prop_assert_eq!(codec::detect_format(&bytes), Some(encoding));
            let back = decode(encoding, &bytes).unwrap();
            // Debug tells −0.0 from 0.0, which `==` does not.
            prop_assert_eq!(format!("{:?}", &scene), format!("{:?}", &back));
            prop_assert_eq!(codec::encode(encoding, &back).unwrap(), bytes);
        }
        let plain = Scene { display: Display::default(), ..scene.clone() };
        let container = codec::encode(Encoding::Binary, &plain).unwrap();
        prop_assert_eq!(codec::hash(&scene), Ok(xxh3_128(&container)));
    }

    #[test]
    fn arbitrary_bytes_are_a_scene_or_one_located_error(bytes: Vec<u8>, encoding in prop::bool::ANY) {
        let encoding = if encoding { Encoding::Json } else { Encoding::Binary };
        prop_assert!(decode(encoding, &bytes).is_err());
    }

    #[test]
    fn text_with_bytes_replaced_never_panics(at in 0usize..900, with: u8) {
        let mut bytes = std::fs::read(frozen("v1/scene.json")).unwrap();
        let at = at % bytes.len();
        bytes[at] = with;
        let _ = decode(Encoding::Json, &bytes);
    }
}

fn small() -> Scene {
    decode(
        Encoding::Json,
        &std::fs::read(frozen("v1/scene.json")).unwrap(),
    )
    .unwrap()
}

/// A scene with an image and a mesh, both long.
fn large() -> Scene {
    decode(
        Encoding::Json,
        &std::fs::read(frozen("v2/scene.json")).unwrap(),
    )
    .unwrap()
}

#[test]
fn a_number_that_is_not_finite_is_not_stored() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut scene = small();
        scene.camera.eye[1] = bad;
        assert!(
            codec::encode(Encoding::Json, &scene).is_err()
                && codec::encode(Encoding::Binary, &scene).is_err()
        );
    }
}

#[test]
fn every_truncation_of_a_text_is_found() {
    let file = codec::encode(Encoding::Json, &small()).unwrap();
    for length in 0..file.len() - 2 {
        assert_eq!(
            fault(Encoding::Json, &file[..length]).0,
            "IR002",
            "length {length}"
        );
    }
}

/// Faults: what is replaced in a text by what; the code, the text that is pointed at, the pointer.
const FAULTS: &[[&str; 5]] = &[
    [
        "59.9",
        "\"59.9\"",
        "IR003",
        "\"59.9\"",
        "/surfaces/0/shape/sphere/radius",
    ],
    [
        "59.9",
        "[59.9]",
        "IR003",
        "[",
        "/surfaces/0/shape/sphere/radius",
    ],
    ["59.9", "1e400", "IR002", "0", ""],
    ["59.9", "NaN", "IR002", "N", ""],
    [
        "\"radius\": 59.9",
        "\"size\": 59.9",
        "IR003",
        "\"size\"",
        "/surfaces/0/shape/sphere/size",
    ],
    [
        "\"shadows\": true",
        "\"shadows\": true, \"shadows\": true",
        "IR003",
        "\"shadows\"",
        "/settings/shadows",
    ],
    [
        "\"irVersion\": 5",
        "\"irVersion\": 5, \"irVersion\": 5",
        "IR003",
        "\"irVersion\"",
        "/irVersion",
    ],
    [
        "\"maxDepth\": 2",
        "\"maxDepth\": -2",
        "IR003",
        "-2",
        "/settings/maxDepth",
    ],
    [
        "\"supersampling\": 4",
        "\"supersampling\": null",
        "IR003",
        "null",
        "/settings/supersampling",
    ],
    [
        "\"mode\": \"phong\"",
        "\"mode\": \"ü\"",
        "IR003",
        "\"ü\"",
        "/settings/mode",
    ],
    [
        "\"irVersion\": 5",
        "\"irVersion\": \"2\"",
        "IR003",
        "\"2\"",
        "/irVersion",
    ],
];

#[test]
fn faults_of_a_text_are_located() {
    let file = String::from_utf8(codec::encode(Encoding::Json, &small()).unwrap()).unwrap();
    for [old, new, code, place, pointer] in FAULTS {
        assert!(file.contains(old), "{old} is not in {file}");
        let bad = format!("\u{feff}{}", file.replacen(old, new, 1));
        let expected = (*code, (*place).to_owned(), (*pointer).to_owned());
        assert_eq!(fault(Encoding::Json, bad.as_bytes()), expected, "{new}");
    }
}

#[test]
fn pixels_that_are_no_base64_are_located() {
    let file = String::from_utf8(codec::encode(Encoding::Json, &large()).unwrap()).unwrap();
    let bad = file.replacen("\"pixels\": \"", "\"pixels\": \"?", 1);
    let (finding, _) = *decode(Encoding::Json, bad.as_bytes()).unwrap_err();
    assert_eq!(
        (finding.code.id, finding.pointer.unwrap().as_str()),
        ("IR003", "/images/0/pixels")
    );
    assert!(
        finding.message.contains("this is not Base64"),
        "{}",
        finding.message
    );
}

#[test]
fn hostile_texts_are_errors() {
    let deep = format!("{{\"irVersion\": 5, \"camera\": {}", "[".repeat(100_000));
    let deep_old = format!(
        "{{\"irVersion\": 0, \"camera\": {}{}}}",
        "[".repeat(100_000),
        "]".repeat(100_000)
    );
    for text in [
        deep.as_str(),
        &deep_old,
        "",
        "{",
        "\u{feff}",
        "null",
        "[]",
        "{\"irVersion\": 1e400}",
    ] {
        assert!(decode(Encoding::Json, text.as_bytes()).is_err());
    }
    assert_eq!(
        fault(Encoding::Json, b"{\"irVersion\": 1, \"a\": \"\xff\"}").0,
        "SY001"
    );
}

#[test]
fn a_course_scene_is_not_taken_for_the_ir() {
    for text in [
        "Eye: [1, 2, 3]",
        "{\"Eye\": [1, 2, 3]}",
        "{\"Eye\": 1, \"irVersion\": 1}",
        "# RTI\n",
        "",
        "\u{feff}{",
    ] {
        assert_eq!(codec::detect_format(text.as_bytes()), None, "{text}");
    }
    for text in ["{\"irVersion\":1}", "\u{feff} \n{ \"irVersion\" : 1 }"] {
        assert_eq!(
            codec::detect_format(text.as_bytes()),
            Some(Encoding::Json),
            "{text}"
        );
    }
}
