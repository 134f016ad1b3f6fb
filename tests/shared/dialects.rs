//! Scenes of other programs of the course, and mistakes of its students: what is read, and what is
//! said.

use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::path::Path;

const FOLDER: &str = "round-4/course";

/// What is said of a file: whether it is an error or a warning, and words of its messages.
const FILES: &[(&str, Severity, &[&str])] = &[
    (
        "A1-camera-up-is-a-field-of-view.yaml",
        Severity::Warning,
        &["22.6 degrees across", "`fov: 22.6`"],
    ),
    ("A2-resolution-number-beside-Eye.json", Severity::Note, &[]),
    (
        "B1-fix-makes-20-percent-a-20.yaml",
        Severity::Error,
        &["20% is 0.2", "guess 0.2"],
    ),
    (
        "B2-light-intensity-alone-switches-to-path-tracing-silently.yaml",
        Severity::Warning,
        &["makes the scene path traced", "has a `color`"],
    ),
    (
        "B3-color-and-intensity-8-alternatives.yaml",
        Severity::Warning,
        &["multiplies its `color`"],
    ),
    (
        "C1-value-on-next-line-help-splits-the-number.yaml",
        Severity::Error,
        &["the value of `radius` is not indented"],
    ),
    (
        "C3-json-list-help-speaks-of-dashes.json",
        Severity::Error,
        &["`Lights` must be a list", "in square brackets"],
    ),
    (
        "C4-missing-type-line-help-removes-the-second-ball.yaml",
        Severity::Error,
        &["`position` occurs twice", "as `- type: sphere`"],
    ),
    (
        "C5-missing-material-line-help-is-indent.yaml",
        Severity::Error,
        &["`color` is indented as below a key", "as `material:`"],
    ),
    (
        "C7-json-missing-quote-raw-libyaml.json",
        Severity::Error,
        &["a quote is never closed"],
    ),
    (
        "D1-black-light-no-word.yaml",
        Severity::Warning,
        &["a black light"],
    ),
    (
        "D2-eta-below-1-no-word.yaml",
        Severity::Warning,
        &["index of refraction of 0.66"],
    ),
    ("D4-n-0-no-word.yaml", Severity::Warning, &["exponent 0"]),
    ("E1-mode-texcoords.yaml", Severity::Note, &[]),
    ("E2-csg-operation-first-second.yaml", Severity::Note, &[]),
    (
        "E3-supersampling-map-without-factor.yaml",
        Severity::Warning,
        &["`SuperSampling` has no `factor`"],
    ),
    (
        "E4-own-key-Ambient-makes-old-file-unreadable.yaml",
        Severity::Warning,
        &["`Ambient` must be", "such a value is ignored"],
    ),
    ("E6-json-cannot-name-a-pattern.json", Severity::Note, &[]),
    (
        "J1-json-textured-scene-reference-is-per-light.json",
        Severity::Warning,
        &["added once", "perLight"],
    ),
    (
        "T1-same-name-in-two-folders/a/scene.yaml",
        Severity::Note,
        &[],
    ),
];

pub(crate) fn trials() -> Vec<Trial> {
    let trial = |(file, worst, words): &'static (&str, Severity, &[&str])| {
        let path = format!("{FOLDER}/{file}");
        needs(format!("dialects/{file}"), &path, |path| {
            check(path, *worst, words);
        })
    };
    FILES.iter().map(trial).collect()
}

/// Checks the worst severity of the findings of a file, and that one of them has these words.
fn check(path: &Path, worst: Severity, words: &[&str]) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let (file, options) = (Loader.file(path, &mut map).unwrap(), Options::default());
    if let Some(lowered) = pipeline::load(file, &mut map, &options, &mut sink) {
        pipeline::validate(&lowered, &options, &mut sink);
    }
    let texts = sink.kept().iter().map(|found| {
        let hints = found.hints.iter().map(|hint| {
            let guessed = hint.replacement.as_ref();
            let guessed = guessed.filter(|replacement| replacement.is_guess);
            let guessed = guessed.map_or(String::new(), |it| format!("guess {}", it.text));
            format!("{} {guessed}", hint.text)
        });
        format!(
            "{}: {}",
            found.message,
            hints.collect::<Vec<_>>().join("; ")
        )
    });
    let texts: Vec<_> = texts.collect();
    let most = sink.kept().iter().map(|found| found.severity).min();
    assert_eq!(most.unwrap_or(Severity::Note), worst, "{texts:#?}");
    let says = |text: &String| words.iter().all(|word| text.contains(word));
    assert!(
        words.is_empty() || texts.iter().any(says),
        "{words:?} in {texts:#?}"
    );
}
