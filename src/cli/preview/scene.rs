//! A scene that was read, to be rendered in any view and setting.

use super::preview_state::{RenderedPicture, ViewSettings};
use super::view::{self, SceneCamera};
use super::{Failure, args, coarse, input, render};
use rtc_diag::DiagnosticSink;
use rtc_ir::Camera;
use rtc_passes::{IntegratorChoice, View};
use rtc_pipeline::{Input, LoadedScene, PictureSetup, RenderError, RenderObserver, RenderSubject};

/// A scene that was read.
pub(super) struct ReadScene {
    pub(super) input: Input,
    pub(super) loaded: Option<LoadedScene>,
    /// The diagnostics of reading it.
    found: DiagnosticSink,
    /// The view and the integrator of the command line.
    view: View,
    integrator: Option<IntegratorChoice>,
    /// Whether it has keys for another view.
    pub(super) can_write: bool,
    /// The view of its own camera, once known.
    pub(super) scene_camera: Option<SceneCamera>,
}

/// A scene as it was rendered, and how.
pub(super) type ShownScene = (PictureSetup, RenderSubject);

impl ReadScene {
    /// Reads an input that was staged.
    pub(super) fn read(mut input: Input, args: &args::PreviewArgs, threads: usize) -> Self {
        input.use_threads(threads);
        render::set_stage(&mut input, &args.look, None);
        let (mut view, mut integrator) = (View::default(), None);
        input.restage(|stage| (view, integrator) = (stage.view, stage.integrator));
        let loaded = input.load();
        let own = loaded
            .as_ref()
            .and_then(|loaded| view::keys(&loaded.lowered, input.map(), input.name()));
        Self {
            found: input.take_diagnostics(),
            can_write: own.is_some() && input.text().is_some(),
            scene_camera: None,
            input,
            loaded,
            view,
            integrator,
        }
    }

    /// Validates the scene in the current view; the diagnostics give the reason if it fails.
    pub(super) fn validate(
        &mut self,
        setup: &PictureSetup,
        view_settings: &ViewSettings,
    ) -> Result<Option<ShownScene>, RenderError> {
        let yfov = self.scene_camera.as_ref().and_then(SceneCamera::yfov);
        let view_override = view_settings.view_override.as_ref();
        let view = view_override.map_or(self.view, |view_override| {
            view_override.view(yfov.or(self.view.yfov))
        });
        let integrator = view_settings.choice.integrator().or(self.integrator);
        self.input
            .restage(|stage| (stage.view, stage.integrator) = (view, integrator));
        self.input.restore_diagnostics(self.found.clone());
        let mut setup = view_settings.choice.settle(setup);
        let Some(loaded) = self.loaded.clone() else {
            return Ok(None);
        };
        let validated = setup.validate(loaded, &mut self.input)?;
        Ok(validated.map(|subject| (setup, subject)))
    }

    /// A coarse picture of the last scene with another camera; its diagnostics are dropped.
    pub(super) fn glance(
        &mut self,
        (setup, subject): &mut ShownScene,
        observer: &RenderObserver<'_>,
    ) -> Result<Option<RenderedPicture>, RenderError> {
        let found = self.input.take_diagnostics();
        let rendering = coarse::render(setup, subject, &mut self.input, observer);
        self.input.restore_diagnostics(found);
        rendering
    }
}

/// Reads the file of the scene, to be shown in the requested view.
pub(super) fn of_file(args: &args::PreviewArgs, threads: usize) -> Result<ReadScene, Failure> {
    let input = input::staged(&args.file, &args.reading, &args.stage)?;
    Ok(ReadScene::read(input, args, threads))
}

/// Lets another camera look at a scene, if it takes pictures of the same size.
pub(super) fn see_by(subject: &mut RenderSubject, camera: &Camera) {
    let validated = &mut subject.validated;
    if let Some(seen) = validated.scene.seen_by(camera) {
        validated.scene = seen;
        validated.lowered.scene.camera = camera.clone();
        subject.turn();
    }
}
