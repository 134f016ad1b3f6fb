//! The proofs of the filters (`docs/proofs`) are about the numbers of the code.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scripts() -> Vec<PathBuf> {
    let folder = fs::read_dir(root().join("docs/proofs")).unwrap();
    let files = folder.map(|entry| entry.unwrap().path());
    let mut scripts: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|of| of == "g"))
        .collect();
    scripts.sort();
    scripts
}

/// A number at the start of a text as the code writes it, and what follows.
fn number(text: &str) -> Option<(f64, &str)> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == '_';
    let end = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let (number, rest) = text.split_at(end);
    Some((number.replace('_', "").parse().ok()?, rest))
}

/// The names in braces of a pattern and the numbers that stand for them at the start of a text.
fn matched<'p>(pattern: &'p str, text: &str) -> Option<Vec<(&'p str, f64)>> {
    let mut text = text;
    let mut found = Vec::new();
    let mut pieces = pattern.split('{');
    text = text.strip_prefix(pieces.next()?)?;
    for piece in pieces {
        let (name, literal) = piece.split_once('}')?;
        let (value, rest) = number(text)?;
        found.push((name, value));
        text = rest.strip_prefix(literal)?;
    }
    Some(found)
}

/// The numbers that a script takes from the code.
fn taken(script: &str) -> Vec<(String, f64)> {
    let lines = script
        .lines()
        .filter_map(|line| line.strip_prefix("# from "));
    let mut all = Vec::new();
    for line in lines {
        let (file, pattern) = line.split_once(": ").unwrap();
        let code = fs::read_to_string(root().join(file)).unwrap();
        let found = (0..code.len())
            .filter(|at| code.is_char_boundary(*at))
            .find_map(|at| matched(pattern, code.split_at(at).1));
        let found = found.unwrap_or_else(|| panic!("{file} has no `{pattern}`"));
        all.extend(
            found
                .into_iter()
                .map(|(name, value)| (name.to_owned(), value)),
        );
    }
    all
}

#[test]
fn proofs_are_about_the_numbers_of_the_code() {
    let scripts = scripts();
    assert_eq!(scripts.len(), 10, "one for each filter");
    for path in scripts {
        let script = fs::read_to_string(&path).unwrap();
        let taken = taken(&script);
        assert!(!taken.is_empty(), "{}", path.display());
        for (name, value) in taken {
            let line = script
                .lines()
                .find_map(|line| line.strip_prefix(&format!("{name} = ")))
                .unwrap_or_else(|| panic!("{} has no {name}", path.display()));
            let (stated, _) = number(line).unwrap();
            assert_eq!(
                stated.to_bits(),
                value.to_bits(),
                "{name} of {}",
                path.display()
            );
        }
    }
}

#[test]
fn another_number_in_the_code_is_found() {
    let found = matched("a({A} * b, {B})", "a(10.0 * b, 1_048_576)").unwrap();
    assert_eq!(found, [("A", 10.0), ("B", 1_048_576.0)]);
    assert_eq!(matched("a({A} * b)", "a(x * b)"), None);
}
