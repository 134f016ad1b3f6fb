//! `rtc fmt`: formats scene texts, each by itself.

use super::args::FmtArgs;
use super::reporter::{self, Reporter};
use super::{Failure, edit, files, input, output};
use rtc_diag::clean;
use rtc_pipeline::{FormatTextError, Input, Options};
use std::path::Path;

/// Formats the files, or lists the unformatted ones.
pub(super) fn run(args: &FmtArgs) -> Result<(), Failure> {
    let mut reporter = Reporter::beside_result(&args.reporter);
    let mut worst = Ok(());
    let scenes = files::texts(&args.files)?;
    for path in &scenes.paths {
        match one(path, args, &mut reporter) {
            Err(gone @ Failure::ClosedPipe) => return Err(gone),
            Err(Failure::Failed(message)) => {
                reporter::print_message(&format!("error: {message}"));
                worst = Err(Failure::Unreadable);
            }
            Err(Failure::Input(message)) => {
                reporter::print_message(&format!("error: {message}"));
                worst = worst.and(Err(Failure::Reported));
            }
            Err(Failure::Reported) => worst = worst.and(Err(Failure::Reported)),
            Err(failure) => worst = Err(failure),
            Ok(()) => {}
        }
    }
    scenes.report_skipped(reporter.is_quiet());
    reporter.finish()?;
    worst
}

fn one(path: &Path, args: &FmtArgs, reporter: &mut Reporter) -> Result<(), Failure> {
    let mut input = input::open(path, None, Options::default());
    let formatted = input.format_text();
    input::report_diagnostics(&mut input, reporter)?;
    let text = match formatted {
        Ok(text) => text,
        Err(fault) => return unformatted(&input, fault, reporter.is_quiet()),
    };
    let before = input.text().unwrap_or_default();
    let is_stdin = path.as_os_str() == "-";
    let is_same = before == text;
    if args.diff && !is_same {
        edit::print(&edit::diff(input.name(), before, &text))?;
    } else if args.check && !is_same {
        output::print(&format!("{}\n", clean(input.name())))?;
    } else if is_stdin && !args.diff && !args.check {
        output::to_stdout(text.as_bytes())?;
    } else if !is_same {
        edit::write(path, before, &text)?;
        if !reporter.is_quiet() {
            reporter::print_message(&format!("{}: formatted", input.name()));
        }
    }
    match args.check && !is_same {
        true => Err(Failure::Reported),
        false => Ok(()),
    }
}

/// The outcome of a file that is left as it is. The YAML of another program is no mistake, as hooks
/// name all YAML files of a repository.
fn unformatted(input: &Input, fault: FormatTextError, is_quiet: bool) -> Result<(), Failure> {
    let name = input.name();
    Err(Failure::Input(match fault {
        FormatTextError::Reported => return Err(Failure::Reported),
        FormatTextError::NoScene => {
            if !is_quiet {
                reporter::print_message(&format!(
                    "`{name}` is unchanged: it has no key of a scene"
                ));
            }
            return Ok(());
        }
        FormatTextError::NoText => {
            format!("`{name}` is unchanged: only scene texts, YAML and JSON, are formatted")
        }
        FormatTextError::Differs => {
            format!("`{name}` is unchanged: formatting would change its meaning")
        }
    }))
}
