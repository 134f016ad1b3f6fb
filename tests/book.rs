//! The reference pages of the book that are generated: the scene format, with an example and its
//! picture for each shape, light, material key and camera key, and the command line.
//!
//! `RTC_UPDATE=1 cargo test --test suites book::` writes the pages and renders the pictures again.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, and writes the pages if asked"
)]

use crate::repo::{files, root};
use rtc::internals::front::course;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

const REFERENCE: &str = "docs/book/src/reference";

/// A page of the scene format: its file, its title, the sections of `rtc schema page` in it, and
/// for each the folder of its examples.
const PAGES: &[(&str, &str, &[(&str, &str)])] = &[
    (
        "README.md",
        "The scene format",
        &[
            ("The file", "scene"),
            ("`ImageSize` as a map", ""),
            ("`SuperSampling`", ""),
            ("`GoochParameters`", ""),
            ("`PathParameters`", ""),
        ],
    ),
    ("camera.md", "Camera", &[("`Camera`", "camera")]),
    (
        "lights.md",
        "Lights",
        &[("`Lights`", "lights"), ("`Environment`", "environment")],
    ),
    (
        "materials.md",
        "Materials",
        &[
            ("`material`", "material"),
            ("`material` of `type: standard`", "standard"),
            ("`Medium`", "medium"),
            ("A texture of a `standard` material", ""),
            ("A pattern as a texture", ""),
        ],
    ),
];

fn run(args: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    let output = command
        .current_dir(root(""))
        .args(args)
        .env_remove("RTC_UPDATE")
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "rtc {args:?}: {errors}");
    String::from_utf8(output.stdout)
        .unwrap()
        .replace("rtc.exe", "rtc")
}

/// Compares a generated file with the committed one, or writes it with `RTC_UPDATE=1`.
fn check(path: &str, current: &[u8]) {
    let path = root(REFERENCE).join(path);
    if env::var_os("RTC_UPDATE").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, current).unwrap();
    }
    let is_current = fs::read(&path).is_ok_and(|committed| committed == current);
    assert!(
        is_current,
        "{} is out of date: RTC_UPDATE=1 cargo test --test suites book::",
        path.display()
    );
}

/// The sections of the page of the scene format: heading and text.
fn sections(page: &str) -> Vec<(&str, &str)> {
    let sections = page.split("\n## ").skip(1);
    sections
        .map(|section| section.split_once('\n').unwrap())
        .collect()
}

/// The keys of a section, each row of its table with all that are given together.
fn keys(text: &str) -> Vec<Vec<&str>> {
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| row.split('|').nth(1).unwrap().split('`'))
        .map(|cell| cell.skip(1).step_by(2).collect())
        .collect()
}

/// A section for the book: the columns of other spellings become a sentence in the last column.
fn narrow(text: &str) -> String {
    let mut page = String::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let line = match cells[..] {
            [key, spellings, _, kind, default, meaning] if line.starts_with('|') => {
                let other = match spellings {
                    "" | "---" | "other spellings" => String::new(),
                    spellings => format!(" Also spelt {}.", spellings.replace(';', ",")),
                };
                format!("| {key} | {kind} | {default} | {meaning}{other} |")
            }
            _ => line.to_owned(),
        };
        page += &line;
        page.push('\n');
    }
    page
}

/// The lines of an example that a page shows: from the last line that is not indented.
fn shown(example: &str) -> String {
    let lines: Vec<&str> = example.lines().collect();
    let first = lines
        .iter()
        .rposition(|line| !line.starts_with(' '))
        .unwrap();
    lines[first..].join("\n")
}

/// An example on a page: what it shows, its picture, and its lines.
fn example(folder: &str, name: &str) -> String {
    let path = format!("examples/{folder}/{name}");
    let text = fs::read_to_string(root(REFERENCE).join(format!("{path}.yaml"))).unwrap();
    let comments = text.lines().map_while(|line| line.strip_prefix("# "));
    let caption = comments.collect::<Vec<_>>().join("\n");
    let shown = shown(&text);
    format!(
        "\n{caption}\n\n![{name}](../{path}.jpg)\n\n```yaml\n{shown}\n```\n\n[The whole scene](../{path}.yaml)\n"
    )
}

/// The names of the examples of a folder, in the order of the keys.
fn examples(folder: &str, keys: &[Vec<&str>]) -> Vec<String> {
    let paths = files(&root(REFERENCE).join("examples").join(folder), &["yaml"]);
    let name = |path: &Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let mut names: Vec<String> = paths.iter().map(|path| name(path)).collect();
    let position = |name: &str| {
        let is_in = |row: &Vec<&str>| row.contains(&name.split('-').next().unwrap());
        keys.iter().position(is_in).unwrap_or(usize::MAX)
    };
    names.sort_by_key(|name| position(name));
    names
}

fn scene_page(title: &str, head: &str, parts: &[(&str, &str)]) -> String {
    let whole = course::page();
    let sections = sections(&whole);
    let mut page = format!(
        "# {title}\n\n<!-- Generated by tests/book.rs from the tables of the scene format. -->\n{head}"
    );
    for (heading, folder) in parts {
        let (_, text) = sections.iter().find(|(found, _)| found == heading).unwrap();
        let _ = write!(page, "\n## {heading}\n{}", narrow(text).trim_end());
        page.push('\n');
        if folder.is_empty() {
            continue;
        }
        let _ = writeln!(page, "\n### Examples for {heading}");
        for name in examples(folder, &keys(text)) {
            page += &example(folder, &name);
        }
    }
    page
}

/// The page of shapes: the example stands before the keys.
fn shapes_page() -> String {
    let whole = course::page();
    let mut page =
        "# Shapes\n\n<!-- Generated by tests/book.rs from the tables of the scene format. -->\n"
            .to_owned();
    for (heading, text) in sections(&whole) {
        let Some(shape) = heading.strip_prefix("`type: ") else {
            continue;
        };
        let shape = shape.trim_end_matches('`');
        let (about, table) = text.trim_start().split_once("\n\n").unwrap();
        let example = example("shapes", shape);
        let table = narrow(table);
        let _ = write!(
            page,
            "\n## {heading}\n\n{about}\n{example}\n{}\n",
            table.trim_end()
        );
    }
    page
}

#[test]
fn the_pages_of_the_scene_format_are_current() {
    let whole = course::page();
    let (head, _) = whole.split_once("\n## ").unwrap();
    let (_, head) = head.split_once('\n').unwrap();
    let head = head.replace(
        ": the third column says which keys the course had in the years of JSON, and the programs written for them",
        " (`rtc schema page` also lists the keys of old JSON files)",
    );
    for (file, title, parts) in PAGES {
        let head = if *file == "README.md" { &head } else { "" };
        let page = scene_page(title, head, parts);
        check(&format!("scene/{file}"), page.as_bytes());
    }
    check("scene/shapes.md", shapes_page().as_bytes());
    let listed = PAGES.iter().flat_map(|(_, _, parts)| parts.iter());
    let listed: Vec<&str> = listed.map(|(heading, _)| *heading).collect();
    for (heading, _) in sections(&whole) {
        let is_listed = heading.starts_with("`type: ") || listed.contains(&heading);
        assert!(is_listed, "{heading} is on no page of the book");
    }
}

/// Maps multiply the value beside them; the example `maps` shows how they are written.
fn needs_example(key: &str) -> bool {
    !key.ends_with("Map") && key != "name"
}

#[test]
fn every_key_of_camera_lights_and_materials_has_an_example() {
    let whole = course::page();
    let mut missing = Vec::new();
    for (heading, folder) in PAGES.iter().flat_map(|(_, _, parts)| parts.iter()) {
        if folder.is_empty() || *folder == "scene" {
            continue;
        }
        let paths = files(&root(REFERENCE).join("examples").join(folder), &["yaml"]);
        let texts = paths.iter().map(|path| fs::read_to_string(path).unwrap());
        let all = texts.map(|text| shown(&text)).collect::<String>();
        let (_, text) = sections(&whole)
            .into_iter()
            .find(|(found, _)| found == heading)
            .unwrap();
        let keys = keys(text).concat().into_iter();
        let unused = keys.filter(|key| needs_example(key) && !all.contains(&format!(" {key}: ")));
        missing.extend(unused.map(|key| format!("{heading}: {key}")));
    }
    assert!(missing.is_empty(), "no example in {REFERENCE}: {missing:?}");
}

#[test]
fn the_pictures_of_the_examples_are_what_their_scenes_render_to() {
    let made = tempfile::tempdir().unwrap();
    for entry in root(REFERENCE).join("examples").read_dir().unwrap() {
        let folder = entry.unwrap().path();
        if !folder.is_dir() {
            continue;
        }
        let name = folder.file_name().unwrap().to_str().unwrap();
        let out = format!("{}/{name}-{{stem}}.jpg", made.path().display());
        let scenes = folder.to_str().unwrap();
        run(&["render", "-q", "--deny", "warnings", scenes, "-o", &out]);
        for scene in files(&folder, &["yaml"]) {
            let stem = scene.file_stem().unwrap().to_str().unwrap();
            let picture = fs::read(made.path().join(format!("{name}-{stem}.jpg"))).unwrap();
            check(&format!("examples/{name}/{stem}.jpg"), &picture);
        }
    }
}

/// An option in a help text: its heading line, and what it means.
#[derive(Clone, PartialEq)]
struct Entry {
    name: String,
    meaning: String,
}

/// A line of a help text for a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}

/// The arguments and options of a help text, and the text after them.
fn entries(help: &str) -> (Vec<Entry>, String) {
    let (mut found, mut tail, mut is_in_tail): (Vec<Entry>, _, _) = (Vec::new(), Vec::new(), false);
    for line in help.lines() {
        let indent = line.len() - line.trim_start().len();
        let text = line.trim();
        let is_heading = indent == 0 && text.ends_with(':');
        let is_name = (2..=6).contains(&indent) && text.starts_with(['-', '<', '[']);
        if indent == 0 && !text.is_empty() {
            is_in_tail = !found.is_empty() && (is_in_tail || !is_heading || text == "Examples:");
        }
        if is_in_tail {
            tail.push(line);
        } else if is_name {
            let (name, meaning) = text.split_once("  ").unwrap_or((text, ""));
            found.push(Entry {
                name: name.to_owned(),
                meaning: cell(meaning.trim()),
            });
        } else if let Some(last) = found.last_mut().filter(|_| indent > 6) {
            let text = cell(text);
            match text.strip_prefix("- ") {
                Some(value) => last.meaning += &format!("<br>`{}", value.replacen(':', "`:", 1)),
                None => last.meaning += &format!(" {text}"),
            }
        }
    }
    for entry in &mut found {
        let values = entry.meaning.matches("<br>`").count();
        if values > entry.meaning.matches("`:").count() {
            entry.meaning = close_values(&entry.meaning);
        }
        entry.meaning = entry.meaning.trim().to_owned();
    }
    (found, tail.join("\n").trim().to_owned())
}

/// Ends the spans of values that have no text of their own.
fn close_values(meaning: &str) -> String {
    let mut parts = meaning.split("<br>`");
    let mut text = parts.next().unwrap().to_owned();
    for part in parts {
        let is_closed = part.contains("`:");
        let (value, rest) = part.split_once(' ').unwrap_or((part, ""));
        let value = if is_closed {
            value.to_owned()
        } else {
            format!("{value}`")
        };
        text += &format!("<br>`{value} {rest}");
    }
    text.trim_end().to_owned()
}

fn table(entries: &[&Entry]) -> String {
    let mut table = "\n| option | meaning |\n| --- | --- |\n".to_owned();
    for Entry { name, meaning } in entries {
        let _ = writeln!(table, "| `{}` | {meaning} |", name.replace('|', "\\|"));
    }
    table
}

#[test]
fn the_page_of_the_command_line_is_current() {
    let help = run(&["--help"]);
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let lines = list.lines().take_while(|line| line.starts_with("  "));
    let commands: Vec<(&str, &str)> = lines
        .filter_map(|line| line.trim().split_once("  "))
        .filter(|(name, _)| *name != "help")
        .collect();
    let helps: Vec<String> = commands
        .iter()
        .map(|(name, _)| run(&[name, "--help"]))
        .collect();
    let parsed: Vec<_> = helps.iter().map(|help| entries(help)).collect();
    let uses = |entry: &Entry| parsed.iter().filter(|(all, _)| all.contains(entry)).count();
    let mut page =
        "# Command line\n\n<!-- Generated by tests/book.rs from the texts of `--help`. -->\n\n"
            .to_owned();
    let (about, _) = help.split_once('\n').unwrap();
    let _ = writeln!(
        page,
        "{about}.\n\n| command | what it does |\n| --- | --- |"
    );
    for (name, about) in &commands {
        let _ = writeln!(page, "| [`rtc {name}`](#rtc-{name}) | {} |", about.trim());
    }
    let (_, codes) = help.split_once("Exit codes:\n").unwrap();
    page += "\n## Exit codes\n\n| exit code | means |\n| --: | --- |\n";
    for (code, means) in codes
        .lines()
        .filter_map(|line| line.trim().split_once("  "))
    {
        let _ = writeln!(page, "| {code} | {} |", means.trim());
    }
    let mut shared: Vec<&Entry> = Vec::new();
    for entry in parsed.iter().flat_map(|(all, _)| all) {
        if uses(entry) > 3 && entry.name.starts_with('-') && !shared.contains(&entry) {
            shared.push(entry);
        }
    }
    page +=
        "\n## Options of several commands\n\nThe list of each command names those that it takes.\n";
    page += &table(&shared);
    for (((name, about), help), (all, tail)) in commands.iter().zip(&helps).zip(&parsed) {
        let usage = help
            .lines()
            .find_map(|line| line.strip_prefix("Usage: "))
            .unwrap();
        let _ = write!(
            page,
            "\n## `rtc {name}`\n\n{}.\n\n```text\n{usage}\n```\n",
            about.trim()
        );
        let (common, own): (Vec<&Entry>, Vec<&Entry>) =
            all.iter().partition(|entry| shared.contains(entry));
        if !own.is_empty() {
            page += &table(&own);
        }
        let names = common.iter().map(|entry| format!("`{}`", entry.name));
        let names = names.collect::<Vec<_>>().join(", ");
        let _ = writeln!(page, "\nOptions shared with other commands: {names}.");
        if !tail.is_empty() {
            let _ = writeln!(page, "\n```text\n{tail}\n```");
        }
    }
    check("command-line.md", page.as_bytes());
}
