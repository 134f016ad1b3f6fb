//! The session: reads the scene, shows its diagnostics, and renders it, coarsely first. A change of
//! a file or of the view restarts it.

use super::against::ComparisonReference;
use super::command::RenderCommand;
use super::findings::{self, ServedFolder};
use super::preview_state::{PreviewState, ReadState, RenderTask, ViewSettings};
use super::scene::{self, ReadScene, ShownScene};
use super::view::SceneCamera;
use super::watch::WatchedFiles;
use super::{Failure, args, coarse, renderings};
use crate::reporter::Reporter;
use rtc_diag::{Diagnostic, Severity};
use rtc_pipeline::{PictureSetup, RenderError, RenderObserver, RenderSubject};
use serde_json::Value;
use std::sync::Arc;

/// The current picture, if there is a scene.
pub(super) struct PreviewSession<'a> {
    args: &'a args::PreviewArgs,
    pub(super) preview_state: Arc<PreviewState>,
    watched: Arc<WatchedFiles>,
    reporter: Reporter,
    /// The picture in the requested settings.
    pub(super) setup: PictureSetup,
    /// The arguments of the command, for the shown command line.
    arguments: RenderCommand,
    loads: u64,
    pub(super) scene: Option<ReadScene>,
    /// The scene as it was rendered last.
    pub(super) shown: Option<ShownScene>,
    against: Option<ComparisonReference>,
    /// The reading and the view settings of the last costs.
    costed: (u64, ViewSettings),
    /// The last report on the terminal.
    reported: Vec<Diagnostic>,
}

impl<'a> PreviewSession<'a> {
    pub(super) fn new(
        args: &'a args::PreviewArgs,
        arguments: RenderCommand,
        (preview_state, watched): (Arc<PreviewState>, Arc<WatchedFiles>),
        against: Option<ComparisonReference>,
    ) -> Result<Self, Failure> {
        let against = match against {
            Some(ComparisonReference::Picture(rendering)) => {
                preview_state.put_against(rendering, 0);
                None
            }
            other => other,
        };
        Ok(Self {
            args,
            preview_state,
            watched,
            reporter: Reporter::beside_result(&args.reporter),
            setup: renderings::setup(args)?,
            arguments,
            loads: 0,
            scene: None,
            shown: None,
            against,
            costed: Default::default(),
            reported: Vec::new(),
        })
    }

    /// Shows the scene until the program is stopped.
    pub(super) fn run(mut self) -> Result<(), Failure> {
        self.preview_state.reload();
        while let Some(work) = self.preview_state.next() {
            if work.orders.reload {
                self.load();
            }
            if work.orders.reload || work.orders.look {
                self.look(&work)?;
            } else if work.orders.effects {
                self.publish_effects(&work);
            }
            // Newer requests come first.
            if work.orders.pixel.is_some() && !self.preview_state.is_stale(work.age) {
                self.publish_pixel(&work);
            }
            if work.orders.noise && !self.preview_state.is_stale(work.age) {
                self.publish_noise(&work);
            }
            if work.orders.costs && !self.preview_state.is_stale(work.age) {
                self.publish_costs(&work)?;
            }
        }
        self.reporter.finish()?;
        Err(Failure::Interrupted)
    }

    /// Reads the scene.
    fn load(&mut self) {
        let known = self.watched.now(&self.args.file);
        let args = self.args;
        self.loads += 1;
        let scene = match scene::of_file(args, self.setup.threads) {
            Ok(scene) => scene,
            Err(failure) => {
                let paths = [Some(&args.file), args.stage.env.as_ref()];
                self.watched
                    .set(&known, paths.into_iter().flatten().cloned().collect());
                (self.scene, self.shown) = (None, None);
                return self.fail(&reported_failure(&failure));
            }
        };
        let paths = scene.input.map().paths_read().into_iter();
        self.watched
            .set(&known, paths.chain([args.file.clone()]).collect());
        self.scene = Some(scene);
    }

    /// Renders the current view: coarsely, and completely unless the view is moving.
    fn look(&mut self, work: &RenderTask) -> Result<(), Failure> {
        if work.is_moving && !work.orders.reload && self.move_on(work) {
            return Ok(());
        }
        self.shown = None;
        self.forget_costs(work);
        let preview_state = Arc::clone(&self.preview_state);
        let is_stopped = || preview_state.is_stale(work.age);
        let rendered = self.render(work, &is_stopped);
        match rendered {
            Ok(true) => {
                self.publish_effects(work);
                self.publish_settings(work);
                if !self.show_against(work, &is_stopped) {
                    return Ok(());
                }
            }
            // The diagnostics give the reason.
            Ok(false) => self.publish(true, &work.view_settings, None),
            Err(RenderError::Stopped) => return Ok(()),
            Err(RenderError::RanOut(diagnostic)) => {
                if let Some(scene) = &mut self.scene {
                    scene.input.push(*diagnostic);
                }
                self.publish(true, &work.view_settings, None);
            }
            Err(RenderError::Refused(message)) => self.fail(&message),
        }
        self.preview_state.rest();
        self.report_diagnostics()
    }

    /// Renders the scene; whether there is a picture.
    fn render(
        &mut self,
        work: &RenderTask,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<bool, RenderError> {
        let Some(scene) = &mut self.scene else {
            return Ok(false);
        };
        let Some((mut setup, mut subject)) = scene.validate(&self.setup, &work.view_settings)?
        else {
            return Ok(false);
        };
        setup.window(&subject.validated.lowered.scene)?;
        let input = &mut scene.input;
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped,
        };
        setup.light(&mut subject, input, &observer)?;
        self.publish(false, &work.view_settings, Some(&subject));
        let Some(ReadScene { input, .. }) = &mut self.scene else {
            return Ok(false);
        };
        if let Some(rendering) = coarse::render(&setup, &mut subject, input, &observer)? {
            self.preview_state.put(rendering, None, work.age);
        }
        let (rendering, pixels) = renderings::finish(&setup, &mut subject, input, &observer)?;
        self.publish(false, &work.view_settings, Some(&subject));
        self.preview_state.put(rendering, Some(pixels), work.age);
        self.shown = Some((setup, subject));
        Ok(true)
    }

    /// Shows the last scene from another view, coarsely; false if that is impossible.
    fn move_on(&mut self, work: &RenderTask) -> bool {
        let (Some(shown), Some(view_override)) =
            (&mut self.shown, &work.view_settings.view_override)
        else {
            return false;
        };
        let Some(scene) = &mut self.scene else {
            return false;
        };
        if !view_override.aim(&mut shown.1.validated.lowered) {
            return false;
        }
        let is_stopped = || self.preview_state.is_stale(work.age);
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &is_stopped,
        };
        match scene.glance(shown, &observer) {
            Ok(Some(rendering)) => self.preview_state.put(rendering, None, work.age),
            Ok(None) | Err(RenderError::Stopped) => {}
            Err(RenderError::RanOut(_) | RenderError::Refused(_)) => return false,
        }
        let camera = &shown.1.validated.lowered.scene.camera;
        if let Some(ComparisonReference::Scene(other)) = &mut self.against
            && let Ok(Some(rendering)) = other.glance(camera, &observer)
        {
            self.preview_state.put_against(rendering, work.age);
        }
        true
    }

    /// Shows the reference in the current view; false if the session ends.
    fn show_against(&mut self, work: &RenderTask, is_stopped: &(dyn Fn() -> bool + Sync)) -> bool {
        let (Some(ComparisonReference::Scene(other)), Some((_, subject))) =
            (&mut self.against, &self.shown)
        else {
            return true;
        };
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped,
        };
        let camera = &subject.validated.lowered.scene.camera;
        match other.rendering(&self.setup, (&work.view_settings, camera), &observer) {
            Ok(Some(rendering)) => self.preview_state.put_against(rendering, work.age),
            Ok(None) => {}
            Err(RenderError::Stopped) => return false,
            Err(RenderError::RanOut(diagnostic)) => {
                super::reporter::print_message(&diagnostic.message)
            }
            Err(RenderError::Refused(message)) => super::reporter::print_message(&message),
        }
        true
    }

    /// Shows the diagnostics so far, and the camera of the picture.
    fn publish(
        &mut self,
        is_failed: bool,
        view_settings: &ViewSettings,
        shown: Option<&RenderSubject>,
    ) {
        let Some(scene) = &mut self.scene else {
            return;
        };
        // Choose the diagnostics to show.
        let mut found = scene.input.take_diagnostics();
        found.sort();
        let least = match self.args.reporter.verbose {
            true => Severity::Note,
            false => Severity::Warning,
        };
        let kept: Vec<&Diagnostic> = found
            .kept()
            .iter()
            .filter(|diagnostic| diagnostic.severity <= least)
            .collect();
        let most = self.args.reporter.max_errors as usize;
        let folder = ServedFolder::of(&self.args.file);
        let diagnostics = findings::reported(&kept, most, &scene.input, &folder);
        scene.input.restore_diagnostics(found);
        // Describe the camera relative to that of the scene.
        let text = scene.input.text().map(Arc::from);
        let scene_camera = shown.map(|subject| {
            let camera = &subject.validated.lowered.scene.camera;
            let (own, view_override) = (
                scene.scene_camera.as_ref(),
                view_settings.view_override.as_ref(),
            );
            let scene_camera = SceneCamera::new(camera, view_override, scene.can_write, own);
            if view_override.is_none() {
                scene.scene_camera = Some(scene_camera.clone());
            }
            scene_camera
        });
        // Publish all of it at once.
        let (load, arguments) = (self.loads, &self.arguments);
        self.preview_state.show(|state| {
            let read = &mut state.read;
            (read.load, read.text, read.diagnostics) = (load, text, diagnostics);
            (read.is_failed, read.fault) = (is_failed, None);
            state.scene_camera = scene_camera.or(state.scene_camera.take());
            let view = state
                .scene_camera
                .as_ref()
                .map_or(&[][..], |own| &own.flags);
            state.command = arguments.command(view, &view_settings.choice);
        });
    }

    /// Shows and reports the reason, which is no diagnostic, why there is no picture.
    fn fail(&mut self, message: &str) {
        self.publish(true, &ViewSettings::default(), None);
        let (load, is_read) = (self.loads, self.scene.is_some());
        self.preview_state.show(|state| {
            if !is_read {
                state.read = ReadState::default();
            }
            state.read.load = load;
            state.read.is_failed = true;
            state.read.fault = Some(ServedFolder::of(&self.args.file).relative(message));
        });
        super::reporter::print_message(&format!("error: {message}"));
    }

    /// Reports the diagnostics on the terminal, once.
    fn report_diagnostics(&mut self) -> Result<(), Failure> {
        let Some(scene) = &mut self.scene else {
            return Ok(());
        };
        let found = scene.input.take_diagnostics();
        if found.kept() == self.reported {
            return Ok(());
        }
        self.reported = found.kept().to_vec();
        self.reporter
            .file(scene.input.name(), found, scene.input.map())
    }

    /// Discards the costs if they belong to another view; overrides of values do not change them.
    fn forget_costs(&mut self, work: &RenderTask) {
        let ViewSettings {
            view_override,
            choice,
        } = &work.view_settings;
        let view_settings = ViewSettings {
            view_override: *view_override,
            choice: choice.without_values(),
        };
        let costed = (self.loads, view_settings);
        self.preview_state.show(|state| {
            state.pixel = Value::Null;
            if self.costed != costed {
                state.costs = Value::Null;
            }
        });
        self.costed = costed;
    }
}

fn reported_failure(failure: &Failure) -> String {
    match failure {
        Failure::Input(message) | Failure::Failed(message) => message.clone(),
        Failure::Reported | Failure::Unreadable | Failure::Interrupted | Failure::ClosedPipe => {
            "the scene can't be read".to_owned()
        }
    }
}
