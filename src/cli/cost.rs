//! `rtc cost`: the cost of accuracy in a scene, as a table, for programs, and as a page.

use super::Failure;
use super::args::{self, StudyFormat};
use super::input;
use super::interrupt::Interrupt;
use super::merge::unfit;
use super::output::Output;
use super::progress::RenderProgress;
use super::render::{or_restart, or_unsaved, print_saved, try_save};
use super::reporter::Reporter;
use super::simd;
use super::system;
use super::versus;
use cpu_time::ThreadTime;
use rtc_diag::clean;
use rtc_image::{FileFormat, Picture};
use rtc_ir::Scene;
use rtc_pipeline::{self as pipeline, Input};
use rtc_render::PixelObserver;
use rtc_source::{Loader, SourceMap};
use rtc_study::{self as study, Journal, Stopped, Study, StudyProvenance, StudyRuntime, WorkClock};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// The largest checkpoint that is read, in bytes.
const MAX_BYTES: u64 = 1 << 36;

/// Studies the scene, or compares it with its reference, and writes the report.
pub(super) fn run(args: &args::CostArgs) -> Result<(), Failure> {
    match args.files.as_slice() {
        [first, second] => versus::run(args, [first, second]),
        files => alone(args, &files[0]),
    }
}

fn alone(args: &args::CostArgs, file: &Path) -> Result<(), Failure> {
    if args.gate.is_some() {
        let message = "`--gate` is for a scene and its reference: `rtc cost new.yaml old.yaml \
            --gate 'time<=1.2x'`";
        return Err(Failure::Failed(message.to_owned()));
    }
    let mut reporter = Reporter::beside_result(&args.reporter);
    let mut input = input::staged(file, &args.reading, &args.stage)?;
    input.use_threads(threads(args));
    let outcome = carry_out(args, &mut input, &mut reporter);
    reporter.finish()?;
    or_unsaved(&outcome, args.checkpoint.as_deref(), args.reporter.quiet);
    outcome
}

fn carry_out(
    args: &args::CostArgs,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    // A study has its own measure of work, and reports on settings that take more than anyone
    // renders.
    input.lift_rays();
    let validated = input::require(input, reporter, input::fill)?;
    let interrupt = Interrupt::listen()?;
    let output = Output::open(&args.output, input)?;
    let page = args
        .html
        .as_deref()
        .map(|path| Output::open(path, input))
        .transpose()?;
    if let Some(folder) = &args.maps {
        make_folder(folder)?;
    }
    let about = about(input.name(), &validated.lowered.scene);
    let journal = journal(args, &about, input)?;
    let scene = &validated.lowered.scene;
    let study = measure(args, (about, journal), scene, (&interrupt, reporter))?;
    let report = match args.format {
        StudyFormat::Table => study::table(&study),
        StudyFormat::Csv => study::csv(&study),
        StudyFormat::Json => study.json(),
    };
    if let Some(folder) = &args.maps {
        write_maps(folder, &study, input, &interrupt)?;
    }
    if let Some(page) = page {
        page.commit(study::html(&study).as_bytes(), &interrupt)?;
    }
    output.commit(report.as_bytes(), &interrupt)
}

fn make_folder(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder)
        .map_err(|error| Failure::Failed(format!("can't make `{}`: {error}", folder.display())))
}

/// The maps as pictures, and their scales as a page.
fn write_maps(
    folder: &Path,
    study: &Study,
    input: &Input,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let mut files = vec![("maps.html".to_owned(), study::maps_page(study).into_bytes())];
    for map in study::maps(study) {
        let name = format!("{}.png", map.name);
        let encoded = Picture::opaque(map.image).encode(FileFormat::Png8);
        let trouble = |error| Failure::Failed(format!("can't write `{name}`: {error}"));
        let bytes = encoded.map_err(trouble)?;
        files.push((name, bytes));
    }
    for (name, bytes) in files {
        Output::open(&folder.join(name), input)?.commit(&bytes, interrupt)?;
    }
    Ok(())
}

/// The number of threads, 0 for one per core.
pub(super) fn threads(args: &args::CostArgs) -> usize {
    args.threads.map_or(0, usize::from)
}

fn measure(
    args: &args::CostArgs,
    (about, journal): (StudyProvenance, Option<Journal>),
    scene: &Scene,
    progress: (&Interrupt, &Reporter),
) -> Result<Study, Failure> {
    let file = args.checkpoint.clone().unwrap_or_default();
    let is_saved = AtomicBool::new(false);
    let save = |journal: &Journal| is_saved.store(try_save(&file, &journal.save()), Relaxed);
    let study = with_progress(threads(args), progress, |runtime| {
        let runtime = match journal {
            Some(journal) => runtime.with_journal(journal, args.every, &save),
            None => runtime,
        };
        let study = study::study(scene, about, args.effort.into(), args.seed, &runtime);
        runtime.save();
        study
    })?;
    study.map_err(|Stopped| {
        if is_saved.load(Relaxed) {
            print_saved(&file, "the renders");
        }
        Failure::Interrupted
    })
}

/// Runs a study as [`with_runtime`], and shows its progress.
pub(super) fn with_progress<T>(
    threads: usize,
    (interrupt, reporter): (&Interrupt, &Reporter),
    work: impl FnOnce(StudyRuntime<'_>) -> T,
) -> Result<T, Failure> {
    let progress = RenderProgress::start(0, reporter.is_quiet());
    let on_pixel = |step| {
        progress.step_rays(step);
        !interrupt.is_raised()
    };
    let on_budget = |rays| progress.set_rays(rays);
    let made = with_runtime(threads, &on_pixel, |runtime| {
        work(runtime.with_budget_report(&on_budget))
    });
    progress.finish();
    made
}

/// Runs the study in a runtime with the requested threads and the clock of the machine.
#[expect(
    clippy::disallowed_methods,
    reason = "the study is handed the clock from here"
)]
pub(super) fn with_runtime<T>(
    threads: usize,
    on_pixel: &PixelObserver<'_>,
    work: impl FnOnce(StudyRuntime<'_>) -> T,
) -> Result<T, Failure> {
    let (simd, start) = (simd::level()?, Instant::now());
    let cpu = || ThreadTime::try_now().map_or(Duration::ZERO, |time| time.as_duration());
    let wall = || start.elapsed();
    let clock = WorkClock {
        cpu: &cpu,
        wall: &wall,
    };
    let runtime = StudyRuntime::new(threads, clock, on_pixel);
    let runtime =
        runtime.map_err(|error| Failure::Failed(format!("can't start threads: {error}")))?;
    Ok(work(runtime.with_simd(simd)))
}

/// The finished renders of the study, if they are saved.
fn journal(
    args: &args::CostArgs,
    about: &StudyProvenance,
    input: &Input,
) -> Result<Option<Journal>, Failure> {
    let Some(file) = &args.checkpoint else {
        return Ok(None);
    };
    Output::open(file, input)?;
    let journal = Journal::new(about, args.effort.into(), args.seed);
    if args.restart || !file.exists() {
        return Ok(Some(journal));
    }
    // Noted in no map that matters: the file is written again.
    let bytes = Loader.bytes(file, MAX_BYTES, &SourceMap::default());
    let bytes = bytes.map_err(|error| Failure::Failed(format!("`{}`: {error}", file.display())))?;
    let journal = journal.load(&bytes);
    let journal = journal.map_err(|error| or_restart(unfit(file, &error)))?;
    Ok(Some(journal))
}

pub(super) fn about(name: &str, scene: &Scene) -> StudyProvenance {
    StudyProvenance {
        scene: Path::new(name).file_name().map_or_else(
            || name.to_owned(),
            |name| clean(&name.to_string_lossy()).into_owned(),
        ),
        hash: pipeline::hash(scene),
        software: concat!("rtc ", env!("CARGO_PKG_VERSION")).to_owned(),
        processor: system::processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
    }
}
