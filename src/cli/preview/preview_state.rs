//! The state that page, watcher and renderer share: the shown picture, under a version that rises
//! with every change, and the requests.

use super::choice::SettingOverrides;
use super::events::{self, EventStreamItem};
use super::interrupt;
use super::pixels::PixelTable;
use super::view::{SceneCamera, ViewOverride};
use rtc_pipeline::DiagnosticRef;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// The requested view.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ViewSettings {
    /// The view, if not the scene's own.
    pub(super) view_override: Option<ViewOverride>,
    /// In which settings.
    pub(super) choice: SettingOverrides,
}

/// A picture as the page shows it.
pub(super) struct RenderedPicture {
    pub(super) png: Arc<Vec<u8>>,
    /// The size that it has when it is finished.
    pub(super) full: [u32; 2],
    /// Whether it is that of `rtc render`, or a coarse one before it.
    pub(super) is_finished: bool,
}

/// A diagnostic as the page shows it.
pub(super) struct ReportedDiagnostic {
    pub(super) severity: &'static str,
    /// As `rtc check` prints it: for a wide page, a narrower one and a narrow one.
    pub(super) texts: [String; 3],
    /// The fix that its hint suggests in the scene's own file, and whether it is a guess.
    pub(super) fix: Option<(DiagnosticRef, bool)>,
    /// What the fix does; empty if that is long.
    pub(super) change: String,
}

/// The properties of the scene as it was last read.
#[derive(Default)]
pub(super) struct ReadState {
    /// How often it was read.
    pub(super) load: u64,
    /// Its text, if it has one.
    pub(super) text: Option<Arc<str>>,
    pub(super) diagnostics: Vec<ReportedDiagnostic>,
    /// The reason why there is no picture, unless diagnostics give it.
    pub(super) fault: Option<String>,
    /// There is no picture of it.
    pub(super) is_failed: bool,
}

/// A picture with its number, and by how old an order it was made.
#[derive(Default)]
struct NumberedPicture {
    rendering: Option<RenderedPicture>,
    number: u64,
    age: u64,
}

/// The shown state and the requests.
#[derive(Default)]
pub(super) struct PreviewData {
    version: u64,
    /// The subscribers in the order of arrival, and how many there ever were.
    subscribers: VecDeque<u64>,
    followed: u64,
    pub(super) read: ReadState,
    is_working: bool,
    shown: NumberedPicture,
    /// The reading of the scene that the picture shows.
    load: u64,
    /// The reference.
    against: NumberedPicture,
    pub(super) pixels: Option<PixelTable>,
    pub(super) scene_camera: Option<SceneCamera>,
    pub(super) effects: Option<String>,
    /// The effects at a pixel, once requested.
    pub(super) pixel: Value,
    /// The settings of the scene, once requested.
    pub(super) settings: Value,
    /// The costs of accuracy in the current view, once requested.
    pub(super) costs: Value,
    /// The noise of the picture, once requested; none of an older one.
    noise: Option<NoiseLayers>,
    /// The command that renders the same.
    pub(super) command: String,
    pub(super) view_settings: ViewSettings,
    is_moving: bool,
    wants_effects: bool,
    wants_settings: bool,
    /// The requests to the renderer.
    orders: PreviewTasks,
    is_ended: bool,
}

/// Pictures of the noise of the shown picture, each with the name of its layer.
pub(super) struct NoiseLayers {
    pub(super) files: Vec<(&'static str, Arc<Vec<u8>>)>,
    /// What is said of them.
    pub(super) text: String,
}

/// The next task.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct PreviewTasks {
    /// Files have changed.
    pub(super) reload: bool,
    /// The view has changed.
    pub(super) look: bool,
    /// The effects are requested.
    pub(super) effects: bool,
    /// The costs are requested.
    pub(super) costs: bool,
    /// The noise is requested.
    pub(super) noise: bool,
    /// The effects of a pixel are requested.
    pub(super) pixel: Option<[u32; 2]>,
}

/// A piece of work for the render.
pub(super) struct RenderTask {
    pub(super) orders: PreviewTasks,
    pub(super) view_settings: ViewSettings,
    /// The view is still changing: a crude picture will do.
    pub(super) is_moving: bool,
    pub(super) wants_effects: bool,
    pub(super) wants_settings: bool,
    /// How old the order is; see [`PreviewState::is_stale`].
    pub(super) age: u64,
}

/// The state, and the threads that wait for a change.
#[derive(Default)]
pub(super) struct PreviewState {
    state: Mutex<PreviewData>,
    changed: Condvar,
    /// Rises with each order that makes the work of before useless.
    age: AtomicU64,
}

impl PreviewState {
    /// The state, read-only.
    pub(super) fn state(&self) -> MutexGuard<'_, PreviewData> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the shown state.
    pub(super) fn show(&self, change: impl FnOnce(&mut PreviewData)) {
        let mut state = self.state();
        change(&mut state);
        state.version += 1;
        self.changed.notify_all();
    }

    /// Shows a picture, made by an order of this age.
    pub(super) fn put(&self, rendering: RenderedPicture, pixels: Option<PixelTable>, age: u64) {
        self.show(|state| {
            state.load = state.read.load;
            state.is_working = !rendering.is_finished;
            state.shown.put(rendering, age);
            state.pixels = pixels;
            state.noise = None;
        });
    }

    /// Shows the noise of the picture.
    pub(super) fn put_noise(&self, noise: NoiseLayers) {
        self.show(|state| state.noise = Some(noise));
    }

    /// Shows the reference, rendered for the request with this number.
    pub(super) fn put_against(&self, rendering: RenderedPicture, age: u64) {
        self.show(|state| state.against.put(rendering, age));
    }

    /// Whether work that was ordered at an age is of no use any more.
    pub(super) fn is_stale(&self, age: u64) -> bool {
        self.age.load(Ordering::Relaxed) != age || interrupt::is_heard()
    }

    /// Has the scene read again.
    pub(super) fn reload(&self) {
        self.order(|state| state.orders.reload = true);
    }

    /// Requests another view, or with `None` the scene's own. Returns the number of the request.
    pub(super) fn look(&self, view_override: Option<ViewOverride>, is_moving: bool) -> u64 {
        self.order(|state| {
            state.view_settings.view_override = view_override;
            state.is_moving = is_moving;
            state.orders.look = true;
        })
    }

    /// Has the scene rendered in these settings. The age of the order.
    pub(super) fn choose(&self, choice: SettingOverrides) -> u64 {
        self.order(|state| {
            state.view_settings.choice = choice;
            state.is_moving = false;
            state.orders.look = true;
        })
    }

    /// Requests the effects. The current task continues.
    pub(super) fn want_effects(&self) {
        let mut state = self.state();
        if !state.wants_effects {
            state.wants_effects = true;
            state.orders.effects = true;
            self.changed.notify_all();
        }
    }

    /// Requests the settings, and their costs. The current task continues first.
    pub(super) fn want_costs(&self) {
        let mut state = self.state();
        state.wants_settings = true;
        state.orders.costs = true;
        self.changed.notify_all();
    }

    /// Requests the noise of the picture. The current task continues first.
    pub(super) fn want_noise(&self) {
        self.state().orders.noise = true;
        self.changed.notify_all();
    }

    /// Requests the effects of a pixel. The current task continues first.
    pub(super) fn want_pixel(&self, position: [u32; 2]) {
        let mut state = self.state();
        state.orders.pixel = Some(position);
        self.changed.notify_all();
    }

    fn order(&self, change: impl FnOnce(&mut PreviewData)) -> u64 {
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
    pub(super) fn next(&self) -> Option<RenderTask> {
        let is_idle =
            |state: &mut PreviewData| !state.is_ended && state.orders == PreviewTasks::default();
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
        Some(RenderTask {
            orders,
            view_settings: state.view_settings.clone(),
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

    /// Adds a subscriber; if all slots are taken, the oldest is removed.
    pub(super) fn admit(&self) -> u64 {
        let mut state = self.state();
        state.followed += 1;
        let number = state.followed;
        state.subscribers.push_back(number);
        while state.subscribers.len() > events::MOST {
            state.subscribers.pop_front();
        }
        self.changed.notify_all();
        number
    }

    /// Removes the subscriber.
    pub(super) fn dismiss(&self, number: u64) {
        self.state().subscribers.retain(|own| *own != number);
    }

    /// Waits until the state differs from a version.
    pub(super) fn wait(&self, number: u64, since: Option<u64>) -> EventStreamItem {
        let should_continue =
            |state: &PreviewData| !state.is_ended && state.subscribers.contains(&number);
        let is_same =
            |state: &mut PreviewData| should_continue(state) && Some(state.version) == since;
        let waited = self.changed.wait_while(self.state(), is_same);
        let state = waited.unwrap_or_else(PoisonError::into_inner);
        match (state.is_ended, should_continue(&state)) {
            (true, _) => EventStreamItem::Ended,
            (false, true) => EventStreamItem::Color(state.version, state.reported()),
            (false, false) => EventStreamItem::GaveWay,
        }
    }
}

impl NumberedPicture {
    fn put(&mut self, rendering: RenderedPicture, age: u64) {
        (self.number, self.age) = (self.number + 1, age);
        self.rendering = Some(rendering);
    }

    /// The file of the picture of this number; none if there is another by now.
    fn png(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        let rendering = self.rendering.as_ref()?;
        (self.number.to_string() == number).then(|| Arc::clone(&rendering.png))
    }

    fn reported(&self, load: u64) -> Option<Value> {
        self.rendering.as_ref().map(|rendering| {
            json!({
                "number": self.number,
                "load": load,
                "age": self.age,
                "full": rendering.full,
                "isFinished": rendering.is_finished,
            })
        })
    }
}

impl PreviewData {
    /// The picture of this number; none if there is another by now.
    pub(super) fn png(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        self.shown.png(number)
    }

    /// That which it is compared with.
    pub(super) fn png_against(&self, number: &str) -> Option<Arc<Vec<u8>>> {
        self.against.png(number)
    }

    /// A layer of the noise of the picture of this number.
    pub(super) fn png_noise(&self, number: &str, name: &str) -> Option<Arc<Vec<u8>>> {
        let files = &self.noise.as_ref()?.files;
        let file = files.iter().find(|(own, _)| *own == name);
        file.filter(|_| self.shown.number.to_string() == number)
            .map(|(_, png)| Arc::clone(png))
    }

    /// The state as the page receives it.
    fn reported(&self) -> Value {
        let diagnostic = |diagnostic: &ReportedDiagnostic| {
            let fix = match diagnostic.fix {
                None => Value::Null,
                Some((_, true)) => "guess".into(),
                Some((_, false)) => "sure".into(),
            };
            json!({
                "severity": diagnostic.severity,
                "texts": diagnostic.texts,
                "fix": fix,
                "change": diagnostic.change,
            })
        };
        json!({
            "version": self.version,
            "load": self.read.load,
            "isWorking": self.is_working,
            "isFailed": self.read.is_failed,
            "fault": self.read.fault,
            "findings": self.read.diagnostics.iter().map(diagnostic).collect::<Vec<_>>(),
            "picture": self.shown.reported(self.load),
            "against": self.against.reported(self.load),
            "view": self.scene_camera.as_ref().map(SceneCamera::reported),
            "isMoved": self.view_settings.view_override.is_some(),
            "choice": self.view_settings.choice,
            "command": self.command,
            "effects": self.effects,
            "pixel": self.pixel,
            "settings": self.settings,
            "costs": self.costs,
            "noise": self.noise.as_ref().map(|noise| &noise.text),
        })
    }
}
