//! The pictures of two folders: those of one name are compared, in one table with a total.

use super::super::args::{DiffArgs, TableFormat};
use super::super::interrupt::Interrupt;
use super::super::table::{FileTable, TableCell};
use super::super::{Failure, files, output, reporter};
use super::{measure, pictures};
use rtc_study::Difference;
use std::path::Path;

/// What was found of one name.
enum Comparison {
    /// Both pictures, and how they differ.
    Of(Difference),
    /// There is one picture alone, or they can't be compared, for this reason.
    Failed(String),
}

/// Compares the pictures of two folders, prints their table, and applies the gates to each pair.
pub(super) fn run(args: &DiffArgs) -> Result<(), Failure> {
    if args.output.is_some() || args.html.is_some() {
        let message = "`--output` and `--html` are of two pictures; compare those that differ";
        return Err(Failure::Failed(message.to_owned()));
    }
    let interrupt = Interrupt::listen()?;
    let [new, old] = [files::pictures(&args.new)?, files::pictures(&args.old)?];
    if new.is_empty() && old.is_empty() {
        let message = "there are no pictures in these folders; render their scenes first";
        return Err(Failure::Failed(message.to_owned()));
    }
    let (mut rows, mut failed, mut lacking) = (Vec::new(), false, false);
    for path in new.union(&old) {
        if interrupt.is_raised() {
            return Err(Failure::Interrupted);
        }
        let found = compare(args, path, [new.contains(path), old.contains(path)])?;
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
        output::to_stdout(table(rows).print(format).as_bytes())?;
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

/// Compares the two pictures of a name, of which one may be missing.
fn compare(args: &DiffArgs, path: &Path, is_there: [bool; 2]) -> Result<Comparison, Failure> {
    let alone = |folder: &Path| Comparison::Failed(format!("only in {}", folder.display()));
    let paths = [args.new.join(path), args.old.join(path)];
    match is_there {
        [true, true] => {}
        [true, false] => return Ok(alone(&args.new)),
        [false, _] => return Ok(alone(&args.old)),
    }
    match pictures::difference(paths.each_ref().map(AsRef::as_ref), args) {
        Ok(found) => Ok(Comparison::Of(
            found.unwrap_or_else(|| Difference::none(args.levels)),
        )),
        Err(Failure::Failed(message)) => Ok(Comparison::Failed(message)),
        Err(failure) => Err(failure),
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
        Comparison::Of(found) => measures(found),
        Comparison::Failed(_) => [const { TableCell::Absent }; 4],
    });
    row
}

/// The measures of a difference that a table has.
fn measures(found: &Difference) -> [TableCell; 4] {
    [
        TableCell::Measure(found.rmse, 4),
        TableCell::Measure(found.max, 2),
        TableCell::Measure(found.flip, 6),
        TableCell::Measure(found.fraction, 6),
    ]
}

/// The table of all pairs; the total has the largest of each measure.
fn table(rows: Vec<(Vec<TableCell>, Comparison)>) -> FileTable {
    let most = |of: fn(&Difference) -> f64| {
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
    let total = vec![
        TableCell::Text(format!("{} pictures", rows.len())),
        TableCell::Text(result),
        TableCell::Measure(most(|found| found.rmse), 4),
        TableCell::Measure(most(|found| found.max), 2),
        TableCell::Measure(most(|found| found.flip), 6),
        TableCell::Measure(most(|found| found.fraction), 6),
    ];
    FileTable {
        schema: "rtc-diff-table/1",
        columns: &["picture", "result", "rmse", "max", "flip", "share"],
        total,
        rows: rows.into_iter().map(|(row, _)| row).collect(),
    }
}
