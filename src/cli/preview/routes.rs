//! The replies: fixed paths only, none of them a file.

use super::choice::SettingOverrides;
use super::events::Subscriber;
use super::http::{HttpReply, HttpRequest};
use super::preview_state::{PreviewState, ReadState};
use super::view::{self, ViewOverride};
use super::{Failure, serve};
use crate::edit;
use rtc_pipeline::{self as pipeline, FixFilter, Options};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The page, in which its style and its scripts are put.
const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = concat!(include_str!("page/base.css"), include_str!("page/page.css"));
const SCRIPT: &str = concat!(
    include_str!("page/page.js"),
    include_str!("page/pointers.js"),
    include_str!("page/settings.js")
);
const VIEW: &str = include_str!("page/view.js");

/// The state needed for replies.
pub(super) struct Routes {
    pub(super) path: PathBuf,
    pub(super) options: Options,
    pub(super) preview_state: Arc<PreviewState>,
    /// A lock for changes of the scene file.
    pub(super) pen: Mutex<()>,
}

/// The diagnostics to fix: one or all.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FixRequest {
    /// The reading of the scene that the diagnostic belongs to.
    load: u64,
    #[serde(rename = "finding")]
    diagnostic: Option<usize>,
}

/// The requested view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct ViewRequest {
    /// The view; `None` for the scene's own.
    view: Option<Value>,
    is_moving: bool,
}

impl Routes {
    /// Answers a request that was let in.
    pub(super) fn answer(&self, request: &HttpRequest) -> HttpReply {
        // GET requests read the state, POST requests change what is wanted.
        match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => self.page(),
            ("GET", "/events") => HttpReply::events(Box::new(Subscriber::new(&self.preview_state))),
            ("GET", "/picture") => {
                let number = request.value("number").unwrap_or_default();
                let png = self.preview_state.state().png(number);
                png.map_or_else(|| HttpReply::empty(404), HttpReply::png)
            }
            ("GET", "/against") => {
                let number = request.value("number").unwrap_or_default();
                let png = self.preview_state.state().png_against(number);
                png.map_or_else(|| HttpReply::empty(404), HttpReply::png)
            }
            ("GET", "/noise") => {
                let [number, layer] =
                    ["number", "layer"].map(|name| request.value(name).unwrap_or_default());
                let png = self.preview_state.state().png_noise(number, layer);
                png.map_or_else(|| HttpReply::empty(404), HttpReply::png)
            }
            ("GET", "/pixel") => self.pixel(request),
            ("POST", "/pixel") => match serde_json::from_slice(&request.body) {
                Ok(place) => {
                    self.preview_state.want_pixel(place);
                    HttpReply::empty(202)
                }
                Err(_) => HttpReply::empty(400),
            },
            ("POST", "/settings") => match SettingOverrides::read(&request.body) {
                Some(choice) => {
                    let age = self.preview_state.choose(choice);
                    HttpReply::json(&json!({ "age": age }))
                }
                None => HttpReply::empty(400),
            },
            ("POST", "/view") => self.look(&request.body),
            ("POST", "/keep") => self.keep(),
            ("POST", "/fix") => self.fix(&request.body),
            ("POST", "/effects") => {
                self.preview_state.want_effects();
                HttpReply::empty(202)
            }
            ("POST", "/costs") => {
                self.preview_state.want_costs();
                HttpReply::empty(202)
            }
            ("POST", "/noise") => {
                self.preview_state.want_noise();
                HttpReply::empty(202)
            }
            _ => HttpReply::empty(404),
        }
    }

    fn page(&self) -> HttpReply {
        let Ok(nonce) = serve::random() else {
            return HttpReply::empty(503);
        };
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        // The scripts are inserted last: they contain braces of their own.
        let page = PAGE
            .replace("{name}", &escaped(&name))
            .replace("{nonce}", &nonce)
            .replace("{style}", STYLE)
            .replace("{view}", VIEW)
            .replace("{script}", SCRIPT);
        HttpReply::page(page, nonce)
    }

    fn pixel(&self, request: &HttpRequest) -> HttpReply {
        let [x, y] = ["x", "y"].map(|name| request.value(name).and_then(|at| at.parse().ok()));
        let state = self.preview_state.state();
        let reported = state.pixels.as_ref().zip(x.zip(y));
        let reported = reported.and_then(|(pixels, (x, y))| pixels.reported(x, y));
        reported.map_or_else(
            || HttpReply::empty(404),
            |reported| HttpReply::json(&reported),
        )
    }

    fn look(&self, body: &[u8]) -> HttpReply {
        let Ok(ViewRequest { view, is_moving }) = serde_json::from_slice(body) else {
            return HttpReply::empty(400);
        };
        let view_override = view.as_ref().map(ViewOverride::read);
        if view_override == Some(None) {
            return HttpReply::empty(400);
        }
        let age = self.preview_state.look(view_override.flatten(), is_moving);
        HttpReply::json(&json!({ "age": age }))
    }

    /// Writes the view into the scene, which is then shown in its own view.
    fn keep(&self) -> HttpReply {
        let _pen = self.pen.lock().unwrap_or_else(PoisonError::into_inner);
        let (text, view_override) = {
            let state = self.preview_state.state();
            (state.read.text.clone(), state.view_settings.view_override)
        };
        let (Some(text), Some(view_override)) = (text, view_override) else {
            return HttpReply::message(409, "there is no other view to write");
        };
        match view::written(&self.path, &text, &self.options, &view_override) {
            Ok(new) => {
                let reply = put(&self.path, &text, &new);
                if reply.is_ok() {
                    self.preview_state.look(None, false);
                }
                reply.map_or_else(|message| HttpReply::message(409, &message), |()| done(1))
            }
            Err(message) => HttpReply::message(409, message),
        }
    }

    /// Applies the suggested fixes to the scene's own file.
    fn fix(&self, body: &[u8]) -> HttpReply {
        let Ok(order) = serde_json::from_slice::<FixRequest>(body) else {
            return HttpReply::empty(400);
        };
        let _pen = self.pen.lock().unwrap_or_else(PoisonError::into_inner);
        let (text, wish) = {
            let state = self.preview_state.state();
            match (state.read.text.clone(), wish(&state.read, &order)) {
                (Some(text), Some(wish)) => (text, wish),
                _ => return HttpReply::message(409, "the scene is another one by now"),
            }
        };
        let fixed = pipeline::fix(&self.path, &text, &self.options, &wish);
        if fixed.changes == 0 {
            return HttpReply::message(409, "that would not make the check better");
        }
        match put(&self.path, &text, &fixed.text) {
            Ok(()) => done(fixed.changes),
            Err(message) => HttpReply::message(409, &message),
        }
    }
}

/// The requested fixes for the scene as it was read; `None` if they belong to another reading.
fn wish(read: &ReadState, order: &FixRequest) -> Option<FixFilter> {
    if read.load != order.load {
        return None;
    }
    let Some(index) = order.diagnostic else {
        return Some(FixFilter::default());
    };
    let (diagnostic_ref, is_guess) = read.diagnostics.get(index)?.fix.as_ref()?;
    Some(FixFilter {
        guesses: *is_guess,
        only: Some(diagnostic_ref.clone()),
    })
}

fn done(changes: usize) -> HttpReply {
    HttpReply::json(&json!({ "changes": changes }))
}

fn put(path: &Path, before: &str, after: &str) -> Result<(), String> {
    edit::write(path, before, after).map_err(|error| match error {
        Failure::Failed(message) => message,
        Failure::Reported
        | Failure::Input(_)
        | Failure::Unreadable
        | Failure::Interrupted
        | Failure::ClosedPipe => "it can't be written".to_owned(),
    })
}

/// A text escaped for HTML.
fn escaped(text: &str) -> String {
    let entity = |letter: char| match letter {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        // It would be taken for a placeholder.
        '{' => "&#123;".to_owned(),
        other => other.to_string(),
    };
    text.chars().map(entity).collect()
}
