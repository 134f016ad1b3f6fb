//! What the packages weigh. `RTC_UPDATE=1 cargo test --test suites weight::` writes
//! `tests/weight.txt`.

use super::circles::circles;
use super::{manifests, rust_files};
use crate::repo::root;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::{env, fs};

/// A package may be so many per cent heavier, or lighter, than its row says.
const PERCENT: (usize, usize) = (2, 5);

/// The most files of a circle that need no row of their own.
const SMALL_CIRCLE: usize = 5;

const HEAD: &str = "\
# Lines of code of each package, without tests, comments and blank lines, and the files of its
# largest circle. RTC_UPDATE=1 cargo test --test suites weight:: writes this table. A commit that
# makes a package more than 2 % heavier, or a circle larger, says why in its body.
";

/// What a package weighs.
#[derive(Clone, Copy)]
struct Weight {
    /// Lines of code.
    lines: usize,
    /// The number of files in its largest circle, if that is not small.
    circle: usize,
}

fn weigh(package: &str) -> Weight {
    let mut files = rust_files(&format!("src/{package}"));
    let base = if package == "api" {
        // The library has no folder of its own.
        files.extend(
            ["src/api.rs", "src/lib.rs"]
                .into_iter()
                .flat_map(rust_files),
        );
        "src".to_owned()
    } else {
        format!("src/{package}")
    };
    let lines = files.iter().map(|(path, text)| lines_of_code(path, text));
    let circles = circles(&base, &files);
    let largest = circles.first().map_or(0, Vec::len);
    Weight {
        lines: lines.sum(),
        circle: if largest > SMALL_CIRCLE { largest } else { 0 },
    }
}

/// The lines of a file that are code of the program.
fn lines_of_code(path: &str, text: &str) -> usize {
    if path.ends_with("tests.rs") || path.contains("/tests/") {
        return 0;
    }
    // Tests stand at the foot of a file, or in a file of their own.
    let foot = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
    text[..foot].lines().filter(is_code).count()
}

/// The table, package by package.
fn read(table: &str) -> BTreeMap<&str, Weight> {
    let rows = table.lines().filter(|line| !line.starts_with('#'));
    rows.map(|line| {
        let mut words = line.split_whitespace();
        let package = words.next().unwrap();
        let mut number = || words.next().map_or(0, |word| word.parse().unwrap());
        let (lines, circle) = (number(), number());
        (package, Weight { lines, circle })
    })
    .collect()
}

#[test]
fn packages_weigh_what_their_rows_say() {
    let found = manifests().into_iter();
    let found: BTreeMap<String, Weight> = found
        .map(|(package, _)| {
            let weight = weigh(&package);
            (package, weight)
        })
        .collect();
    let mut text = HEAD.to_owned();
    for (package, Weight { lines, circle }) in &found {
        write!(text, "{package} {lines}").unwrap();
        if *circle > 0 {
            write!(text, " {circle}").unwrap();
        }
        text.push('\n');
    }
    if env::var_os("RTC_UPDATE").is_some() {
        fs::write(root("tests/weight.txt"), &text).unwrap();
    }
    let table = fs::read_to_string(root("tests/weight.txt")).unwrap();
    let rows = read(&table);
    let mut faults = Vec::new();
    for (package, weight) in &found {
        let row = rows.get(package.as_str());
        let row = row.unwrap_or(&Weight {
            lines: 0,
            circle: 0,
        });
        let heaviest = row.lines * (100 + PERCENT.0);
        let lightest = row.lines * (100 - PERCENT.1);
        if !(lightest..=heaviest).contains(&(weight.lines * 100)) {
            faults.push(format!(
                "{package}: {} lines, {} in its row",
                weight.lines, row.lines
            ));
        }
        if weight.circle != row.circle {
            faults.push(format!(
                "{package}: a circle of {}, not {}",
                weight.circle, row.circle
            ));
        }
    }
    assert_eq!(rows.len(), found.len(), "one row for each package");
    assert!(faults.is_empty(), "{}\n{HEAD}", faults.join("\n"));
}
