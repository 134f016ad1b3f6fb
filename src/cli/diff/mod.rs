//! `rtc diff`: the differences between two pictures, or two scenes and their pictures, or the
//! pictures or scenes of two folders, with gates.

mod folders;
mod pictures;
mod scenes;

use super::Failure;
use super::args::DiffArgs;
use super::gate::{self, GateResult};
use super::input;
use super::interrupt::Interrupt;
use super::output::{self, Output};
use super::reporter::Reporter;
use super::shown::over_limit;
use rtc_codec::ValueChange;
use rtc_diag::{Diagnostic, DiagnosticSink, clean, clean_lines, codes};
use rtc_image::{DisplayedPicture, FileFormat, Image, Picture};
use rtc_source::{Budget, Resource, SourceMap};
use rtc_study::{Difference, SliderPage, heat_map, slider_page, value_text};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

/// The results of a comparison, each fit to be written.
struct DiffOutputs {
    map: Option<Output>,
    page: Option<Output>,
}

impl DiffOutputs {
    fn are_none(&self) -> bool {
        self.map.is_none() && self.page.is_none()
    }
}

/// Bytes of a pixel that a map takes: FLIP, its colour, and the file.
const MAP_PIXEL: u64 = 40;

/// Bytes of a pixel that a page takes besides: both pictures and their copies.
const PAGE_PIXEL: u64 = 104;

/// Compares two pictures or two scenes, and reports the differences.
pub(super) fn run(args: &DiffArgs) -> Result<(), Failure> {
    if args.new.is_dir() && args.old.is_dir() {
        let mut reporter = Reporter::beside_result(&args.reporter);
        let outcome = folders::run(args, &mut reporter);
        reporter.finish()?;
        return outcome;
    }
    if args.table.is_some() {
        let message = "`--table` is of two folders; `--format` is of two files";
        return Err(Failure::Failed(message.to_owned()));
    }
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = match [&args.new, &args.old].map(|path| input::is_picture(path)) {
        [true, true] => pictures::run(args, &mut reporter),
        [false, false] => scenes::run(args, &mut reporter),
        [is_picture, _] => {
            let files = [&args.new, &args.old].map(|path| path.display());
            let (picture, scene) = (
                &files[usize::from(!is_picture)],
                &files[usize::from(is_picture)],
            );
            Err(Failure::Failed(format!(
                "`{picture}` is a picture, and `{scene}` a scene: compare two of a kind, or \
                render the scene"
            )))
        }
    };
    reporter.finish()?;
    outcome
}

/// The inputs of the comparison.
struct ComparedInputs<'a> {
    /// The new picture and the old one, of one size; none of files that are the same.
    pictures: Option<[&'a DisplayedPicture; 2]>,
    size: [u32; 2],
    /// What differs in their scenes.
    changes: Option<&'a [ValueChange]>,
}

/// The JSON report of a comparison.
#[derive(Serialize, JsonSchema)]
pub(super) struct DiffReport<'a> {
    /// The schema of this report: `rtc-diff/1`.
    #[schemars(extend("const" = "rtc-diff/1"))]
    schema: &'static str,
    /// The new picture or scene, as on the command line.
    picture: String,
    /// The old picture or scene.
    reference: String,
    /// Width and height of the pictures.
    size: [u32; 2],
    /// The difference of the pictures.
    difference: Difference,
    /// The gates of `--gate`, in their order.
    gates: &'a [GateResult],
    /// The values of the IR that differ; absent if pictures were compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    changes: Option<&'a [ValueChange]>,
}

/// Writes the requested files, reports the differences of pictures and scenes, and applies the
/// gates.
fn report(
    args: &DiffArgs,
    outputs: DiffOutputs,
    compared: &ComparedInputs<'_>,
    (map, reporter): (&SourceMap, &mut Reporter),
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let is_denied = warn_of_flat(args, compared, map, reporter)?;
    let budget = map.budget();
    let found = match compared.pictures {
        None => Difference::none(args.levels),
        Some([new, old]) if outputs.are_none() => Difference::of(new, old, args.levels),
        Some(pictures) => write(args, outputs, (compared, pictures), budget, interrupt)?,
    };
    let gates = args.gate.as_ref();
    let results = gates.map_or_else(Vec::new, |gates| {
        gates.results(|name| measure(&found, name))
    });
    if args.format.is_json() {
        output::print_json(&json(args, compared, &found, &results)?)?;
    } else if !args.reporter.quiet {
        let scenes = compared.changes.map_or_else(String::new, changed);
        output::print(&(scenes + &message(args, compared.size, &found)))?;
    }
    gate::pass(&results, args.reporter.quiet)?;
    match is_denied {
        true => Err(Failure::Reported),
        false => Ok(()),
    }
}

/// Warns of two pictures of one value each; true if that is an error.
fn warn_of_flat(
    args: &DiffArgs,
    compared: &ComparedInputs<'_>,
    map: &SourceMap,
    reporter: &mut Reporter,
) -> Result<bool, Failure> {
    let are_flat = |pictures: &[&DisplayedPicture; 2]| pictures.iter().all(|own| own.is_flat());
    if !compared.pictures.as_ref().is_some_and(are_flat) {
        return Ok(false);
    }
    let message = "both pictures are of one value each, so that they say little of their scenes";
    let found = Diagnostic::new(&codes::FLAT, message);
    let levels = args.reading.levels().map_err(Failure::Failed)?;
    let mut sink = DiagnosticSink::default().with_levels(levels);
    sink.push(found.hint("see whether anything is in view and lit"));
    let is_denied = sink.has_errors();
    reporter.file(&args.new.to_string_lossy(), sink, map)?;
    Ok(is_denied)
}

/// Writes the map and the page of two pictures, and hands on how they differ.
fn write(
    args: &DiffArgs,
    outputs: DiffOutputs,
    (compared, pictures): (&ComparedInputs<'_>, [&DisplayedPicture; 2]),
    budget: &Budget,
    interrupt: &Interrupt,
) -> Result<Difference, Failure> {
    let [width, height] = compared.size.map(u64::from);
    let bytes = width * height * (MAP_PIXEL + u64::from(outputs.page.is_some()) * PAGE_PIXEL);
    let charged = budget.charge(Resource::Memory, bytes);
    charged.map_err(|fault| over_limit("the files of the difference", &fault))?;
    let [new, old] = pictures;
    let (found, flips) = Difference::mapped(new, old, args.levels);
    if let Some(output) = outputs.map {
        output.commit(&map_file(heat_map(compared.size, &flips))?, interrupt)?;
    }
    if let Some(output) = outputs.page {
        let images = pictures.map(DisplayedPicture::image);
        let page = slider_page(&SliderPage {
            names: [&args.new, &args.old]
                .map(|path| page_name(path))
                .each_ref()
                .map(String::as_str),
            pictures: images.each_ref(),
            difference: &found,
            flips: &flips,
            changes: compared.changes,
        });
        output.commit(clean_lines(&page).as_bytes(), interrupt)?;
    }
    Ok(found)
}

/// The name of a file on a page, which is read elsewhere: without folders of this machine.
fn page_name(path: &Path) -> String {
    let shown = match path.is_absolute() {
        true => path.file_name().map_or(path, Path::new),
        false => path,
    };
    shown.display().to_string()
}

/// The map of differences as a PNG.
fn map_file(image: Image) -> Result<Vec<u8>, Failure> {
    let bytes = Picture::opaque(image).encode(FileFormat::Png8);
    bytes.map_err(|error| Failure::Failed(error.to_string()))
}

fn measure(found: &Difference, name: &str) -> f64 {
    match name {
        "rmse" => found.rmse,
        "max" => found.max,
        "relmse" => found.relative_mse,
        "flip" => found.flip,
        _ => found.fraction,
    }
}

/// What differs in the scenes, a line each.
fn changed(changes: &[ValueChange]) -> String {
    /// The maximum number of lines.
    const MOST: usize = 40;
    let line = |ValueChange { path, new, old }: &ValueChange| {
        let (new, old) = (value_text(new.as_ref()), value_text(old.as_ref()));
        format!("  {path}: {old} → {new}\n")
    };
    let lines: String = changes.iter().take(MOST).map(line).collect();
    match changes.len() {
        0 => "the scenes are alike\n".to_owned(),
        count if count > MOST => {
            let more = count - MOST;
            format!(
                "values that differ: {count}\n{lines}  and {more} more (`--format json` has all)\n"
            )
        }
        count => format!("values that differ: {count}\n{lines}"),
    }
}

fn message(args: &DiffArgs, [width, height]: [u32; 2], found: &Difference) -> String {
    let [new, old] = [&args.new, &args.old].map(|path| path.display().to_string());
    let names = format!("{} and {}: {width}×{height}", clean(&new), clean(&old));
    if found.is_none() {
        return format!("{names}, no difference\n");
    }
    let location = found.max_at.map_or_else(String::new, |[x, y]| {
        format!(", first in column {x}, row {y}")
    });
    let Difference {
        rmse,
        max,
        max_at: _,
        relative_mse,
        flip,
        fraction,
        levels,
    } = found;
    format!(
        "{names}\n\
         rmse    {rmse:.4} grey levels\n\
         max     {max:.2} grey levels{location}\n\
         relmse  {relative_mse:.3e}\n\
         flip    {flip:.6}\n\
         share   {:.4} % of the pixels are off by more than {levels} grey levels\n",
        100.0 * fraction
    )
}

fn json(
    args: &DiffArgs,
    compared: &ComparedInputs<'_>,
    found: &Difference,
    gates: &[GateResult],
) -> Result<String, Failure> {
    let report = DiffReport {
        schema: "rtc-diff/1",
        picture: args.new.display().to_string(),
        reference: args.old.display().to_string(),
        size: compared.size,
        difference: *found,
        gates,
        changes: compared.changes,
    };
    let text = serde_json::to_string_pretty(&report);
    text.map(|text| text + "\n")
        .map_err(|error| Failure::Failed(error.to_string()))
}
