//! `rtc explain`: the long text of a code, or of all of them as a page of Markdown.

use super::args::ExplainArgs;
use super::{Failure, output};
use rtc_diag::{clip, codes};
use rtc_pipeline::{explain_code, explanation};
use rtc_plan::Rule;

/// Prints the text of a code.
pub(super) fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let text = match &args.code {
        Some(id) => explanation(id).ok_or_else(|| unknown(id))?,
        None if args.all => page(),
        None => list(),
    };
    output::to_stdout(text.as_bytes())
}

/// All codes and rules, one line each.
fn list() -> String {
    let codes = codes::all().map(|code| {
        format!(
            "{}  {:7}  {}\n",
            code.id,
            code.severity.name(),
            code.summary
        )
    });
    let rules = Rule::ALL.iter().map(|rule| format!("  {}\n", rule.name()));
    format!(
        "Codes of diagnostics; `rtc explain CODE` explains one:\n\n{}\n\
         Rules of the plan, which leave out effects; `rtc explain RULE` explains one:\n\n{}",
        codes.collect::<String>(),
        rules.collect::<String>()
    )
}

fn unknown(id: &str) -> Failure {
    Failure::Failed(format!(
        "there is no code `{}`; `rtc explain` lists them",
        clip(id)
    ))
}

/// The text before the codes.
const HEAD: &str = "\
# Diagnostics

Every code rtc gives, printed by `rtc explain --all`. A code never changes its
meaning. `--strict` makes some warnings errors, `--lenient` some errors warnings.

With `--message-format json` each finding is one line, an object with

- `code`, `severity` (`error`, `warning` or `note`) and `message`;
- `file`: the file that was checked;
- `primary`: the culprit, or null: `file`, `byteStart`, `byteEnd`, `start` and
  `end` (each `line` and `column` from 1, columns in characters; absent where
  the file is not text) and `text`, what is there;
- `labels`: other places that matter, each like `primary`;
- `hints`: what to do, each with `text` and `replacement`, which is null or
  like `primary`, its `text` being what to put there, and its `guess` whether that
  is only what was most likely meant, so that `rtc check --fix` leaves it alone
  without `--unsafe`;
- `pointer`: a JSON pointer to the culprit, or null;
- `alias`: the name of the finding in the glTF validator of Khronos, if it has one.

If more was found than `--max-errors`, a last line `{\"omitted\": N}` says how
much.
";

/// `schema/diagnostics.md`.
fn page() -> String {
    codes::all().fold(HEAD.to_owned(), |page, code| {
        format!("{page}\n{}", explain_code(code))
    })
}
