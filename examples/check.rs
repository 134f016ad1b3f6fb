//! Checks a scene for a program, as an editor would: `cargo run --example check SCENE`.

#![expect(clippy::print_stdout, reason = "it speaks to the one who runs it")]

use rtc::{Error, Scene};

fn main() -> Result<(), Error> {
    let lines = check(&std::env::args().nth(1).unwrap_or_default())?;
    lines.iter().for_each(|line| println!("{line}"));
    Ok(())
}

pub(crate) fn check(path: &str) -> Result<Vec<String>, Error> {
    let mut lines = Vec::new();
    for finding in Scene::open(path)?.check() {
        lines.push(finding.short());
        for edit in finding
            .hints
            .iter()
            .filter_map(|hint| hint.replacement.as_ref())
        {
            let bytes = &edit.location.bytes;
            lines.push(format!("  bytes {bytes:?} become `{}`", edit.text));
        }
    }
    Ok(lines)
}
