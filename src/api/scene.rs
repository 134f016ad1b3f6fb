//! A scene that a caller holds.

use super::{Effect, Error, Finding, Light, Options, Picture, Reading};
use rtc_diag::{Diagnostic, Sink};
use rtc_passes as passes;
use rtc_pipeline::{
    self as pipeline, Input, Loaded, Observer, PictureSetup, RenderSubject, Traced,
};
use rtc_plan::{Plan, Rules};
use rtc_render::Film;
use std::fmt;
use std::path::Path;

/// A scene that was read, in any form: the YAML or JSON of the course, glTF, a mesh, or the IR.
pub struct Scene {
    input: Input,
    /// As it was read, and changed since; `None` if it has errors.
    loaded: Option<Loaded>,
    /// What was found while it was read.
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
    /// Reads the scene in a file; [`Reading`] says how, where this is not enough.
    ///
    /// What the scene names is read too. Mistakes in it are findings of [`Scene::check`].
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is no such file, or it can't be read.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Reading::new().open(path)
    }

    /// Takes the scene at `path` of `files`, in memory, each a path with `/` between components and
    /// the bytes of the file; the scene may name the others.
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
        let found = input.take_findings();
        if !input.is_read() {
            let findings = found.kept().iter();
            let findings = findings.map(|found| Finding::new(found, input.map()));
            return Err(Error::Invalid(findings.collect()));
        }
        Ok(Self {
            input,
            loaded,
            found,
        })
    }

    /// All that is to be said of it, in the order of its text; one with errors has no picture.
    pub fn check(&mut self) -> Vec<Finding> {
        self.restart();
        if let Some(loaded) = self.loaded.clone() {
            self.input.unstage();
            self.input.validate(loaded, |_, _| ());
        }
        self.findings()
    }

    /// What its picture needs and what is left out of it, each with the reason: the parts of the
    /// picture by their names, then those of single lights, materials and surfaces.
    ///
    /// # Errors
    /// As [`Scene::render`].
    pub fn effects(&mut self, options: &Options) -> Result<Vec<Effect>, Error> {
        let subject = self.validate(options, &mut options.setup()?)?;
        let plan = Plan::new(&subject.proven.scene, Rules::ALL);
        Ok(plan.statuses.iter().map(Effect::new).collect())
    }

    /// How many lights it has, besides surroundings and surfaces that glow; 0 if it has errors.
    #[must_use]
    pub fn lights(&self) -> usize {
        let loaded = self.loaded.as_ref();
        loaded.map_or(0, |loaded| loaded.lowered.scene.lights.len())
    }

    /// Adds a light, which [`Scene::check`] judges like the others; nothing if it has errors.
    pub fn add_light(&mut self, light: Light) {
        if let Some(loaded) = &mut self.loaded {
            passes::add_light(&mut loaded.lowered.scene, light.0);
        }
    }

    /// Takes its lights away, besides surroundings and surfaces that glow.
    pub fn remove_lights(&mut self) {
        if let Some(loaded) = &mut self.loaded {
            passes::remove_lights(&mut loaded.lowered);
        }
    }

    /// Renders its picture.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it has errors, [`Error::Refused`] if the options don't fit or there is
    /// no memory, [`Error::TooManyRays`] if it takes more rays than it may.
    pub fn render(&mut self, options: &Options) -> Result<Picture, Error> {
        self.render_until(options, &|| false)
    }

    /// Renders its picture, unless it is stopped: `is_stopped` is asked from all threads, after each
    /// pixel and within long ones.
    ///
    /// # Errors
    /// As [`Scene::render`], and [`Error::Stopped`].
    pub fn render_until(
        &mut self,
        options: &Options,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, Error> {
        let mut setup = options.setup()?;
        let mut subject = self.validate(options, &mut setup)?;
        let observer = Observer {
            on_step: &|_| (),
            is_stopped,
        };
        let rays = options.rays.unwrap_or(self.input.rays());
        let made = setup.light(&mut subject, &mut self.input, &observer);
        let made = made.and_then(|()| {
            let window = setup.window(&subject.proven.lowered.scene)?;
            setup.find_room(&mut subject, window)?;
            let order = (window, rays);
            let (film, error) = if options.target_error.is_some() {
                let grown = setup.approach(&mut subject, order, &observer)?;
                let film = Film {
                    image: grown.image,
                    coverage: grown.coverage,
                    counts: grown.counts,
                };
                (film, grown.undersampled.is_none().then_some(grown.error))
            } else {
                let Traced { film, probed } = setup.trace(&mut subject, order, &observer)?;
                let told = probed.filter(|probed| probed.undersampled.is_none());
                (film, told.map(|probed| probed.error))
            };
            let counts = film.counts;
            let film = (film.image, film.coverage, &counts);
            let picture = setup.develop(&mut subject, film, &mut self.input, is_stopped)?;
            Ok((picture, counts, error))
        });
        let (picture, counts, error) = made.map_err(|error| self.error(error))?;
        let origin = setup.origin(&subject.proven.lowered.scene);
        let look = setup.look.settled(&subject.proven.scene.settings().mode);
        Ok(Picture::new(
            (picture, look, origin),
            options.format,
            (&counts, error),
            self.findings(),
        ))
    }

    /// The scene as the options ask for it, proven.
    fn validate(
        &mut self,
        options: &Options,
        setup: &mut PictureSetup,
    ) -> Result<RenderSubject, Error> {
        self.restart();
        self.input.stage(options.stage());
        let proven = match self.loaded.clone() {
            Some(loaded) => setup.validate(loaded, &mut self.input),
            None => Ok(None),
        };
        let proven = proven.map_err(|error| self.error(error))?;
        proven.ok_or_else(|| Error::Invalid(self.findings()))
    }

    /// Forgets what was found after it was read.
    fn restart(&mut self) {
        self.input.take_findings();
        self.input.put_findings(self.found.clone());
    }

    /// What was found.
    fn findings(&mut self) -> Vec<Finding> {
        let mut found = self.input.take_findings();
        found.sort();
        let public = |found: &Diagnostic| Finding::new(found, self.input.map());
        found.kept().iter().map(public).collect()
    }

    fn error(&self, error: pipeline::RenderError) -> Error {
        Error::of_render(error, |found| Finding::new(&found, self.input.map()))
    }
}
