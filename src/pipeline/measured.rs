//! Path-traced pictures of a fixed number of samples, with the quality of their pixels: the samples
//! are rendered in two halves, whose difference tells the error. Both together are, bit for bit,
//! the film of all samples.

use super::denoise::paths_per_pixel;
use super::{PictureSetup, RayCounter, RenderError, RenderSubject};
use rtc_render::{PartialFilm, PixelObserver, RenderSelection, SAMPLES_OF_BLOCK};
use rtc_study::{PixelQuality, quality_of_halves};

/// Why a picture has no layers of its samples.
const UNSAMPLED: &str = "of traced paths (`--integrator path`), or of pictures to a target error \
or within a time; give `--target-error LEVELS` or `--time-budget SECONDS`";

/// The film of some tiles, and the quality of the pixels of the window, row by row; pixels of other
/// tiles have no samples.
pub(super) type MeasuredFilm = (PartialFilm, Vec<PixelQuality>);

impl PictureSetup {
    /// Whether layers of statistics of a fixed number of samples are requested.
    pub(super) fn is_measured(&self) -> bool {
        !self.is_progressive() && self.look.aovs.iter().any(|aov| aov.is_of_samples())
    }

    /// Renders the tiles of a job in two halves of their samples; `None` if `on_pixel`, which
    /// counts rays on `counter`, stopped it.
    ///
    /// # Errors
    /// If no paths are traced, or too few for two halves.
    pub(super) fn measured(
        &self,
        subject: &mut RenderSubject,
        job: &RenderSelection,
        (on_pixel, counter): (&PixelObserver<'_>, &RayCounter),
    ) -> Result<Option<MeasuredFilm>, RenderError> {
        let refused = |message: String| RenderError::Refused(message);
        let named = self.look.aovs.iter().find(|aov| aov.is_of_samples());
        let name = named.map_or("error", |aov| aov.name());
        let scene = &subject.validated.scene;
        let samples = paths_per_pixel(scene)
            .ok_or_else(|| refused(format!("the layer `{name}` is {UNSAMPLED}")))?;
        if samples <= SAMPLES_OF_BLOCK {
            return Err(refused(format!(
                "the layer `{name}` takes at least `--spp {}`",
                SAMPLES_OF_BLOCK + 1
            )));
        }
        // Halves of whole blocks, the second with the odd one.
        let middle = samples.div_ceil(SAMPLES_OF_BLOCK) / 2 * SAMPLES_OF_BLOCK;
        let window = self.window(&subject.validated.lowered.scene)?;
        let order = self.order(subject, job.crop.unwrap_or(window), None);
        let (_, renderer) = self.renderer(subject)?;
        let render = |half| {
            let film = renderer.render_part(job, Some(half), on_pixel);
            counter.begin_round();
            film.map_err(|error| refused(error.to_string()))
        };
        let Some(mut film) = render(0..middle)? else {
            return Ok(None);
        };
        let Some(second) = render(middle..samples)? else {
            return Ok(None);
        };
        let quality = quality_of_halves(&renderer.world, &order, [&film, &second]);
        let added = film.add(second);
        added.map_err(|error| refused(error.to_string()))?;
        Ok(Some((film, quality)))
    }

    /// The memory of a measured film in bytes per pixel, in addition to a film: that of the second
    /// half, and the quality.
    pub(super) fn measured_memory(&self) -> usize {
        if self.is_measured() { 40 + 24 } else { 0 }
    }
}
