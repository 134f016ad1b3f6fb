//! The laws of the two forms: what was encoded decodes to the same bits, old files stay readable,
//! and no change of a file goes unnoticed.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
mod faults;
mod scenes;
mod sections;

use proptest::prelude::*;
use rtc::codec::{self, Form};
use rtc::diag::{Diagnostic, Sink};
use rtc::ir::{Column, ImageId, Pixels, Scene, Shape, Texture};
use rtc::source::SourceMap;
use scenes::scene;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_128;

fn frozen(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/codec")
        .join(name)
}

/// The scene or the first finding, and the text the finding points at.
fn decode(form: Form, bytes: &[u8]) -> Result<Scene, Box<(Diagnostic, String)>> {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("test", bytes.to_vec());
    let scene = codec::decode(form, file, &map, &mut sink);
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
fn fault(form: Form, bytes: &[u8]) -> (&'static str, String, String) {
    let (finding, place) = *decode(form, bytes).unwrap_err();
    (finding.code.id, place, finding.pointer.unwrap_or_default())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn both_forms_give_the_scene_back_to_the_bit(scene in scene()) {
        for form in [Form::Text, Form::Binary] {
            let bytes = codec::encode(form, &scene).unwrap();
            prop_assert_eq!(codec::recognise(&bytes), Some(form));
            let back = decode(form, &bytes).unwrap();
            // Debug tells −0.0 from 0.0, which `==` does not.
            prop_assert_eq!(format!("{:?}", &scene), format!("{:?}", &back));
            prop_assert_eq!(codec::encode(form, &back).unwrap(), bytes);
        }
        let text = codec::encode(Form::Text, &scene).unwrap();
        prop_assert_eq!(codec::hash(&scene), Ok(xxh3_128(&text)));
    }

    #[test]
    fn arbitrary_bytes_are_a_scene_or_one_located_error(bytes: Vec<u8>, form in prop::bool::ANY) {
        let form = if form { Form::Text } else { Form::Binary };
        prop_assert!(decode(form, &bytes).is_err());
    }

    #[test]
    fn text_with_bytes_replaced_never_panics(at in 0usize..900, with: u8) {
        let mut bytes = std::fs::read(frozen("v1/scene.json")).unwrap();
        let at = at % bytes.len();
        bytes[at] = with;
        let _ = decode(Form::Text, &bytes);
    }
}

fn small() -> Scene {
    decode(Form::Text, &std::fs::read(frozen("v1/scene.json")).unwrap()).unwrap()
}

/// A scene with an image and a mesh, both long.
fn large() -> Scene {
    decode(Form::Text, &std::fs::read(frozen("v2/scene.json")).unwrap()).unwrap()
}

#[test]
fn a_number_that_is_not_finite_is_not_stored() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut scene = small();
        scene.camera.eye[1] = bad;
        assert!(
            codec::encode(Form::Text, &scene).is_err()
                && codec::encode(Form::Binary, &scene).is_err()
        );
    }
}

/// The files of each version as they were written when it was new. They are never rewritten.
#[test]
fn frozen_files_decode() {
    let text = small();
    assert_eq!(
        decode(
            Form::Binary,
            &std::fs::read(frozen("v1/scene.rtir")).unwrap()
        )
        .unwrap(),
        text
    );
    assert_eq!(
        decode(Form::Text, &std::fs::read(frozen("v0/scene.json")).unwrap()).unwrap(),
        text
    );
    let Shape::Sphere(sphere) = &text.surfaces[0].shape else {
        panic!("the first surface is a sphere")
    };
    assert_eq!(
        (
            sphere.radius,
            text.settings.supersampling,
            text.surfaces.len()
        ),
        (59.9, 4, 3)
    );
    let text = large();
    assert_eq!(
        decode(
            Form::Binary,
            &std::fs::read(frozen("v2/scene.rtir")).unwrap()
        )
        .unwrap(),
        text
    );
    assert_eq!(
        (
            text.meshes[0].positions.at(35),
            text.meshes[0].triangles.len()
        ),
        ([0.5, 0.5, 0.125], 50)
    );
    assert_eq!(
        (text.images[0].pixels.len(), &text.textures[1]),
        (384, &Texture::Uv)
    );
}

/// The scenes of version 3: all shapes of the course, and one whose paths are traced, with columns
/// of 32-bit floats.
#[test]
fn frozen_files_of_version_3_decode() {
    let [course, path] = ["course", "path"].map(|name| {
        let text = decode(
            Form::Text,
            &std::fs::read(frozen(&format!("v3/{name}.json"))).unwrap(),
        )
        .unwrap();
        let binary = decode(
            Form::Binary,
            &std::fs::read(frozen(&format!("v3/{name}.rtir"))).unwrap(),
        )
        .unwrap();
        assert_eq!(format!("{binary:?}"), format!("{text:?}"), "{name}");
        text
    });
    assert_eq!(
        (
            course.surfaces.len(),
            course.materials.len(),
            course.names[9].as_str()
        ),
        (10, 5, "leaf")
    );
    assert_eq!(
        (
            course.meshes[0].positions.at(35),
            course.images[0].pixels[383]
        ),
        ([1.0, 1.0, 0.225], 40)
    );
    assert!(matches!(course.meshes[0].positions, Column::Double(_)));
    let Column::Single(positions) = &path.meshes[0].positions else {
        panic!("glTF has 32-bit floats")
    };
    assert_eq!(
        (positions[1], path.meshes[0].colors.at(35)),
        ([0.2, 0.0, 0.045], [1.0, 1.0, f64::from(0.1_f32), 1.0])
    );
    assert_eq!(
        (
            path.lights.len(),
            path.images[1].kind,
            path.images[1].pixels.len()
        ),
        (3, Pixels::Rgb32f, 384)
    );
    assert_eq!(
        path.environment
            .as_ref()
            .and_then(|environment| environment.image),
        Some(ImageId(1))
    );
}

#[test]
fn older_files_are_the_same_scene_in_the_current_version() {
    let texts = ["v0/scene.json", "v1/scene.json", "v2/scene.json"].map(|name| (name, Form::Text));
    let binaries = ["v1/scene.rtir", "v2/scene.rtir"].map(|name| (name, Form::Binary));
    for (name, form) in texts.into_iter().chain(binaries) {
        let old = decode(form, &std::fs::read(frozen(name)).unwrap()).unwrap();
        for form in [Form::Text, Form::Binary] {
            let bytes = codec::encode(form, &old).unwrap();
            let version = [&b"\"irVersion\": 3"[..], b"\"irVersion\":3"];
            let start = &bytes[..64];
            assert!(
                version
                    .iter()
                    .any(|version| start.windows(version.len()).any(|part| part == *version)),
                "{name}"
            );
            assert_eq!(
                format!("{:?}", decode(form, &bytes).unwrap()),
                format!("{old:?}"),
                "{name}, {form:?}"
            );
        }
    }
}

#[test]
fn every_flipped_bit_of_a_container_is_found() {
    for scene in [small(), large()] {
        flip_every_bit(&codec::encode(Form::Binary, &scene).unwrap());
    }
}

fn flip_every_bit(file: &[u8]) {
    for bit in 0..8 * file.len() {
        let mut bytes = file.to_vec();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(codec::recognise(&bytes), Some(Form::Binary), "bit {bit}");
        let (id, _, _) = fault(Form::Binary, &bytes);
        let expected = match bit / 8 {
            0..8 => &["IR004"][..],
            12..16 => &["IR005", "IR006"],
            _ => &["IR006"],
        };
        assert!(expected.contains(&id), "bit {bit}: {id}");
    }
}

#[test]
fn every_truncation_of_a_container_is_found() {
    let file = codec::encode(Form::Binary, &large()).unwrap();
    for length in 1..file.len() {
        assert_eq!(
            codec::recognise(&file[..length]),
            Some(Form::Binary),
            "length {length}"
        );
        assert_eq!(
            fault(Form::Binary, &file[..length]).0,
            "IR005",
            "length {length}"
        );
    }
    let longer = [file.as_slice(), &[0]].concat();
    assert_eq!(fault(Form::Binary, &longer).0, "IR007");
}

#[test]
fn every_truncation_of_a_text_is_found() {
    let file = codec::encode(Form::Text, &small()).unwrap();
    for length in 0..file.len() - 2 {
        assert_eq!(
            fault(Form::Text, &file[..length]).0,
            "IR002",
            "length {length}"
        );
    }
}

#[test]
fn a_container_copied_as_text_is_recognised_and_says_so() {
    let file = codec::encode(Form::Binary, &small()).unwrap();
    let lines: Vec<u8> = file.iter().copied().filter(|byte| *byte != b'\r').collect();
    let seven_bits: Vec<u8> = file.iter().map(|byte| byte & 0x7f).collect();
    let latin1: String = file.iter().copied().map(char::from).collect();
    let lossy = String::from_utf8_lossy(&file).into_owned();
    let spoilt = [
        (lines, "line ends"),
        (seven_bits, "eighth bit"),
        (latin1.into(), "UTF-8"),
        (lossy.into(), "UTF-8"),
    ];
    for (bytes, word) in spoilt {
        assert_eq!(codec::recognise(&bytes), Some(Form::Binary), "{word}");
        let (finding, _) = *decode(Form::Binary, &bytes).unwrap_err();
        assert!(
            finding.code.id == "IR004" && finding.hints[0].text.contains(word),
            "{finding:?}"
        );
    }
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

#[test]
fn parts_that_do_not_fit_together_are_refused() {
    let file = codec::encode(Form::Binary, &small()).unwrap();
    assert!(decode(Form::Binary, &with_header(&file, |header| header)).is_ok());
    let cases = [
        (r#""order":0"#, r#""order":99"#, "IR007"),
        (r#""order":0"#, r#""order":1"#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"lights""#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"camera""#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"things""#, "IR003"),
        (r#""offset":64"#, r#""offset":0"#, "IR007"),
        (r#""stride":6"#, r#""stride":5"#, "IR007"),
        (r#""stride":6"#, r#""stride":18446744073709551615"#, "IR007"),
        (r#""length":4"#, r#""length":18446744073709551612"#, "IR005"),
        (r#""radius":null"#, r#""radius":[null,null]"#, "IR007"),
        (r#""radius":null"#, r#""radios":null"#, "IR003"),
        (r#""shadows":true"#, r#""shadows":"yes""#, "IR003"),
        (r#"{"irVersion":3"#, r#"{"irVersion":4"#, "IR001"),
        (r#"{"irVersion":3"#, r#"{"irVersion":-2"#, "IR007"),
    ];
    for (old, new, expected) in cases {
        let bad = with_header(&file, |header| {
            assert!(header.contains(old), "{old} is not in {header}");
            header.replacen(old, new, 1)
        });
        assert_eq!(fault(Form::Binary, &bad).0, expected, "{new}");
    }
}

/// A short file can't ask for much memory: here each of 2 000 records would repeat 30 KB of text.
#[test]
fn a_table_that_would_grow_beyond_its_file_is_refused() {
    let mut scene = small();
    scene.surfaces = vec![scene.surfaces[0].clone(); 2_000];
    let file = codec::encode(Form::Binary, &scene).unwrap();
    let (old, long) = ("\"radius\":null", "x".repeat(30_000));
    let bomb = with_header(&file, |header| {
        header.replacen(old, &format!("\"name\":\"{long}\",{old}"), 1)
    });
    let (finding, _) = decode(Form::Binary, &bomb)
        .map_err(|fault| *fault)
        .unwrap_err();
    assert!(
        finding.code.id == "IR007" && finding.message.contains("repeats more text"),
        "{finding:?}"
    );
}

#[test]
fn newer_files_say_so_where_the_version_stands() {
    let text = "{\"irVersion\": 7, \"spectra\": []}";
    let (finding, place) = *decode(Form::Text, text.as_bytes()).unwrap_err();
    assert_eq!((finding.code.id, place.as_str()), ("IR001", "7"));
    assert_eq!(
        finding.message,
        "IR version 7 is newer than 3, the newest this rtc reads"
    );
    let mut file = codec::encode(Form::Binary, &small()).unwrap();
    file[8] = 2;
    let file = with_header(&file, |header| header);
    let (finding, _) = *decode(Form::Binary, &file).unwrap_err();
    assert_eq!(
        finding.message,
        "container version 2 is newer than 1, the newest this rtc reads"
    );
    assert_eq!(finding.primary.unwrap().span.start, 8);
}

#[test]
fn faults_of_a_text_are_located() {
    let file = String::from_utf8(codec::encode(Form::Text, &small()).unwrap()).unwrap();
    let cases = [
        (
            "59.9",
            "\"59.9\"",
            "IR003",
            "\"59.9\"",
            "/surfaces/0/shape/sphere/radius",
        ),
        (
            "59.9",
            "[59.9]",
            "IR003",
            "[",
            "/surfaces/0/shape/sphere/radius",
        ),
        ("59.9", "1e400", "IR002", "0", ""),
        ("59.9", "NaN", "IR002", "N", ""),
        (
            "\"radius\": 59.9",
            "\"size\": 59.9",
            "IR003",
            "\"size\"",
            "/surfaces/0/shape/sphere/size",
        ),
        (
            "\"shadows\": true",
            "\"shadows\": true, \"shadows\": true",
            "IR003",
            "\"shadows\"",
            "/settings/shadows",
        ),
        (
            "\"irVersion\": 3",
            "\"irVersion\": 3, \"irVersion\": 3",
            "IR003",
            "\"irVersion\"",
            "/irVersion",
        ),
        (
            "\"maxDepth\": 2",
            "\"maxDepth\": -2",
            "IR003",
            "-2",
            "/settings/maxDepth",
        ),
        (
            "\"supersampling\": 4",
            "\"supersampling\": null",
            "IR003",
            "null",
            "/settings/supersampling",
        ),
        (
            "\"mode\": \"phong\"",
            "\"mode\": \"ü\"",
            "IR003",
            "\"ü\"",
            "/settings/mode",
        ),
        (
            "\"irVersion\": 3",
            "\"irVersion\": \"2\"",
            "IR003",
            "\"2\"",
            "/irVersion",
        ),
    ];
    for (old, new, code, place, pointer) in cases {
        assert!(file.contains(old), "{old} is not in {file}");
        let bad = format!("\u{feff}{}", file.replacen(old, new, 1));
        let expected = (code, place.to_owned(), pointer.to_owned());
        assert_eq!(fault(Form::Text, bad.as_bytes()), expected, "{new}");
    }
}

#[test]
fn pixels_that_are_no_base64_are_located() {
    let file = String::from_utf8(codec::encode(Form::Text, &large()).unwrap()).unwrap();
    let bad = file.replacen("\"pixels\": \"", "\"pixels\": \"?", 1);
    let (finding, _) = *decode(Form::Text, bad.as_bytes()).unwrap_err();
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
    let deep = format!("{{\"irVersion\": 3, \"camera\": {}", "[".repeat(100_000));
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
        assert!(decode(Form::Text, text.as_bytes()).is_err());
    }
    assert_eq!(
        fault(Form::Text, b"{\"irVersion\": 1, \"a\": \"\xff\"}").0,
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
        assert_eq!(codec::recognise(text.as_bytes()), None, "{text}");
    }
    for text in ["{\"irVersion\":1}", "\u{feff} \n{ \"irVersion\" : 1 }"] {
        assert_eq!(
            codec::recognise(text.as_bytes()),
            Some(Form::Text),
            "{text}"
        );
    }
}
