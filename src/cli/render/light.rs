//! The light of a picture: how it is exposed, and whether the studio fills in beside the light that
//! the scene brings.

use super::{RenderSetup, Subject, no_threads};
use crate::cli::input::Input;
use crate::cli::interrupt::Interrupt;
use crate::cli::{Failure, findings};
use crate::ir::Camera;
use crate::passes::{self, FillLight};
use crate::pipeline::OwnLight;
use crate::valid::revalidate;

/// The light of a scene shows most of it if that part of its surfaces is seen.
const MOST: f64 = 0.5;

/// The view by which the light of all pictures is found.
pub(super) struct FirstView {
    pub(super) camera: Camera,
    /// It is of a glTF asset with lights of its own.
    pub(super) is_lit_asset: bool,
    pub(super) fill: FillLight,
}

impl RenderSetup {
    /// Finds the exposure of all pictures by the first view, whatever the size of the picture, and
    /// lets the studio fill in where the light of the scene shows little of it.
    pub(super) fn light(
        &mut self,
        subject: &mut Subject,
        view: &FirstView,
        input: &mut Input,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let finds_exposure = self.look.finds_exposure(view.is_lit_asset);
        if !finds_exposure && view.fill == FillLight::Never {
            return Ok(());
        }
        let (proven, renderer) = self.renderer(subject).map_err(no_threads)?;
        let on_pixel = |_| !interrupt.is_raised();
        let exposes = finds_exposure || view.is_lit_asset;
        let light = renderer.own_light(&proven.lowered.scene, &view.camera, exposes, &on_pixel);
        let OwnLight { stops, seen } = light.ok_or(Failure::Interrupted)?;
        if view.fill == FillLight::Always || (view.fill == FillLight::IfDim && seen < MOST) {
            let proven = &mut subject.proven;
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
    pub(super) fn light_told(&self) -> String {
        let exposed = self.look.found_exposure();
        let exposed = exposed.map(|stops| format!("exposed by {stops:+.2} stops, "));
        let filled = self
            .is_filled
            .then(|| "filled in by the studio, ".to_owned());
        exposed.into_iter().chain(filled).collect()
    }
}
