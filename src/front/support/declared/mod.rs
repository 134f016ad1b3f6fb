//! Tests that the tables of plugins are what the readers read, and what editors are proposed: over
//! all examples and the scenes of the repository.

mod mitsuba;
mod pbrt;

use super::{ForeignFormat, files};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The findings of the reader about a text, by their messages.
fn findings(format: ForeignFormat, text: &str) -> String {
    format.tried(text, &files::beside()).1
}

/// The scenes of the repository with this extension, and all examples of their format.
fn texts(format: ForeignFormat, extension: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut open: Vec<PathBuf> = ["docs", "scenes", "tests"]
        .map(|name| root.join(name))
        .into();
    let mut texts = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(
                fs::read_dir(&path)
                    .unwrap()
                    .map(|entry| entry.unwrap().path()),
            );
        } else if path.ends_with("PB006/doubtful.pbrt") {
            // It says a parameter twice, which is not proposed again.
        } else if path.extension().is_some_and(|own| own == extension) {
            texts.push(fs::read_to_string(&path).unwrap());
        }
    }
    let parts = format.parts().iter();
    texts.extend(parts.flat_map(|part| {
        let example =
            |(_, text): &(&str, &str)| [&part.before.concat(), *text, part.after].concat();
        part.examples.iter().map(example)
    }));
    texts
}

/// A name without the type of a parameter, however it is spelt.
fn plain(text: &str) -> String {
    text.rsplit(' ')
        .next()
        .unwrap()
        .replace('_', "")
        .to_lowercase()
}

/// Asserts that `expected` is proposed at the end of a word, and while it is typed: at the end of
/// the text.
fn assert_proposed(format: ForeignFormat, text: &str, word: Range<usize>, expected: &str) {
    let name = plain(expected);
    let typed = text.get(..word.start + 1).unwrap();
    for (text, offset) in [(text, word.end), (typed, typed.len())] {
        let found = format.completion(text, offset);
        let proposals = found
            .as_ref()
            .map_or(&[][..], |found| found.proposals.as_slice());
        let is_there = proposals.iter().any(|own| plain(&own.text) == name);
        assert!(is_there, "{expected}: {found:?} in\n{text}");
    }
    let meaning = format.completion(text, word.end).unwrap();
    assert!(
        meaning.written(text).is_some(),
        "{expected} has no meaning in\n{text}"
    );
}

#[test]
fn no_cut_of_a_scene_panics() {
    for (format, extension) in [
        (ForeignFormat::Pbrt, "pbrt"),
        (ForeignFormat::Mitsuba, "xml"),
    ] {
        for text in texts(format, extension).iter().take(3) {
            for (at, _) in text.char_indices() {
                let (start, end) = text.split_at(at);
                for text in [
                    start,
                    &format!("{start}😀\"<{end}"),
                    &format!("{start}é\\{end}"),
                ] {
                    for offset in [at, text.len(), at + 9] {
                        if let Some(found) = format.completion(text, offset) {
                            assert!(text.get(found.replaced.clone()).is_some(), "{found:?}");
                        }
                    }
                }
            }
        }
    }
}
