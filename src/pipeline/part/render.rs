//! Shares of a picture rendered, and what says of which picture they are.

use super::super::{
    Observer, PicturePart, PictureSetup, RayCounter, RenderError, RenderSubject, ShardPlan,
    SharedBy,
};
use super::Made;
use rtc_ir::{self as ir, Scene};
use rtc_render::{Crop, Job};
use rtc_valid as valid;

/// Why a picture has no parts by samples.
const INSEPARABLE: &str = "only pictures of traced paths have parts by samples; \
     `--parts-by tiles` shares out any picture";

impl PictureSetup {
    /// Refuses to share out what has no shares of that kind.
    ///
    /// # Errors
    /// If no paths are traced whose samples could be shared out.
    pub fn separable(&self, scene: &Scene, by: SharedBy) -> Result<(), RenderError> {
        match (by, &scene.settings.mode) {
            (SharedBy::Tiles, _) | (SharedBy::Samples, ir::Mode::Path(_)) => Ok(()),
            (SharedBy::Samples, _) => Err(RenderError::Refused(INSEPARABLE.to_owned())),
        }
    }

    /// Some shares of the picture, or where its rays ran out, of which there may be so many.
    ///
    /// # Errors
    /// If there is none, or no paths are traced whose samples could be shared out.
    pub fn part(
        &self,
        subject: &mut RenderSubject,
        (shares, window, rays): (ShardPlan, Crop, u64),
        observer: &Observer<'_>,
    ) -> Result<PicturePart, RenderError> {
        let settings = subject.proven.scene.settings();
        let look = self.look.settled(&settings.mode);
        let whole = Job {
            crop: Some(window),
            values: self.look.values(&settings.mode),
            background: self.look.background(),
            ..Job::default()
        };
        let (job, samples) = match (shares.by, &settings.mode) {
            (SharedBy::Tiles, _) => {
                let tiles = Some(shares.tiles());
                (Job { tiles, ..whole }, None)
            }
            (SharedBy::Samples, valid::Mode::Path(path)) => {
                (whole, Some(shares.samples(path.samples.get())))
            }
            (SharedBy::Samples, _) => return Err(RenderError::Refused(INSEPARABLE.to_owned())),
        };
        let meter = RayCounter::new(rays, window);
        let on_pixel = |step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && meter.step(step)
        };
        let film = self
            .renderer(subject)?
            .1
            .render_part(&job, samples, &on_pixel);
        if let Some(finding) = subject.ran_out(&meter, observer) {
            return Err(RenderError::RanOut(finding));
        }
        let film = film.map_err(|error| RenderError::Refused(error.to_string()))?;
        let film = film.ok_or(RenderError::Stopped)?;
        let tiles = Some(shares.tiles());
        let layers = self.layers(subject, &Job { tiles, ..job }, observer.is_stopped)?;
        let origin = self.origin(&subject.proven.lowered.scene);
        let made = Made {
            origin,
            look,
            arithmetic: self.arithmetic,
            aovs: &self.look.aovs,
        };
        Ok(PicturePart::new(made, (shares, window), film, &layers))
    }
}
