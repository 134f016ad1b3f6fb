//! Options of reading a scene and of rendering a picture.

use super::progress::ProgressCallback;
use super::{Aov, Error, Progress, Scene, Tone};
use rtc_image::BackgroundFill;
use rtc_image::FileFormat;
use rtc_passes::{
    EnvironmentOverride, IntegratorChoice, OrbitAngles, Overrides, View, ViewAndLight,
};
use rtc_pipeline::{self as pipeline, Exposure, Input, OutputTransform, PictureSetup};
use rtc_plan::Arithmetic;
use rtc_render::Crop;
use rtc_source::MemoryFiles;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Options of reading a scene.
///
/// ```
/// use rtc::{Reading, Severity};
///
/// let text = "Objects:\n- {type: sphere, position: [0, 0, 0], raduis: 1}\n";
/// let files = [("a.yaml".to_owned(), text.into())];
/// let found = Reading::new().strict(true).from_files("a.yaml", files)?.check();
/// let typo = found.iter().find(|found| found.code == "SC001").unwrap();
/// assert_eq!(typo.severity, Severity::Error);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "it reads nothing until a scene is opened by it"]
pub struct Reading(pipeline::Options);

impl Reading {
    /// The options of [`Scene::open`].
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether unknown keys are errors.
    pub fn strict(mut self, strict: bool) -> Self {
        self.0.front.strict = strict;
        self
    }

    /// Whether mistakes with one sensible repair are repaired, with a warning.
    pub fn lenient(mut self, lenient: bool) -> Self {
        self.0.front.lenient = lenient;
        self
    }

    /// An additional folder from which the scene may read files.
    pub fn asset_root(mut self, folder: impl Into<PathBuf>) -> Self {
        self.0.front.asset_root = Some(folder.into());
        self
    }

    /// The diameter of the points of a mesh file or a glTF asset, in pixels of a picture of 512
    /// rows that shows all; by default by their density.
    pub fn point_size(mut self, pixels: f64) -> Self {
        self.0.front.point_size = Some(pixels);
        self
    }

    /// For a glTF asset with animations: the time in seconds. By default the asset is at rest.
    pub fn time(mut self, seconds: f64) -> Self {
        self.0.front.time = Some(seconds);
        self
    }

    /// For a glTF asset: the animation that [`Reading::time`] applies to; by default the first.
    pub fn animation(mut self, name: impl Into<String>) -> Self {
        self.0.front.animation = Some(name.into());
        self
    }

    /// For a glTF asset: the material variant.
    pub fn variant(mut self, name: impl Into<String>) -> Self {
        self.0.front.variant = Some(name.into());
        self
    }

    /// For a glTF asset: the camera, by its name, the name of its node, or its index.
    pub fn camera(mut self, name: impl Into<String>) -> Self {
        self.0.front.camera = Some(name.into());
        self
    }

    /// The number of threads that decode images; 0 for one per core.
    pub fn threads(mut self, threads: usize) -> Self {
        self.0.front.threads = threads;
        self
    }

    /// Reads a scene from a file.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the file does not exist or can't be read.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Scene, Error> {
        let options = self.options()?;
        Scene::new(Input::file(path.as_ref(), options))
    }

    /// Reads the scene at `path` from `files` in memory. Each file is a path, with `/` between
    /// components, and its bytes. The scene may refer to the other files.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is no file at `path`.
    pub fn from_files(
        &self,
        path: &str,
        files: impl IntoIterator<Item = (String, Vec<u8>)>,
    ) -> Result<Scene, Error> {
        let options = self.options()?;
        Scene::new(Input::memory(path, MemoryFiles::new(files), options))
    }

    fn options(&self) -> Result<pipeline::Options, Error> {
        let time = self.0.front.time;
        if time.is_some_and(|time| !time.is_finite()) {
            return Err(refused("the time is a finite number of seconds"));
        }
        Ok(self.0.clone())
    }
}

/// The file format of a picture, which decides which values the picture holds.
///
/// ```
/// use rtc::{Camera, Format, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let picture = scene.render(&Options::new().format(Format::Exr))?;
/// assert_eq!((Format::Exr.extension(), &picture.encode()?[..4]), ("exr", &b"v/1\x01"[..]));
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Display values, for a PNG with 8 bits per channel.
    #[default]
    Png,
    /// Display values, for a PNG with 16 bits per channel.
    Png16,
    /// Linear values, for an EXR of 32-bit floats.
    Exr,
    /// Linear values, for an EXR of 16-bit floats; depth and position layers keep 32 bits.
    ExrHalf,
    /// Linear values of at least 0, for a Radiance HDR: mantissas of 8 bits that share an exponent.
    Hdr,
}

impl Format {
    pub(super) fn kind(self) -> FileFormat {
        match self {
            Self::Png => FileFormat::Png8,
            Self::Png16 => FileFormat::Png16,
            Self::Exr => FileFormat::Exr,
            Self::ExrHalf => FileFormat::ExrHalf,
            Self::Hdr => FileFormat::Hdr,
        }
    }

    /// The extension of its file name.
    #[must_use]
    pub fn extension(self) -> &'static str {
        self.kind().traits().extensions[0]
    }
}

/// Options of rendering. An option that is not set has the value of the scene, or the default of
/// `rtc render`.
///
/// ```
/// use rtc::{Camera, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let options = Options::new().size(16, 12).trace_paths(true).samples(4).environment([1.0; 3]);
/// let options = options.set("multipleScattering", "false");
/// assert_eq!(scene.render(&options)?.width(), 16);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "it makes no picture until a scene is rendered by it"]
pub struct Options {
    pub(super) format: Format,
    overrides: Overrides,
    set: Vec<(String, String)>,
    threads: usize,
    pub(super) rays: Option<u64>,
    crop: Option<Crop>,
    exposure: Option<Exposure>,
    tone: Option<Tone>,
    background: BackgroundFill,
    aovs: Vec<Aov>,
    view: View,
    environment: Option<[f64; 3]>,
    integrator: Option<IntegratorChoice>,
    target_error: Option<f64>,
    time_budget: Option<Duration>,
    denoise: bool,
    arithmetic: Arithmetic,
    pub(super) on_progress: Option<ProgressCallback>,
}

impl Options {
    /// The defaults.
    pub fn new() -> Self {
        Self::default()
    }

    /// The file format.
    pub fn format(mut self, format: Format) -> Self {
        self.format = format;
        self
    }

    /// Width and height in pixels; the picture shows at least what it shows in its own size.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.overrides.size = Some([width, height]);
        self
    }

    /// Paths per pixel, at least 1; for path tracing.
    pub fn samples(mut self, paths: u32) -> Self {
        self.overrides.spp = Some(paths);
        self
    }

    /// Sub-samples along each side of a pixel, at least 1; for all other integrators.
    pub fn supersampling(mut self, side: u32) -> Self {
        self.overrides.supersampling = Some(side);
        self
    }

    /// The maximum number of bounces after the first hit.
    pub fn depth(mut self, bounces: u32) -> Self {
        self.overrides.depth = Some(bounces);
        self
    }

    /// Any setting by its name in the IR and a value in JSON, as [`SceneBuilder::set`]. An unknown
    /// name or a value of another type is an error of the render.
    ///
    /// [`SceneBuilder::set`]: super::SceneBuilder::set
    pub fn set(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.set.push((name.into(), value.into()));
        self
    }

    /// The number of threads, 0 for one per core. It does not change the picture.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Takes samples adaptively until the root mean square error is at most `levels` (above 0) grey
    /// levels of 8 bits, with a confidence of 90 %. [`Picture::error`](super::Picture::error) is
    /// the error reached.
    pub fn target_error(mut self, levels: f64) -> Self {
        self.target_error = Some(levels);
        self
    }

    /// Adds samples where they reduce the error most until the time is over; with a target error,
    /// whichever is reached first. The picture depends on the machine.
    /// [`Picture::error`](super::Picture::error) is the error reached.
    #[cfg(not(target_family = "wasm"))]
    pub fn time_budget(mut self, time: Duration) -> Self {
        self.time_budget = Some(time);
        self
    }

    /// Calls `on_progress` about a hundred times during a render, from any of its threads but one
    /// at a time, and once at its end.
    pub fn on_progress(
        mut self,
        on_progress: impl Fn(Progress<'_>) + Send + Sync + 'static,
    ) -> Self {
        self.on_progress = Some(ProgressCallback(Arc::new(on_progress)));
        self
    }

    /// Denoises a path-traced picture; needs at least two paths per pixel. With a target error the
    /// picture is rendered again with more paths until it is met, at most four times.
    /// [`Picture::error`](super::Picture::error) is the error reached.
    pub fn denoise(mut self, denoise: bool) -> Self {
        self.denoise = denoise;
        self
    }

    /// The maximum number of rays.
    pub fn max_rays(mut self, rays: u64) -> Self {
        self.rays = Some(rays);
        self
    }

    /// Renders a part only: the upper left corner and the size, in pixels.
    pub fn crop(mut self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        self.crop = Some(Crop {
            x,
            y,
            width,
            height,
        });
        self
    }

    /// The exposure in stops, -64 to 64; each stop doubles the values.
    pub fn exposure(mut self, stops: f64) -> Self {
        self.exposure = Some(Exposure::Stops(stops));
        self
    }

    /// Chooses the exposure from the visible radiance; not for linear formats.
    pub fn auto_exposure(mut self) -> Self {
        self.exposure = Some(Exposure::Auto);
        self
    }

    /// The tone map; not for linear formats.
    pub fn tonemap(mut self, tone: Tone) -> Self {
        self.tone = Some(tone);
        self
    }

    /// A transparent background: the picture gets an alpha channel.
    pub fn transparent(mut self) -> Self {
        self.background = BackgroundFill::Transparent;
        self
    }

    /// The colour of the background, in the values of the picture.
    pub fn background(mut self, color: [f64; 3]) -> Self {
        self.background = BackgroundFill::Color(color);
        self
    }

    /// Adds a layer to the picture.
    pub fn layer(mut self, aov: Aov) -> Self {
        self.aovs.push(aov);
        self
    }

    /// The position of the camera and the point in the centre of the picture.
    pub fn look_at(mut self, eye: [f64; 3], center: [f64; 3]) -> Self {
        (self.view.eye, self.view.center) = (Some(eye), Some(center));
        self
    }

    /// Frames the whole scene from an angle, in radians: azimuth from the front to the right, and
    /// elevation above the horizon.
    pub fn orbit(mut self, azimuth: f64, elevation: f64) -> Self {
        self.view.orbit = Some(OrbitAngles {
            azimuth,
            elevation,
            roll: 0.0,
        });
        self
    }

    /// Replaces the environment by a uniform one of this linear radiance.
    pub fn environment(mut self, radiance: [f64; 3]) -> Self {
        self.environment = Some(radiance);
        self
    }

    /// Whether to use path tracing or Whitted ray tracing.
    pub fn trace_paths(mut self, traced: bool) -> Self {
        self.integrator = Some(if traced {
            IntegratorChoice::Path
        } else {
            IntegratorChoice::Whitted
        });
        self
    }

    /// The options of a setting of a study.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn of_setting(setting: &rtc_study::Setting, scene: &rtc_ir::Scene) -> Self {
        Self {
            overrides: setting.overrides(scene),
            denoise: setting.denoise,
            arithmetic: setting.precision,
            ..Self::default()
        }
    }

    /// The overrides of view and light.
    pub(super) fn stage(&self) -> ViewAndLight {
        ViewAndLight {
            view: self.view,
            integrator: self.integrator,
            environment: self.environment.map(EnvironmentOverride::Color),
            ground: (self.background == BackgroundFill::Transparent).then_some(false),
            ..ViewAndLight::default()
        }
    }

    /// The setup of the picture.
    ///
    /// # Errors
    /// [`Error::Refused`] if an option is invalid.
    pub(super) fn setup(&self) -> Result<PictureSetup, Error> {
        if let Some(fault) = self.fault() {
            return Err(refused(fault));
        }
        if self.denoise && self.time_budget.is_some() {
            return Err(refused("a denoised picture has no time budget"));
        }
        let kind = self.format.kind();
        let look =
            OutputTransform::new(kind, self.tone, self.exposure, self.background, &self.aovs);
        let mut setup = PictureSetup::new(look.map_err(refused)?);
        setup.overrides = self.overrides;
        setup.set.clone_from(&self.set);
        setup.crop = self.crop;
        setup.threads = self.threads;
        setup.goal.error = self.target_error;
        setup.goal.time = self.time_budget;
        setup.denoise = self.denoise;
        setup.arithmetic = self.arithmetic;
        Ok(setup)
    }

    /// The first invalid option, independent of the scene.
    fn fault(&self) -> Option<&'static str> {
        // Collect the values that are checked.
        let Overrides {
            size,
            supersampling,
            spp,
            ..
        } = self.overrides;
        let is_linear = self.format.kind().is_linear();
        let View { eye, center, .. } = self.view;
        let numbers = [eye, center].into_iter().flatten().flatten();
        let angles = self
            .view
            .orbit
            .map(|orbit| [orbit.azimuth, orbit.elevation]);
        let light = self.environment.into_iter().flatten();
        let is_bright = |channel: f64| channel >= 0.0 && channel.is_finite();
        // Pair each condition with its message.
        let faults = [
            (
                size.is_some_and(|size| size.contains(&0)),
                "a picture has at least one pixel",
            ),
            (
                self.target_error
                    .is_some_and(|levels| !(levels > 0.0 && levels.is_finite())),
                "a target error is above 0",
            ),
            (
                supersampling == Some(0) || spp == Some(0),
                "a pixel takes at least one sample",
            ),
            (
                matches!(
                    self.exposure,
                    Some(Exposure::Stops(stops)) if !(-64.0..=64.0).contains(&stops)
                ),
                "the exposure is -64 to 64 stops",
            ),
            (
                is_linear && self.exposure == Some(Exposure::Auto),
                "linear values are exposed by stops alone",
            ),
            (
                is_linear && self.tone.is_some_and(|tone| tone != Tone::None),
                "linear values have no tone map",
            ),
            (
                matches!(
                    self.background,
                    BackgroundFill::Color(color) if !color.iter().all(|v| v.is_finite())
                ),
                "the background is of finite numbers",
            ),
            (
                !light.into_iter().all(is_bright),
                "radiance is finite and at least 0",
            ),
            (
                !numbers
                    .chain(angles.into_iter().flatten())
                    .all(f64::is_finite),
                "the view is of finite numbers",
            ),
        ];
        // The message of the first condition that holds.
        faults
            .iter()
            .find(|(is_so, _)| *is_so)
            .map(|(_, message)| *message)
    }
}

fn refused(message: &str) -> Error {
    Error::Refused(message.to_owned())
}
