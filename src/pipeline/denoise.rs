//! Denoised pictures and their errors; path tracing only, with at least two samples per pixel.

use super::{PictureSetup, RayCounter, RenderError, RenderSubject, Renderer};
use rtc_render::{Film, PixelObserver, RenderSelection};
use rtc_study::{ProbedError, RenderRequest, probe};
use rtc_valid::{Mode, ValidScene};

/// A picture rendered with the settings of its scene.
pub struct Traced {
    /// The picture, with the counts of all rays.
    pub film: Film,
    /// The error of a denoised picture.
    pub probed: Option<ProbedError>,
}

impl From<Film> for Traced {
    fn from(film: Film) -> Self {
        Self { film, probed: None }
    }
}

impl PictureSetup {
    /// The denoised picture and its error; `None` if `on_pixel`, which counts rays on `counter`,
    /// stopped it.
    pub(super) fn denoised(
        &self,
        subject: &mut RenderSubject,
        job: &RenderSelection,
        (on_pixel, counter): (&PixelObserver<'_>, &RayCounter),
    ) -> Result<Option<Traced>, RenderError> {
        let samples = paths(&subject.validated.scene, "--denoise")?;
        if samples < 2 {
            let message = "`--denoise` takes at least `--spp 2`";
            return Err(RenderError::Refused(message.to_owned()));
        }
        let window = match job.crop {
            Some(crop) => crop,
            None => self.window(&subject.validated.lowered.scene)?,
        };
        let order = self.order(subject, window, None);
        let (_, renderer) = self.renderer(subject)?;
        Ok(renderer.denoised(samples, (job, &order), (on_pixel, counter)))
    }

    /// The memory of the denoiser in bytes per pixel, in addition to the film.
    pub(super) fn denoiser_memory(&self) -> usize {
        /// A second film with guides, three sets of guides, their planes and those of colours in
        /// single precision, the values of models, the result and its doubts. The film of the
        /// probes is smaller, and is made after the guides are freed.
        const DENOISED: usize = 104 + 3 * 64 + 4 * (3 * 8 + 16) + 2 * 12 + 2 * 24 + 40;
        if self.denoise { DENOISED } else { 0 }
    }
}

impl Renderer {
    /// Renders a denoised path-traced picture with `samples` (at least 2) per pixel and estimates
    /// its error. `None` if `on_pixel` stopped it.
    fn denoised(
        &self,
        samples: u32,
        (job, order): (&RenderSelection, &RenderRequest),
        (on_pixel, counter): (&PixelObserver<'_>, &RayCounter),
    ) -> Option<Traced> {
        self.threads.install(|| {
            let between = || counter.begin_round();
            let picture = self.world.denoised(samples, job, on_pixel, &between)?;
            between();
            let (film, probed) = probe(&self.world, order, picture, samples, on_pixel)?;
            let probed = Some(probed);
            Some(Traced { film, probed })
        })
    }
}

/// Rejects an option that needs path tracing for other scenes.
pub(super) fn require_paths(scene: &ValidScene, option: &str) -> Result<(), RenderError> {
    paths(scene, option).map(drop)
}

/// The paths per pixel, for an option that needs path tracing.
fn paths(scene: &ValidScene, option: &str) -> Result<u32, RenderError> {
    match scene.settings().mode {
        Mode::Path(path) => Ok(path.samples.get()),
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => Err(RenderError::Refused(
            format!("`{option}` is for traced paths; `--integrator path` traces them"),
        )),
    }
}
