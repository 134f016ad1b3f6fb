//! Finds the exposure of a picture, and decides whether the studio adds light to the scene, and
//! lamps to closed rooms.

use super::setup::{PictureSetup, RenderError, RenderObserver, RenderSubject};
use super::{Input, LightMeasurement, RayCounter, exposure, picture_diagnostics};
use rtc_ir::{Camera, Scene};
use rtc_passes::{self as passes, FillLight, Framing};
use rtc_render::SeenBehind;
use rtc_valid::{Material, ValidScene, revalidate};

/// The visible fraction of the surfaces below which the lights of a scene need the studio.
const MIN_VISIBLE_LIT: f64 = 0.5;
/// The same for a scene lit only by emissive surfaces, which are rarely meant to light the rest.
const MIN_VISIBLE_EMISSIVE: f64 = 0.95;

/// The view from which exposure and light are measured, for all pictures.
pub(super) struct FirstView {
    pub(super) camera: Camera,
    /// Whether paths are traced.
    pub(super) is_traced: bool,
    /// How it was framed, if the scene has no camera.
    pub(super) framing: Option<Framing>,
    /// Whether it is a glTF asset with lights.
    pub(super) is_lit_asset: bool,
    pub(super) fill: FillLight,
    /// Whether lamps may be added in closed rooms.
    pub(super) adds_lamps: bool,
}

impl RenderSubject {
    /// Adds light to the scene.
    fn add_light(&mut self, add: impl FnOnce(&mut Scene)) {
        add(&mut self.validated.lowered.scene);
        self.validated.scene = revalidate(&self.validated.lowered.scene);
        self.renderer = None;
    }
}

/// Whether camera rays may pass surfaces of a scene from behind.
fn has_single_sided(scene: &ValidScene) -> bool {
    scene.materials().iter().any(|material| match material {
        Material::Standard(standard) => standard.is_seen_from_one_side(),
        Material::Phong(_) => false,
    })
}

impl PictureSetup {
    /// Measures the light from the first view, independent of the picture size; sets the exposure,
    /// adds the studio if too little is visible, and lamps to closed rooms.
    ///
    /// # Errors
    /// If it was stopped, takes more rays than the limit, or the threads can't be started.
    pub fn light(
        &mut self,
        subject: &mut RenderSubject,
        input: &mut Input,
        observer: &RenderObserver<'_>,
    ) -> Result<(), RenderError> {
        // Report the diagnostics of validation.
        let pending = subject.pending.drain(..);
        pending.for_each(|remark| input.push(remark));
        let FirstView {
            is_lit_asset, fill, ..
        } = subject.first;
        let finds_exposure = self.look.finds_exposure(is_lit_asset);
        let measures = finds_exposure || fill != FillLight::Never;
        let may_pass_walls = subject.first.is_traced && has_single_sided(&subject.validated.scene);
        if !measures && !may_pass_walls {
            return Ok(());
        }
        // See what is behind walls that camera rays pass.
        self.renderer(subject)?;
        let RenderSubject {
            validated,
            renderer,
            first,
            ..
        } = subject;
        let behind = match (may_pass_walls, renderer.as_ref()) {
            (true, Some(renderer)) => renderer.seen_behind(&first.camera),
            _ => Vec::new(),
        };
        if !measures && behind.is_empty() {
            return Ok(());
        }
        // Measure the light.
        let counter = RayCounter::of_each(input.rays(), exposure::WINDOW, exposure::RENDERS);
        let on_pixel = |step| !(observer.is_stopped)() && counter.step(step);
        let exposes = finds_exposure || is_lit_asset;
        let light = renderer.as_mut().and_then(|renderer| {
            renderer.measure_light(&validated.lowered.scene, &first.camera, exposes, &on_pixel)
        });
        if let Some(diagnostic) = subject.ran_out(&counter, observer) {
            return Err(RenderError::RanOut(diagnostic));
        }
        let LightMeasurement {
            stops,
            visible,
            is_dark,
        } = light.ok_or(RenderError::Stopped)?;
        // Add lamps to closed rooms.
        let dark = behind.into_iter().filter(|(pixel, _)| is_dark[*pixel]);
        let dark: Vec<SeenBehind> = dark.map(|(_, seen)| seen).collect();
        let lamps = subject.renderer.as_ref();
        if let Some(mut lamps) = lamps.and_then(|renderer| renderer.lamps(&dark, stops)) {
            if !subject.first.adds_lamps {
                lamps.clear();
            }
            input.push(picture_diagnostics::closed_room(lamps.len()));
            if !lamps.is_empty() {
                subject.add_light(|scene| scene.lights.extend(lamps));
            }
        }
        // Add the studio if too little is visible.
        let least = if is_lit_asset {
            MIN_VISIBLE_LIT
        } else {
            MIN_VISIBLE_EMISSIVE
        };
        if fill == FillLight::Always || (fill == FillLight::IfDim && visible < least) {
            subject.add_light(|scene| passes::fill(scene, stops));
            input.push(picture_diagnostics::filled(visible));
            self.is_filled = true;
        }
        // Set the exposure.
        if finds_exposure {
            self.look.expose(stops);
            if stops != 0.0 {
                input.push(picture_diagnostics::exposed(stops));
            }
        }
        Ok(())
    }

    /// A summary for the message about a picture.
    #[must_use]
    pub fn light_summary(&self) -> String {
        let exposed = self.look.found_exposure();
        let exposed = exposed.map(|stops| format!("exposed by {stops:+.2} stops, "));
        let filled = self
            .is_filled
            .then(|| "filled in by the studio, ".to_owned());
        exposed.into_iter().chain(filled).collect()
    }
}
