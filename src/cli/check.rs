//! `rtc check`: every file is checked, whatever is found in those before.

use super::Failure;
use super::args::CheckArgs;
use super::reporter::{self, Reporter};
use super::{files, fix, input};

/// Checks the files and reports their diagnostics.
pub(super) fn run(args: &CheckArgs) -> Result<(), Failure> {
    // The printed diff is the result of the command.
    let mut reporter = match args.diff {
        true => Reporter::beside_result(&args.reporter),
        false => Reporter::as_result(&args.reporter),
    };
    let mut worst = Ok(());
    let scenes = files::scenes(&args.files, args.skip_others)?;
    for path in &scenes.paths {
        let read = input::read(path, &args.reading)?;
        let mut input = match fix::run(path, read, args, &reporter) {
            Ok(input) => input,
            Err(Failure::Failed(message)) => {
                reporter::print_message(&format!("error: {message}"));
                worst = Err(Failure::Unreadable);
                continue;
            }
            Err(failure) => return Err(failure),
        };
        if let Some(loaded) = input.load() {
            input.validate(loaded, |_, _| ());
        }
        match input::report_diagnostics(&mut input, &mut reporter) {
            Err(gone @ Failure::ClosedPipe) => return Err(gone),
            Err(Failure::Reported) if worst.is_err() => {}
            Err(failure) => worst = Err(failure),
            Ok(()) => {}
        }
    }
    let is_in_doubt = reporter.left_in_doubt();
    scenes.report_skipped(reporter.is_quiet());
    reporter.finish()?;
    if worst.is_ok() && is_in_doubt {
        reporter::print_message(&nothing_found(scenes.paths.len()));
    }
    worst
}

/// The summary for files without errors.
fn nothing_found(files: usize) -> String {
    match files {
        1 => "1 scene, no findings".to_owned(),
        _ => format!("{files} scenes, no findings"),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_scene_is_one() {
        assert_eq!(super::nothing_found(1), "1 scene, no findings");
        assert_eq!(super::nothing_found(12), "12 scenes, no findings");
    }
}
