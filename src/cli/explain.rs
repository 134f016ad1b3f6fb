//! `rtc explain`: the long text of a code, or of all of them as a page of Markdown.

use super::args::Explain;
use super::{Failure, output};
use crate::diag::{Code, Severity, codes};

/// Columns of the text.
const WIDTH: usize = 80;

/// Prints the text of the code asked for.
pub(super) fn run(args: &Explain) -> Result<(), Failure> {
    let text = match &args.code {
        Some(id) => entry(codes::find(id).ok_or_else(|| unknown(id))?),
        None => page(),
    };
    output::to_stdout(text.as_bytes())
}

fn unknown(id: &str) -> Failure {
    Failure::Trouble(format!("there is no code `{}`; `rtc explain --all` lists them", id.escape_debug()))
}

/// `schema/diagnostics.md`.
fn page() -> String {
    let head =
        "# Diagnostics\n\nEvery code rtc gives, printed by `rtc explain --all`. A code never changes its meaning.\n";
    codes::all().fold(head.to_owned(), |page, code| format!("{page}\n{}", entry(code)))
}

fn entry(code: &Code) -> String {
    let Code { id, severity, summary, explanation } = code;
    let severity = match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    format!("## {id} ({severity}): {summary}\n\n{}", fill(explanation))
}

/// The words in lines of at most [`WIDTH`] characters.
fn fill(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a first line and none is taken away");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= WIDTH {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_filled_and_no_longer() {
        let text = "ab ".repeat(100);
        let filled = fill(&text);
        assert!(filled.lines().all(|line| line.len() <= WIDTH));
        assert_eq!(filled.lines().count(), 4);
        assert_eq!(filled.split_whitespace().count(), 100);
    }
}
