//! What the page, the watch and the render have in common: what is shown, under a number that rises
//! with every change, and what is asked for.

use super::interrupt;
use super::news::{self, News};
use super::pixels::PixelTable;
use super::view::{Gaze, Sight};
use crate::pipeline::Complaint;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

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
    pub(super) fix: Option<(Complaint, bool)>,
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

/// All that is shown and asked for.
#[derive(Default)]
pub(super) struct BoardState {
    version: u64,
    /// Who follows what is shown, by the order in which they came, and how many ever did.
    followers: VecDeque<u64>,
    followed: u64,
    pub(super) read: ReadState,
    is_working: bool,
    shot: Option<Shot>,
    /// The number of the picture, of which reading of the scene it is, and by how old an order.
    number: u64,
    load: u64,
    age: u64,
    pub(super) pixels: Option<PixelTable>,
    pub(super) sight: Option<Sight>,
    pub(super) effects: Option<String>,
    /// What accuracy costs in the picture that is shown, once it was asked for.
    pub(super) costs: Option<String>,
    /// Where the page looks from, if not as the scene says.
    pub(super) gaze: Option<Gaze>,
    is_moving: bool,
    wants_effects: bool,
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
}

/// A piece of work for the render.
pub(super) struct Work {
    pub(super) orders: Orders,
    pub(super) gaze: Option<Gaze>,
    /// The view is still changing: a crude picture will do.
    pub(super) is_moving: bool,
    pub(super) wants_effects: bool,
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
            state.number += 1;
            (state.load, state.age) = (state.read.load, age);
            state.is_working = !shot.is_finished;
            state.shot = Some(shot);
            state.pixels = pixels;
        });
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
            state.gaze = gaze;
            state.is_moving = is_moving;
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

    /// Has the costs of the picture measured. What is being done goes on before.
    pub(super) fn want_costs(&self) {
        let mut state = self.state();
        state.orders.costs = true;
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
            gaze: state.gaze,
            is_moving: state.is_moving,
            wants_effects: state.wants_effects,
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
        let goes_on = |state: &BoardState| !state.is_ended && state.followers.contains(&number);
        let is_same = |state: &mut BoardState| goes_on(state) && Some(state.version) == since;
        let waited = self.changed.wait_while(self.state(), is_same);
        let state = waited.unwrap_or_else(PoisonError::into_inner);
        match (state.is_ended, goes_on(&state)) {
            (true, _) => News::Ended,
            (false, true) => News::Shown(state.version, state.told()),
            (false, false) => News::GaveWay,
        }
    }
}

impl BoardState {
    /// The picture of this number; none if there is another by now.
    pub(super) fn png(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        let shot = self.shot.as_ref()?;
        (self.number.to_string() == number).then(|| Arc::clone(&shot.png))
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
        let picture = self.shot.as_ref().map(|shot| {
            json!({
                "number": self.number,
                "load": self.load,
                "age": self.age,
                "full": shot.full,
                "isFinished": shot.is_finished,
            })
        });
        json!({
            "version": self.version,
            "load": self.read.load,
            "isWorking": self.is_working,
            "isFailed": self.read.is_failed,
            "fault": self.read.fault,
            "findings": self.read.findings.iter().map(finding).collect::<Vec<_>>(),
            "picture": picture,
            "view": self.sight.as_ref().map(Sight::told),
            "isMoved": self.gaze.is_some(),
            "effects": self.effects,
            "costs": self.costs,
        })
    }
}
