//! The links of the documentation lead somewhere, and the book holds all of its chapters.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]

use crate::repo::{files, root};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

const BOOK: &str = "docs/book/src";

/// Chapters whose links may also lead to scenes and programs of the repository.
const GUIDE: &[&str] = &["tutorial", "cookbook", "gallery.md", "getting-started.md"];

/// The pages whose links are checked.
fn pages() -> Vec<PathBuf> {
    let single = [
        "README.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "SECURITY.md",
    ]
    .map(root);
    let folders = ["docs", "schema", "benches"].map(|folder| files(&root(folder), &["md"]));
    single.into_iter().chain(folders.concat()).collect()
}

/// A path without `.` and `..`.
fn normal(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::CurDir => {}
            part => parts.push(part),
        }
    }
    parts
}

/// The text of a page, with what `{{#include FILE}}` puts there.
fn text(path: &Path) -> String {
    let mut text = String::new();
    for line in fs::read_to_string(path).unwrap().lines() {
        let file = line
            .strip_prefix("{{#include ")
            .and_then(|line| line.strip_suffix("}}"));
        match file {
            Some(file) => {
                let included = normal(&path.parent().unwrap().join(file));
                assert!(included.is_file(), "{}: no {file}", path.display());
                text += &fs::read_to_string(included).unwrap();
            }
            None => text += line,
        }
        text.push('\n');
    }
    text
}

/// The lines of a text outside of blocks of code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The anchors of the headings of a text.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter(|line| line.starts_with('#'));
    let mut found = BTreeSet::new();
    for heading in headings {
        let heading = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = heading
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let anchor: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        found.insert(anchor);
    }
    found
}

/// The targets of the links and pictures of a line, without those in code.
fn targets(line: &str) -> Vec<String> {
    let outside: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
    let parts = outside.split("](").skip(1);
    parts
        .filter_map(|part| Some(part.split_once(')')?.0.to_owned()))
        .filter(|target| !target.contains("://"))
        .collect()
}

/// What is wrong with a link of a page.
fn fault(page: &Path, target: &str) -> Option<String> {
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path = match file {
        "" => page.to_owned(),
        file => normal(&page.parent().unwrap().join(file)),
    };
    let book = root(BOOK);
    if !path.exists() {
        return Some("no such file".to_owned());
    }
    let is_guide = GUIDE.iter().any(|part| page.starts_with(book.join(part)));
    if page.starts_with(&book) && !path.starts_with(&book) && !is_guide {
        return Some("leaves the book".to_owned());
    }
    let is_known = anchor.is_empty() || anchors(&text(&path)).contains(anchor);
    (!is_known).then(|| "no such heading".to_owned())
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let (mut faults, mut count) = (Vec::new(), 0);
    for page in pages() {
        let text = text(&page);
        for target in prose(&text).flat_map(targets) {
            count += 1;
            let fault = fault(&page, &target);
            faults.extend(fault.map(|fault| format!("{}: {target}: {fault}", page.display())));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 100, "{count}");
}

#[test]
fn the_summary_lists_every_chapter_of_the_book() {
    let summary = fs::read_to_string(root(BOOK).join("SUMMARY.md")).unwrap();
    let listed: Vec<String> = summary.lines().flat_map(targets).collect();
    let unique: BTreeSet<_> = listed
        .iter()
        .map(|target| root(BOOK).join(target))
        .collect();
    assert_eq!(unique.len(), listed.len(), "a chapter is listed twice");
    let written = files(&root(BOOK), &["md"]).into_iter();
    let written: BTreeSet<_> = written
        .filter(|path| !path.ends_with("SUMMARY.md"))
        .collect();
    assert_eq!(unique, written);
}

#[test]
fn anchors_are_those_of_the_book() {
    let found = anchors("# A `b` of C: d\n```\n# no\n```\n## `--x`");
    assert_eq!(found, ["--x", "a-b-of-c-d"].map(str::to_owned).into());
    assert_eq!(
        targets("[a](b.md#c) `[d](e)` ![f](g.png)"),
        ["b.md#c", "g.png"]
    );
}
