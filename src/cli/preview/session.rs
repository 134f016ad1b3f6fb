//! The session: reads the scene, shows what is found, and renders it, crude first; all of it anew when
//! a file or the view changes, whatever is under way.

use super::board::{Board, ReadState, ToldFinding, Work};
use super::view::{self, Gaze, Sight};
use super::watch::Watched;
use super::{Failure, args, costs, crude, input, render, shots};
use crate::cli::report::PlanReport;
use crate::cli::talk::Talk;
use crate::diag::{self, Diagnostic, Severity, Sink};
use crate::passes::View;
use crate::pipeline::{self, Input, Loaded, Observer, PictureSetup, RenderError, RenderSubject};
use std::sync::Arc;

/// Columns of what is told on the page.
const WIDTH: usize = 100;

/// What is shown, as long as there is a scene.
pub(super) struct Session<'a> {
    args: &'a args::Preview,
    board: Arc<Board>,
    watched: Arc<Watched>,
    talk: Talk,
    /// The picture as it is asked for.
    setup: PictureSetup,
    loads: u64,
    scene: Option<ReadScene>,
    /// The scene as it was rendered last, and how.
    shown: Option<(PictureSetup, RenderSubject)>,
    /// What was told last.
    told: Vec<Diagnostic>,
}

/// A scene that was read.
struct ReadScene {
    input: Input,
    loaded: Option<Loaded>,
    /// What was found while it was read.
    found: Sink,
    /// The view that was asked for when it was read.
    view: View,
    /// Whether it has keys for another view.
    can_write: bool,
    /// How its own camera sees it, once that is known.
    sight: Option<Sight>,
}

impl<'a> Session<'a> {
    pub(super) fn new(
        args: &'a args::Preview,
        board: Arc<Board>,
        watched: Arc<Watched>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            args,
            board,
            watched,
            talk: Talk::beside_result(&args.talk),
            setup: shots::setup(args)?,
            loads: 0,
            scene: None,
            shown: None,
            told: Vec::new(),
        })
    }

    /// Shows the scene until told to stop.
    pub(super) fn run(mut self) -> Result<(), Failure> {
        self.board.reload();
        while let Some(work) = self.board.next() {
            if work.orders.reload {
                self.load();
            }
            if work.orders.reload || work.orders.look {
                self.look(&work)?;
            } else if work.orders.effects {
                self.tell_effects(&work);
            } else if work.orders.costs {
                self.tell_costs(&work)?;
            }
        }
        self.talk.finish()?;
        Err(Failure::Interrupted)
    }

    /// Reads the scene.
    fn load(&mut self) {
        let known = self.watched.now(&self.args.file);
        let args = self.args;
        self.loads += 1;
        let mut input = match input::staged(&args.file, &args.reading, &args.stage) {
            Ok(input) => input,
            Err(failure) => {
                let paths = [Some(&args.file), args.stage.env.as_ref()];
                self.watched
                    .set(&known, paths.into_iter().flatten().cloned().collect());
                (self.scene, self.shown) = (None, None);
                return self.fail(&failure_told(&failure));
            }
        };
        input.use_threads(self.setup.threads);
        render::set_stage(&mut input, &args.look, None);
        let mut view = View::default();
        input.restage(|stage| view = stage.view);
        let loaded = input.load();
        let paths = input.map().paths_read().into_iter();
        self.watched
            .set(&known, paths.chain([args.file.clone()]).collect());
        let own = loaded
            .as_ref()
            .and_then(|loaded| view::keys(&loaded.lowered, input.map(), input.name()));
        self.scene = Some(ReadScene {
            found: input.take_findings(),
            can_write: own.is_some() && input.text().is_some(),
            sight: None,
            input,
            loaded,
            view,
        });
    }

    /// Renders the scene as it is looked at: crude, and to the end unless the view is moving.
    fn look(&mut self, work: &Work) -> Result<(), Failure> {
        if work.is_moving && !work.orders.reload && self.move_on(work) {
            return Ok(());
        }
        self.shown = None;
        let board = Arc::clone(&self.board);
        let is_stopped = || board.is_stale(work.age);
        let rendered = self.render(work, &is_stopped);
        match rendered {
            Ok(true) => self.tell_effects(work),
            // The findings say why.
            Ok(false) => self.publish(true, None),
            Err(RenderError::Stopped) => return Ok(()),
            Err(RenderError::RanOut(finding)) => {
                self.push(*finding);
                self.publish(true, None);
            }
            Err(RenderError::Refused(words)) => self.fail(&words),
        }
        self.board.rest();
        self.tell()
    }

    /// Renders the scene; whether there is a picture.
    fn render(
        &mut self,
        work: &Work,
        is_stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<bool, RenderError> {
        let Some((mut setup, mut subject)) = self.prove(work.gaze.as_ref())? else {
            return Ok(false);
        };
        setup.window(&subject.proven.lowered.scene)?;
        let Some(ReadScene { input, .. }) = &mut self.scene else {
            return Ok(false);
        };
        let observer = Observer {
            on_step: &|_| (),
            is_stopped,
        };
        setup.light(&mut subject, input, &observer)?;
        self.publish(false, Some((&subject, work.gaze.as_ref())));
        let Some(ReadScene { input, .. }) = &mut self.scene else {
            return Ok(false);
        };
        if let Some(shot) = crude::render(&setup, &mut subject, input, &observer)? {
            self.board.put(shot, None, work.age);
        }
        let (shot, pixels) = shots::finish(&setup, &mut subject, input, &observer)?;
        self.publish(false, Some((&subject, work.gaze.as_ref())));
        self.board.put(shot, Some(pixels), work.age);
        self.shown = Some((setup, subject));
        Ok(true)
    }

    /// Proves the scene as it is looked at.
    fn prove(
        &mut self,
        gaze: Option<&Gaze>,
    ) -> Result<Option<(PictureSetup, RenderSubject)>, RenderError> {
        let Some(scene) = &mut self.scene else {
            return Ok(None);
        };
        let yfov = scene.sight.as_ref().and_then(Sight::yfov);
        let view = gaze.map_or(scene.view, |gaze| gaze.view(yfov.or(scene.view.yfov)));
        scene.input.restage(|stage| stage.view = view);
        scene.input.put_findings(scene.found.clone());
        let mut setup = self.setup.clone();
        let Some(loaded) = scene.loaded.clone() else {
            return Ok(None);
        };
        let proven = setup.prove(loaded, &mut scene.input)?;
        Ok(proven.map(|subject| (setup, subject)))
    }

    /// Shows what was rendered last from elsewhere, crudely; false if it can't be.
    fn move_on(&mut self, work: &Work) -> bool {
        let (Some((setup, subject)), Some(gaze)) = (&mut self.shown, &work.gaze) else {
            return false;
        };
        let Some(scene) = &mut self.scene else {
            return false;
        };
        if !gaze.aim(&mut subject.proven.lowered) {
            return false;
        }
        let is_stopped = || self.board.is_stale(work.age);
        let observer = Observer {
            on_step: &|_| (),
            is_stopped: &is_stopped,
        };
        let found = scene.input.take_findings();
        let shot = crude::render(setup, subject, &mut scene.input, &observer);
        scene.input.put_findings(found);
        match shot {
            Ok(Some(shot)) => self.board.put(shot, None, work.age),
            Ok(None) | Err(RenderError::Stopped) => {}
            Err(RenderError::RanOut(_) | RenderError::Refused(_)) => return false,
        }
        true
    }

    fn push(&mut self, finding: Diagnostic) {
        if let Some(scene) = &mut self.scene {
            scene.input.push(finding);
        }
    }

    /// Shows what was found so far, and the camera of what is rendered.
    fn publish(&mut self, is_failed: bool, shown: Option<(&RenderSubject, Option<&Gaze>)>) {
        let Some(scene) = &mut self.scene else {
            return;
        };
        let mut found = scene.input.take_findings();
        found.sort();
        let least = match self.args.talk.verbose {
            true => Severity::Note,
            false => Severity::Warning,
        };
        let findings = found
            .kept()
            .iter()
            .filter(|finding| finding.severity <= least)
            .take(self.args.talk.max_errors as usize)
            .map(|finding| told(finding, &scene.input))
            .collect();
        scene.input.put_findings(found);
        let text = scene.input.text().map(Arc::from);
        let sight = shown.map(|(subject, gaze)| {
            let camera = &subject.proven.lowered.scene.camera;
            let own = scene.sight.as_ref();
            let sight = Sight::new(camera, gaze, scene.can_write, own);
            if gaze.is_none() {
                scene.sight = Some(sight.clone());
            }
            sight
        });
        let load = self.loads;
        self.board.show(|state| {
            let read = &mut state.read;
            (read.load, read.text, read.findings) = (load, text, findings);
            (read.is_failed, read.fault) = (is_failed, None);
            state.costs = None;
            state.sight = sight.or(state.sight.take());
        });
    }

    /// Shows and tells that there is no picture for a reason that is no finding.
    fn fail(&mut self, words: &str) {
        self.publish(true, None);
        let (load, is_read) = (self.loads, self.scene.is_some());
        self.board.show(|state| {
            if !is_read {
                state.read = ReadState::default();
            }
            state.read.load = load;
            state.read.is_failed = true;
            state.read.fault = Some(words.to_owned());
        });
        super::talk::say(&format!("error: {words}"));
    }

    /// Tells what was found on the terminal, once.
    fn tell(&mut self) -> Result<(), Failure> {
        let Some(scene) = &mut self.scene else {
            return Ok(());
        };
        let found = scene.input.take_findings();
        if found.kept() == self.told {
            return Ok(());
        }
        self.told = found.kept().to_vec();
        self.talk.file(scene.input.name(), found, scene.input.map())
    }

    /// Shows which effects the picture needs, if that is asked for.
    fn tell_effects(&self, work: &Work) {
        if !work.wants_effects {
            return;
        }
        if let (Some(scene), Some((_, subject))) = (&self.scene, &self.shown) {
            let effects = PlanReport::verdicts(&subject.proven, &scene.input);
            self.board.show(|state| state.effects = Some(effects));
        }
    }

    /// Shows what accuracy costs in the picture, unless something newer is ordered meanwhile.
    fn tell_costs(&self, work: &Work) -> Result<(), Failure> {
        if let (Some(scene), Some((setup, subject))) = (&self.scene, &self.shown) {
            let is_going = || !self.board.is_stale(work.age);
            let studied = (scene.input.name(), &subject.proven.lowered.scene);
            let costs = costs::table(studied, setup.threads, &is_going)?;
            if costs.is_some() {
                self.board.show(|state| state.costs = costs);
            }
        }
        Ok(())
    }
}

/// A finding as the page shows it.
fn told(finding: &Diagnostic, input: &Input) -> ToldFinding {
    let changes = finding
        .hints
        .iter()
        .filter_map(|hint| hint.replacement.as_ref());
    let own = changes.filter(|change| input.is_own(change.span));
    let is_guess = own.map(|change| change.is_guess).reduce(|a, b| a && b);
    ToldFinding {
        severity: finding.severity.name(),
        text: diag::one(finding, input.map(), WIDTH),
        fix: is_guess.map(|is_guess| (pipeline::complaint(finding), is_guess)),
    }
}

fn failure_told(failure: &Failure) -> String {
    match failure {
        Failure::Input(words) | Failure::Trouble(words) => words.clone(),
        Failure::Findings | Failure::Unreadable | Failure::Interrupted | Failure::ClosedPipe => {
            "the scene can't be read".to_owned()
        }
    }
}
