//! What a caller asks for: how a scene is read, and how its picture is made.

use super::{Aov, Error, Scene, Tone};
use rtc_image::BackgroundFill;
use rtc_image::FileFormat;
use rtc_passes::{EnvironmentOverride, IntegratorChoice, Orbit, Overrides, View, ViewAndLight};
use rtc_pipeline::{self as pipeline, Exposure, Input, OutputTransform, PictureSetup};
use rtc_render::Crop;
use rtc_source::MemoryFiles;
use std::path::{Path, PathBuf};

/// How a scene is read, and what of it.
#[derive(Clone, Debug, Default)]
#[must_use = "it reads nothing until a scene is opened by it"]
pub struct Reading(pipeline::Options);

impl Reading {
    /// As [`Scene::open`] reads.
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

    /// A folder, beside that of the scene, whose files the scene may name.
    pub fn asset_root(mut self, folder: impl Into<PathBuf>) -> Self {
        self.0.front.asset_root = Some(folder.into());
        self
    }

    /// Of a glTF asset: the moment at which it is shown, in seconds; at rest without.
    pub fn time(mut self, seconds: f64) -> Self {
        self.0.front.time = Some(seconds);
        self
    }

    /// Of a glTF asset: the animation that the moment is of; the first without.
    pub fn animation(mut self, name: impl Into<String>) -> Self {
        self.0.front.animation = Some(name.into());
        self
    }

    /// Of a glTF asset: the variant of its materials.
    pub fn variant(mut self, name: impl Into<String>) -> Self {
        self.0.front.variant = Some(name.into());
        self
    }

    /// Of a glTF asset: the camera, by its name, that of its node, or its index.
    pub fn camera(mut self, name: impl Into<String>) -> Self {
        self.0.front.camera = Some(name.into());
        self
    }

    /// How many threads decode images, 0 for one per core.
    pub fn threads(mut self, threads: usize) -> Self {
        self.0.front.threads = threads;
        self
    }

    /// Reads the scene in a file.
    ///
    /// # Errors
    /// [`Error::Invalid`] if there is no such file, or it can't be read.
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Scene, Error> {
        let options = self.options()?;
        Scene::new(Input::file(path.as_ref(), options))
    }

    /// Takes the scene at `path` of `files`, in memory, each a path with `/` between components and
    /// the bytes of the file; the scene may name the others.
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

/// What kind of file a picture is made for, and so which values it holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Values as displayed, for a PNG of 8 bits a channel.
    #[default]
    Png,
    /// Values as displayed, for a PNG of 16 bits a channel.
    Png16,
    /// Linear values, for an EXR of 32-bit floats.
    Exr,
    /// Linear values, for an EXR of 16-bit floats; layers of distances and places keep 32 bits.
    ExrHalf,
}

impl Format {
    pub(super) fn kind(self) -> FileFormat {
        match self {
            Self::Png => FileFormat::Png8,
            Self::Png16 => FileFormat::Png16,
            Self::Exr => FileFormat::Exr,
            Self::ExrHalf => FileFormat::ExrHalf,
        }
    }

    /// What the name of its file ends in.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png | Self::Png16 => "png",
            Self::Exr | Self::ExrHalf => "exr",
        }
    }
}

/// How a picture is made; what is not said is as the scene says, or as `rtc render` does.
#[derive(Clone, Debug, Default)]
#[must_use = "it makes no picture until a scene is rendered by it"]
pub struct Options {
    pub(super) format: Format,
    overrides: Overrides,
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
    pub(super) target_error: Option<f64>,
    denoise: bool,
}

impl Options {
    /// The picture that the scene asks for.
    pub fn new() -> Self {
        Self::default()
    }

    /// The kind of file it is made for.
    pub fn format(mut self, format: Format) -> Self {
        self.format = format;
        self
    }

    /// Width and height in pixels; the picture keeps its height in the scene.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.overrides.size = Some([width, height]);
        self
    }

    /// Paths a pixel, at least 1, of scenes whose paths are traced.
    pub fn samples(mut self, paths: u32) -> Self {
        self.overrides.spp = Some(paths);
        self
    }

    /// Sub-samples along each side of a pixel, at least 1, of scenes whose paths are not traced.
    pub fn supersampling(mut self, side: u32) -> Self {
        self.overrides.supersampling = Some(side);
        self
    }

    /// Bounces after the first hit.
    pub fn depth(mut self, bounces: u32) -> Self {
        self.overrides.depth = Some(bounces);
        self
    }

    /// Threads, 0 for one per core; the picture is the same for any number.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Takes samples, more where there is more noise, until the error is at most so many grey levels of 8
    /// bits, above 0: root mean square, in 90 % of all pictures. [`Picture::error`](super::Picture::error)
    /// says how good it got.
    pub fn target_error(mut self, levels: f64) -> Self {
        self.target_error = Some(levels);
        self
    }

    /// Denoises a picture of traced paths, which takes two paths a pixel at least.
    /// [`Picture::error`](super::Picture::error) says how good it got.
    pub fn denoise(mut self, denoise: bool) -> Self {
        self.denoise = denoise;
        self
    }

    /// The most rays that it may take.
    pub fn max_rays(mut self, rays: u64) -> Self {
        self.rays = Some(rays);
        self
    }

    /// The part that is rendered, in pixels from the upper left.
    pub fn crop(mut self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Self {
        self.crop = Some(Crop {
            x,
            y,
            width,
            height,
        });
        self
    }

    /// The exposure in stops, -64 to 64; each doubles the values.
    pub fn exposure(mut self, stops: f64) -> Self {
        self.exposure = Some(Exposure::Stops(stops));
        self
    }

    /// The exposure by what is seen; not of linear values.
    pub fn auto_exposure(mut self) -> Self {
        self.exposure = Some(Exposure::Auto);
        self
    }

    /// How linear values become displayed ones; not of linear values.
    pub fn tonemap(mut self, tone: Tone) -> Self {
        self.tone = Some(tone);
        self
    }

    /// Nothing behind the surfaces: the picture has an alpha channel.
    pub fn transparent(mut self) -> Self {
        self.background = BackgroundFill::Transparent;
        self
    }

    /// A colour behind the surfaces, in the values that the picture holds.
    pub fn background(mut self, color: [f64; 3]) -> Self {
        self.background = BackgroundFill::Color(color);
        self
    }

    /// Adds a layer to the picture.
    pub fn layer(mut self, aov: Aov) -> Self {
        self.aovs.push(aov);
        self
    }

    /// Where the camera stands and what is in the middle of the picture.
    pub fn look_at(mut self, eye: [f64; 3], center: [f64; 3]) -> Self {
        (self.view.eye, self.view.center) = (Some(eye), Some(center));
        self
    }

    /// All of the scene from an angle, in radians: around from the front to the right, and above the
    /// horizon.
    pub fn orbit(mut self, azimuth: f64, elevation: f64) -> Self {
        self.view.orbit = Some(Orbit {
            azimuth,
            elevation,
            roll: 0.0,
        });
        self
    }

    /// The same radiance from every direction in place of what surrounds the scene, linear.
    pub fn environment(mut self, radiance: [f64; 3]) -> Self {
        self.environment = Some(radiance);
        self
    }

    /// Whether light is followed along all its paths, or by Whitted's rules.
    pub fn trace_paths(mut self, traced: bool) -> Self {
        self.integrator = Some(if traced {
            IntegratorChoice::Path
        } else {
            IntegratorChoice::Whitted
        });
        self
    }

    /// View and light.
    pub(super) fn stage(&self) -> ViewAndLight {
        ViewAndLight {
            view: self.view,
            integrator: self.integrator,
            environment: self.environment.map(EnvironmentOverride::Color),
            ground: (self.background == BackgroundFill::Transparent).then_some(false),
            ..ViewAndLight::default()
        }
    }

    /// The picture as it is asked for.
    pub(super) fn setup(&self) -> Result<PictureSetup, Error> {
        if let Some(fault) = self.fault() {
            return Err(refused(fault));
        }
        if self.denoise && self.target_error.is_some() {
            return Err(refused("a denoised picture has no target error"));
        }
        let kind = self.format.kind();
        let look =
            OutputTransform::new(kind, self.tone, self.exposure, self.background, &self.aovs);
        let mut setup = PictureSetup::new(look.map_err(refused)?);
        setup.overrides = self.overrides;
        setup.crop = self.crop;
        setup.threads = self.threads;
        setup.goal.error = self.target_error;
        setup.denoise = self.denoise;
        Ok(setup)
    }

    /// What is wrong with it, whatever the scene.
    fn fault(&self) -> Option<&'static str> {
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
                matches!(self.exposure, Some(Exposure::Stops(stops)) if !(-64.0..=64.0).contains(&stops)),
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
                matches!(self.background, BackgroundFill::Color(color) if !color.iter().all(|v| v.is_finite())),
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
        faults
            .iter()
            .find(|(is_so, _)| *is_so)
            .map(|(_, words)| *words)
    }
}

fn refused(words: &str) -> Error {
    Error::Refused(words.to_owned())
}
