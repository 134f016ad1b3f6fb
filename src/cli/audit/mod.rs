//! `rtc audit`: verifies that a picture, or a part of one, matches its metadata; some tiles are
//! rendered again.

mod report;

use super::args::{self, AuditArgs, ReadArgs, StageArgs};
use super::interrupt::Interrupt;
use super::merge::part_of;
use super::progress::RenderProgress;
use super::reporter::{self, Reporter};
use super::shown::{charge, read};
use super::{Failure, input, output, simd};
pub(super) use report::AuditReport;
use rtc_image::WrittenFile;
use rtc_pipeline::{
    AuditResult, Input, PictureAudit, PictureSetup, RenderError, RenderObserver, RenderShard,
    RenderSubject, TileDraw,
};
use rtc_source::{Resource, SourceMap};
use std::path::Path;

/// Audits a picture and reports the result.
pub(super) fn run(args: &AuditArgs) -> Result<(), Failure> {
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = carry_out(args, &mut reporter);
    reporter.finish()?;
    let (result, seed) = outcome?;
    let report = AuditReport::new([&args.picture, &args.scene], seed, &result);
    if args.format.is_json() {
        output::print_json(&report.json()?)?;
    } else if !args.reporter.quiet || !result.findings.is_empty() {
        output::print(&report.to_text())?;
    }
    match result.findings.is_empty() {
        true => Ok(()),
        false => Err(Failure::Reported),
    }
}

/// The report, and the seed of the choice of tiles.
fn carry_out(args: &AuditArgs, reporter: &mut Reporter) -> Result<(AuditResult, u64), Failure> {
    // Read the picture and draw the seed that chooses the tiles.
    let map = SourceMap::with_limits(args.reading.limits(|_| ()));
    let bytes = read(&args.picture, &map)?;
    let seed = seed(args.draw.seed)?;
    let draw = TileDraw {
        tiles: args.draw.tiles,
        seed,
    };
    let scene = AuditScene {
        file: &args.scene,
        stage: &args.stage,
        reading: &args.reading,
        threads: args.threads.count(),
    };
    // A part of a picture is audited against its own setup.
    if args.picture.extension().is_some_and(|it| it == "rtp") {
        let part = part_of(&args.picture, &bytes, map.budget().limit(Resource::Pixels))?;
        let setup = part
            .setup()
            .map_err(|error| refused(&args.picture, error))?;
        let mut audited = scene.validate(setup, reporter)?;
        return Ok((audited.part((&args.picture, &part), draw, reporter)?, seed));
    }
    // Decode the picture with its metadata and its hash tree.
    let named = |error| Failure::Failed(format!("`{}` {error}", args.picture.display()));
    let file = WrittenFile::open(&bytes, map.budget().limit(Resource::Pixels)).map_err(named)?;
    charge(&args.picture, file.cost(), map.budget())?;
    let picture = file.decode().map_err(named)?;
    let opened = PictureAudit::open(&picture);
    let (audit, setup) = match opened.map_err(|error| refused(&args.picture, error))? {
        Ok(opened) => opened,
        Err(result) => return Ok((result, seed)),
    };
    // Render the chosen tiles anew and compare them.
    let mut audited = scene.validate(setup, reporter)?;
    let result = audited.observed(draw, reporter, |setup, subject, order, observer| {
        let result = audit.run(setup, subject, order, observer);
        result.map_err(|error| refused(&args.picture, error))
    })?;
    Ok((result, seed))
}

/// Why a file can't be audited.
pub(super) fn refused(path: &Path, error: RenderError) -> Failure {
    match error {
        RenderError::Refused(message) => {
            Failure::Failed(format!("`{}` can't be audited: {message}", path.display()))
        }
        error @ (RenderError::Stopped | RenderError::RanOut(_)) => error.into(),
    }
}

/// The seed given, or a random one.
pub(super) fn seed(given: Option<u64>) -> Result<u64, Failure> {
    let Some(seed) = given else {
        let none = |error| Failure::Failed(format!("the system gives no random numbers: {error}"));
        return getrandom::u64().map_err(none);
    };
    Ok(seed)
}

/// The input for the scene of the audited picture.
pub(super) struct AuditScene<'a> {
    pub(super) file: &'a Path,
    pub(super) stage: &'a StageArgs,
    pub(super) reading: &'a ReadArgs,
    /// 0 for one a core.
    pub(super) threads: usize,
}

/// A scene, validated in the settings of the audited picture.
pub(super) struct AuditedScene {
    input: Input,
    setup: PictureSetup,
    subject: RenderSubject,
    interrupt: Interrupt,
}

impl AuditScene<'_> {
    /// Reads the scene, lights it as the picture was lit, and reports its diagnostics.
    pub(super) fn validate(
        &self,
        setup: PictureSetup,
        reporter: &mut Reporter,
    ) -> Result<AuditedScene, Failure> {
        let mut setup = PictureSetup {
            threads: self.threads,
            simd: simd::level()?,
            ..setup
        };
        let mut input = input::staged(self.file, self.reading, self.stage)?;
        input.use_threads(setup.threads);
        if setup.look.is_transparent() {
            input.restage(|stage| stage.ground = stage.ground.or(Some(false)));
        }
        let mut subject = input::subject(&mut setup, &mut input, reporter)?;
        let interrupt = Interrupt::listen()?;
        input::light(&mut setup, &mut subject, &mut input, &interrupt, reporter)?;
        Ok(AuditedScene {
            input,
            setup,
            subject,
            interrupt,
        })
    }
}

impl AuditedScene {
    /// Audits a part.
    pub(super) fn part(
        &mut self,
        (path, part): (&Path, &RenderShard),
        draw: TileDraw,
        reporter: &Reporter,
    ) -> Result<AuditResult, Failure> {
        self.observed(draw, reporter, |setup, subject, order, observer| {
            let result = part.audit(setup, subject, order, observer);
            result.map_err(|error| refused(path, error))
        })
    }

    /// Renders tiles again by `audit`, with a progress bar.
    fn observed(
        &mut self,
        draw: TileDraw,
        reporter: &Reporter,
        audit: impl FnOnce(
            &PictureSetup,
            &mut RenderSubject,
            (TileDraw, u64),
            &RenderObserver<'_>,
        ) -> Result<AuditResult, Failure>,
    ) -> Result<AuditResult, Failure> {
        let pixels = draw.tiles.saturating_mul(256);
        let progress = RenderProgress::start(pixels, reporter.is_quiet());
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| self.interrupt.is_raised(),
        };
        let order = (draw, self.input.rays());
        let result = audit(&self.setup, &mut self.subject, order, &observer);
        progress.finish();
        result
    }
}

/// Reports the audit of parts, or fails with the differences.
pub(super) fn judge_part(
    path: &Path,
    args: &args::MergeArgs,
    seed: u64,
    result: &AuditResult,
) -> Result<(), Failure> {
    let scene = args.scene.as_deref().unwrap_or(Path::new("-"));
    let message = AuditReport::new([path, scene], seed, result).to_text();
    let message = message.trim_end();
    if !result.findings.is_empty() {
        return Err(Failure::Input(message.to_owned()));
    }
    if !args.reporter.quiet {
        reporter::print_message(message);
    }
    Ok(())
}
