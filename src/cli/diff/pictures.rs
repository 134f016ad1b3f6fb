//! Two pictures from files; the memory for decoding is charged in advance.

use super::super::Failure;
use super::super::args::DiffArgs;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::super::reporter::Reporter;
use super::super::shown::{charge, decoded, opened, read};
use super::{ComparedInputs, DiffOutputs, report};
use rtc_image::{DisplayedFile, DisplayedPicture};
use rtc_source::{Budget, SourceMap};
use rtc_study::Difference;
use std::path::Path;

/// Compares two pictures, and reports the differences.
pub(super) fn run(args: &DiffArgs, reporter: &mut Reporter) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let map = SourceMap::with_limits(args.reading.limits(|_| ()));
    let (new, old) = (read(&args.new, &map)?, read(&args.old, &map)?);
    let open = |path: &Option<_>| {
        let path: Option<&Path> = path.as_deref();
        path.map(|path| Output::open_unless_read(path, &map))
            .transpose()
    };
    let outputs = DiffOutputs {
        map: open(&args.output)?,
        page: open(&args.html)?,
    };
    let budget = map.budget();
    let file = opened(&args.new, &new, budget)?;
    let same = ComparedInputs {
        pictures: None,
        size: file.size(),
        changes: None,
    };
    if new == old && outputs.are_none() {
        return report(args, outputs, &same, (&map, reporter), &interrupt);
    }
    let pictures = both(
        [&args.new, &args.old],
        file,
        opened(&args.old, &old, budget)?,
        budget,
    )?;
    let compared = ComparedInputs {
        pictures: Some(pictures.each_ref()),
        size: pictures[0].size(),
        changes: None,
    };
    report(args, outputs, &compared, (&map, reporter), &interrupt)
}

/// How the pictures in two files differ; `None` of the same bytes.
pub(super) fn difference(
    paths: [&Path; 2],
    args: &DiffArgs,
) -> Result<Option<Difference>, Failure> {
    let map = SourceMap::with_limits(args.reading.limits(|_| ()));
    let [new, old] = [read(paths[0], &map)?, read(paths[1], &map)?];
    let budget = map.budget();
    let files = [
        opened(paths[0], &new, budget)?,
        opened(paths[1], &old, budget)?,
    ];
    if new == old {
        return Ok(None);
    }
    let [first, second] = files;
    let [new, old] = both(paths, first, second, budget)?;
    Ok(Some(Difference::of(&new, &old, args.levels)))
}

/// Decodes two pictures that can be compared.
fn both(
    paths: [&Path; 2],
    new: DisplayedFile<'_>,
    old: DisplayedFile<'_>,
    budget: &Budget,
) -> Result<[DisplayedPicture; 2], Failure> {
    fitting(paths, &new, &old)?;
    charge(paths[0], new.cost(), budget)?;
    charge(paths[1], old.cost(), budget)?;
    let pictures = [decoded(paths[0], new)?, decoded(paths[1], old)?];
    match pictures.each_ref().map(DisplayedPicture::size) {
        [a, b] if a == b => Ok(pictures),
        other => Err(sizes(paths, other)),
    }
}

/// Refuses pictures that can't be compared.
fn fitting(
    paths: [&Path; 2],
    new: &DisplayedFile<'_>,
    old: &DisplayedFile<'_>,
) -> Result<(), Failure> {
    if new.holds_light() != old.holds_light() {
        let names = paths.map(|path| path.display());
        let light = usize::from(old.holds_light());
        return Err(Failure::Failed(format!(
            "`{}` holds values of light, and `{}` those of a display: compare two of a kind",
            names[light],
            names[1 - light]
        )));
    }
    // The layer of an EXR that is compared may be smaller than its largest.
    match new.size() == old.size() || new.holds_light() {
        true => Ok(()),
        false => Err(sizes(paths, [new.size(), old.size()])),
    }
}

fn sizes(paths: [&Path; 2], [a, b]: [[u32; 2]; 2]) -> Failure {
    let names = paths.map(|path| path.display());
    Failure::Failed(format!(
        "pictures of one size are compared: `{}` has {} × {} pixels, `{}` {} × {}",
        names[0], a[0], a[1], names[1], b[0], b[1]
    ))
}
