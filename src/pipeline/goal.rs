//! Renders until the picture reaches a target error.

use super::{Observer, PictureSetup, RayCounter, RenderError, RenderSubject};
use rtc_render::Crop;
use rtc_study::{Goal, Order, TargetResult, Watch};
use std::time::Duration;

impl PictureSetup {
    /// The target of a picture or a part of it, with the remaining time.
    #[must_use]
    pub fn order(&self, subject: &RenderSubject, crop: Crop, time: Option<Duration>) -> Order {
        let mode = &subject.validated.scene.settings().mode;
        Order {
            goal: Goal { time, ..self.goal },
            crop,
            background: self.look.background(),
            values: self.look.values(mode),
            display: self.look.display(mode),
            keep_lights: self.overrides.light_samples.is_some(),
            seed: 0,
        }
    }

    /// Takes samples until the target error is reached, with at most `rays` rays; does not read the
    /// clock.
    ///
    /// # Errors
    /// If there is no picture.
    pub fn approach(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        observer: &Observer<'_>,
    ) -> Result<TargetResult, RenderError> {
        let order = self.order(subject, window, None);
        let counter = RayCounter::new(rays, window);
        let watch = Watch {
            on_pixel: &|step| {
                (observer.on_step)(step);
                !(observer.is_stopped)() && counter.step(step)
            },
            is_stopped: observer.is_stopped,
            elapsed: &|| Duration::ZERO,
            round: &|_| counter.begin_round(),
        };
        let (validated, renderer) = self.renderer(subject)?;
        let reached = renderer.approach(&validated.lowered.scene, &order, &watch, None);
        match subject.ran_out(&counter, observer) {
            Some(diagnostic) => Err(RenderError::RanOut(diagnostic)),
            None => reached.map_err(|_| RenderError::Stopped),
        }
    }
}
