//! `rtc check --fix` and `--diff`: applies the suggested fixes to files or prints them.

use super::args::CheckArgs;
use super::project::Project;
use super::reporter::{self, Reporter};
use super::{Failure, edit, input};
use rtc_diag::plural;
use rtc_pipeline::{self as pipeline, FixFilter, FixedText, Input};
use std::path::Path;

/// Fixes the scene that was read from `path`, or prints the changes; returns the fixed scene.
pub(super) fn run(
    path: &Path,
    read: Input,
    args: &CheckArgs,
    reporter: &Reporter,
) -> Result<Input, Failure> {
    let Some(text) = read.text().filter(|_| args.fix || args.diff) else {
        return Ok(read);
    };
    // Fixing needs a file to write to, unless only the changes are shown.
    let is_file = path.as_os_str() != "-";
    if !is_file && !args.diff {
        return Err(Failure::Failed(
            "standard input can't be fixed; give a file, or `--diff`".to_owned(),
        ));
    }
    // Apply the fixes.
    let project = Project::of(path, &args.reading)?;
    let options = input::options(&args.reading, project.as_ref())?;
    let wish = FixFilter {
        guesses: args.guesses,
        only: None,
    };
    let fixed = pipeline::fix(path, text, &options, &wish);
    if !reporter.is_quiet() {
        report_changes(read.name(), &fixed, args.diff);
    }
    if fixed.changes == 0 {
        return Ok(read);
    }
    // Show the changes, or write the text and go on with it.
    if args.diff {
        edit::print(&edit::diff(read.name(), text, &fixed.text))?;
        return Ok(read);
    }
    edit::write(path, text, &fixed.text)?;
    let mut input = Input::edited(path, fixed.text.into_bytes(), options);
    if let Some(project) = project {
        project.report_diagnostics(&mut input);
    }
    Ok(input)
}

/// Reports the applied fixes, and the rejected ones with reasons.
fn report_changes(name: &str, fixed: &FixedText, is_shown: bool) {
    let changes = |count| plural(count, "change");
    let FixedText {
        text: _,
        changes: made,
        rejected: refused,
        guesses,
    } = *fixed;
    if made > 0 {
        let what = if is_shown { "proposed" } else { "made" };
        reporter::print_message(&format!("{name}: {} {what}", changes(made)));
    }
    if refused > 0 {
        reporter::print_message(&format!(
            "{name}: {} left out, which would not make the check better",
            changes(refused)
        ));
    }
    if guesses > 0 {
        reporter::print_message(&format!(
            "{name}: {} skipped as guesses; `--unsafe` applies guesses, too",
            changes(guesses)
        ));
    }
}
