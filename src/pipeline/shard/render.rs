//! Renders shards.

use super::super::{
    PictureSetup, RayCounter, RenderError, RenderObserver, RenderShard, RenderSubject,
    ShardDivision, ShardPlan,
};
use super::ShardSource;
use rtc_ir::{self as ir, Scene};
use rtc_render::{Crop, RenderSelection};
use rtc_study::with_quality;
use rtc_valid as valid;

/// The message for a picture that can't be divided by samples.
const INSEPARABLE: &str = "only pictures of traced paths have parts by samples; \
     `--parts-by tiles` shares out any picture";

/// The message for layers of samples of a picture that is divided by samples.
const HALVES: &str = "the layers error, samples and unmet tell of all samples of a pixel, so they \
     have no parts by samples; `--parts-by tiles` has them";

impl PictureSetup {
    /// Checks that the picture can be divided this way.
    ///
    /// # Errors
    /// If it is not path-traced and is to be divided by samples.
    pub fn separable(&self, scene: &Scene, by: ShardDivision) -> Result<(), RenderError> {
        match (by, &scene.settings.mode) {
            (ShardDivision::Tiles, _) | (ShardDivision::Samples, ir::Mode::Path(_)) => Ok(()),
            (ShardDivision::Samples, _) => Err(RenderError::Refused(INSEPARABLE.to_owned())),
        }
    }

    /// Renders some shares of the picture, with at most `rays` rays.
    ///
    /// # Errors
    /// If there is no picture, or it can't be divided by samples.
    pub fn part(
        &self,
        subject: &mut RenderSubject,
        (shares, window, rays): (ShardPlan, Crop, u64),
        observer: &RenderObserver<'_>,
    ) -> Result<RenderShard, RenderError> {
        // The job: tiles or samples of the shares.
        let settings = subject.validated.scene.settings();
        let look = self.look.resolve(&settings.mode);
        let whole = RenderSelection {
            crop: Some(window),
            values: self.look.values(&settings.mode),
            background: self.look.background(),
            ..RenderSelection::default()
        };
        let (job, samples) = match (shares.by, &settings.mode) {
            (ShardDivision::Tiles, _) => {
                // Render the layers, always by tiles.
                let tiles = Some(shares.tiles());
                (RenderSelection { tiles, ..whole }, None)
            }
            (ShardDivision::Samples, valid::Mode::Path(path)) => {
                (whole, Some(shares.samples(path.samples.get())))
            }
            (ShardDivision::Samples, _) => {
                return Err(RenderError::Refused(INSEPARABLE.to_owned()));
            }
        };
        // Render the film.
        let counter = RayCounter::new(rays, window);
        let on_pixel = |step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && counter.step(step)
        };
        let film = match (self.is_measured(), samples) {
            (true, None) => self.measured(subject, &job, (&on_pixel, &counter))?,
            (true, Some(_)) => return Err(RenderError::Refused(HALVES.to_owned())),
            (false, samples) => {
                let (_, renderer) = self.renderer(subject)?;
                let film = renderer.render_part(&job, samples, &on_pixel);
                let film = film.map_err(|error| RenderError::Refused(error.to_string()))?;
                film.map(|film| (film, Vec::new()))
            }
        };
        if let Some(diagnostic) = subject.ran_out(&counter, observer) {
            return Err(RenderError::RanOut(diagnostic));
        }
        let (film, quality) = film.ok_or(RenderError::Stopped)?;
        let tiles = Some(shares.tiles());
        let layers = self.layers(
            subject,
            &RenderSelection { tiles, ..job },
            observer.is_stopped,
        )?;
        let layers = with_quality(layers, &self.look.aovs, &quality);
        let metadata = self.metadata(&subject.validated.lowered.scene);
        let made = ShardSource {
            metadata,
            look,
            arithmetic: self.arithmetic,
            aovs: &self.look.aovs,
        };
        Ok(RenderShard::new(made, (shares, window), film, &layers))
    }
}
