//! `rtc check`: every file is checked, whatever is found in those before.

use super::Failure;
use super::args::CheckArgs;
use super::reporter::{self, Reporter};
use super::table::{FileTable, TableCell};
use super::{files, fix, input, output};
use rtc_diag::plural;
use std::path::Path;

/// Checks the files and reports their diagnostics.
pub(super) fn run(args: &CheckArgs) -> Result<(), Failure> {
    // The printed diff or table is the result of the command.
    let mut reporter = match args.diff || args.table.is_some() {
        true => Reporter::beside_result(&args.reporter),
        false => Reporter::as_result(&args.reporter),
    };
    let mut worst = Ok(());
    let scenes = files::scenes(&args.files, args.skip_others)?;
    let mut rows = Vec::new();
    for path in &scenes.paths {
        let read = input::read(path, &args.reading)?;
        let mut input = match fix::run(path, read, args, &reporter) {
            Ok(input) => input,
            Err(Failure::Failed(message)) => {
                reporter::print_message(&format!("error: {message}"));
                worst = Err(Failure::Unreadable);
                rows.push(row(path, [1, 0, 0]));
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
        rows.push(row(path, reporter.last_counts()));
    }
    let is_in_doubt = reporter.left_in_doubt();
    scenes.report_skipped(reporter.is_quiet());
    reporter.finish()?;
    if let Some(format) = args.table {
        output::to_stdout(table(rows).print(format).as_bytes())?;
    } else if worst.is_ok() && is_in_doubt {
        reporter::print_message(&nothing_found(scenes.paths.len()));
    }
    worst
}

/// The row of a file with so many errors, warnings and notes.
fn row(path: &Path, counts: [usize; 3]) -> (TableCell, [usize; 3]) {
    (TableCell::Text(path.display().to_string()), counts)
}

/// The table of the files, and their total.
fn table(rows: Vec<(TableCell, [usize; 3])>) -> FileTable {
    let sum = |k: usize| rows.iter().map(|(_, counts)| counts[k]).sum();
    let files = plural(rows.len(), "file");
    let line = |name, counts: [usize; 3]| {
        let counts = counts.map(TableCell::Count);
        [name].into_iter().chain(counts).collect()
    };
    FileTable {
        schema: "rtc-check-table/1",
        columns: &["file", "errors", "warnings", "notes"],
        total: line(TableCell::Text(files), [sum(0), sum(1), sum(2)]),
        rows: rows
            .into_iter()
            .map(|(name, counts)| line(name, counts))
            .collect(),
    }
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
