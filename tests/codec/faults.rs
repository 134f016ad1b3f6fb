//! All faults of an IR text are found at once, each with its pointer and its words.

use super::small;
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::{Diagnostic, DiagnosticSink};
use rtc::internals::source::SourceMap;

/// The code, the pointer and the words of every finding about a text.
fn all_faults(text: &str) -> Vec<(&'static str, String, String)> {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("faults.json", text.as_bytes().to_vec());
    assert!(codec::decode(Encoding::Json, file, &map, &mut sink).is_none());
    let words = |finding: &Diagnostic| {
        let what = finding.message.split_once(": ").unwrap().1;
        (
            finding.code.id,
            finding.pointer.clone().unwrap_or_default(),
            what.to_owned(),
        )
    };
    sink.kept().iter().map(words).collect()
}

#[test]
fn every_fault_of_a_text_is_a_finding() {
    let text = r#"{"irVersion": 5, "camera": {"eye": 1, "size": [8, -8]}, "settings": {"mode": 5},
        "lights": [{"point": {}}, {"sun": 1}], "materials": 4, "surfaces": [7, 8]}"#;
    let found = all_faults(text);
    let pointers: Vec<_> = found
        .iter()
        .map(|(_, pointer, _)| pointer.as_str())
        .collect();
    let expected = [
        ("/camera", 4),
        ("/camera/eye", 1),
        ("/camera/size/1", 1),
        ("/settings", 3),
        ("/settings/mode", 1),
        ("/lights/0/point", 2),
        ("/lights/1/sun", 1),
        ("/materials", 1),
        ("/surfaces/0", 1),
        ("/surfaces/1", 1),
    ];
    let expected: Vec<_> = expected
        .into_iter()
        .flat_map(|(pointer, count)| std::iter::repeat_n(pointer, count))
        .collect();
    assert_eq!(pointers, expected, "{found:#?}");
    assert!(found.iter().all(|(code, ..)| *code == "IR003"));
}

#[test]
fn two_faults_of_one_entity_are_two_findings() {
    let file = String::from_utf8(codec::encode(Encoding::Json, &small()).unwrap()).unwrap();
    let change = |pairs: &[(&str, &str)]| {
        pairs.iter().fold(file.clone(), |text, (old, new)| {
            assert!(text.contains(old), "{old} is not in {text}");
            text.replacen(old, new, 1)
        })
    };
    let found = |pairs: &[(&str, &str)]| -> Vec<(String, String)> {
        let found = all_faults(&change(pairs)).into_iter();
        found.map(|(_, pointer, what)| (pointer, what)).collect()
    };
    let said = |pointer: &str, what: &str| (pointer.to_owned(), what.to_owned());
    assert_eq!(
        found(&[
            ("\"shadows\": true", "\"shadows\": 1"),
            ("\"maxDepth\": 2", "\"maxDepth\": 2.5")
        ]),
        [
            said(
                "/settings/shadows",
                "invalid type: integer `1`, expected a boolean"
            ),
            said(
                "/settings/maxDepth",
                "invalid type: floating point `2.5`, expected u32"
            ),
        ]
    );
    assert_eq!(
        found(&[
            ("\"radius\": 59.9", "\"size\": 59.9"),
            ("\"center\": [", "\"center\": [1, ")
        ]),
        [
            said(
                "/camera/center",
                "invalid length 4, expected an array of length 3"
            ),
            said(
                "/surfaces/0/shape/sphere/size",
                "unknown field `size`, expected one of `center`, `radius`, `textureFromWorld`"
            ),
        ],
        "what is missing may be what is not known"
    );
    assert_eq!(
        found(&[
            ("\"shadows\": true,", ""),
            ("\"mode\": \"phong\"", "\"mode\": \"gooch\"")
        ]),
        [
            said("/settings", "missing field `shadows`"),
            said(
                "/settings/mode",
                "invalid type: unit variant, expected newtype variant"
            ),
        ]
    );
}

#[test]
fn faults_of_the_version_and_of_json_are_two_findings() {
    let found = all_faults(r#"{"irVersion": "3", "camera": [}"#);
    let found: Vec<_> = found
        .iter()
        .map(|(code, pointer, what)| (*code, pointer.as_str(), what.as_str()))
        .collect();
    let version = "invalid type: string \"3\", expected u32";
    let expected = [
        ("IR003", "/irVersion", version),
        ("IR002", "", "expected value"),
    ];
    assert_eq!(found, expected);
}

#[test]
fn numbers_out_of_range_are_told_each() {
    let file = String::from_utf8(codec::encode(Encoding::Json, &small()).unwrap()).unwrap();
    let text =
        file.replacen("59.9", "1e400", 1)
            .replacen("\"maxDepth\": 2", "\"maxDepth\": 1e999", 1);
    let found = all_faults(&text);
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        found
            .iter()
            .all(|(code, _, what)| *code == "IR002" && what == "number out of range")
    );
}
