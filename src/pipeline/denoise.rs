//! Denoised pictures, with their errors: of traced paths alone, of two samples a pixel at least.

use super::{PictureSetup, RayCounter, RenderError, RenderSubject, Renderer};
use rtc_render::{DenoisedFilm, Film, Job, OnPixel};
use rtc_study::{Order, ProbedError, probe};
use rtc_valid::{Mode, ValidScene};

/// A picture in the setting of its scene.
pub struct Traced {
    /// The picture, and all rays.
    pub film: Film,
    /// Of a denoised picture, its error.
    pub probed: Option<ProbedError>,
}

impl From<Film> for Traced {
    fn from(film: Film) -> Self {
        Self { film, probed: None }
    }
}

impl PictureSetup {
    /// The denoised picture and its error; `None` if `on_pixel`, which counts on `meter`, said stop.
    pub(super) fn denoised(
        &self,
        subject: &mut RenderSubject,
        job: &Job,
        (on_pixel, meter): (&OnPixel<'_>, &RayCounter),
    ) -> Result<Option<Traced>, RenderError> {
        let samples = paths(&subject.proven.scene, "--denoise")?;
        if samples < 2 {
            let words = "`--denoise` takes at least `--spp 2`";
            return Err(RenderError::Refused(words.to_owned()));
        }
        let window = match job.crop {
            Some(crop) => crop,
            None => self.window(&subject.proven.lowered.scene)?,
        };
        let order = self.order(subject, window, None);
        let (_, renderer) = self.renderer(subject)?;
        Ok(renderer.denoised(samples, (job, &order), (on_pixel, meter)))
    }

    /// The bytes of a pixel that a denoiser holds beside the film.
    pub(super) fn denoiser_memory(&self) -> usize {
        /// A second film, guides by three sets of rays and how they are gathered, variance, picture; less
        /// than those is the film of probes, which comes when guides have gone.
        const DENOISED: usize = 40 + 3 * 64 * 2 + 2 * 24;
        if self.denoise { DENOISED } else { 0 }
    }
}

impl Renderer {
    /// Renders a denoised picture of traced paths, of so many samples a pixel, at least 2, and finds its
    /// error. `None` if `on_pixel` said stop.
    fn denoised(
        &self,
        samples: u32,
        (job, order): (&Job, &Order),
        (on_pixel, meter): (&OnPixel<'_>, &RayCounter),
    ) -> Option<Traced> {
        self.threads.install(|| {
            let between = || meter.begin_round();
            let picture = self.world.denoised(samples, job, on_pixel, &between)?;
            between();
            let probed = probe(&self.world, order, &picture, samples, on_pixel)?;
            let DenoisedFilm { mut film, .. } = picture;
            film.counts = film.counts.plus(probed.counts);
            let probed = Some(probed);
            Some(Traced { film, probed })
        })
    }
}

/// Refuses an option that needs traced paths for a scene without.
pub(super) fn require_paths(scene: &ValidScene, option: &str) -> Result<(), RenderError> {
    paths(scene, option).map(drop)
}

/// The paths a pixel of a scene, for an option that needs paths.
fn paths(scene: &ValidScene, option: &str) -> Result<u32, RenderError> {
    match scene.settings().mode {
        Mode::Path(path) => Ok(path.samples.get()),
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => Err(RenderError::Refused(
            format!("`{option}` is for traced paths; `--integrator path` traces them"),
        )),
    }
}
