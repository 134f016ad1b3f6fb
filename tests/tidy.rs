//! The house keeps itself tidy: rooms name only lower floors, files are short and open with what
//! they answer for.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod circles;
mod tokens;
mod weight;

use crate::repo::{files, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use tokens::tokens;

/// The floor of each room; a room may name only rooms on lower floors.
const FLOORS: &[(&str, u32)] = &[
    ("math", 0),
    ("color", 0),
    ("tables", 0),
    ("image", 1),
    ("profile", 1),
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
    ("api", 9),
    ("cli", 10),
];

/// What a room may not name although it stands lower.
const FORBIDDEN: &[(&str, &str)] = &[
    ("render", "source"),
    ("render", "diag"),
    ("render", "front"),
    ("render", "codec"),
    ("render", "ir"),
    ("render", "emit"),
    ("render", "passes"),
];

/// Most files have 400 lines or fewer: they are cut at a joint, never at a number.
const MAX_LINES: usize = 800;

/// Tables of data may be longer; each with its reason.
const TABLES: &[&str] = &["src/diag/codes/"];

fn rust_files(folder: &str) -> Vec<(String, String)> {
    let paths = files(&root(folder), &["rs"]).into_iter();
    // What a build of an example made is no source.
    let sources = paths.filter(|path| !relative(path).contains("/target/"));
    let read = |path: PathBuf| (relative(&path), fs::read_to_string(&path).unwrap());
    sources.map(read).collect()
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root(""))
        .unwrap()
        .to_string_lossy()
        .replace('\\', "/")
}

fn all_files() -> Vec<(String, String)> {
    [
        "src",
        "tests",
        "benches",
        "examples",
        "scenes",
        "fuzz/fuzz_targets",
    ]
    .into_iter()
    .filter(|folder| root(folder).exists())
    .flat_map(rust_files)
    .collect()
}

/// The rooms, each with its manifest; the library itself is the one that stands above them.
fn manifests() -> Vec<(String, String)> {
    let mut manifests = vec![("api".to_owned(), root("Cargo.toml"))];
    for entry in fs::read_dir(root("src")).unwrap() {
        let folder = entry.unwrap().path();
        if folder.join("Cargo.toml").exists() {
            let room = folder.file_name().unwrap().to_string_lossy().into_owned();
            manifests.push((room, folder.join("Cargo.toml")));
        }
    }
    let read = |(room, path)| (room, fs::read_to_string(path).unwrap());
    manifests.into_iter().map(read).collect()
}

/// The rooms that a manifest names as dependencies: cargo lets a room name no others.
fn dependencies(manifest: &str) -> BTreeSet<&str> {
    let tables = manifest.split("\n[").filter(|table| {
        let name = table.split(']').next().unwrap_or_default();
        name.ends_with("dependencies") && !name.contains("workspace") && !name.contains("dev")
    });
    let lines = tables.flat_map(str::lines);
    let rooms = lines.filter_map(|line| line.strip_prefix("rtc-")?.split(['.', ' ']).next());
    rooms.collect()
}

#[test]
fn every_room_has_a_floor() {
    let rooms: BTreeSet<String> = manifests().into_iter().map(|(room, _)| room).collect();
    let known: BTreeSet<String> = FLOORS.iter().map(|(room, _)| (*room).to_owned()).collect();
    assert_eq!(rooms, known);
}

#[test]
fn rooms_depend_on_lower_floors_alone() {
    let floors: BTreeMap<&str, u32> = FLOORS.iter().copied().collect();
    let mut faults = Vec::new();
    for (room, manifest) in &manifests() {
        let others = dependencies(manifest);
        assert!(room != "render" || others.contains("plan"), "{others:?}");
        for other in others {
            // The library hands out the program, which stands above it.
            let is_program = room == "api" && other == "cli";
            let is_below = floors[other] < floors[room.as_str()];
            if !is_program && !is_below || FORBIDDEN.contains(&(room, other)) {
                faults.push(format!("{room} depends on {other}"));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:?}");
}

/// The room of `render` that sees the proof: all others see what was prepared from it.
const PREPARING: &str = "src/render/world/";

#[test]
fn the_world_alone_knows_the_proof() {
    let files = rust_files("src/render").into_iter();
    let knowing: BTreeSet<_> = files
        .filter(|(_, text)| text.contains("rtc_valid::"))
        .map(|(path, _)| path)
        .collect();
    let (world, others): (Vec<_>, Vec<_>) =
        knowing.iter().partition(|file| file.starts_with(PREPARING));
    assert_eq!(others, Vec::<&String>::new());
    assert!(world.len() > 4, "{world:?}");
}

#[test]
fn the_proof_passes_on_nothing_of_the_representation() {
    for (path, text) in rust_files("src/valid") {
        let exports = text.split("pub use ").skip(1);
        let of_ir = exports.filter(|rest| rest.starts_with("rtc_ir")).count();
        assert_eq!(of_ir, 0, "{path}");
    }
}

/// The stages that a noun of the scene goes through; it keeps its name in each.
const STAGES: [&str; 5] = ["front", "ir", "valid", "render", "image"];

/// Names that several types share, because the types are one notion at different stages (the first
/// three), or in code of formats that do not know each other.
const SHARED_NAMES: [&str; 13] = [
    "Lowering",
    "PhongMaterial",
    "StandardMaterial",
    "Channel",
    "Element",
    "Fault",
    "Key",
    "Layer",
    "Node",
    "Object",
    "Stream",
    "Transform",
    "Value",
];

/// The types that a file defines, private ones and those of inner modules too, but no associated
/// types.
fn types(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let item = line.trim_start();
        let restricted = item
            .strip_prefix("pub(")
            .and_then(|rest| rest.split_once(") "));
        let public = || item.strip_prefix("pub ").unwrap_or(item);
        let item = restricted.map_or_else(public, |(_, item)| item);
        let (keyword, rest) = item.split_once(' ')?;
        let is_associated = keyword == "type" && line.starts_with(' ');
        let is_type = matches!(keyword, "struct" | "enum" | "union" | "trait" | "type");
        let name = rest
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .next()?;
        let is_named = name.starts_with(char::is_uppercase);
        (is_type && !is_associated && is_named).then_some(name)
    })
}

#[test]
fn no_two_types_have_one_name() {
    let files = rust_files("src").into_iter();
    // The public API has types of its own for what it returns. The glTF document has the names of
    // the specification.
    let apart = ["src/api", "src/emit/gltf/document.rs"];
    let files: Vec<_> = files
        .filter(|(path, _)| !apart.iter().any(|own| path.starts_with(own)))
        .collect();
    let mut homes: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (path, text) in &files {
        for name in types(text) {
            homes.entry(name).or_default().insert(path);
        }
    }
    let is_in = |path: &str, rooms: &[&str]| {
        let room = path.split('/').nth(1);
        room.is_some_and(|room| rooms.contains(&room))
    };
    let is_noun = |paths: &BTreeSet<&str>| {
        paths.iter().any(|path| is_in(path, &["ir", "valid"]))
            && paths.iter().all(|path| is_in(path, &STAGES))
    };
    let nouns = homes
        .values()
        .filter(|paths| paths.len() > 1 && is_noun(paths));
    assert!(nouns.count() > 20, "nouns are found");
    let is_shared = |name: &&str| SHARED_NAMES.contains(name);
    homes.retain(|name, paths| paths.len() > 1 && !is_noun(paths) && !is_shared(name));
    assert!(homes.is_empty(), "{homes:#?}");
}

#[test]
fn examples_and_hosts_enter_by_the_door() {
    let outside = |folder: &&str| root(folder).exists();
    let folders = ["examples", "hosts"].into_iter().filter(outside);
    let files: Vec<_> = folders.flat_map(rust_files).collect();
    assert!(files.len() >= 3, "there are examples");
    let inside: Vec<_> = files
        .iter()
        .filter(|(_, text)| text.contains("internals"))
        .map(|(path, _)| path)
        .collect();
    assert!(
        inside.is_empty(),
        "they name what is no promise: {inside:?}"
    );
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
        .filter(|(_, text)| heads(text) == 0 || heads(text) > 60)
        .map(|(path, _)| path)
        .collect();
    assert!(bad.is_empty(), "no head of 1 to 60 lines: {bad:?}");
}

#[test]
fn files_are_short() {
    let long: Vec<_> = all_files()
        .into_iter()
        .filter(|(path, text)| {
            text.lines().count() > MAX_LINES && !TABLES.iter().any(|table| path.starts_with(table))
        })
        .map(|(path, text)| format!("{path}: {}", text.lines().count()))
        .collect();
    assert!(long.is_empty(), "longer than {MAX_LINES} lines: {long:?}");
}

/// Private names that a file uses for what a standard or a crate calls so.
const ALLOWED_NAMES: &[(&str, &str)] = &[
    // The public name of the reason of an effect.
    ("src/api/effect.rs", "because"),
];

#[test]
fn names_are_standard_terms() {
    assert!(ALLOWED_NAMES.len() <= 10);
    let list = fs::read_to_string(root("tests/private-names.txt")).unwrap();
    let banned: BTreeMap<&str, &str> = list
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split_once(' '))
        .collect();
    let mut faults = Vec::new();
    for (path, text) in rust_files("src") {
        let names: BTreeSet<&str> = tokens(&text).into_iter().collect();
        for name in names {
            if let Some(term) = banned.get(name)
                && !ALLOWED_NAMES.contains(&(&path, name))
            {
                faults.push(format!("{path}: `{name}`: the standard term is `{term}`"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn lines_have_at_most_100_columns() {
    let mut long = Vec::new();
    // Tests hold what programs print as it is.
    let is_test = |path: &str| path.ends_with("tests.rs") || path.contains("/tests/");
    for (path, text) in rust_files("src")
        .into_iter()
        .filter(|(path, _)| !is_test(path))
    {
        // The formatter breaks neither strings nor the patterns of macros.
        let is_bound = |line: &str| line.contains(['"', '$', '`', '\\']);
        for (index, line) in text.lines().enumerate() {
            if line.chars().count() > 100 && !is_bound(line) {
                long.push(format!("{path}:{}", index + 1));
            }
        }
    }
    assert!(long.is_empty(), "{} lines: {}", long.len(), long.join(" "));
}
