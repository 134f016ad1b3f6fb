//! The options of a picture, and the steps from a loaded scene to the file: validate, render,
//! develop, encode.

use super::denoise::{Traced, require_paths};
use super::light::FirstView;
use super::{
    Input, LoadedScene, OutputTransform, RayCounter, Renderer, ValidatedScene, hash,
    picture_diagnostics,
};
use rayon::ThreadPoolBuildError;
use rtc_diag::Diagnostic;
use rtc_image::{Image, Picture, PictureHeader, PictureMetadata, PixelLayers};
use rtc_ir::{
    Camera, EntityField, EntityKind, Lens, Light, LoweredScene, Mode, Scene, Settings, ValuePath,
};
use rtc_passes::{self as passes, Framing, Overrides};
use rtc_plan::{self as plan, Plan, Rule, RuleSet};
use rtc_render::{Aov, Crop, FilmMonitor, RayCounts, RenderSelection, RenderStep, SimdLevel};
use rtc_study::{
    PixelQuality, Progress, RenderCallbacks, RenderGoal, RenderRequest, TargetResult, with_quality,
};
use rtc_valid::ValidScene;
use serde_json::Value;
use std::time::Duration;

/// Options of a picture in addition to its scene.
#[derive(Clone, Debug)]
pub struct PictureSetup {
    /// The output transform.
    pub look: OutputTransform,
    /// Overrides of the scene's settings.
    pub overrides: Overrides,
    /// IR settings by name and value, applied last.
    pub set: Vec<(String, String)>,
    /// Lens and settings that replace those of the scene: those of a picture that is rendered
    /// again.
    pub settings: Option<(Lens, Settings)>,
    /// The arithmetic of intersections.
    pub arithmetic: plan::Arithmetic,
    /// The crop window; `None` for the whole picture.
    pub crop: Option<Crop>,
    /// The target error and time; by default the samples of the scene.
    pub goal: RenderGoal,
    /// The number of threads, 0 for one per core.
    pub threads: usize,
    /// The SIMD level.
    pub simd: SimdLevel,
    /// The optimization rules that may be applied.
    pub rules: RuleSet,
    /// Whether to render without optimizations as well, and compare.
    pub verify: bool,
    /// Whether to denoise.
    pub denoise: bool,
    /// The clamp for indirect radiance of path tracing.
    pub clamp: Option<f64>,
    /// Whether the studio was added to the light of the scene.
    pub is_filled: bool,
}

/// A valid scene, with its renderer once it was made.
pub struct RenderSubject {
    /// The scene.
    pub validated: ValidatedScene,
    pub(super) renderer: Option<Renderer>,
    /// The view from which its light is measured.
    pub(super) first: FirstView,
    /// Diagnostics that were not reported yet.
    pub(super) pending: Vec<Diagnostic>,
    /// The settings of the scene that were replaced by others: name, value now, value before.
    pub(super) replaced: Vec<[String; 3]>,
}

/// The program and its version.
pub(super) const SOFTWARE: &str = concat!("rtc ", env!("CARGO_PKG_VERSION"));

/// Observes a render; called from all threads.
pub struct RenderObserver<'a> {
    /// Called after each pixel and during long ones.
    pub on_step: &'a (dyn Fn(RenderStep) + Sync),
    /// Whether to stop.
    pub is_stopped: &'a (dyn Fn() -> bool + Sync),
}

/// The clock and the observer of a render that takes samples in rounds.
pub struct Rounds<'a> {
    /// The time since the start of the time budget.
    pub elapsed: &'a (dyn Fn() -> Duration + Sync),
    /// Called before each round.
    pub begin: &'a (dyn Fn(Progress) + Sync),
}

/// Why there is no picture.
#[derive(Debug)]
pub enum RenderError {
    /// The observer stopped it.
    Stopped,
    /// The limit on rays was exceeded; the diagnostic has the position.
    RanOut(Box<Diagnostic>),
    /// It can't be rendered, for this reason.
    Refused(String),
}

impl From<ThreadPoolBuildError> for RenderError {
    fn from(error: ThreadPoolBuildError) -> Self {
        Self::Refused(format!("can't start threads: {error}"))
    }
}

impl PictureSetup {
    /// The options for this output transform, with defaults for the rest.
    #[must_use]
    pub fn new(look: OutputTransform) -> Self {
        Self {
            look,
            overrides: Overrides::default(),
            set: Vec::new(),
            settings: None,
            arithmetic: plan::Arithmetic::Robust,
            crop: None,
            goal: RenderGoal::default(),
            threads: 0,
            simd: SimdLevel::best(),
            rules: RuleSet::ALL,
            verify: false,
            denoise: false,
            clamp: None,
            is_filled: false,
        }
    }

    /// Applies the settings to a scene and validates it. `None` if it has errors, which are among
    /// the diagnostics.
    ///
    /// # Errors
    /// If a setting has an unknown name or an invalid value.
    pub fn validate(
        &mut self,
        loaded: LoadedScene,
        input: &mut Input,
    ) -> Result<Option<RenderSubject>, RenderError> {
        // Apply display settings, size and overrides, then validate.
        let (mut set, mut first, mut fitted) = (Ok(()), None, None);
        let mut replaced = Vec::new();
        let validated = input.validate(loaded, |lowered, provenance| {
            let is_traced = matches!(lowered.scene.settings.mode, Mode::Path(_));
            first = Some(FirstView {
                camera: lowered.scene.camera.clone(),
                is_traced,
                framing: provenance.framing,
                is_lit_asset: provenance.is_lit_asset && is_traced,
                fill: provenance.fill,
                adds_lamps: provenance.adds_lamps,
            });
            if provenance.is_asset && is_traced && !provenance.is_unlit {
                self.look.show_asset();
            }
            self.look.show_as(&lowered.scene);
            let before = self.unasked(&lowered.scene);
            fitted = resize(lowered, self.overrides.size, provenance.framing);
            self.overrides.apply(&mut lowered.scene);
            if let Some((lens, settings)) = &self.settings {
                lowered.scene.camera.lens = lens.clone();
                lowered.scene.settings = settings.clone();
                difference("", &self.described(&lowered.scene), &before, &mut replaced);
            }
            set = self.set.iter().try_for_each(|(name, value)| {
                passes::set(&mut lowered.scene.settings, name, value)
            });
        });
        let Some((validated, first)) = validated.zip(first) else {
            return Ok(None);
        };
        set.map_err(|message| RenderError::Refused(format!("--set: {message}")))?;
        // Keep diagnostics for the render.
        let imprecise = picture_diagnostics::imprecise(&validated, self.arithmetic);
        Ok(Some(RenderSubject {
            validated,
            renderer: None,
            first,
            pending: imprecise.into_iter().chain(fitted).collect(),
            replaced,
        }))
    }

    /// The crop window, clipped to the picture.
    ///
    /// # Errors
    /// If it is empty.
    pub fn window(&self, scene: &Scene) -> Result<Crop, RenderError> {
        let [width, height] = scene.camera.size;
        let window = self.crop.map_or(
            Crop {
                x: 0,
                y: 0,
                width,
                height,
            },
            |crop| crop.within(width, height),
        );
        if window.width == 0 || window.height == 0 {
            return Err(RenderError::Refused(format!(
                "the crop is outside the picture of {width}×{height} pixels"
            )));
        }
        Ok(window)
    }

    /// Checks that there is enough memory for a picture.
    ///
    /// # Errors
    /// If there is not, or the threads can't be started.
    pub fn check_memory(
        &self,
        subject: &mut RenderSubject,
        window: Crop,
    ) -> Result<(), RenderError> {
        /// Bytes per pixel of a film with its counts, and of a progressive one.
        const FILM: [usize; 2] = [40, 320];
        let Crop { width, height, .. } = window;
        let pixel = FILM[usize::from(self.is_progressive())]
            + self.look.memory()
            + self.denoiser_memory()
            + self.measured_memory();
        let bytes = (width as usize)
            .saturating_mul(height as usize)
            .saturating_mul(pixel);
        if self.renderer(subject)?.1.has_memory(bytes) {
            return Ok(());
        }
        let size = bytes.div_ceil(1 << 20);
        Err(RenderError::Refused(format!(
            "there is no memory for a picture of {width}×{height} pixels: it takes up to {size} \
            MiB; `--strips=16` holds 16 rows at a time"
        )))
    }

    /// Renders the picture with the settings of the scene, with at most `rays` rays.
    ///
    /// # Errors
    /// If there is no picture.
    pub fn trace(
        &self,
        subject: &mut RenderSubject,
        order: (Crop, u64),
        observer: &RenderObserver<'_>,
    ) -> Result<Traced, RenderError> {
        self.trace_monitored(subject, order, observer, None)
    }

    /// As [`Self::trace`], where a monitor may show the film meanwhile, unless it is verified,
    /// denoised or measured.
    ///
    /// # Errors
    /// As [`Self::trace`].
    pub fn trace_monitored(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        observer: &RenderObserver<'_>,
        monitor: Option<&FilmMonitor>,
    ) -> Result<Traced, RenderError> {
        // The job.
        let job = RenderSelection {
            crop: Some(window),
            values: self.look.values(&subject.validated.scene.settings().mode),
            background: self.look.background(),
            clamp: self.clamp,
            ..RenderSelection::default()
        };
        if self.clamp.is_some() {
            require_paths(&subject.validated.scene, "--clamp")?;
        }
        // Count rays, and stop at the limit.
        let counter = RayCounter::of_each(rays, window, 1 + usize::from(self.verify));
        let on_pixel = |step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && counter.step(step)
        };
        // Render: verified, denoised, or directly.
        let traced = if self.verify {
            let scene = &subject.validated.scene;
            super::verify(scene, &self.plan(scene), &job, self.threads, &on_pixel)?
                .map(|film| film.map(Traced::from))
        } else if self.denoise {
            self.denoised(subject, &job, (&on_pixel, &counter))?.map(Ok)
        } else if self.is_measured() {
            match self.measured(subject, &job, (&on_pixel, &counter))? {
                Some((film, quality)) => {
                    let film = film.develop();
                    let film = film.map_err(|error| RenderError::Refused(error.to_string()))?;
                    Some(Ok(Traced {
                        quality,
                        ..film.into()
                    }))
                }
                None => None,
            }
        } else {
            let job = RenderSelection { monitor, ..job };
            let film = self.renderer(subject)?.1.render(&job, &on_pixel);
            film.map(|film| Ok(film.into()))
        };
        if let Some(diagnostic) = subject.ran_out(&counter, observer) {
            return Err(RenderError::RanOut(diagnostic));
        }
        let rejected =
            |mismatch| RenderError::Refused(picture_diagnostics::verification_failure(&mismatch));
        traced.ok_or(RenderError::Stopped)?.map_err(rejected)
    }

    /// The picture of a film, with the quality of its pixels if layers show it.
    /// Diagnostics about it go to `input`.
    ///
    /// # Errors
    /// If it was stopped.
    pub fn develop(
        &self,
        subject: &mut RenderSubject,
        (image, coverage, counts): (Image, Vec<f32>, &RayCounts),
        quality: &[PixelQuality],
        input: &mut Input,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, RenderError> {
        self.report_empty_picture(subject, counts, input);
        self.report_dark_picture(subject, (&image, &coverage), input);
        let job = RenderSelection {
            crop: Some(self.window(&subject.validated.lowered.scene)?),
            ..RenderSelection::default()
        };
        let layers = self.layers(subject, &job, is_stopped)?;
        let layers = with_quality(layers, &self.look.aovs, quality);
        let look = self.look.resolve(&subject.validated.scene.settings().mode);
        let film = (image, coverage, counts.unnumbered);
        let (picture, found) = look.finish(film, layers, self.arithmetic);
        found
            .into_iter()
            .for_each(|diagnostic| input.push(diagnostic));
        Ok(picture)
    }

    /// Reports an empty picture.
    pub(super) fn report_empty_picture(
        &self,
        subject: &RenderSubject,
        counts: &RayCounts,
        input: &mut Input,
    ) {
        if self.crop.is_none() && counts.hits == 0 {
            let camera = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
            let camera = subject.validated.lowered.source_spans.span(camera);
            input.push(picture_diagnostics::nothing_in_view(camera));
        }
    }

    /// Reports a picture of black surfaces of a scene with light.
    fn report_dark_picture(
        &self,
        subject: &RenderSubject,
        (image, coverage): (&Image, &[f32]),
        input: &mut Input,
    ) {
        let LoweredScene {
            scene,
            source_spans,
        } = &subject.validated.lowered;
        let is_shaded = matches!(scene.settings.mode, Mode::Phong | Mode::Path(_));
        let light = scene.lights.iter().position(Light::emits);
        let has_light = light.is_some() || passes::emissive_surfaces(scene).contains(&true);
        if self.crop.is_some() || !is_shaded || !has_light {
            return;
        }
        // Pixels that show nothing but surfaces.
        let shown = image.pixels.iter().zip(coverage);
        let mut shown = shown.filter(|(_, coverage)| **coverage >= 1.0).peekable();
        if shown.peek().is_some() && shown.all(|(pixel, _)| *pixel == [0.0; 3]) {
            let light = light.map(|at| ValuePath::new(EntityKind::Light, at, EntityField::Whole));
            let span = light.and_then(|light| source_spans.span(light));
            input.push(picture_diagnostics::dark(span));
        }
    }

    /// A warning about a picture without a time budget that ended above its target error: with
    /// this bound on its error in grey levels, if it is not `undersampled`.
    #[must_use]
    pub fn above_target(&self, error: f64, undersampled: Option<f64>) -> Option<Diagnostic> {
        let target = self.goal.error.filter(|_| self.goal.time.is_none())?;
        let error = undersampled.is_none().then_some(error);
        let is_unmet = error.is_none_or(|error| error > target);
        is_unmet.then(|| picture_diagnostics::above_target(target, error))
    }

    /// Rejects layers of sample statistics of pictures that show something else than the mean of
    /// the samples, or are rendered twice.
    ///
    /// # Errors
    /// If there is such a layer.
    pub fn check_layers(&self) -> Result<(), RenderError> {
        let options = [
            (self.denoise, "--denoise"),
            (self.verify, "--verify-effects"),
        ];
        let named = options.iter().find(|(is_on, _)| *is_on);
        match named {
            Some((_, option)) if self.is_measured() => Err(RenderError::Refused(format!(
                "layers of samples (error, samples, unmet) are not of pictures by `{option}`"
            ))),
            _ => Ok(()),
        }
    }

    /// The requested layers of first hits, for the pixels of a job.
    pub(super) fn layers(
        &self,
        subject: &mut RenderSubject,
        job: &RenderSelection,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<PixelLayers, RenderError> {
        let mut aovs = self.look.aovs.clone();
        aovs.retain(|aov| !aov.is_of_samples());
        if aovs.is_empty() {
            return Ok(PixelLayers::default());
        }
        let (_, renderer) = self.renderer(subject)?;
        let layers = renderer.layers(&aovs, job, &|| !is_stopped());
        layers.ok_or(RenderError::Stopped)
    }

    /// The bytes of the file of a picture.
    ///
    /// # Errors
    /// If the picture is larger than the format allows.
    pub fn encode(
        &self,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<u8>, RenderError> {
        let metadata = || self.metadata(&subject.validated.lowered.scene);
        let look = self.look.resolve(&subject.validated.scene.settings().mode);
        let bytes = look.encode(picture, metadata);
        bytes.map_err(|error| RenderError::Refused(error.to_string()))
    }

    /// The plan of a scene.
    fn plan(&self, scene: &ValidScene) -> Plan {
        Plan::with_arithmetic(self.arithmetic, scene, self.rules)
    }

    /// The scene and its renderer, which is made on first use.
    ///
    /// # Errors
    /// If the threads can't be started.
    pub fn renderer<'s>(
        &self,
        subject: &'s mut RenderSubject,
    ) -> Result<(&'s ValidatedScene, &'s mut Renderer), ThreadPoolBuildError> {
        let RenderSubject {
            validated,
            renderer,
            ..
        } = subject;
        let made = match renderer.take() {
            Some(made) => made,
            None => {
                let plan = self.plan(&validated.scene);
                Renderer::at_level(&validated.scene, &plan, self.threads, self.simd)?
            }
        };
        Ok((validated, renderer.insert(made)))
    }

    /// Stores the hierarchy over the meshes of the scene in its IR, if there is one.
    ///
    /// # Errors
    /// If the threads can't be started.
    pub fn store_tree(&self, subject: &mut RenderSubject) -> Result<(), RenderError> {
        let (_, renderer) = self.renderer(subject)?;
        let tree = renderer.tree_to_store();
        subject.validated.lowered.scene.trees = tree.into_iter().collect();
        Ok(())
    }

    /// The metadata that identifies the picture: rtc version, scene, settings.
    #[must_use]
    pub fn metadata(&self, scene: &Scene) -> PictureMetadata {
        PictureMetadata {
            software: SOFTWARE.to_owned(),
            scene: hash(scene),
            settings: self.described(scene).to_string(),
            world_to_camera: scene.camera.world_to_camera(),
            layer: String::new(),
        }
    }

    /// The settings that the metadata of the picture hold.
    fn described(&self, scene: &Scene) -> Value {
        let mut settings = serde_json::json!({
            "size": scene.camera.size,
            "lens": scene.camera.lens,
            "settings": scene.settings,
            "crop": self.crop.map(|Crop { x, y, width, height }| [x, y, width, height]),
        });
        if let Some(levels) = self.goal.error {
            settings["targetError"] = levels.into();
        }
        if let Some(time) = self.goal.time {
            settings["timeBudget"] = time.as_secs_f64().into();
        }
        if self.denoise {
            settings["denoiser"] = "regression-2".into();
        }
        if let Some(limit) = self.clamp {
            settings["clamp"] = limit.into();
        }
        if let Some(rays) = self.overrides.glossy_samples {
            settings["glossySamples"] = rays.into();
        }
        if self.arithmetic != plan::Arithmetic::Robust {
            settings["arithmetic"] = serde_json::json!(self.arithmetic);
        }
        if self.rules.contains(Rule::Cut) {
            settings["approx"] = true.into();
        }
        self.look.describe(&mut settings);
        settings
    }

    /// The settings of the picture that the scene defines by itself.
    fn unasked(&self, scene: &Scene) -> Value {
        let look = self.look.unasked(scene);
        Self::new(look).described(scene)
    }
}

impl RenderSubject {
    /// How its view was framed, if its scene has no camera.
    #[must_use]
    pub fn framing(&self) -> Option<Framing> {
        self.first.framing
    }

    /// Shows it, and measures its light, by another camera. `None` if the camera can't see it.
    #[must_use]
    pub fn see_by(&mut self, camera: &Camera) -> Option<()> {
        let validated = &mut self.validated;
        validated.scene = validated.scene.seen_by(camera)?;
        validated.lowered.scene.camera = camera.clone();
        self.first.camera = camera.clone();
        self.turn();
        Some(())
    }

    /// Updates the renderer after the camera of the scene was changed.
    pub fn turn(&mut self) {
        if let Some(renderer) = &mut self.renderer {
            renderer.change(self.validated.scene.clone());
        }
    }

    /// The diagnostic if the limit on rays was exceeded, unless the observer stopped the render.
    #[must_use]
    pub fn ran_out(
        &self,
        counter: &RayCounter,
        observer: &RenderObserver<'_>,
    ) -> Option<Box<Diagnostic>> {
        let pixel = counter.ran_out().filter(|_| !(observer.is_stopped)())?;
        Some(Box::new(counter.diagnostic(&self.validated.lowered, pixel)))
    }
}

/// The leaves in which two JSON trees differ: their paths and both values; null where there is
/// none.
fn difference(path: &str, new: &Value, old: &Value, found: &mut Vec<[String; 3]>) {
    match (new, old) {
        (Value::Object(a), Value::Object(b)) => {
            let others = b.keys().filter(|name| !a.contains_key(*name));
            for name in a.keys().chain(others) {
                let path = [path, name].join(if path.is_empty() { "" } else { "." });
                difference(&path, &new[name], &old[name], found);
            }
        }
        _ if new == old => {}
        _ => found.push([path.to_owned(), new.to_string(), old.to_string()]),
    }
}

/// Frames a framed view again for the requested size. The overrides fit any other view, which may
/// give a diagnostic.
fn resize(
    LoweredScene {
        scene,
        source_spans,
    }: &mut LoweredScene,
    size: Option<[u32; 2]>,
    framing: Option<Framing>,
) -> Option<Diagnostic> {
    let requested = size?;
    if let Some(framing) = framing {
        Framing { size, ..framing }.apply(scene, source_spans);
        return None;
    }
    picture_diagnostics::fitted(scene.camera.size, requested)
}

impl PictureSetup {
    /// The target of a picture or a part of it, with the remaining time.
    #[must_use]
    pub fn order(
        &self,
        subject: &RenderSubject,
        crop: Crop,
        time: Option<Duration>,
    ) -> RenderRequest {
        let mode = &subject.validated.scene.settings().mode;
        RenderRequest {
            goal: RenderGoal { time, ..self.goal },
            crop,
            background: self.look.background(),
            values: self.look.values(mode),
            display: self.look.display(mode),
            keep_lights: self.overrides.light_samples.is_some(),
            seed: 0,
        }
    }

    /// Takes samples until the goal is reached, with at most `rays` rays. The time is that of
    /// `rounds`.
    ///
    /// # Errors
    /// If there is no picture.
    pub fn approach(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        observer: &RenderObserver<'_>,
        rounds: &Rounds<'_>,
    ) -> Result<TargetResult, RenderError> {
        let order = self.order(subject, window, self.goal.time);
        let counter = RayCounter::new(rays, window);
        let watch = RenderCallbacks {
            on_pixel: &|step| {
                (observer.on_step)(step);
                !(observer.is_stopped)() && counter.step(step)
            },
            is_stopped: observer.is_stopped,
            elapsed: rounds.elapsed,
            round: &|progress| {
                (rounds.begin)(progress);
                counter.begin_round();
            },
        };
        let (validated, renderer) = self.renderer(subject)?;
        let reached = renderer.approach(&validated.lowered.scene, &order, &watch, None);
        match subject.ran_out(&counter, observer) {
            Some(diagnostic) => Err(RenderError::RanOut(diagnostic)),
            None => reached.map_err(|_| RenderError::Stopped),
        }
    }
}

impl PictureSetup {
    /// The PNG of a layer, with the bits of the picture. Its metadata has the name of the layer and
    /// the values of black and white.
    ///
    /// # Errors
    /// If there is no such layer, or it is larger than the format allows.
    pub fn encode_layer(
        &self,
        aov: Aov,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<u8>, RenderError> {
        let rejected = |message: String| RenderError::Refused(message);
        let layer = picture.layer_picture(aov.channels());
        let layer = layer.ok_or_else(|| rejected(format!("there is no layer `{}`", aov.name())))?;
        let mut metadata = serde_json::json!({ "layer": aov.name() });
        if !layer.ranges.is_empty() {
            metadata["ranges"] = serde_json::json!(layer.ranges);
        }
        let look = self.look.resolve(&subject.validated.scene.settings().mode);
        let displayed = Picture::opaque(layer.image);
        let head = PictureHeader {
            is_color: layer.is_color,
            metadata: look.metadata(PictureMetadata {
                layer: metadata.to_string(),
                ..self.metadata(&subject.validated.lowered.scene)
            }),
            ..PictureHeader::of(&displayed, self.look.kind)
        };
        let bytes = head.encode(&displayed);
        bytes.map_err(|error| rejected(error.to_string()))
    }
}
