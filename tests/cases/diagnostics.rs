//! Every file under `tests/diagnostics/<CODE>/` is a test: its comments say what `rtc` must find in
//! it, and where.
//!
//! `# expect: CODE severity LINE:COLUMN message`, one line a finding, in the order of the places,
//! in a binary file `byte N`; `# options: strict lenient` sets options. A file that can't hold
//! comments has them beside it, in `<case>.expect`.

use crate::suite::{files, name, root, trial, updates};
use libtest_mimic::{Failed, Trial};
use rtc::internals::diag::{Diagnostic, DiagnosticSink, Severity, codes};
use rtc::internals::source::{FileId, Loader, SourceMap};
use rtc::internals::{front, pipeline};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Codes that no scene text can raise: files, the container, renders, and faults only a hand-made
/// IR can have. Texts for SY010 and SY011 are too large to keep; `tests/hostile` makes them.
const ELSEWHERE: &[&str] = &[
    "EX", "IO", "IR", "MI", "RD", "SY010", "SY011", "GL048", "GL049", "GL050", "GL051", "GL052",
    "VA014", "VA017", "VA018",
];

pub(crate) fn trials() -> Vec<Trial> {
    let folder = root("tests/diagnostics");
    let cases = files(&folder, &["yaml", "gltf", "glb", "pbrt", "usda"]).into_iter();
    // What cases name lies in folders below.
    let depth = folder.components().count() + 2;
    let cases = cases.filter(|case| case.components().count() == depth);
    let mut covered = BTreeSet::new();
    let mut trials: Vec<_> = cases
        .map(|case| {
            let name = name(&case, &folder);
            covered.extend(name.split('/').next().map(str::to_owned));
            Trial::test(format!("diagnostics/{name}"), move || check(&case))
        })
        .collect();
    let texts = files(&folder, &["yaml"]);
    trials.push(trial("diagnostics: what is proposed helps", move || {
        let faults: Vec<String> = texts.iter().flat_map(|case| unhelpful(case)).collect();
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }));
    let texts = files(&folder, &["yaml"]);
    trials.push(trial("diagnostics: fixes leave no case worse", move || {
        let changed: usize = texts.iter().map(|case| fixed(case)).sum();
        assert!(changed >= 20, "only {changed} cases are changed");
    }));
    trials.push(trial("diagnostics: every code has a case", move || {
        every_code_has_a_case(&covered);
    }));
    trials
}

fn options(text: &str) -> pipeline::Options {
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("# options:"))
        .unwrap_or_default();
    let has = |word| line.split_whitespace().any(|option| option == word);
    pipeline::Options {
        front: front::FrontOptions {
            strict: has("strict"),
            lenient: has("lenient"),
            ..front::FrontOptions::default()
        },
        ..pipeline::Options::default()
    }
}

fn base_name(path: &str) -> &str {
    path.rsplit('/').next().unwrap()
}

/// What is found in a file, one line each.
fn findings(case: &Path) -> String {
    let mut map = SourceMap::default();
    let file = Loader.file(case, &mut map).unwrap();
    let mut sink = DiagnosticSink::default();
    let options = options(&String::from_utf8_lossy(
        &fs::read(expectations(case)).unwrap(),
    ));
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let proof = lowered.and_then(|lowered| pipeline::validate(&lowered, &options, &mut sink));
    let is_gltf = case
        .extension()
        .is_some_and(|extension| extension != "yaml");
    assert!(
        is_gltf || proof.is_some() != sink.has_errors(),
        "a scene is proven unless there is an error"
    );
    sink.sort();
    let folder = case.parent().unwrap().display().to_string();
    let mut text = String::new();
    for finding in sink.kept() {
        let severity = match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let place = finding
            .primary
            .as_ref()
            .expect("every finding in a text has a place");
        let at = map.line_column(place.span.file, place.span.start);
        let is_binary = case.extension().is_some_and(|extension| extension == "glb");
        let at = if is_binary {
            format!("byte {}", place.span.start)
        } else {
            format!("{}:{}", at.line, at.column)
        };
        let name = if place.span.file == file {
            String::new()
        } else {
            format!("{}:", base_name(map.name(place.span.file)))
        };
        let message = finding.message.replace(&*folder, ".");
        writeln!(
            text,
            "# expect: {} {severity} {name}{at} {message}",
            finding.code
        )
        .unwrap();
    }
    text
}

/// What is found in a text that stands in the place of a case.
fn found_in(case: &Path, text: &[u8]) -> (SourceMap, FileId, DiagnosticSink) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add_from(case, text.to_vec());
    let options = options(&String::from_utf8_lossy(text));
    if let Some(lowered) = pipeline::load(file, &mut map, &options, &mut sink) {
        pipeline::validate(&lowered, &options, &mut sink);
    }
    (map, file, sink)
}

/// Proposals of a case that, obeyed, leave the finding there, or bring more errors. What comes
/// after a mistake in the syntax is seen only when it is gone.
fn unhelpful(case: &Path) -> Vec<String> {
    let text = fs::read(case).unwrap();
    let (_, file, before) = found_in(case, &text);
    let errors = |sink: &DiagnosticSink| {
        let errors = sink.kept().iter();
        errors
            .filter(|finding| finding.severity == Severity::Error)
            .count()
    };
    let mut faults = Vec::new();
    for finding in before.kept() {
        for replacement in finding
            .hints
            .iter()
            .filter_map(|hint| hint.replacement.as_ref())
        {
            if replacement.span.file != file {
                continue;
            }
            let [start, end] = [replacement.span.start, replacement.span.end].map(|at| at as usize);
            let obeyed = [&text[..start], replacement.text.as_bytes(), &text[end..]].concat();
            let (_, _, after) = found_in(case, &obeyed);
            let same = |sink: &DiagnosticSink| {
                let is_same = |other: &&Diagnostic| {
                    (other.code.id, &other.message) == (finding.code.id, &finding.message)
                };
                sink.kept().iter().filter(is_same).count()
            };
            let is_syntax = finding.code.id.starts_with("SY");
            if same(&after) >= same(&before) || (!is_syntax && errors(&after) > errors(&before)) {
                faults.push(format!("{}: {}", case.display(), finding.message));
            }
        }
    }
    faults
}

/// How many texts are made of a case by what is proposed for it, with guesses and without: each
/// with fewer findings than before, no more errors, and nothing left to do.
fn fixed(case: &Path) -> usize {
    let bytes = fs::read(case).unwrap();
    let Ok(text) = std::str::from_utf8(&bytes) else {
        return 0;
    };
    let options = options(text);
    let count = |text: &str| {
        let (_, _, sink) = found_in(case, text.as_bytes());
        let of = |severity| {
            let found = sink.kept().iter();
            found.filter(|d| d.severity == severity).count()
        };
        (of(Severity::Error), of(Severity::Warning))
    };
    let before = count(text);
    let fix = |guesses| {
        let wish = pipeline::FixFilter {
            guesses,
            only: None,
        };
        let fixed = pipeline::fix(case, text, &options, &wish);
        let again = pipeline::fix(case, &fixed.text, &options, &wish);
        let name = case.display();
        assert_eq!((again.changes, &again.text), (0, &fixed.text), "{name}");
        assert_eq!(fixed.changes > 0, fixed.text != text, "{name}");
        let after = count(&fixed.text);
        assert!(after < before || fixed.changes == 0, "{name}: {after:?}");
        usize::from(fixed.changes > 0)
    };
    fix(false) + fix(true)
}

/// Where the expectations of a case are: in the file, unless there is one beside it.
fn expectations(case: &Path) -> PathBuf {
    let beside = case.with_extension("expect");
    if beside.exists() {
        beside
    } else {
        case.to_owned()
    }
}

fn is_expectation(line: &&[u8]) -> bool {
    line.starts_with(b"# expect:")
}

fn expected(path: &Path) -> String {
    let bytes = fs::read(path).unwrap();
    let lines = bytes
        .split_inclusive(|byte| *byte == b'\n')
        .filter(is_expectation);
    lines.map(String::from_utf8_lossy).collect()
}

fn update(path: &Path, found: &str) {
    let bytes = fs::read(path).unwrap();
    let others = bytes
        .split_inclusive(|byte| *byte == b'\n')
        .filter(|line| !is_expectation(line));
    let mut kept: Vec<u8> = others.flatten().copied().collect();
    kept.extend(found.bytes());
    fs::write(path, kept).unwrap();
}

fn check(case: &Path) -> Result<(), Failed> {
    let found = findings(case);
    let path = expectations(case);
    if updates() {
        update(&path, &found);
    }
    let expected = expected(&path);
    if found != expected {
        return Err(format!("expected\n{expected} found\n{found}").into());
    }
    let folder = case.parent().and_then(Path::file_name).unwrap();
    let folder = folder.to_string_lossy();
    if !found.contains(&format!("# expect: {folder} ")) {
        return Err(format!("it raises no {folder}").into());
    }
    Ok(())
}

fn every_code_has_a_case(covered: &BTreeSet<String>) {
    let missing: Vec<_> = codes::all()
        .map(|code| code.id)
        .filter(|id| {
            !ELSEWHERE.iter().any(|prefix| id.starts_with(prefix)) && !covered.contains(*id)
        })
        .collect();
    assert!(
        missing.is_empty(),
        "no case under tests/diagnostics for {missing:?}"
    );
}
