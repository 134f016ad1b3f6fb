//! What the page, the watch and the render have in common: what is shown, under a number that rises
//! with every change, and what is asked for.

use super::choice::Choice;
use super::interrupt;
use super::news::{self, News};
use super::pixels::PixelTable;
use super::view::{Gaze, Sight};
use rtc_pipeline::DiagnosticRef;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// How the scene is looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Manner {
    /// From where, if not as the scene says.
    pub(super) gaze: Option<Gaze>,
    /// In which settings.
    pub(super) choice: Choice,
}

/// A picture as the page shows it.
pub(super) struct Shot {
    pub(super) png: Arc<Vec<u8>>,
    /// The size that it has when it is finished.
    pub(super) full: [u32; 2],
    /// It is that of `rtc render`; else a crude one on the way to it.
    pub(super) is_finished: bool,
}

/// A finding as the page shows it.
pub(super) struct ToldFinding {
    pub(super) severity: &'static str,
    /// As `rtc check` prints it.
    pub(super) text: String,
    /// What its hint would mend in the scene's own file, and whether that is a guess.
    pub(super) fix: Option<(DiagnosticRef, bool)>,
}

/// What is known of the scene as it was last read.
#[derive(Default)]
pub(super) struct ReadState {
    /// How often it was read.
    pub(super) load: u64,
    /// Its text, if it has one.
    pub(super) text: Option<Arc<str>>,
    pub(super) findings: Vec<ToldFinding>,
    /// Why there is no picture, beside the findings.
    pub(super) fault: Option<String>,
    /// There is no picture of it.
    pub(super) is_failed: bool,
}

/// A picture with its number, and by how old an order it was made.
#[derive(Default)]
struct NumberedShot {
    shot: Option<Shot>,
    number: u64,
    age: u64,
}

/// All that is shown and asked for.
#[derive(Default)]
pub(super) struct BoardState {
    version: u64,
    /// Who follows what is shown, by the order in which they came, and how many ever did.
    followers: VecDeque<u64>,
    followed: u64,
    pub(super) read: ReadState,
    is_working: bool,
    shown: NumberedShot,
    /// Of which reading of the scene the picture is.
    load: u64,
    /// What it is compared with.
    against: NumberedShot,
    pub(super) pixels: Option<PixelTable>,
    pub(super) sight: Option<Sight>,
    pub(super) effects: Option<String>,
    /// Which effects took part at a pixel, once that was asked for.
    pub(super) pixel: Value,
    /// The settings that the scene has, once they were asked for.
    pub(super) settings: Value,
    /// What accuracy costs in the scene as it is looked at, once that was asked for.
    pub(super) costs: Value,
    /// The command that renders the same.
    pub(super) command: String,
    pub(super) manner: Manner,
    is_moving: bool,
    wants_effects: bool,
    wants_settings: bool,
    /// What is asked of the render.
    orders: Orders,
    is_ended: bool,
}

/// What is to be done.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct Orders {
    /// Files have changed.
    pub(super) reload: bool,
    /// The view has changed.
    pub(super) look: bool,
    /// The effects are asked for.
    pub(super) effects: bool,
    /// The costs are asked for.
    pub(super) costs: bool,
    /// The effects of a pixel are asked for.
    pub(super) pixel: Option<[u32; 2]>,
}

/// A piece of work for the render.
pub(super) struct Work {
    pub(super) orders: Orders,
    pub(super) manner: Manner,
    /// The view is still changing: a crude picture will do.
    pub(super) is_moving: bool,
    pub(super) wants_effects: bool,
    pub(super) wants_settings: bool,
    /// How old the order is; see [`Board::is_stale`].
    pub(super) age: u64,
}

/// The state, and who waits for it to change.
#[derive(Default)]
pub(super) struct Board {
    state: Mutex<BoardState>,
    changed: Condvar,
    /// Rises with each order that makes the work of before useless.
    age: AtomicU64,
}

impl Board {
    /// The state, to be looked at.
    pub(super) fn state(&self) -> MutexGuard<'_, BoardState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes what is shown.
    pub(super) fn show(&self, change: impl FnOnce(&mut BoardState)) {
        let mut state = self.state();
        change(&mut state);
        state.version += 1;
        self.changed.notify_all();
    }

    /// Shows a picture, made by an order of this age.
    pub(super) fn put(&self, shot: Shot, pixels: Option<PixelTable>, age: u64) {
        self.show(|state| {
            state.load = state.read.load;
            state.is_working = !shot.is_finished;
            state.shown.put(shot, age);
            state.pixels = pixels;
        });
    }

    /// Shows what the picture is compared with, made by an order of this age.
    pub(super) fn put_against(&self, shot: Shot, age: u64) {
        self.show(|state| state.against.put(shot, age));
    }

    /// Whether work that was ordered at an age is of no use any more.
    pub(super) fn is_stale(&self, age: u64) -> bool {
        self.age.load(Ordering::Relaxed) != age || interrupt::is_heard()
    }

    /// Has the scene read again.
    pub(super) fn reload(&self) {
        self.order(|state| state.orders.reload = true);
    }

    /// Has the scene looked at from elsewhere; as it says with `None`. The age of the order.
    pub(super) fn look(&self, gaze: Option<Gaze>, is_moving: bool) -> u64 {
        self.order(|state| {
            state.manner.gaze = gaze;
            state.is_moving = is_moving;
            state.orders.look = true;
        })
    }

    /// Has the scene rendered in these settings. The age of the order.
    pub(super) fn choose(&self, choice: Choice) -> u64 {
        self.order(|state| {
            state.manner.choice = choice;
            state.is_moving = false;
            state.orders.look = true;
        })
    }

    /// Has the effects told from now on. What is being done goes on.
    pub(super) fn want_effects(&self) {
        let mut state = self.state();
        if !state.wants_effects {
            state.wants_effects = true;
            state.orders.effects = true;
            self.changed.notify_all();
        }
    }

    /// Has the settings told from now on, and their costs measured. What is being done goes on before.
    pub(super) fn want_costs(&self) {
        let mut state = self.state();
        state.wants_settings = true;
        state.orders.costs = true;
        self.changed.notify_all();
    }

    /// Has the effects of a pixel told. What is being done goes on before.
    pub(super) fn want_pixel(&self, place: [u32; 2]) {
        let mut state = self.state();
        state.orders.pixel = Some(place);
        self.changed.notify_all();
    }

    fn order(&self, change: impl FnOnce(&mut BoardState)) -> u64 {
        let mut state = self.state();
        change(&mut state);
        self.changed.notify_all();
        self.age.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Ends all work.
    pub(super) fn end(&self) {
        self.order(|state| state.is_ended = true);
    }

    /// Waits for work; `None` if there is to be none any more.
    pub(super) fn next(&self) -> Option<Work> {
        let is_idle = |state: &mut BoardState| !state.is_ended && state.orders == Orders::default();
        let waited = self.changed.wait_while(self.state(), is_idle);
        let mut state = waited.unwrap_or_else(PoisonError::into_inner);
        if state.is_ended {
            return None;
        }
        let orders = std::mem::take(&mut state.orders);
        if orders.reload || orders.look {
            state.is_working = true;
            state.version += 1;
            self.changed.notify_all();
        }
        Some(Work {
            orders,
            manner: state.manner.clone(),
            is_moving: state.is_moving,
            wants_effects: state.wants_effects,
            wants_settings: state.wants_settings,
            age: self.age.load(Ordering::Relaxed),
        })
    }

    /// Nothing is done any more, unless there are new orders.
    pub(super) fn rest(&self) {
        self.show(|state| state.is_working = false);
    }

    /// A place for one more who follows what is shown; if need be, the oldest gives way.
    pub(super) fn admit(&self) -> u64 {
        let mut state = self.state();
        state.followed += 1;
        let number = state.followed;
        state.followers.push_back(number);
        while state.followers.len() > news::MOST {
            state.followers.pop_front();
        }
        self.changed.notify_all();
        number
    }

    /// Takes the place back.
    pub(super) fn dismiss(&self, number: u64) {
        self.state().followers.retain(|own| *own != number);
    }

    /// Waits until what is shown differs from that of a version.
    pub(super) fn wait(&self, number: u64, since: Option<u64>) -> News {
        let should_continue =
            |state: &BoardState| !state.is_ended && state.followers.contains(&number);
        let is_same =
            |state: &mut BoardState| should_continue(state) && Some(state.version) == since;
        let waited = self.changed.wait_while(self.state(), is_same);
        let state = waited.unwrap_or_else(PoisonError::into_inner);
        match (state.is_ended, should_continue(&state)) {
            (true, _) => News::Ended,
            (false, true) => News::Shown(state.version, state.told()),
            (false, false) => News::GaveWay,
        }
    }
}

impl NumberedShot {
    fn put(&mut self, shot: Shot, age: u64) {
        (self.number, self.age) = (self.number + 1, age);
        self.shot = Some(shot);
    }

    /// The file of the picture of this number; none if there is another by now.
    fn png(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        let shot = self.shot.as_ref()?;
        (self.number.to_string() == number).then(|| Arc::clone(&shot.png))
    }

    fn told(&self, load: u64) -> Option<Value> {
        self.shot.as_ref().map(|shot| {
            json!({
                "number": self.number,
                "load": load,
                "age": self.age,
                "full": shot.full,
                "isFinished": shot.is_finished,
            })
        })
    }
}

impl BoardState {
    /// The picture of this number; none if there is another by now.
    pub(super) fn png(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        self.shown.png(number)
    }

    /// That which it is compared with.
    pub(super) fn png_against(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        self.against.png(number)
    }

    /// What the page is told.
    fn told(&self) -> Value {
        let finding = |finding: &ToldFinding| {
            let fix = match finding.fix {
                None => Value::Null,
                Some((_, true)) => "guess".into(),
                Some((_, false)) => "sure".into(),
            };
            json!({ "severity": finding.severity, "text": finding.text, "fix": fix })
        };
        json!({
            "version": self.version,
            "load": self.read.load,
            "isWorking": self.is_working,
            "isFailed": self.read.is_failed,
            "fault": self.read.fault,
            "findings": self.read.findings.iter().map(finding).collect::<Vec<_>>(),
            "picture": self.shown.told(self.load),
            "against": self.against.told(self.load),
            "view": self.sight.as_ref().map(Sight::told),
            "isMoved": self.manner.gaze.is_some(),
            "choice": self.manner.choice,
            "command": self.command,
            "effects": self.effects,
            "pixel": self.pixel,
            "settings": self.settings,
            "costs": self.costs,
        })
    }
}
