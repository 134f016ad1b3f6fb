//! The light of a picture: how it is exposed, and whether the studio fills in beside the light that
//! the scene brings.

use super::setup::{Observer, PictureSetup, RenderError, RenderSubject};
use super::{Input, OwnLight, findings};
use rtc_ir::Camera;
use rtc_passes::{self as passes, FillLight};
use rtc_valid::revalidate;

/// The light of a scene shows most of it if that part of its surfaces is seen.
const MOST: f64 = 0.5;
/// What glows was hardly made to light the rest, so without lights all but that is to be seen.
const ALL: f64 = 0.95;

/// The view by which the light of all pictures is found.
pub(super) struct FirstView {
    pub(super) camera: Camera,
    /// It is of a glTF asset with lights of its own.
    pub(super) is_lit_asset: bool,
    pub(super) fill: FillLight,
}

impl PictureSetup {
    /// Finds the exposure of all pictures by the first view, whatever the size of the picture, and
    /// lets the studio fill in where the light of the scene shows little of it.
    ///
    /// # Errors
    /// If someone said stop, or the system gives no threads.
    pub fn light(
        &mut self,
        subject: &mut RenderSubject,
        input: &mut Input,
        observer: &Observer<'_>,
    ) -> Result<(), RenderError> {
        let remarks = subject.remarks.drain(..);
        remarks.for_each(|remark| input.push(remark));
        let FirstView {
            is_lit_asset, fill, ..
        } = subject.first;
        let finds_exposure = self.look.finds_exposure(is_lit_asset);
        if !finds_exposure && fill == FillLight::Never {
            return Ok(());
        }
        self.renderer(subject)?;
        let RenderSubject {
            proven,
            renderer,
            first,
            ..
        } = subject;
        let on_pixel = |_| !(observer.is_stopped)();
        let exposes = finds_exposure || is_lit_asset;
        let light = renderer.as_mut().and_then(|renderer| {
            renderer.own_light(&proven.lowered.scene, &first.camera, exposes, &on_pixel)
        });
        let OwnLight { stops, seen } = light.ok_or(RenderError::Stopped)?;
        let least = if is_lit_asset { MOST } else { ALL };
        if fill == FillLight::Always || (fill == FillLight::IfDim && seen < least) {
            passes::fill(&mut proven.lowered.scene, stops);
            proven.scene = revalidate(&proven.lowered.scene);
            subject.renderer = None;
            input.push(findings::filled(seen));
            self.is_filled = true;
        }
        if finds_exposure {
            self.look.expose(stops);
            if stops != 0.0 {
                input.push(findings::exposed(stops));
            }
        }
        Ok(())
    }

    /// What is said of it beside a picture.
    #[must_use]
    pub fn light_told(&self) -> String {
        let exposed = self.look.found_exposure();
        let exposed = exposed.map(|stops| format!("exposed by {stops:+.2} stops, "));
        let filled = self
            .is_filled
            .then(|| "filled in by the studio, ".to_owned());
        exposed.into_iter().chain(filled).collect()
    }
}
