//! The pictures of two folders, or the scenes of folders without pictures: those of one name are
//! compared, in one table with a total.

use super::super::args::{DiffArgs, TableFormat};
use super::super::interrupt::Interrupt;
use super::super::reporter::Reporter;
use super::super::table::{FileTable, TableCell};
use super::super::{Failure, files, output, reporter};
use super::{measure, pictures, scenes};
use rtc_diag::plural;
use rtc_study::Difference;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What was found of one name.
enum Comparison {
    /// Both pictures, and how they differ.
    Of(Difference),
    /// There is one picture alone, or they can't be compared, for this reason.
    Failed(String),
}

/// What is compared in the folders.
#[derive(Clone, Copy)]
enum ComparedKind {
    Pictures,
    Scenes,
}

/// The files that the new and the old folder have of one kind: pictures, or else scenes.
fn listed(args: &DiffArgs) -> Result<(ComparedKind, [BTreeSet<PathBuf>; 2]), Failure> {
    let found = [files::pictures(&args.new)?, files::pictures(&args.old)?];
    if found.iter().any(|files| !files.is_empty()) {
        return Ok((ComparedKind::Pictures, found));
    }
    let found = [
        files::scenes_below(&args.new)?,
        files::scenes_below(&args.old)?,
    ];
    match found.iter().all(BTreeSet::is_empty) {
        true => {
            let message = "there are no pictures and no scenes in these folders";
            Err(Failure::Failed(message.to_owned()))
        }
        false => Ok((ComparedKind::Scenes, found)),
    }
}

/// Compares the files of two folders, prints their table, and applies the gates to each pair.
pub(super) fn run(args: &DiffArgs, reporter: &mut Reporter) -> Result<(), Failure> {
    if args.output.is_some() || args.html.is_some() {
        let message = "`--output` and `--html` are of two files; compare those that differ";
        return Err(Failure::Failed(message.to_owned()));
    }
    let interrupt = Interrupt::listen()?;
    let (kind, [new, old]) = listed(args)?;
    let (mut rows, mut failed, mut lacking) = (Vec::new(), false, false);
    for path in new.union(&old) {
        if interrupt.is_raised() {
            return Err(Failure::Interrupted);
        }
        let found = match [new.contains(path), old.contains(path)] {
            [true, true] => compare(args, kind, path, reporter, &interrupt)?,
            [true, false] => alone(&args.new),
            [false, _] => alone(&args.old),
        };
        let has_passed = has_passed(args, &found);
        failed |= has_passed == Some(false);
        lacking |= matches!(found, Comparison::Failed(_));
        rows.push((row(path, &found, has_passed), found));
    }
    let format = match (args.table, args.format.is_json()) {
        (Some(format), _) => format,
        (None, true) => TableFormat::Json,
        (None, false) => TableFormat::Text,
    };
    if !args.reporter.quiet || format != TableFormat::Text {
        output::to_stdout(table(kind, rows).print(format).as_bytes())?;
    }
    match (failed, lacking) {
        (true, _) => {
            reporter::print_message("gate failed: see the table");
            Err(Failure::Reported)
        }
        (false, true) => Err(Failure::Unreadable),
        (false, false) => Ok(()),
    }
}

/// A file that one folder alone has.
fn alone(folder: &Path) -> Comparison {
    Comparison::Failed(format!("only in {}", folder.display()))
}

/// Compares the two files of a name.
fn compare(
    args: &DiffArgs,
    kind: ComparedKind,
    path: &Path,
    reporter: &mut Reporter,
    interrupt: &Interrupt,
) -> Result<Comparison, Failure> {
    let paths = [args.new.join(path), args.old.join(path)];
    let paths = paths.each_ref().map(AsRef::as_ref);
    let found = match kind {
        ComparedKind::Pictures => pictures::difference(paths, args),
        ComparedKind::Scenes => scenes::difference(paths, args, reporter, interrupt).map(Some),
    };
    match found {
        Ok(found) => Ok(Comparison::Of(
            found.unwrap_or_else(|| Difference::none(args.levels)),
        )),
        Err(Failure::Failed(message) | Failure::Input(message)) => Ok(Comparison::Failed(message)),
        Err(Failure::Reported) => Ok(Comparison::Failed("one has errors".to_owned())),
        Err(Failure::Unreadable) => Ok(Comparison::Failed("one can't be read".to_owned())),
        Err(stopped @ (Failure::Interrupted | Failure::ClosedPipe)) => Err(stopped),
    }
}

/// Whether a pair passes all gates; `None` without gates. What can't be compared passes none.
fn has_passed(args: &DiffArgs, found: &Comparison) -> Option<bool> {
    let gates = args.gate.as_ref()?;
    Some(match found {
        Comparison::Failed(_) => false,
        Comparison::Of(found) => {
            let results = gates.results(|name| measure(found, name));
            results.iter().all(|gate| gate.passed)
        }
    })
}

/// The row of a name.
fn row(path: &Path, found: &Comparison, has_passed: Option<bool>) -> Vec<TableCell> {
    let result = match (found, has_passed) {
        (Comparison::Failed(reason), _) => reason,
        (Comparison::Of(_), Some(false)) => "gate failed",
        (Comparison::Of(found), _) if found.is_none() => "same",
        (Comparison::Of(_), _) => "differs",
    };
    let name = TableCell::Text(path.display().to_string());
    let mut row = vec![name, TableCell::Text(result.to_owned())];
    row.extend(match found {
        Comparison::Of(found) => measures(|of| of(found)),
        Comparison::Failed(_) => [const { TableCell::Absent }; 4],
    });
    row
}

/// A measure of a difference.
type Measure = fn(&Difference) -> f64;

/// The measures that a table has, by the value of each.
fn measures(value: impl Fn(Measure) -> f64) -> [TableCell; 4] {
    let cell = |of: Measure, decimals| TableCell::Measure(value(of), decimals);
    [
        cell(|found| found.rmse, 4),
        cell(|found| found.max, 2),
        cell(|found| found.flip, 6),
        cell(|found| found.fraction, 6),
    ]
}

/// The table of all pairs; the total has the largest of each measure.
fn table(kind: ComparedKind, rows: Vec<(Vec<TableCell>, Comparison)>) -> FileTable {
    let most = |of: Measure| {
        let values = rows.iter().filter_map(|(_, found)| match found {
            Comparison::Of(found) => Some(of(found)),
            Comparison::Failed(_) => None,
        });
        values.fold(0.0, f64::max)
    };
    let count = |is: fn(&Comparison) -> bool| rows.iter().filter(|(_, found)| is(found)).count();
    let same = count(|found| matches!(found, Comparison::Of(found) if found.is_none()));
    let lacking = count(|found| matches!(found, Comparison::Failed(_)));
    let result = format!(
        "{same} same, {} differ, {lacking} not compared",
        rows.len() - same - lacking
    );
    let mut total = vec![
        TableCell::Text(plural(
            rows.len(),
            match kind {
                ComparedKind::Pictures => "picture",
                ComparedKind::Scenes => "scene",
            },
        )),
        TableCell::Text(result),
    ];
    total.extend(measures(most));
    FileTable {
        schema: "rtc-diff-table/1",
        columns: &["file", "result", "rmse", "max", "flip", "share"],
        total,
        rows: rows.into_iter().map(|(row, _)| row).collect(),
    }
}
