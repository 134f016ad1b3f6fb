//! A picture as it is asked for: from a scene that was loaded to a film, and to the picture that a
//! file holds.

use super::denoise::{Traced, require_paths};
use super::light::FirstView;
use super::{
    Input, Loaded, OutputTransform, Proven, Provenance, RayCounter, Renderer, findings, hash,
};
use rayon::ThreadPoolBuildError;
use rtc_diag::Diagnostic;
use rtc_image::{Image, Layers, Origin, Picture};
use rtc_ir::{EntityKind, Field, Mode, Scene, ValuePath};
use rtc_passes::{self as passes, Framing, Overrides};
use rtc_plan::{self as plan, Plan, Rules};
use rtc_render::{Counts, Crop, Job, SimdLevel, Step};
use rtc_study::Goal;
use rtc_valid::ValidScene;

/// How a picture is made, beside what its scene says.
#[derive(Clone, Debug)]
pub struct PictureSetup {
    /// How it looks.
    pub look: OutputTransform,
    /// The settings that replace those of the scene.
    pub overrides: Overrides,
    /// Settings of the IR by their names there, which replace those of the scene last of all.
    pub set: Vec<(String, String)>,
    /// How rays meet shapes.
    pub arithmetic: plan::Arithmetic,
    /// The part that is rendered; all of it without.
    pub crop: Option<Crop>,
    /// When it is good enough; as the scene says without.
    pub goal: Goal,
    /// Threads, 0 for one per core.
    pub threads: usize,
    /// Vector instructions.
    pub simd: SimdLevel,
    /// The rules that may leave something out.
    pub rules: Rules,
    /// Whether what was left out is simulated too, and compared.
    pub verify: bool,
    /// Whether the picture is denoised.
    pub denoise: bool,
    /// The radiance that a traced path brings at most after its first bounce.
    pub clamp: Option<f64>,
    /// Whether the studio was found to fill in beside the light of the scene.
    pub is_filled: bool,
}

/// What pictures are taken of: a proven scene, and its renderer from the first picture on.
pub struct RenderSubject {
    /// The scene.
    pub proven: Proven,
    pub(super) renderer: Option<Renderer>,
    /// The view by which its light is found.
    pub(super) first: FirstView,
    /// What is still to be said of it.
    pub(super) remarks: Vec<Diagnostic>,
}

/// Who looks on while a picture is rendered, on all its threads.
pub struct Observer<'a> {
    /// Called after each pixel and within long ones.
    pub on_step: &'a (dyn Fn(Step) + Sync),
    /// Whether to stop.
    pub is_stopped: &'a (dyn Fn() -> bool + Sync),
}

/// Why there is no picture.
#[derive(Debug)]
pub enum RenderError {
    /// The observer said stop.
    Stopped,
    /// The limit on rays was reached; the finding says where.
    RanOut(Box<Diagnostic>),
    /// It can't be made, for this reason.
    Refused(String),
}

impl From<ThreadPoolBuildError> for RenderError {
    fn from(fault: ThreadPoolBuildError) -> Self {
        Self::Refused(format!("can't start threads: {fault}"))
    }
}

impl PictureSetup {
    /// A picture of this look, all else as the scene says.
    #[must_use]
    pub fn new(look: OutputTransform) -> Self {
        Self {
            look,
            overrides: Overrides::default(),
            set: Vec::new(),
            arithmetic: plan::Arithmetic::Robust,
            crop: None,
            goal: Goal::default(),
            threads: 0,
            simd: SimdLevel::best(),
            rules: Rules::ALL,
            verify: false,
            denoise: false,
            clamp: None,
            is_filled: false,
        }
    }

    /// Proves a scene with the settings asked for. `None` if it has errors; the findings say which.
    ///
    /// # Errors
    /// If a setting has no such name or value.
    pub fn validate(
        &mut self,
        loaded: Loaded,
        input: &mut Input,
    ) -> Result<Option<RenderSubject>, RenderError> {
        let (mut set, mut first, mut fitted) = (Ok(()), None, None);
        let proven = input.validate(loaded, |lowered, provenance| {
            let is_traced = matches!(lowered.scene.settings.mode, Mode::Path(_));
            first = Some(FirstView {
                camera: lowered.scene.camera.clone(),
                is_lit_asset: provenance.is_lit_asset && is_traced,
                fill: provenance.fill,
            });
            if provenance.is_asset && is_traced && !provenance.is_unlit {
                self.look.show_asset();
            }
            self.look.show_as(&lowered.scene.display);
            fitted = resize(&mut lowered.scene, self.overrides.size, provenance);
            self.overrides.apply(&mut lowered.scene);
            set = self.set.iter().try_for_each(|(name, value)| {
                passes::set(&mut lowered.scene.settings, name, value)
            });
        });
        let Some((proven, first)) = proven.zip(first) else {
            return Ok(None);
        };
        set.map_err(|words| RenderError::Refused(format!("--set: {words}")))?;
        let imprecise = findings::imprecise(&proven, self.arithmetic);
        Ok(Some(RenderSubject {
            proven,
            renderer: None,
            first,
            remarks: imprecise.into_iter().chain(fitted).collect(),
        }))
    }

    /// The part of the picture that is rendered.
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
                "the crop lies outside the picture of {width}×{height} pixels"
            )));
        }
        Ok(window)
    }

    /// Refuses a picture that there is no memory for.
    ///
    /// # Errors
    /// If there is none, or the system gives no threads.
    pub fn find_room(&self, subject: &mut RenderSubject, window: Crop) -> Result<(), RenderError> {
        /// A pixel of a film, with what is counted of it; and of one that grows.
        const FILM: [usize; 2] = [40, 320];
        let Crop { width, height, .. } = window;
        let pixel = FILM[usize::from(self.goal != Goal::default())]
            + self.look.memory()
            + self.denoiser_memory();
        let bytes = (width as usize)
            .saturating_mul(height as usize)
            .saturating_mul(pixel);
        if self.renderer(subject)?.1.has_room(bytes) {
            return Ok(());
        }
        let size = bytes.div_ceil(1 << 20);
        Err(RenderError::Refused(format!(
            "there is no memory for a picture of {width}×{height} pixels: it takes up to {size} MiB; \
             `--strips=16` holds 16 rows at a time"
        )))
    }

    /// The picture in the setting of the scene, or where its rays, at most so many, ran out.
    ///
    /// # Errors
    /// If there is none.
    pub fn trace(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        observer: &Observer<'_>,
    ) -> Result<Traced, RenderError> {
        let job = Job {
            crop: Some(window),
            values: self.look.values(&subject.proven.scene.settings().mode),
            background: self.look.background(),
            clamp: self.clamp,
            ..Job::default()
        };
        if self.clamp.is_some() {
            require_paths(&subject.proven.scene, "--clamp")?;
        }
        let meter = RayCounter::of_each(rays, window, 1 + usize::from(self.verify));
        let on_pixel = |step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && meter.step(step)
        };
        let traced = if self.verify {
            let scene = &subject.proven.scene;
            super::verify(scene, &self.plan(scene), &job, self.threads, &on_pixel)?
                .map(|film| film.map(Traced::from))
        } else if self.denoise {
            self.denoised(subject, &job, (&on_pixel, &meter))?.map(Ok)
        } else {
            let film = self.renderer(subject)?.1.render(&job, &on_pixel);
            film.map(|film| Ok(film.into()))
        };
        if let Some(finding) = subject.ran_out(&meter, observer) {
            return Err(RenderError::RanOut(finding));
        }
        let refused = |mismatch| RenderError::Refused(findings::left_out(&mismatch));
        traced.ok_or(RenderError::Stopped)?.map_err(refused)
    }

    /// The picture of a film, and what is found in it.
    ///
    /// # Errors
    /// If someone said stop.
    pub fn develop(
        &self,
        subject: &mut RenderSubject,
        (image, coverage, counts): (Image, Vec<f32>, &Counts),
        input: &mut Input,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Picture, RenderError> {
        self.look_for_hits(subject, counts, input);
        let job = Job {
            crop: Some(self.window(&subject.proven.lowered.scene)?),
            ..Job::default()
        };
        let layers = self.layers(subject, &job, is_stopped)?;
        let look = self.look.settled(&subject.proven.scene.settings().mode);
        let film = (image, coverage, counts.unnumbered);
        let (picture, found) = look.finish(film, layers, self.arithmetic);
        found.into_iter().for_each(|finding| input.push(finding));
        Ok(picture)
    }

    /// Remarks that the picture is empty, if it is.
    pub(super) fn look_for_hits(
        &self,
        subject: &RenderSubject,
        counts: &Counts,
        input: &mut Input,
    ) {
        if self.crop.is_none() && counts.hits == 0 {
            let camera = ValuePath::new(EntityKind::Camera, 0, Field::Whole);
            let camera = subject.proven.lowered.source_spans.span(camera);
            input.push(findings::nothing_in_view(camera));
        }
    }

    /// The layers asked for, of the pixels of a job.
    pub(super) fn layers(
        &self,
        subject: &mut RenderSubject,
        job: &Job,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Layers, RenderError> {
        if self.look.aovs.is_empty() {
            return Ok(Layers::default());
        }
        let (_, renderer) = self.renderer(subject)?;
        let layers = renderer.layers(&self.look.aovs, job, &|| !is_stopped());
        layers.ok_or(RenderError::Stopped)
    }

    /// The bytes of the file of a picture.
    ///
    /// # Errors
    /// If the picture is larger than the format can hold.
    pub fn encode(
        &self,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<u8>, RenderError> {
        let origin = || self.origin(&subject.proven.lowered.scene);
        let look = self.look.settled(&subject.proven.scene.settings().mode);
        let bytes = look.encode(picture, origin);
        bytes.map_err(|error| RenderError::Refused(error.to_string()))
    }

    /// What a scene needs for its picture.
    fn plan(&self, scene: &ValidScene) -> Plan {
        Plan::with_arithmetic(self.arithmetic, scene, self.rules)
    }

    /// A scene and its renderer, which is made when it is first asked for.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn renderer<'s>(
        &self,
        subject: &'s mut RenderSubject,
    ) -> Result<(&'s Proven, &'s mut Renderer), ThreadPoolBuildError> {
        let RenderSubject {
            proven, renderer, ..
        } = subject;
        let made = match renderer.take() {
            Some(made) => made,
            None => {
                let plan = self.plan(&proven.scene);
                Renderer::at_level(&proven.scene, &plan, self.threads, self.simd)?
            }
        };
        Ok((proven, renderer.insert(made)))
    }

    /// Enough to make the same picture again: which rtc, which scene, which part of it.
    #[must_use]
    pub fn origin(&self, scene: &Scene) -> Origin {
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
            settings["denoiser"] = "regression-1".into();
        }
        if let Some(limit) = self.clamp {
            settings["clamp"] = limit.into();
        }
        self.look.describe(&mut settings);
        Origin {
            software: concat!("rtc ", env!("CARGO_PKG_VERSION")).to_owned(),
            scene: hash(scene),
            settings: settings.to_string(),
            world_to_camera: scene.camera.world_to_camera(),
            layer: String::new(),
        }
    }
}

impl RenderSubject {
    /// Shows it as it is now, which differs from before in its camera alone.
    pub fn turn(&mut self) {
        if let Some(renderer) = &mut self.renderer {
            renderer.change(self.proven.scene.clone());
        }
    }

    /// What to say if the rays ran out, unless the observer ended the render.
    #[must_use]
    pub fn ran_out(&self, meter: &RayCounter, observer: &Observer<'_>) -> Option<Box<Diagnostic>> {
        let pixel = meter.ran_out().filter(|_| !(observer.is_stopped)())?;
        Some(Box::new(meter.finding(&self.proven.lowered, pixel)))
    }
}

/// Gives the view of an asset a picture of another size: it shows no less than before; what is to be
/// said of that. Other scenes keep their height.
fn resize(
    scene: &mut Scene,
    size: Option<[u32; 2]>,
    provenance: &Provenance,
) -> Option<Diagnostic> {
    match (size, provenance.framing) {
        (Some(_), Some(framing)) => Framing { size, ..framing }.apply(scene),
        (Some(size), None) if provenance.is_asset => {
            let before = scene.camera.size;
            scene.camera.fit(size);
            return findings::fitted(before, size);
        }
        _ => {}
    }
    None
}
