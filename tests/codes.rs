//! The table of codes is sound, and `schema/diagnostics.md` is what `rtc explain --all` prints.
//!
//! `RTC_UPDATE=1 cargo test --test suites codes::` rewrites the page.

#![expect(clippy::disallowed_methods, reason = "reads and renews what it checks")]
use rtc::internals::diag::codes;
use std::path::Path;
use std::process::Command;

#[test]
fn ids_are_a_family_and_a_number_and_ascend() {
    for code in codes::all() {
        let (family, number) = code.id.split_at(2);
        assert!(
            [
                "IO", "SY", "SC", "RE", "VA", "GL", "MI", "PB", "US", "IR", "RD", "EX"
            ]
            .contains(&family),
            "{code}"
        );
        assert!(
            number.len() == 3 && number.bytes().all(|byte| byte.is_ascii_digit()),
            "{code}"
        );
    }
    let ids: Vec<&str> = codes::all().map(|code| code.id).collect();
    for pair in ids
        .windows(2)
        .filter(|pair| pair[0].get(..2) == pair[1].get(..2))
    {
        assert!(pair[0] < pair[1], "{} stands before {}", pair[0], pair[1]);
    }
}

#[test]
fn summaries_are_one_line_without_a_stop_and_explanations_are_sentences() {
    for code in codes::all() {
        let first = code.summary.chars().next().unwrap();
        assert!(
            !first.is_uppercase() || code.summary.starts_with("YAML"),
            "{code}: {}",
            code.summary
        );
        assert!(
            !code.summary.ends_with('.') && code.summary.len() <= 80,
            "{code}: {}",
            code.summary
        );
        assert!(
            code.explanation().ends_with('.') && code.page().contains("**Why it matters:**"),
            "{code}"
        );
    }
}

#[test]
fn every_code_is_found_in_any_case() {
    assert!(codes::all().all(|code| codes::find(&code.id.to_lowercase()) == Some(code)));
    assert_eq!(codes::find("VA"), None);
}

#[test]
fn the_page_is_current() {
    let page = Command::new(env!("CARGO_BIN_EXE_rtc"))
        .args(["explain", "--all"])
        .output()
        .unwrap()
        .stdout;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema/diagnostics.md");
    if std::env::var_os("RTC_UPDATE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed.as_bytes() == page,
        "schema/diagnostics.md is out of date; RTC_UPDATE=1 renews it"
    );
}
