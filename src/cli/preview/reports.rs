//! Requested reports of a session: the effects of the picture and of a pixel, the settings and
//! their costs.

use super::preview_state::{NoiseLayers, RenderTask, ViewSettings};
use super::session::PreviewSession;
use super::{Failure, choice, costs, renderings};
use crate::render::effects;
use crate::report::PlanReport;
use rtc_ir::Scene;
use rtc_pipeline::{PictureSetup, RenderError, RenderObserver};
use serde_json::json;

impl PreviewSession<'_> {
    /// Publishes the effects that the picture needs, if requested.
    pub(super) fn publish_effects(&self, work: &RenderTask) {
        if !work.wants_effects {
            return;
        }
        if let (Some(scene), Some((_, subject))) = (&self.scene, &self.shown) {
            let effects = PlanReport::statuses(&subject.validated, &scene.input);
            self.preview_state
                .show(|state| state.effects = Some(effects));
        }
    }

    /// Publishes the effects at the requested pixel.
    pub(super) fn publish_pixel(&mut self, work: &RenderTask) {
        let (Some(scene), Some((setup, subject)), Some(place)) =
            (&self.scene, &mut self.shown, work.orders.pixel)
        else {
            return;
        };
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| self.preview_state.is_stale(work.age),
        };
        let counts = renderings::pixel(setup, subject, place, &scene.input, &observer);
        // Errors are not reported here: the picture has already been rendered.
        if let Ok(Some(counts)) = counts {
            let effects = effects(&counts).map(|(name, count)| json!([name, count]));
            let effects: Vec<_> = effects.collect();
            self.preview_state
                .show(|state| state.pixel = json!({ "at": place, "effects": effects }));
        }
    }

    /// Publishes the noise of the picture, unless a newer request arrives. A reason why there is
    /// none is published in its place.
    pub(super) fn publish_noise(&mut self, work: &RenderTask) {
        let (Some(scene), Some((setup, subject))) = (&mut self.scene, &mut self.shown) else {
            return;
        };
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| self.preview_state.is_stale(work.age),
        };
        let found = scene.input.take_diagnostics();
        let noise = renderings::noise(setup, subject, &mut scene.input, &observer);
        scene.input.restore_diagnostics(found);
        let text = match noise {
            Ok(noise) => return self.preview_state.put_noise(noise),
            Err(RenderError::Stopped) => return,
            Err(RenderError::Refused(message)) => message,
            Err(RenderError::RanOut(_)) => "its rays ran out".to_owned(),
        };
        let files = Vec::new();
        self.preview_state.put_noise(NoiseLayers { files, text });
    }

    /// Publishes the settings of the scene, if requested.
    pub(super) fn publish_settings(&mut self, work: &RenderTask) {
        let settings = match work.wants_settings {
            true => self.without_overrides(work),
            false => None,
        };
        if let Some((setup, scene)) = settings {
            let settings = choice::reported(&scene, &choice::own_setting(&scene, &setup));
            self.preview_state.show(|state| state.settings = settings);
        }
    }

    /// The scene in the current view, without overridden values.
    fn without_overrides(&mut self, work: &RenderTask) -> Option<(PictureSetup, Scene)> {
        let scene = self.scene.as_mut()?;
        let view_settings = ViewSettings {
            view_override: work.view_settings.view_override,
            choice: work.view_settings.choice.without_values(),
        };
        if view_settings == work.view_settings {
            let (setup, subject) = self.shown.as_ref()?;
            return Some((setup.clone(), subject.validated.lowered.scene.clone()));
        }
        let found = scene.input.take_diagnostics();
        let validated = scene.validate(&self.setup, &view_settings).ok().flatten();
        let lit = validated.and_then(|(mut setup, mut subject)| {
            let observer = RenderObserver {
                on_step: &|_| (),
                is_stopped: &|| self.preview_state.is_stale(work.age),
            };
            let lit = setup.light(&mut subject, &mut scene.input, &observer);
            lit.ok().map(|()| (setup, subject.validated.lowered.scene))
        });
        scene.input.restore_diagnostics(found);
        lit
    }

    /// Publishes the costs of accuracy in the scene, unless a newer request arrives.
    pub(super) fn publish_costs(&mut self, work: &RenderTask) -> Result<(), Failure> {
        self.publish_settings(work);
        let Some((setup, studied)) = self.without_overrides(work) else {
            return Ok(());
        };
        let Some(scene) = &self.scene else {
            return Ok(());
        };
        let is_going = || !self.preview_state.is_stale(work.age);
        let own = choice::own_setting(&studied, &setup);
        let studied = (scene.input.name(), &studied, &own);
        if let Some(costs) = costs::costs(studied, setup.threads, &is_going)? {
            self.preview_state.show(|state| state.costs = costs);
        }
        Ok(())
    }
}
