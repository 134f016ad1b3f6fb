//! Denoised pictures: of traced paths alone, of two samples a pixel at least.

use super::{PictureSetup, RenderError, RenderSubject, Renderer};
use crate::render::{Film, Job, OnPixel};
use crate::valid::{Mode, Proof};

impl PictureSetup {
    /// The denoised picture; `None` if `on_pixel` said stop.
    pub(super) fn denoised(
        &self,
        subject: &mut RenderSubject,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Result<Option<Film>, RenderError> {
        let samples = paths(&subject.proven.scene)?;
        let (_, renderer) = self.renderer(subject)?;
        Ok(renderer.denoised(samples, job, on_pixel))
    }

    /// The bytes of a pixel that a denoiser holds beside the film.
    pub(super) fn denoiser_memory(&self) -> usize {
        /// A second film, guides by three sets of rays and how they are gathered, variance, picture.
        const DENOISED: usize = 40 + 3 * 64 * 2 + 2 * 24;
        if self.denoise { DENOISED } else { 0 }
    }
}

impl Renderer {
    /// Renders a denoised picture of traced paths, of so many samples a pixel, at least 2. `None` if
    /// `on_pixel` said stop.
    fn denoised(&self, samples: u32, job: &Job, on_pixel: &OnPixel<'_>) -> Option<Film> {
        let world = &self.world;
        self.threads
            .install(|| world.denoised(samples, job, on_pixel))
    }
}

/// The paths a pixel of a scene that is denoised.
fn paths(scene: &Proof) -> Result<u32, RenderError> {
    let refused = |words: &str| Err(RenderError::Refused(words.to_owned()));
    match scene.settings().mode {
        Mode::Path(path) if path.samples.get() >= 2 => Ok(path.samples.get()),
        Mode::Path(_) => refused("`--denoise` takes at least `--spp 2`"),
        Mode::Phong | Mode::Zbuffer | Mode::Normal | Mode::Gooch(_) => {
            refused("`--denoise` is for traced paths; `--integrator path` traces them")
        }
    }
}
