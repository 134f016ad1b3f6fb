//! The house keeps itself tidy: rooms name only lower floors, files are short and open with what
//! they answer for.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use std::fs;
use std::path::{Path, PathBuf};

/// The floor of each room; a room may name only rooms on lower floors.
const FLOORS: &[(&str, u32)] = &[
    ("math", 0),
    ("color", 0),
    ("image", 1),
    ("source", 1),
    ("diag", 2),
    ("ir", 3),
    ("front", 4),
    ("emit", 4),
    ("codec", 4),
    ("passes", 4),
    ("valid", 4),
    ("plan", 5),
    ("render", 6),
    ("study", 7),
    ("pipeline", 8),
    ("cli", 9),
];

/// What a room may not name although it stands lower.
const FORBIDDEN: &[(&str, &str)] = &[
    ("render", "source"),
    ("render", "diag"),
    ("render", "front"),
    ("render", "codec"),
    ("render", "ir"),
];

const MAX_LINES: usize = 400;

/// Tables of data may be longer; each with its reason.
const TABLES: &[&str] = &["src/diag/codes/"];

/// Files that outgrew the limit when lines became shorter, to be parted by their nouns.
const OUTGROWN: &[&str] = &[
    "src/cli/render.rs",
    "src/plan/mod.rs",
    "src/plan/window.rs",
    "src/render/instance.rs",
    "src/render/path/tracer.rs",
    "src/render/whitted.rs",
    "src/render/wide.rs",
    "src/study/flip.rs",
    "src/study/knob.rs",
    "src/valid/shape.rs",
    "tests/assets/search.rs",
    "tests/cli/main.rs",
    "tests/cli/stage.rs",
    "tests/codec/main.rs",
    "tests/cost.rs",
    "tests/course.rs",
    "tests/plan/need.rs",
];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(
                fs::read_dir(&path)
                    .unwrap()
                    .map(|entry| entry.unwrap().path()),
            );
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push((relative(&path), fs::read_to_string(&path).unwrap()));
        }
    }
    found.sort();
    found
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root())
        .unwrap()
        .to_string_lossy()
        .replace('\\', "/")
}

fn all_files() -> Vec<(String, String)> {
    ["src", "tests", "benches", "fuzz/fuzz_targets"]
        .into_iter()
        .filter(|folder| root().join(folder).exists())
        .flat_map(rust_files)
        .collect()
}

fn room_of(path: &str) -> Option<(&'static str, u32)> {
    let room = path.strip_prefix("src/")?.split(['/', '.']).next()?;
    FLOORS.iter().copied().find(|(name, _)| *name == room)
}

/// The file without its unit tests and comments: docs may point anywhere.
fn shipped_code(text: &str) -> String {
    let shipped = text.split("#[cfg(test)]").next().unwrap();
    shipped
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n")
}

/// The rooms a text names as `crate::room` or within `use crate::{…}`.
fn rooms_named(text: &str) -> Vec<&'static str> {
    let mut named = Vec::new();
    for rest in text.split("crate::").skip(1) {
        let list = match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or(list),
            None => rest
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .next()
                .unwrap_or(rest),
        };
        named.extend(FLOORS.iter().map(|(name, _)| *name).filter(|name| {
            list.split(|c: char| !c.is_alphanumeric() && c != '_')
                .any(|word| word == *name)
        }));
    }
    named
}

#[test]
fn rooms_name_only_lower_floors() {
    let floor = |room: &str| FLOORS.iter().find(|(name, _)| *name == room).unwrap().1;
    let mut faults = Vec::new();
    for (path, text) in rust_files("src") {
        let Some((room, own)) = room_of(&path) else {
            continue;
        };
        for named in rooms_named(&shipped_code(&text))
            .into_iter()
            .filter(|named| *named != room)
        {
            if floor(named) >= own || FORBIDDEN.contains(&(room, named)) {
                faults.push(format!("{path} names `{named}`"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_file_opens_with_what_it_answers_for() {
    let heads = |text: &str| {
        text.lines()
            .take_while(|line| line.starts_with("//!"))
            .count()
    };
    let bad: Vec<_> = all_files()
        .into_iter()
        .filter(|(path, text)| heads(text) == 0 || (heads(text) > 8 && path != "src/lib.rs"))
        .map(|(path, _)| path)
        .collect();
    assert!(bad.is_empty(), "no head of 1 to 8 lines: {bad:?}");
}

#[test]
fn files_are_short() {
    let long: Vec<_> = all_files()
        .into_iter()
        .filter(|(path, text)| {
            text.lines().count() > MAX_LINES
                && !OUTGROWN.contains(&path.as_str())
                && !TABLES.iter().any(|table| path.starts_with(table))
        })
        .map(|(path, text)| format!("{path}: {}", text.lines().count()))
        .collect();
    assert!(long.is_empty(), "longer than {MAX_LINES} lines: {long:?}");
}
