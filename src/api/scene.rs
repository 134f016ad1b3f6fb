//! A scene that was read.

use super::{Diagnostic, Effect, Error, Light, Options, Picture, Reading};
use rtc_diag::Sink;
use rtc_passes as passes;
use rtc_pipeline::{
    self as pipeline, Input, Loaded, Observer, PictureSetup, RenderSubject, Traced,
};
use rtc_plan::{Plan, Rules};
use rtc_render::Film;
use std::fmt;
use std::path::Path;

/// A scene that was read from any format: YAML or JSON of the course, glTF, a mesh, or the IR.
pub struct Scene {
    input: Input,
    /// The scene with its changes; `None` if it has errors.
    loaded: Option<Loaded>,
    /// The diagnostics of reading.
    found: Sink,
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
        let loaded = input.load();
        let found = input.take_diagnostics();
        if !input.is_read() {
            let diagnostics = found.kept().iter();
            let diagnostics = diagnostics.map(|found| Diagnostic::new(found, input.map()));
            return Err(Error::Invalid(diagnostics.collect()));
        }
        Ok(Self {
            input,
            loaded,
            found,
        })
    }

    /// All diagnostics, in the order of the text. A scene with errors can't be rendered.
    pub fn check(&mut self) -> Vec<Diagnostic> {
        self.restart();
        if let Some(loaded) = self.loaded.clone() {
            self.input.unstage();
            self.input.validate(loaded, |_, _| ());
        }
        self.diagnostics()
    }

    /// The effects of the picture, which are rendered and which omitted, each with the reason:
    /// first effects of the whole picture, then of single lights, materials and surfaces.
    ///
    /// # Errors
    /// As [`Scene::render`].
    pub fn effects(&mut self, options: &Options) -> Result<Vec<Effect>, Error> {
        let subject = self.validate(options, &mut options.setup()?)?;
        let plan = Plan::new(&subject.validated.scene, Rules::ALL);
        Ok(plan.statuses.iter().map(Effect::new).collect())
    }

    /// The number of lights, without the environment and emissive surfaces; 0 if the scene has
    /// errors.
    #[must_use]
    pub fn lights(&self) -> usize {
        let loaded = self.loaded.as_ref();
        loaded.map_or(0, |loaded| loaded.lowered.scene.lights.len())
    }

    /// Adds a light; [`Scene::check`] validates it. Does nothing if the scene has errors.
    pub fn add_light(&mut self, light: Light) {
        if let Some(loaded) = &mut self.loaded {
            passes::add_light(&mut loaded.lowered.scene, light.0);
        }
    }

    /// Removes all lights except the environment and emissive surfaces.
    pub fn remove_lights(&mut self) {
        if let Some(loaded) = &mut self.loaded {
            passes::remove_lights(&mut loaded.lowered);
        }
    }

    /// Renders the picture.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the scene has errors, [`Error::Refused`] if an option is invalid or
    /// memory is too small, [`Error::TooManyRays`] if it needs more rays than allowed.
    pub fn render(&mut self, options: &Options) -> Result<Picture, Error> {
        self.render_until(options, &|| false)
    }

    /// Renders the picture unless it is stopped. All threads call `is_stopped` after each pixel,
    /// and during long ones.
    ///
    /// # Errors
    /// As [`Scene::render`], and [`Error::Stopped`].
    pub fn render_until(
        &mut self,
        options: &Options,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, Error> {
        // Validate the scene with the options.
        let mut setup = options.setup()?;
        let mut subject = self.validate(options, &mut setup)?;
        let observer = Observer {
            on_step: &|_| (),
            is_stopped,
        };
        let rays = options.rays.unwrap_or(self.input.rays());
        // Measure the light, then check window and memory.
        let made = setup.light(&mut subject, &mut self.input, &observer);
        let made = made.and_then(|()| {
            let window = setup.window(&subject.validated.lowered.scene)?;
            setup.check_memory(&mut subject, window)?;
            // Render, to a target error if there is one.
            let order = (window, rays);
            setup.check_layers()?;
            let (film, quality, error) = if options.target_error.is_some() {
                let grown = setup.approach(&mut subject, order, &observer)?;
                let film = Film {
                    image: grown.image,
                    coverage: grown.coverage,
                    counts: grown.counts,
                };
                (
                    film,
                    grown.quality,
                    grown.undersampled.is_none().then_some(grown.error),
                )
            } else {
                let Traced { film, probed } = setup.trace(&mut subject, order, &observer)?;
                let verified = probed.filter(|probed| probed.undersampled.is_none());
                (film, Vec::new(), verified.map(|probed| probed.error))
            };
            // Develop the film to a picture.
            let counts = film.counts;
            let film = (film.image, film.coverage, &counts);
            let picture =
                setup.develop(&mut subject, film, &quality, &mut self.input, is_stopped)?;
            Ok((picture, counts, error))
        });
        // Attach what describes the picture.
        let (picture, counts, error) = made.map_err(|error| self.error(error))?;
        let origin = setup.origin(&subject.validated.lowered.scene);
        let look = setup.look.resolve(&subject.validated.scene.settings().mode);
        Ok(Picture::new(
            (picture, look, origin),
            options.format,
            (&counts, error),
            self.diagnostics(),
        ))
    }

    /// Validates the scene with these options.
    fn validate(
        &mut self,
        options: &Options,
        setup: &mut PictureSetup,
    ) -> Result<RenderSubject, Error> {
        self.restart();
        self.input.stage(options.stage());
        let validated = match self.loaded.clone() {
            Some(loaded) => setup.validate(loaded, &mut self.input),
            None => Ok(None),
        };
        let validated = validated.map_err(|error| self.error(error))?;
        validated.ok_or_else(|| Error::Invalid(self.diagnostics()))
    }

    /// Discards the diagnostics that are not from reading.
    fn restart(&mut self) {
        self.input.take_diagnostics();
        self.input.restore_diagnostics(self.found.clone());
    }

    /// The diagnostics so far.
    fn diagnostics(&mut self) -> Vec<Diagnostic> {
        let mut found = self.input.take_diagnostics();
        found.sort();
        let public = |found: &rtc_diag::Diagnostic| Diagnostic::new(found, self.input.map());
        found.kept().iter().map(public).collect()
    }

    fn error(&self, error: pipeline::RenderError) -> Error {
        Error::of_render(error, |found| Diagnostic::new(&found, self.input.map()))
    }
}
