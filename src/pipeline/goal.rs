//! A picture that grows until it is as good as was asked.

use super::{Observer, PictureSetup, RayCounter, RenderError, RenderSubject};
use rtc_render::Crop;
use rtc_study::{Goal, Order, TargetResult, Watch};
use std::time::Duration;

impl PictureSetup {
    /// What a part of a picture with a goal is to be, given the time that is left for it.
    #[must_use]
    pub fn order(&self, subject: &RenderSubject, crop: Crop, time: Option<Duration>) -> Order {
        let mode = &subject.proven.scene.settings().mode;
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

    /// Takes samples until the error asked for is reached, with so many rays at most; no clock is looked
    /// at.
    ///
    /// # Errors
    /// If there is none.
    pub fn approach(
        &self,
        subject: &mut RenderSubject,
        (window, rays): (Crop, u64),
        observer: &Observer<'_>,
    ) -> Result<TargetResult, RenderError> {
        let order = self.order(subject, window, None);
        let meter = RayCounter::new(rays, window);
        let watch = Watch {
            on_pixel: &|step| {
                (observer.on_step)(step);
                !(observer.is_stopped)() && meter.step(step)
            },
            is_stopped: observer.is_stopped,
            elapsed: &|| Duration::ZERO,
            round: &|_| meter.begin_round(),
        };
        let (proven, renderer) = self.renderer(subject)?;
        let reached = renderer.approach(&proven.lowered.scene, &order, &watch, None);
        match subject.ran_out(&meter, observer) {
            Some(finding) => Err(RenderError::RanOut(finding)),
            None => reached.map_err(|_| RenderError::Stopped),
        }
    }
}
