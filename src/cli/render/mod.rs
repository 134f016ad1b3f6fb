//! `rtc render`: renders scenes to pictures.
//!
//! The arguments become a [`RenderSetup`] before any file is read. `rendering` renders one picture
//! with the requested samples, target or time budget (`budget`). Variants: `checkpoint` saves
//! progress, `part` renders a part, `strips` writes rows as they are finished, `turning` and
//! `animation` render turntables, `many` renders several scenes, with a contact sheet (`sheet`).
//! `cache` keeps finished pictures. `look` resolves the output transform, `layers` writes AOVs, `made` reports the finished picture,
//! `show` prints it in the terminal.

mod animation;
mod budget;
mod cache;
mod checkpoint;
mod layers;
mod look;
mod made;
mod many;
mod part;
mod rendering;
mod sheet;
mod show;

use super::Failure;
use super::args::{self, BackgroundArg};
use super::input::{self, halted};
use super::interrupt::Interrupt;
use super::output::{self, Output};
use super::project;
use super::reporter::Reporter;
use super::simd;
use super::turntable::{self, Turntable, TurntableViews};
use budget::PictureClock;
use cache::PictureCache;
use checkpoint::{Checkpoint, CheckpointedRender, RunContext};
pub(super) use checkpoint::{ended, or_restart, or_unsaved, print_saved, try_save};
use layers::LayerFiles;
pub(super) use look::{kind, refuse_layers};
pub(super) use made::{FinishedPicture, effects};
use part::PartSetup;
use rtc_image::{BackgroundFill, Picture};
use rtc_ir::Mode;
use rtc_passes::Overrides;
use rtc_pipeline::{FolderIdentity, Input, PictureSetup, RenderError, RenderSubject};
use rtc_plan::{Rule, RuleSet};
use rtc_render::Crop;
use rtc_study::RenderGoal;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// A render as it will be done.
struct RenderSetup {
    output: PathBuf,
    picture: PictureSetup,
    /// The requests of the command line.
    requested: Overrides,
    /// Views around the scene, if more than its own.
    turntable: Option<TurntableViews>,
    /// Pictures a second of a turntable in one file.
    rate: Option<u16>,
    up: Option<[f64; 3]>,
    /// The share of the picture that is rendered, if not all of it.
    part: Option<PartSetup>,
    /// The checkpoint.
    checkpoint: Option<Checkpoint>,
    /// Whether it is rendered in strips, and of how many rows.
    strips: Option<Option<u32>>,
    /// Whether the picture is shown in the terminal, too.
    is_shown: bool,
    clock: PictureClock,
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Stopped => Self::Interrupted,
            RenderError::RanOut(_) => Self::Reported,
            RenderError::Refused(message) => Self::Failed(message),
        }
    }
}

/// Renders the scene and writes the picture.
pub(super) fn run(args: args::RenderArgs, typed: &[OsString]) -> Result<(), Failure> {
    if let Some(jobs) = many::jobs(&args)? {
        return many::run(args, jobs, typed);
    }
    let plan = RenderSetup::new(&args, typed)?;
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = plan.begin(args.file(), &args, &mut reporter);
    reporter.finish()?;
    or_unsaved(&outcome, args.checkpoint.as_deref(), args.reporter.quiet);
    outcome
}

impl RenderSetup {
    fn new(args: &args::RenderArgs, typed: &[OsString]) -> Result<Self, Failure> {
        // Choose the output.
        let part = PartSetup::new(args, typed)?;
        let output = match (&args.output, &part) {
            (Some(output), _) => output.clone(),
            (None, Some(part)) => part.beside_here(args)?,
            (None, None) => beside_here(args)?,
        };
        // Refuse combinations of flags that can't be written.
        let turntable = TurntableViews::new(args.turntable, args.frames)?;
        if turntable.is_some() && output::is_stdout(&output) {
            return Err(Failure::Failed(
                "a turntable is many pictures; give `-o NAME-%04d.png`".to_owned(),
            ));
        }
        output::refuse_terminal(&output)?;
        if args.show && output::is_stdout(&output) {
            return Err(Failure::Failed(
                "`--show` takes standard output; give the picture a name by `-o`".to_owned(),
            ));
        }
        // Find the goal and the format of the picture.
        let goal = args.goal();
        let rate = animation::rate(args, &output)?;
        let still = rate.map(|_| animation::still(&output));
        let picture = part.as_ref().map_or(output.as_path(), PartSetup::picture);
        let picture = still.as_deref().unwrap_or(picture);
        // Flags come before the settings of the project.
        let requested = args.wanted.overrides();
        let settled = project::picture(args.file(), &args.reading, goal)?;
        let picture = PictureSetup {
            overrides: requested.or(settled),
            goal,
            threads: args.threads.count(),
            rules: rules(&args.pruning, goal),
            verify: args.pruning.verify_effects,
            denoise: args.denoise,
            clamp: args.clamp,
            ..wanted(&args.wanted, &args.look, picture)?
        };
        picture.check_layers()?;
        // Layers need files beside the picture.
        let is_one_file = args.strips.is_some()
            || rate.is_some()
            || part.is_some()
            || args.checkpoint.is_some()
            || output::is_stdout(&output);
        if is_one_file {
            refuse_layers(&picture)?;
        }
        Ok(Self {
            output,
            picture,
            requested,
            turntable,
            rate,
            up: args.stage.up,
            part,
            checkpoint: Checkpoint::new(args),
            strips: args.strips,
            is_shown: args.show,
            clock: PictureClock::start(),
        })
    }

    /// Reads the scene at `file` and renders it.
    fn begin(
        mut self,
        file: &Path,
        args: &args::RenderArgs,
        reporter: &mut Reporter,
    ) -> Result<(), Failure> {
        let cache = PictureCache::open(&self, file, args, reporter)?;
        let is_written = match &cache {
            Some(cache) => self.recall(cache, reporter)?,
            None => false,
        };
        if !is_written {
            let mut input = match &cache {
                Some(_) => input::staged_and_recorded(file, &args.reading, &args.stage)?,
                None => input::staged(file, &args.reading, &args.stage)?,
            };
            input.use_threads(self.picture.threads);
            set_stage(&mut input, &args.look, args.turntable);
            self.carry_out(cache.as_ref(), &mut input, reporter)?;
        }
        match self.is_shown {
            true => show::show(&self.output),
            false => Ok(()),
        }
    }

    fn carry_out(
        &mut self,
        cache: Option<&PictureCache>,
        input: &mut Input,
        reporter: &mut Reporter,
    ) -> Result<(), Failure> {
        // Validate the scene with the overrides.
        let subject = match input.load() {
            Some(loaded) => self.picture.validate(loaded, input),
            None => Ok(None),
        };
        let mut subject = match subject {
            Ok(subject) => input::unless_refused(subject, input, reporter)?,
            Err(error) => {
                input::report_diagnostics(input, reporter)?;
                return Err(error.into());
            }
        };
        // Report flags that have no effect.
        let scene = &subject.validated.lowered.scene;
        let idle = idle_samples(&self.requested, &scene.settings.mode);
        idle.into_iter().for_each(|message| reporter.warn(message));
        self.picture.window(scene)?;
        // Measure exposure and light.
        let interrupt = Interrupt::listen()?;
        input::light(&mut self.picture, &mut subject, input, &interrupt, reporter)?;
        // Render with a checkpoint, as an animation, a turntable, a part or a picture.
        if let Some(checkpoint) = &self.checkpoint {
            let mut saving = CheckpointedRender::begin(checkpoint, &self.output, input)?;
            let run_context = (input, reporter, &interrupt);
            return match &self.turntable {
                None => self.shoot_saving(&mut saving, &mut subject, run_context),
                Some(views) => self.turn_saving(views, saving, &mut subject, run_context),
            };
        }
        if let (Some(views), Some(rate)) = (&self.turntable, self.rate) {
            let run_context = (input, reporter, &interrupt);
            return self.shoot_animation((views, rate), &mut subject, run_context);
        }
        if let Some(views) = &self.turntable {
            return self.shoot_around(views, &mut subject, input, reporter, &interrupt);
        }
        if let Some(part) = &self.part {
            return self.shoot_part(part, &mut subject, input, reporter, &interrupt);
        }
        if let Some(cache) = cache {
            let run_context = (input, reporter, &interrupt);
            return self.render_cached(cache, &mut subject, run_context);
        }
        self.render_picture(&mut subject, &self.output, input, reporter, &interrupt)
    }

    /// Renders views around the scene, or a part of the only one, and writes them.
    fn shoot_around(
        &self,
        views: &TurntableViews,
        subject: &mut RenderSubject,
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let table = Turntable::new(&subject.validated.lowered.scene, self.up, views.count);
        let path = |frame| match &self.part {
            Some(_) => self.output.clone(),
            None => turntable::name(&self.output, frame),
        };
        let mut frames = views.shown.clone();
        frames.try_for_each(|frame| Output::open(&path(frame), input).map(drop))?;
        let folder = FolderIdentity::of_file(&self.output);
        let folder = folder.map_err(|error| Failure::Failed(error.to_string()))?;
        for frame in views.shown.clone() {
            output::check_folder(&folder, &path(frame))?;
            table.turn(&mut subject.validated, frame)?;
            subject.turn();
            match &self.part {
                Some(part) => self.shoot_part(part, subject, input, reporter, interrupt)?,
                None => self.render_picture(subject, &path(frame), input, reporter, interrupt)?,
            }
        }
        Ok(())
    }

    /// The region of the picture, with its memory charged, and its destination.
    fn ready(
        &self,
        subject: &mut RenderSubject,
        path: &Path,
        input: &Input,
    ) -> Result<(Crop, Output), Failure> {
        let window = self.picture.window(&subject.validated.lowered.scene)?;
        self.picture.check_memory(subject, window)?;
        Ok((window, Output::open(path, input)?))
    }

    /// Renders one picture and writes it.
    fn render_picture(
        &self,
        subject: &mut RenderSubject,
        path: &Path,
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        if let Some(rows) = self.strips {
            return self.shoot_strips(rows, (subject, path), input, reporter, interrupt);
        }
        self.make_picture(subject, path, input, reporter, interrupt)
            .map(drop)
    }

    /// Renders one picture and writes it; returns the bytes of its files, the picture first, and
    /// its messages.
    fn make_picture(
        &self,
        subject: &mut RenderSubject,
        path: &Path,
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(Vec<Vec<u8>>, FinishedPicture), Failure> {
        let (window, output) = self.ready(subject, path, input)?;
        let layers = LayerFiles::open(&self.picture.look, path, input.map())?;
        let run_context = (&mut *input, &mut *reporter, interrupt);
        let (picture, made) = self.take(subject, path, window, run_context)?;
        let mut files = vec![self.picture.encode(&picture, subject)?];
        files.extend(layers.encode(&self.picture, &picture, subject)?);
        output.commit(&files[0], interrupt)?;
        layers.commit(&files[1..], interrupt)?;
        input::report_diagnostics(input, reporter)?;
        reporter.made(&made);
        Ok((files, made))
    }

    /// Renders one picture; returns it with its messages. Its diagnostics are not reported yet: one
    /// that is denied is no reason to lose the picture.
    fn take(
        &self,
        subject: &mut RenderSubject,
        path: &Path,
        window: Crop,
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(Picture, FinishedPicture), Failure> {
        // Render once, or until the goal is met.
        let quiet = reporter.is_quiet();
        let order = (window, input.rays());
        let rendering = if self.picture.is_progressive() {
            self.approach(subject, order, interrupt, quiet, None)
        } else {
            self.trace(subject, order, interrupt, quiet)
        };
        let rendering = rendering.map_err(|error| ended(error, input, reporter))?;
        // Develop the film into the picture.
        let coarse = rendering.coarse();
        let above_target = rendering.above_target(&self.picture);
        let size = [rendering.image.width, rendering.image.height];
        let work = (rendering.counts, rendering.elapsed);
        let made = FinishedPicture::new(path, &self.picture, size, work).with(rendering.quality);
        let film = (rendering.image, rendering.coverage, &rendering.counts);
        let is_stopped = || interrupt.is_raised();
        let picture = self
            .picture
            .develop(subject, film, &rendering.pixels, input, &is_stopped)?;
        // Report what the time budget did not allow.
        let time = self.picture.goal.time;
        let found = self.clock.stop(time, (coarse, window));
        let found = found.into_iter().chain(above_target);
        found.for_each(|diagnostic| input.push(diagnostic));
        Ok((picture, made))
    }
}

/// Shows a scene as pictures of this look want it, some of them all around.
pub(super) fn set_stage(
    input: &mut Input,
    look: &args::OutputTransformArgs,
    turntable: Option<u32>,
) {
    input.restage(|stage| {
        stage.all_around = turntable.is_some();
        if look.background == BackgroundArg::Fill(BackgroundFill::Transparent) {
            stage.ground = stage.ground.or(Some(false));
        }
    });
}

/// The rules that may leave something out.
fn rules(args: &args::PruningArgs, goal: RenderGoal) -> RuleSet {
    // The error that is promised counts no other one.
    let is_exact = !args.approx || goal != RenderGoal::default();
    let all = if is_exact {
        RuleSet::ALL
    } else {
        RuleSet::ALL.with(Rule::Cut)
    };
    match args.no_prune.as_deref() {
        None => all,
        Some([]) => RuleSet::NONE,
        Some(named) => named.iter().fold(all, |rules, rule| rules.without(*rule)),
    }
}

/// The requested picture, in the format of its name.
pub(super) fn wanted(
    wanted: &args::WantedArgs,
    look: &args::OutputTransformArgs,
    name: &Path,
) -> Result<PictureSetup, Failure> {
    Ok(PictureSetup {
        overrides: wanted.overrides(),
        set: wanted.set.clone(),
        arithmetic: wanted.arithmetic.into(),
        crop: wanted.crop,
        simd: simd::level()?,
        ..PictureSetup::new(look::look(look, name)?)
    })
}

/// The name of the scene with `.png`, in the current folder.
fn beside_here(args: &args::RenderArgs) -> Result<PathBuf, Failure> {
    Ok(PathBuf::from(stem(args.file(), args)?).with_added_extension("png"))
}

/// The name of a scene without its extension.
fn stem<'a>(file: &'a Path, args: &'a args::RenderArgs) -> Result<&'a OsStr, Failure> {
    let name = if file.as_os_str() == "-" {
        args.reading.stdin_name.as_deref().map(Path::new)
    } else {
        Some(file)
    };
    let stem = name.and_then(Path::file_stem);
    stem.ok_or_else(|| Failure::Failed("no name for the picture; give `-o FILE`".to_owned()))
}

/// The warning about requested samples that the mode of a scene does not use, if any.
fn idle_samples(requested: &Overrides, mode: &Mode) -> Option<&'static str> {
    match mode {
        Mode::Path(_) => requested.supersampling.is_some().then_some(
            "warning: `--supersampling` has no effect: the scene is path-traced; `--spp N` traces \
             N paths in each pixel",
        ),
        Mode::Depth => requested
            .spp
            .is_some()
            .then_some("warning: `--spp` has no effect: the scene is not path-traced"),
        Mode::Phong | Mode::Gooch(_) | Mode::Normal => requested.spp.is_some().then_some(
            "warning: `--spp` has no effect: the scene is not path-traced; `--supersampling N` \
             takes N×N samples in each pixel",
        ),
    }
}
