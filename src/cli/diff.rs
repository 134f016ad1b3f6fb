//! `rtc diff`: how far two pictures are apart, and whether that is within gates.

use super::Failure;
use super::args::Diff;
use super::gate::{self, JudgedGate};
use super::interrupt::Interrupt;
use super::output::{self, Output};
use crate::image::{FileFormat, Picture, ShownPicture};
use crate::source::{Loader, SourceMap};
use crate::study::{Difference, heat_map};
use std::path::Path;

/// The largest picture file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 32;

/// The most pixels of a picture, unless more are allowed: some 200 bytes each are taken for two pictures
/// and what the eye makes of them.
const MAX_PIXELS: u64 = 1 << 25;

/// Compares two pictures, and says how they differ.
pub(super) fn run(args: &Diff) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let map = SourceMap::default();
    let picture = read(&args.picture, args, &map)?;
    let reference = read(&args.reference, args, &map)?;
    let size = fitting(args, &picture, &reference)?;
    let output = args
        .output
        .as_deref()
        .map(|path| Output::apart_from(path, &map));
    let output = output.transpose()?;
    let (found, flips) = Difference::of(&picture, &reference, args.levels);
    if let Some(output) = output {
        output.commit(&map_file(size, &flips)?, &interrupt)?;
    }
    let gates = args.gate.as_ref();
    let judged = gates.map_or_else(Vec::new, |gates| gates.judged(|name| measure(&found, name)));
    if args.json {
        output::to_stdout(json(args, size, &found, &judged)?.as_bytes())?;
    } else if !args.quiet {
        output::to_stdout(words(args, size, &found).as_bytes())?;
    }
    gate::pass(&judged, args.quiet)
}

fn read(path: &Path, args: &Diff, map: &SourceMap) -> Result<ShownPicture, Failure> {
    let name = path.display();
    let bytes = Loader.bytes(path, MAX_BYTES, map);
    let bytes = bytes.map_err(|error| Failure::Trouble(format!("`{name}`: {error}")))?;
    let most = if args.allow_huge {
        u64::MAX
    } else {
        MAX_PIXELS
    };
    ShownPicture::read(&bytes, most).map_err(|error| Failure::Trouble(format!("`{name}` {error}")))
}

/// The size of both pictures, if they can be compared.
fn fitting(
    args: &Diff,
    picture: &ShownPicture,
    reference: &ShownPicture,
) -> Result<[u32; 2], Failure> {
    let size = |picture: &ShownPicture| [picture.display.width, picture.display.height];
    let names = [&args.picture, &args.reference].map(|path| path.display());
    let [a, b] = [size(picture), size(reference)];
    if a != b {
        return Err(Failure::Trouble(format!(
            "pictures of one size are compared: `{}` has {} × {} pixels, `{}` {} × {}",
            names[0], a[0], a[1], names[1], b[0], b[1]
        )));
    }
    if picture.linear.is_some() != reference.linear.is_some() {
        let light = usize::from(reference.linear.is_some());
        return Err(Failure::Trouble(format!(
            "`{}` holds values of light, and `{}` those of a display: compare two of a kind",
            names[light],
            names[1 - light]
        )));
    }
    Ok(a)
}

/// The map of differences as a PNG.
fn map_file(size: [u32; 2], flips: &[f64]) -> Result<Vec<u8>, Failure> {
    let picture = Picture {
        image: heat_map(size, flips),
        ..Picture::default()
    };
    let bytes = picture.encode(&FileFormat::Png8);
    bytes.map_err(|error| Failure::Trouble(error.to_string()))
}

fn measure(found: &Difference, name: &str) -> f64 {
    match name {
        "rmse" => found.rmse,
        "max" => found.max,
        "relmse" => found.relative_mse,
        "flip" => found.flip,
        _ => found.share,
    }
}

fn words(args: &Diff, [width, height]: [u32; 2], found: &Difference) -> String {
    let names = format!(
        "{} and {}: {width}×{height}",
        args.picture.display(),
        args.reference.display()
    );
    if found.is_none() {
        return format!("{names}, no difference\n");
    }
    let place = found.max_at.map_or_else(String::new, |[x, y]| {
        format!(", first in column {x}, row {y}")
    });
    let Difference {
        rmse,
        max,
        max_at: _,
        relative_mse,
        flip,
        share,
        levels,
    } = found;
    format!(
        "{names}\n\
         rmse    {rmse:.4} grey levels\n\
         max     {max:.2} grey levels{place}\n\
         relmse  {relative_mse:.3e}\n\
         flip    {flip:.6}\n\
         share   {:.4} % of the pixels are off by more than {levels} grey levels\n",
        100.0 * share
    )
}

fn json(
    args: &Diff,
    size: [u32; 2],
    found: &Difference,
    gates: &[JudgedGate],
) -> Result<String, Failure> {
    let object = serde_json::json!({
        "schema": "rtc-diff/1",
        "picture": args.picture.display().to_string(),
        "reference": args.reference.display().to_string(),
        "size": size,
        "difference": found,
        "gates": gates,
    });
    let text = serde_json::to_string_pretty(&object);
    text.map(|text| text + "\n")
        .map_err(|error| Failure::Trouble(error.to_string()))
}
