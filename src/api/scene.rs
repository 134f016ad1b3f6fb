//! A scene that was read or built.

use super::clock::Stopwatch;
use super::progress::{ProgressMeasure, ProgressReporter};
use super::{
    Diagnostic, Effect, Error, Light, Options, Picture, Reading, SceneBuilder, SceneContents,
    Severity,
};
use rtc_pipeline::{
    self as pipeline, Input, LoadedScene, PictureSetup, RenderObserver, RenderSubject, Rounds,
    Traced,
};
use rtc_plan::{Plan, RuleSet};
use rtc_render::{Crop, Film, FilmMonitor, RayCounts};
use rtc_study::{PixelQuality, RenderGoal};
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// A scene that was read from any format (YAML or JSON of the course, glTF, a mesh, Mitsuba, pbrt
/// or the IR), or built with a [`SceneBuilder`].
///
/// Copies are cheap and share what they can. Several threads may render one scene at once.
///
/// ```
/// use rtc::{Camera, Light, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(16, 16));
/// builder.light(Light::plain([5.0, 5.0, 9.0], [1.0; 3], 0.0));
/// let ball = builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let white = builder.build().unwrap();
///
/// let mut red = white.clone();
/// red.edit(|builder| {
///     let material = builder.material_of(ball).and_then(|id| builder.material_mut(id));
///     material.unwrap().set_color([1.0, 0.0, 0.0]);
/// })
/// .unwrap();
/// let pictures = std::thread::scope(|scope| {
///     let renders = [&white, &red].map(|scene| scope.spawn(|| scene.render(&Options::new())));
///     renders.map(|render| render.join().unwrap())
/// });
/// let [white, red] = pictures.map(|picture| picture.unwrap().rgba8());
/// assert_ne!(white, red);
/// ```
#[derive(Clone)]
pub struct Scene {
    /// The files, with the diagnostics of reading; not changed any more.
    input: Arc<Input>,
    /// The scene with its changes; `None` if it has errors.
    loaded: Option<Arc<LoadedScene>>,
    /// Whether some of its values are not from files.
    is_built: bool,
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut scene = f.debug_struct("Scene");
        scene.field("name", &self.input.name());
        scene.field("lights", &self.lights());
        scene.finish_non_exhaustive()
    }
}

impl Scene {
    /// Reads a scene from a file; [`Reading`] has options for it.
    ///
    /// The files to which the scene refers are read too. Errors in the scene are reported by
    /// [`Scene::check`].
    ///
    /// # Errors
    /// [`Error::Invalid`] if the file does not exist or can't be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Reading::new().open(path)
    }

    /// Reads the scene at `path` from `files` in memory. Each file is a path, with `/` between
    /// components, and its bytes. The scene may refer to the other files.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is no file at `path`.
    pub fn from_files(
        path: &str,
        files: impl IntoIterator<Item = (String, Vec<u8>)>,
    ) -> Result<Self, Error> {
        Reading::new().from_files(path, files)
    }

    pub(super) fn new(mut input: Input) -> Result<Self, Error> {
        let loaded = input.load().map(Arc::new);
        let scene = Self {
            input: Arc::new(input),
            loaded,
            is_built: false,
        };
        if !scene.input.is_read() {
            return Err(Error::Invalid(scene.run().diagnostics()));
        }
        Ok(scene)
    }

    /// The scene of a builder, validated, instead of `loaded`.
    pub(super) fn of_builder(
        input: Arc<Input>,
        mut loaded: LoadedScene,
        builder: SceneBuilder,
    ) -> Result<Self, Vec<Diagnostic>> {
        let (lowered, faults, has_camera) = builder.finish();
        loaded.replace(lowered, has_camera);
        let scene = Self {
            input,
            loaded: Some(Arc::new(loaded)),
            is_built: true,
        };
        let mut run = scene.run();
        faults.into_iter().for_each(|fault| run.input.push(fault));
        let found = run.check();
        let is_wrong = found.iter().any(|found| found.severity == Severity::Error);
        if is_wrong { Err(found) } else { Ok(scene) }
    }

    /// All diagnostics, in the order of the text. A scene with errors can't be rendered.
    #[must_use]
    pub fn check(&self) -> Vec<Diagnostic> {
        self.run().check()
    }

    /// The contents of the scene; `None` if it can't be read.
    #[must_use]
    pub fn tree(&self) -> Option<SceneContents<'_>> {
        let loaded = self.loaded.as_ref()?;
        Some(SceneContents::new(&loaded.lowered, self.input.map()))
    }

    /// Changes the scene if it is valid after the change; copies of it stay as they are.
    ///
    /// # Errors
    /// All diagnostics if there is an error; then nothing is changed.
    pub fn edit(&mut self, change: impl FnOnce(&mut SceneBuilder)) -> Result<(), Vec<Diagnostic>> {
        let Some(loaded) = &self.loaded else {
            return Err(self.check());
        };
        let mut builder = SceneBuilder::of(loaded.lowered.clone());
        change(&mut builder);
        let input = Arc::clone(&self.input);
        *self = Self::of_builder(input, LoadedScene::clone(loaded), builder)?;
        Ok(())
    }

    /// The effects of the picture, which are rendered and which omitted, each with the reason:
    /// first effects of the whole picture, then of single lights, materials and surfaces.
    ///
    /// # Errors
    /// As [`Scene::render`].
    pub fn effects(&self, options: &Options) -> Result<Vec<Effect>, Error> {
        let subject = self.run().validate(options, &mut options.setup()?)?;
        let plan = Plan::new(&subject.validated.scene, RuleSet::ALL);
        Ok(plan.statuses.iter().map(Effect::new).collect())
    }

    /// The number of lights, without the environment and emissive surfaces; 0 if the scene has
    /// errors.
    #[must_use]
    pub fn lights(&self) -> usize {
        self.tree().map_or(0, |tree| tree.lights().len())
    }

    /// Adds a light; [`Scene::check`] validates it. Does nothing if the scene has errors.
    pub fn add_light(&mut self, light: Light) {
        self.change(|builder| {
            builder.light(light);
        });
    }

    /// Removes all lights except the environment and emissive surfaces.
    pub fn remove_lights(&mut self) {
        self.change(SceneBuilder::remove_lights);
    }

    /// Changes the scene without validating it.
    fn change(&mut self, change: impl FnOnce(&mut SceneBuilder)) {
        if let Some(loaded) = &mut self.loaded {
            let loaded = Arc::make_mut(loaded);
            let mut builder = SceneBuilder::of(loaded.lowered.clone());
            change(&mut builder);
            let (lowered, _, has_camera) = builder.finish();
            loaded.replace(lowered, has_camera);
            self.is_built = true;
        }
    }

    /// Renders the picture.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the scene has errors, [`Error::Refused`] if an option is invalid or
    /// memory is too small, [`Error::TooManyRays`] if it needs more rays than allowed.
    pub fn render(&self, options: &Options) -> Result<Picture, Error> {
        self.render_until(options, &|| false)
    }

    /// Renders the picture unless it is stopped. All threads call `is_stopped` after each pixel,
    /// and during long ones.
    ///
    /// # Errors
    /// As [`Scene::render`], and [`Error::Stopped`].
    pub fn render_until(
        &self,
        options: &Options,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, Error> {
        self.run().render(options, is_stopped)
    }

    pub(super) fn run(&self) -> SceneRun<'_> {
        SceneRun {
            input: Input::clone(&self.input),
            scene: self,
        }
    }
}

/// One check or one render of a scene, with the diagnostics of reading and its own.
pub(super) struct SceneRun<'a> {
    pub(super) input: Input,
    scene: &'a Scene,
}

/// A film, the quality of its pixels if layers show it, and its error if that is known.
type RenderedFilm = (Film, Vec<PixelQuality>, Option<f64>);

impl SceneRun<'_> {
    fn check(mut self) -> Vec<Diagnostic> {
        if let Some(loaded) = &self.scene.loaded {
            self.input.unstage();
            self.input.validate(LoadedScene::clone(loaded), |_, _| ());
        }
        self.diagnostics()
    }

    /// Validates the scene with these options.
    pub(super) fn validate(
        &mut self,
        options: &Options,
        setup: &mut PictureSetup,
    ) -> Result<RenderSubject, Error> {
        self.input.stage(options.stage());
        let validated = match &self.scene.loaded {
            Some(loaded) => setup.validate(LoadedScene::clone(loaded), &mut self.input),
            None => Ok(None),
        };
        let validated = validated.map_err(|error| self.error(error))?;
        validated.ok_or_else(|| Error::Invalid(self.diagnostics()))
    }

    fn render(
        mut self,
        options: &Options,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, Error> {
        let mut setup = options.setup()?;
        let mut subject = self.validate(options, &mut setup)?;
        // Measure the light, render the film, develop it to a picture.
        let made = self
            .film(options, &mut setup, &mut subject, is_stopped)
            .and_then(|(film, quality, error)| {
                let counts = film.counts;
                let film = (film.image, film.coverage, &counts);
                let input = &mut self.input;
                let picture = setup.develop(&mut subject, film, &quality, input, is_stopped)?;
                Ok((picture, counts, error))
            });
        // Attach the metadata of the picture.
        let (picture, counts, error) = made.map_err(|error| self.error(error))?;
        let metadata = setup.metadata(&subject.validated.lowered.scene);
        let look = setup.look.resolve(&subject.validated.scene.settings().mode);
        Ok(Picture::new(
            (picture, look, metadata),
            options.format,
            (&counts, error),
            self.diagnostics(),
        ))
    }

    /// Measures the light, checks window and memory, and renders.
    fn film(
        &mut self,
        options: &Options,
        setup: &mut PictureSetup,
        subject: &mut RenderSubject,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<RenderedFilm, pipeline::RenderError> {
        // Measure exposure and light, and check the limits of memory.
        let stopwatch = Stopwatch::start();
        let observer = |on_step| RenderObserver {
            on_step,
            is_stopped,
        };
        setup.light(subject, &mut self.input, &observer(&|_| ()))?;
        let window = setup.window(&subject.validated.lowered.scene)?;
        setup.check_memory(subject, window)?;
        setup.check_layers()?;
        // Progress is measured by time, error or pixels.
        let has_goal = setup.is_progressive();
        let measure = match setup.goal.time {
            Some(time) => ProgressMeasure::Time(&stopwatch, time),
            None if has_goal => ProgressMeasure::Error,
            None => ProgressMeasure::Pixels,
        };
        let pixels = window.pixels() as u64;
        let look = setup.look.resolve(&subject.validated.scene.settings().mode);
        let (look, monitor) = (look.without_metadata(), FilmMonitor::default());
        let picture = || Picture::unfinished(&look, options.format, &monitor);
        let on_progress = options.on_progress.as_ref();
        let counter = ProgressReporter::new(on_progress, pixels, measure, &picture);
        let on_step = |step| counter.step(step);
        // Render until the goal is met, or once.
        let order = (window, options.rays.unwrap_or(self.input.rays()));
        let rendered = if has_goal {
            let progress = (&counter, &stopwatch);
            let (rendered, above_target) =
                approach(setup, subject, order, &observer(&on_step), progress)?;
            above_target
                .into_iter()
                .for_each(|found| self.input.push(found));
            rendered
        } else {
            let monitor = on_progress.map(|_| &monitor);
            let traced = setup.trace_monitored(subject, order, &observer(&on_step), monitor)?;
            let Traced {
                film,
                probed,
                quality,
            } = traced;
            let above_target = probed.as_ref();
            let above_target =
                above_target.and_then(|own| setup.above_target(own.error, own.undersampled));
            above_target
                .into_iter()
                .for_each(|found| self.input.push(found));
            let verified = probed.filter(|probed| probed.undersampled.is_none());
            (film, quality, verified.map(|probed| probed.error))
        };
        let counts: &RayCounts = &rendered.0.counts;
        // Report the end.
        counter.finish(counts.rays());
        Ok(rendered)
    }

    /// The diagnostics so far.
    pub(super) fn diagnostics(&mut self) -> Vec<Diagnostic> {
        let mut found = self.input.take_diagnostics();
        found.sort();
        let found = found.kept().iter();
        found.map(|found| self.public(found)).collect()
    }

    fn public(&self, found: &rtc_diag::Diagnostic) -> Diagnostic {
        let Scene {
            loaded, is_built, ..
        } = self.scene;
        let built = loaded.as_ref().filter(|_| *is_built);
        let built = built.map(|loaded| &loaded.lowered.scene);
        Diagnostic::new(found, self.input.map(), built)
    }

    pub(super) fn error(&self, error: pipeline::RenderError) -> Error {
        Error::of_render(error, |found| self.public(&found))
    }
}

/// Renders towards a target error, or within a time; with a warning if the error is larger.
fn approach(
    setup: &PictureSetup,
    subject: &mut RenderSubject,
    order: (Crop, u64),
    observer: &RenderObserver<'_>,
    (counter, stopwatch): (&ProgressReporter<'_>, &Stopwatch),
) -> Result<(RenderedFilm, Option<rtc_diag::Diagnostic>), pipeline::RenderError> {
    let RenderGoal { error, time } = setup.goal;
    let elapsed = || stopwatch.elapsed();
    let begin = |progress: rtc_study::Progress| {
        // The error falls with the square root of the samples.
        let by_error = error
            .zip(progress.error)
            .map_or(0.0, |(target, bound)| (target / bound) * (target / bound));
        let of_time = |time: std::time::Duration| elapsed().as_secs_f64() / time.as_secs_f64();
        counter.reach(time.map_or(0.0, of_time).max(by_error));
    };
    let rounds = Rounds {
        elapsed: &elapsed,
        begin: &begin,
    };
    let grown = setup.approach(subject, order, observer, &rounds)?;
    let above_target = setup.above_target(grown.error, grown.undersampled);
    let is_bounded = grown.undersampled.is_none() && grown.coarse.is_none();
    let film = Film {
        image: grown.image,
        coverage: grown.coverage,
        counts: grown.counts,
    };
    let error = is_bounded.then_some(grown.error);
    Ok(((film, grown.quality, error), above_target))
}
