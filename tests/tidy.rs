//! The house keeps itself tidy: rooms name only lower floors, files are short and open with what
//! they answer for.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod names;

use names::{House, Named};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The floor of each room; a room may name only rooms on lower floors.
const FLOORS: &[(&str, u32)] = &[
    ("math", 0),
    ("color", 0),
    ("standard", 0),
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

/// What rooms still name against the rules, through what other rooms re-export; to become less.
const REMAINS: &[(&str, &str)] = &[];

const MAX_LINES: usize = 400;

/// Tables of data may be longer; each with its reason.
const TABLES: &[&str] = &["src/diag/codes/"];

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
    [
        "src",
        "tests",
        "benches",
        "examples",
        "scenes",
        "fuzz/fuzz_targets",
    ]
    .into_iter()
    .filter(|folder| root().join(folder).exists())
    .flat_map(rust_files)
    .collect()
}

/// The floor of a room; none for the names of things in the root of the crate.
fn floor_of(room: &str) -> Option<u32> {
    let known = FLOORS.iter().find(|(name, _)| *name == room);
    known.map(|(_, floor)| *floor)
}

/// What a room names and may not, as `render` and `ir::Camera`, and the files that name it.
fn faults(named: BTreeSet<Named>) -> BTreeMap<(String, String), BTreeSet<String>> {
    let mut faults: BTreeMap<(String, String), BTreeSet<String>> = BTreeMap::new();
    for Named {
        file,
        module,
        place,
    } in named
    {
        let Some((room, own)) = module
            .first()
            .and_then(|room| Some((room.clone(), floor_of(room)?)))
        else {
            continue;
        };
        let other = &place[0];
        let is_fault = other != &room
            && floor_of(other).is_some_and(|floor| {
                floor >= own || FORBIDDEN.contains(&(room.as_str(), other.as_str()))
            });
        // What lies deeper in the room is named by way of this.
        if is_fault && place.len() == 2 {
            let files = faults.entry((room, place.join("::"))).or_default();
            files.insert(file);
        }
    }
    faults
}

#[test]
fn every_room_has_a_floor() {
    let rooms: BTreeSet<String> = rust_files("src")
        .into_iter()
        .filter_map(|(path, _)| {
            Some(
                path.strip_prefix("src/")?
                    .split(['/', '.'])
                    .next()?
                    .to_owned(),
            )
        })
        .filter(|room| room != "lib" && room != "main")
        .collect();
    let known: BTreeSet<String> = FLOORS.iter().map(|(room, _)| (*room).to_owned()).collect();
    assert_eq!(rooms, known);
}

#[test]
fn rooms_name_only_lower_floors() {
    let mut faults = faults(House::read(&rust_files("src")).named());
    let is_gone = |(room, place): &&(&str, &str)| {
        faults
            .remove(&((*room).to_owned(), (*place).to_owned()))
            .is_none()
    };
    let gone: Vec<_> = REMAINS.iter().filter(is_gone).collect();
    let told: Vec<_> = faults
        .into_iter()
        .map(|((room, place), files)| format!("{room} names `{place}` in {files:?}"))
        .collect();
    assert!(told.is_empty(), "{}", told.join("\n"));
    assert!(
        gone.is_empty(),
        "no longer named, so no longer to be listed: {gone:?}"
    );
}

#[test]
fn rooms_are_named_in_lists_by_super_and_through_others() {
    let files = [
        ("src/lib.rs", ""),
        ("src/source/mod.rs", ""),
        ("src/diag/mod.rs", ""),
        ("src/codec/mod.rs", ""),
        ("src/ir/mod.rs", "pub struct Camera; pub struct Lens;"),
        (
            "src/valid/mod.rs",
            "mod lens; pub use crate::ir::Camera as Eye; pub use lens::*;",
        ),
        ("src/valid/lens.rs", "pub use super::super::ir::Lens;"),
        (
            "src/render/a.rs",
            "use crate::{math::{self, Vec3}, valid::{Eye}};",
        ),
        (
            "src/render/b.rs",
            "use crate::valid as proof; fn f() -> proof::Lens { proof::Lens }",
        ),
        (
            "src/render/c.rs",
            "fn f() { assert!(super::super::diag::is_fine()) }",
        ),
        (
            "src/render/d.rs",
            "macro_rules! m { () => { $crate::source::Span } }",
        ),
        ("src/render/e.rs", "mod inner { use rtc::codec::decode; }"),
        ("src/render/g.rs", "use super::super::valid::*;"),
        (
            "src/render/f.rs",
            "//! See crate::ir::Camera.\n#[cfg(test)]\nmod tests { use crate::ir::Lens; }",
        ),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let named: BTreeMap<_, _> = faults(House::read(&files).named())
        .into_iter()
        .map(|((_, place), files)| (place, files.into_iter().collect::<Vec<_>>().join(" ")))
        .collect();
    let expected = [
        ("codec::decode", "src/render/e.rs"),
        ("diag::is_fine", "src/render/c.rs"),
        ("ir::Camera", "src/render/a.rs src/render/g.rs"),
        ("ir::Lens", "src/render/b.rs src/render/g.rs"),
        ("source::Span", "src/render/d.rs"),
    ];
    let expected = expected.map(|(place, file)| (place.to_owned(), file.to_owned()));
    assert_eq!(named, BTreeMap::from(expected));
}

/// The room of `render` that sees the proof: all others see what was prepared from it.
const PREPARING: &str = "src/render/world/";

#[test]
fn the_world_alone_knows_the_proof() {
    let named = House::read(&rust_files("src")).named().into_iter();
    let knowing = named
        .filter(|named| named.place[0] == "valid")
        .map(|named| named.file);
    let knowing: BTreeSet<_> = knowing
        .filter(|file| file.starts_with("src/render/"))
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
        let of_ir = exports.filter(|rest| rest.starts_with("crate::ir")).count();
        assert_eq!(of_ir, 0, "{path}");
    }
}

/// The stages that a noun of the scene goes through; it keeps its name in each.
const STAGES: [&str; 5] = ["front", "ir", "valid", "render", "image"];

/// The types at the top of a file that other files may name.
fn shared_types(text: &str) -> impl Iterator<Item = &str> {
    let items = text.lines().filter(|line| line.starts_with("pub"));
    items.filter_map(|line| {
        let mut words = line.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        words.find(|word| matches!(*word, "struct" | "enum" | "union" | "trait" | "type"))?;
        words.next()
    })
}

#[test]
fn no_two_types_have_one_name() {
    let files = rust_files("src").into_iter();
    // The door has the names that its callers use; what it hands out stands for what lies within.
    let files: Vec<_> = files
        .filter(|(path, _)| !path.starts_with("src/api"))
        .collect();
    let mut homes: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (path, text) in &files {
        for name in shared_types(text) {
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
    homes.retain(|_, paths| paths.len() > 1 && !is_noun(paths));
    assert!(homes.is_empty(), "{homes:#?}");
}

#[test]
fn examples_and_hosts_enter_by_the_door() {
    let outside = |folder: &&str| root().join(folder).exists();
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
            text.lines().count() > MAX_LINES && !TABLES.iter().any(|table| path.starts_with(table))
        })
        .map(|(path, text)| format!("{path}: {}", text.lines().count()))
        .collect();
    assert!(long.is_empty(), "longer than {MAX_LINES} lines: {long:?}");
}
