//! `rtc merge`: parts of a picture to the picture, or to a larger part.

use super::args::Merge;
use super::interrupt::Interrupt;
use super::output::Output;
use super::render::kind;
use super::reporter::{self, Reporter};
use super::{Failure, progress};
use rtc_diag::Sink;
use rtc_pipeline::{RenderShard, ShardError};
use rtc_source::{Limits, Loader, Resource, SourceMap};
use std::fmt;
use std::path::Path;

/// The largest part that is read, in bytes.
const MAX_BYTES: u64 = 1 << 36;

/// Merges the parts and writes what they become.
pub(super) fn run(args: &Merge) -> Result<(), Failure> {
    let limits = match args.allow_huge {
        true => Limits::NONE,
        false => Limits::default(),
    };
    let map = SourceMap::with_limits(limits);
    let merged = merged(args, &map)?;
    let output = Output::apart_from(&args.output, &map)?;
    let interrupt = Interrupt::listen()?;
    let (shares, count) = merged.shares();
    if args.output.extension().is_some_and(|it| it == "rtp") {
        output.commit(&merged.save(), &interrupt)?;
        let words = format!("{} of {count} shares", shares.len());
        return said(args, &words);
    }
    refuse_other_kind(args, &merged)?;
    let (picture, counts, found) = merged.develop().map_err(|error| refused(error, &merged))?;
    let mut reporter = Reporter::beside_result(&args.reporter);
    let mut sink = Sink::within(&limits);
    found
        .into_iter()
        .for_each(|diagnostic| sink.push(diagnostic));
    reporter.file(&args.output.display().to_string(), sink, &map)?;
    reporter.finish()?;
    let bytes = merged.look().encode(&picture, || merged.origin());
    let bytes = bytes.map_err(|error| Failure::Trouble(error.to_string()))?;
    output.commit(&bytes, &interrupt)?;
    let [width, height] = [picture.image.width, picture.image.height];
    let rays = progress::rays(counts.rays());
    said(
        args,
        &format!("{width}×{height}, of {count} shares, {rays}"),
    )
}

/// All parts as one.
fn merged(args: &Merge, map: &SourceMap) -> Result<RenderShard, Failure> {
    let max_pixels = map.budget().limit(Resource::Pixels);
    let mut all: Option<RenderShard> = None;
    for path in &args.parts {
        let part = read_part(path, max_pixels, map)?;
        match &mut all {
            Some(all) => all.add(part).map_err(|error| unfit(path, &error))?,
            None => all = Some(part),
        }
    }
    all.ok_or_else(|| Failure::Trouble("no parts".to_owned()))
}

/// Reads a part of a picture of at most so many pixels; the map notes the file.
pub(super) fn read_part(
    path: &Path,
    max_pixels: u64,
    map: &SourceMap,
) -> Result<RenderShard, Failure> {
    let bytes = Loader.bytes(path, MAX_BYTES, map);
    let bytes = bytes.map_err(|error| Failure::Trouble(said_of(path, &error)))?;
    RenderShard::load(&bytes, max_pixels).map_err(|error| unfit(path, &error))
}

/// What to say of a part that is not as it should be.
pub(super) fn unfit(path: &Path, error: &dyn fmt::Display) -> Failure {
    Failure::Input(said_of(path, error))
}

fn said_of(path: &Path, error: &dyn fmt::Display) -> String {
    format!("`{}`: {error}", path.display())
}

/// Refuses to write a picture of another kind than that which the parts are of.
fn refuse_other_kind(args: &Merge, merged: &RenderShard) -> Result<(), Failure> {
    let asked = kind(&args.output, None)?;
    let ((is, own), (_, other)) = (merged.look().kind.names(), asked.names());
    if own == other {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "the parts are of {is}; those of another picture are rendered with `--picture NAME.{other}`"
    )))
}

/// What to say of parts that make no picture.
fn refused(error: ShardError, merged: &RenderShard) -> Failure {
    let words = match &error {
        ShardError::Missing(shares, _) => {
            let first = shares.first().copied().unwrap_or(1);
            format!("{error}\nhelp: `{}` renders it", merged.command(first))
        }
        ShardError::NotAPart
        | ShardError::Version(_)
        | ShardError::Damaged(_)
        | ShardError::Film(_)
        | ShardError::OtherPicture(_)
        | ShardError::Overlap(_) => error.to_string(),
    };
    Failure::Input(words)
}

fn said(args: &Merge, words: &str) -> Result<(), Failure> {
    if !args.reporter.quiet {
        reporter::say(&format!("{}: {words}", args.output.display()));
    }
    Ok(())
}
