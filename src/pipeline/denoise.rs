//! Denoised pictures and their errors; path tracing only, with at least two samples per pixel.

use super::{PictureSetup, RayCounter, RenderError, RenderSubject, Renderer};
use rtc_render::{Film, PixelObserver, RayCounts, RenderSelection};
use rtc_study::{PixelQuality, ProbedError, RenderGoal, RenderRequest, probe};
use rtc_valid::{Mode, ValidScene};

/// A picture rendered with the settings of its scene.
pub struct Traced {
    /// The picture, with the counts of all rays.
    pub film: Film,
    /// The error of a denoised picture.
    pub probed: Option<ProbedError>,
    /// The quality of each pixel, if layers show it.
    pub quality: Vec<PixelQuality>,
}

impl From<Film> for Traced {
    fn from(film: Film) -> Self {
        Self {
            film,
            probed: None,
            quality: Vec::new(),
        }
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
        let samples = self.goal.error.map_or(samples, first_paths);
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
        let between = || counter.begin_round();
        Ok(renderer.denoised(samples, (job, &order), (on_pixel, &between)))
    }

    /// Whether the picture grows in rounds towards a target error or within a time. A denoised one
    /// does not: it is rendered again with more paths, until its error is small enough.
    #[must_use]
    pub fn is_progressive(&self) -> bool {
        self.goal != RenderGoal::default() && !self.denoise
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
    /// its error; with a target error, again with more until it is met. `None` if `on_pixel`
    /// stopped it.
    fn denoised(
        &self,
        mut samples: u32,
        (job, order): (&RenderSelection, &RenderRequest),
        (on_pixel, between): (&PixelObserver<'_>, &(dyn Fn() + Sync)),
    ) -> Option<Traced> {
        let (mut counts, mut pictures) = (RayCounts::default(), 0);
        loop {
            // Denoise; each picture has probes of its own.
            let seed = order.seed + pictures;
            let order = RenderRequest { seed, ..*order };
            let (mut film, probed) = self.threads.install(|| {
                let picture = self.world.denoised(samples, job, on_pixel, between)?;
                between();
                probe(&self.world, &order, picture, samples, on_pixel)
            })?;
            (counts, pictures) = (counts.plus(film.counts), pictures + 1);
            // Render again if it is not good enough.
            let can_improve = pictures < PICTURES && samples < MAX_PATHS;
            let is_missed = |target: &f64| can_improve && probed.error > *target;
            let Some(target) = order.goal.error.filter(is_missed) else {
                film.counts = counts;
                return Some(Traced {
                    probed: Some(probed),
                    ..film.into()
                });
            };
            samples = more_paths(samples, probed.error / target);
            between();
        }
    }
}

/// The maximum number of denoised pictures towards a target error.
const PICTURES: u64 = 4;

/// The maximum number of paths per pixel of the last one.
const MAX_PATHS: u32 = 1 << 14;

/// The paths per pixel of the first picture towards a target error in grey levels. 16 leave some
/// 1.5 grey levels, and the squared error of noise falls as their number grows.
fn first_paths(target: f64) -> u32 {
    let ratio = 1.5 / target;
    even((16.0 * ratio * ratio).clamp(4.0, 64.0))
}

/// The paths per pixel after a picture of `samples`, whose error was `excess` times the target.
fn more_paths(samples: u32, excess: f64) -> u32 {
    /// By so much the next error is to be below the target: it has noise.
    const MARGIN: f64 = 1.1;
    let aim = MARGIN * excess;
    let growth = (aim * aim).clamp(1.5, 16.0);
    even((f64::from(samples) * growth).min(f64::from(MAX_PATHS)))
}

/// The next even number: both halves of the paths weigh the same.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 4 to MAX_PATHS"
)]
fn even(paths: f64) -> u32 {
    (paths.ceil() as u32).next_multiple_of(2)
}

/// Rejects an option that needs path tracing for other scenes.
pub(super) fn require_paths(scene: &ValidScene, option: &str) -> Result<(), RenderError> {
    paths(scene, option).map(drop)
}

/// The paths per pixel, for an option that needs path tracing.
fn paths(scene: &ValidScene, option: &str) -> Result<u32, RenderError> {
    paths_per_pixel(scene).ok_or_else(|| {
        let message = format!("`{option}` is for traced paths; `--integrator path` traces them");
        RenderError::Refused(message)
    })
}

/// The paths per pixel; `None` if none are traced.
pub(super) fn paths_per_pixel(scene: &ValidScene) -> Option<u32> {
    match scene.settings().mode {
        Mode::Path(path) => Some(path.samples.get()),
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => None,
    }
}
