//! `rtc merge`: parts of a picture to the picture, or to a larger part.

use super::args::MergeArgs;
use super::audit::{self, AuditScene, AuditedScene};
use super::interrupt::Interrupt;
use super::output::Output;
use super::render::kind;
use super::reporter::{self, Reporter};
use super::{Failure, progress};
use rtc_diag::DiagnosticSink;
use rtc_pipeline::{RenderShard, ShardError, TileDraw};
use rtc_source::{Loader, Resource, SourceMap};
use std::fmt;
use std::path::Path;

/// The largest part that is read, in bytes.
const MAX_BYTES: u64 = 1 << 36;

/// Merges the parts and writes the result.
pub(super) fn run(args: &MergeArgs) -> Result<(), Failure> {
    let limits = args.reading.limits(|_| ());
    let map = SourceMap::with_limits(limits);
    let mut reporter = Reporter::beside_result(&args.reporter);
    // Read and merge the shares.
    let merged = merged(args, &map, &mut reporter);
    if merged.is_err() {
        reporter.finish()?;
        return merged.map(drop);
    }
    let merged = merged?;
    let output = Output::open_unless_read(&args.output, &map)?;
    let interrupt = Interrupt::listen()?;
    // An incomplete picture remains a part.
    let (shares, count) = merged.shares();
    if args.output.extension().is_some_and(|it| it == "rtp") {
        output.commit(&merged.save(), &interrupt)?;
        let text = format!("{} of {count} shares", shares.len());
        return print_result(args, &text);
    }
    refuse_other_kind(args, &merged)?;
    // Develop the merged film and report what it lacks.
    let (picture, counts, found) = merged.develop().map_err(|error| refused(error, &merged))?;
    let mut sink = DiagnosticSink::within(&limits);
    found
        .into_iter()
        .for_each(|diagnostic| sink.push(diagnostic));
    reporter.file(&args.output.display().to_string(), sink, &map)?;
    reporter.finish()?;
    // Encode and write the picture.
    let bytes = merged.look().encode(&picture, || merged.metadata());
    let bytes = bytes.map_err(|error| Failure::Failed(error.to_string()))?;
    output.commit(&bytes, &interrupt)?;
    let [width, height] = [picture.image.width, picture.image.height];
    let rays = progress::rays(counts.rays());
    print_result(
        args,
        &format!("{width}×{height}, of {count} shares, {rays}"),
    )
}

/// All parts as one.
fn merged(
    args: &MergeArgs,
    map: &SourceMap,
    reporter: &mut Reporter,
) -> Result<RenderShard, Failure> {
    let max_pixels = map.budget().limit(Resource::Pixels);
    let (mut all, mut audited) = (None::<RenderShard>, None);
    for path in &args.parts {
        let part = read_part(path, max_pixels, map)?;
        if let Some(tiles) = args.audit {
            audit_part((path, &part), tiles, args, &mut audited, reporter)?;
        }
        match &mut all {
            Some(all) => all.add(part).map_err(|error| unfit(path, &error))?,
            None => all = Some(part),
        }
    }
    all.ok_or_else(|| Failure::Failed("no parts".to_owned()))
}

/// Audits a part against the scene, which is read in the settings of the first one.
fn audit_part(
    (path, part): (&Path, &RenderShard),
    tiles: u64,
    args: &MergeArgs,
    audited: &mut Option<AuditedScene>,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let scene = AuditScene {
        file: args.scene.as_deref().unwrap_or(Path::new("-")),
        stage: &args.stage,
        reading: &args.reading,
        threads: 0,
    };
    let audited = match audited {
        Some(audited) => audited,
        None => {
            let setup = part.setup();
            let setup = setup.map_err(|error| audit::refused(path, error))?;
            audited.insert(scene.validate(setup, reporter)?)
        }
    };
    let seed = audit::seed(args.seed)?;
    let result = audited.part((path, part), TileDraw { tiles, seed }, reporter)?;
    audit::judge_part(path, args, seed, &result)
}

/// Reads a part of a picture with at most the given pixels; the map records the file.
pub(super) fn read_part(
    path: &Path,
    max_pixels: u64,
    map: &SourceMap,
) -> Result<RenderShard, Failure> {
    let bytes = Loader.bytes(path, MAX_BYTES, map);
    let bytes = bytes.map_err(|error| Failure::Failed(message_of(path, &error)))?;
    part_of(path, &bytes, max_pixels)
}

/// The part in the bytes of a file, of a picture with at most the given pixels.
pub(super) fn part_of(path: &Path, bytes: &[u8], max_pixels: u64) -> Result<RenderShard, Failure> {
    RenderShard::load(bytes, max_pixels).map_err(|error| unfit(path, &error))
}

/// The message for an invalid part.
pub(super) fn unfit(path: &Path, error: &dyn fmt::Display) -> Failure {
    Failure::Input(message_of(path, error))
}

fn message_of(path: &Path, error: &dyn fmt::Display) -> String {
    format!("`{}`: {error}", path.display())
}

/// Rejects a picture format other than that of the parts.
fn refuse_other_kind(args: &MergeArgs, merged: &RenderShard) -> Result<(), Failure> {
    let requested = kind(&args.output, None)?;
    let (own, requested) = (merged.look().kind.traits(), requested.traits());
    if own.extensions == requested.extensions {
        return Ok(());
    }
    let (is, other) = (own.name, requested.extensions[0]);
    Err(Failure::Input(format!(
        "the parts are of {is}; those of another picture are rendered with `--picture NAME.{other}`"
    )))
}

/// The message for parts that can't be merged.
fn refused(error: ShardError, merged: &RenderShard) -> Failure {
    let text = match &error {
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
    Failure::Input(text)
}

fn print_result(args: &MergeArgs, text: &str) -> Result<(), Failure> {
    if !args.reporter.quiet {
        reporter::print_message(&format!("{}: {text}", args.output.display()));
    }
    Ok(())
}
