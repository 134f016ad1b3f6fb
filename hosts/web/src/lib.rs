//! The library in WebAssembly: a scene in memory is checked, explained and rendered. Findings and effects are plain objects,
//! pictures are bytes; the types of TypeScript are made from those here. Rendering holds the thread, so it runs in a worker.

use rtc::{Diagnostic, EffectState, Error, Label, Options};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use tsify::{Ts, Tsify};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
extern "C" {
    /// The worker's function for the progress of a render: the share that is done, and the rays so far.
    #[wasm_bindgen(js_namespace = globalThis, js_name = rtcProgress)]
    fn report_progress(done: f64, rays: f64);
}

/// The files of a scene.
#[wasm_bindgen]
#[derive(Default)]
pub struct Files(Vec<(String, Vec<u8>)>);

#[wasm_bindgen]
impl Files {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file; its path has `/` between components.
    pub fn add(&mut self, path: String, bytes: Vec<u8>) {
        self.0.push((path, bytes));
    }
}

/// The settings of a picture; those left out are as in the scene.
#[derive(Default, Deserialize, Tsify)]
#[serde(rename_all = "camelCase", default, deny_unknown_fields)]
pub struct Settings {
    /// Pixels; with `height`.
    #[tsify(optional)]
    pub width: Option<u32>,
    /// Pixels; with `width`.
    #[tsify(optional)]
    pub height: Option<u32>,
    /// Paths per pixel, at least 1; for path tracing.
    #[tsify(optional)]
    pub samples: Option<u32>,
    /// Sub-samples along each side of a pixel, at least 1; for all other integrators.
    #[tsify(optional)]
    pub supersampling: Option<u32>,
    /// The maximum number of bounces after the first hit.
    #[tsify(optional)]
    pub depth: Option<u32>,
    /// Takes samples until the root mean square error is at most this, in grey levels of 8 bits.
    #[tsify(optional)]
    pub target_error: Option<f64>,
    /// Denoises a path-traced picture.
    #[tsify(optional)]
    pub denoise: Option<bool>,
    /// Any setting by its name in the IR, with its value in JSON.
    #[tsify(optional)]
    pub set: BTreeMap<String, String>,
}

impl Settings {
    fn options(self) -> Options {
        let mut options = Options::new();
        if let (Some(width), Some(height)) = (self.width, self.height) {
            options = options.size(width, height);
        }
        if let Some(paths) = self.samples {
            options = options.samples(paths);
        }
        if let Some(side) = self.supersampling {
            options = options.supersampling(side);
        }
        if let Some(bounces) = self.depth {
            options = options.depth(bounces);
        }
        if let Some(levels) = self.target_error {
            options = options.target_error(levels);
        }
        options = options.denoise(self.denoise.unwrap_or(false));
        for (name, value) in self.set {
            options = options.set(name, value);
        }
        options.on_progress(|progress| report_progress(progress.done, progress.rays as f64))
    }
}

/// A scene that was read.
#[wasm_bindgen]
pub struct Scene(rtc::Scene);

#[wasm_bindgen]
impl Scene {
    /// The scene at a path of the files. It throws a [`Fault`], as the others do.
    pub fn read(path: &str, files: Files) -> Result<Self, JsValue> {
        let scene = rtc::Scene::from_files(path, files.0);
        scene.map(Self).map_err(|error| thrown(&error))
    }

    /// All findings, in the order of the text.
    pub fn check(&self) -> Result<Ts<Findings>, JsValue> {
        told(&Findings::new(&self.0.check()))
    }

    /// The effects that its picture needs, and those left out, each with the reason.
    pub fn effects(&self, settings: Ts<Settings>) -> Result<Ts<Effects>, JsValue> {
        let effects = self.0.effects(&options(&settings)?);
        let effects = effects.map_err(|error| thrown(&error))?;
        told(&Effects(effects.into_iter().map(Effect::new).collect()))
    }

    /// Its picture.
    pub fn render(&self, settings: Ts<Settings>) -> Result<Picture, JsValue> {
        let picture = self.0.render(&options(&settings)?);
        picture.map(Picture).map_err(|error| thrown(&error))
    }
}

/// A picture.
#[wasm_bindgen]
pub struct Picture(rtc::Picture);

#[wasm_bindgen]
impl Picture {
    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.0.width()
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.0.height()
    }

    /// Four bytes a pixel, as a canvas takes them.
    pub fn rgba(&self) -> Vec<u8> {
        self.0.rgba8()
    }

    /// Linear red, green and blue of each pixel.
    pub fn linear(&self) -> Vec<f32> {
        self.0
            .pixels()
            .iter()
            .flatten()
            .map(|&value| value as f32)
            .collect()
    }

    /// The bytes of its PNG file, the same as those of `rtc render`.
    pub fn png(&self) -> Result<Vec<u8>, JsValue> {
        self.0.png().map_err(|error| thrown(&error))
    }

    /// The rays that it took.
    pub fn rays(&self) -> f64 {
        self.0.statistics().rays as f64
    }

    /// The root mean square error, in grey levels of 8 bits, with a confidence of 90 %; with a target error or denoised.
    pub fn error(&self) -> Option<f64> {
        self.0.error()
    }

    /// The findings of the scene and the picture.
    pub fn findings(&self) -> Result<Ts<Findings>, JsValue> {
        told(&Findings::new(self.0.diagnostics()))
    }
}

/// The reason why there is no scene or no picture.
#[derive(Serialize, Tsify)]
pub struct Fault {
    /// One sentence.
    pub message: String,
    /// The findings that explain it; may be empty.
    pub findings: Findings,
}

impl Fault {
    /// As what is thrown.
    fn thrown(&self) -> JsValue {
        let text = |error: serde_json::Error| JsValue::from_str(&error.to_string());
        self.into_js().map_or_else(text, Into::into)
    }
}

/// An error of the library, as what is thrown.
fn thrown(error: &Error) -> JsValue {
    Fault {
        message: error.to_string(),
        findings: Findings::new(error.diagnostics()),
    }
    .thrown()
}

/// An error in what passes between JavaScript and the library, as what is thrown.
fn misunderstood(error: &tsify::Error) -> JsValue {
    Fault {
        message: error.to_string(),
        findings: Findings(Vec::new()),
    }
    .thrown()
}

fn options(settings: &Ts<Settings>) -> Result<Options, JsValue> {
    let settings = settings.to_rust().map_err(|error| misunderstood(&error))?;
    Ok(settings.options())
}

/// An object of the library, as one of JavaScript.
fn told<T: Tsify + Serialize>(object: &T) -> Result<Ts<T>, JsValue> {
    object.into_ts().map_err(|error| misunderstood(&error))
}

/// Findings, in the order of the text.
#[derive(Serialize, Tsify)]
pub struct Findings(Vec<Finding>);

impl Findings {
    fn new(diagnostics: &[Diagnostic]) -> Self {
        Self(diagnostics.iter().map(Finding::new).collect())
    }
}

/// An error, a warning or a note about a scene.
#[derive(Serialize, Tsify)]
pub struct Finding {
    /// The stable code, for example `VA003`.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// One sentence.
    pub message: String,
    /// The position of the error, if it has one.
    pub place: Option<Place>,
    /// How to fix it.
    pub hints: Vec<Hint>,
    /// What `rtc check` prints.
    pub text: String,
}

/// The severity of a finding.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    Error,
    Warning,
    Note,
}

/// Advice, with a replacement if there is one.
#[derive(Serialize, Tsify)]
pub struct Hint {
    /// The advice.
    pub text: String,
    /// The range to replace and its new text.
    pub replacement: Option<Place>,
}

/// A range of a file with a text: a label, or what replaces the range.
#[derive(Serialize, Tsify)]
pub struct Place {
    /// The path of the file.
    pub file: String,
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// The line of the first byte, from 1; none in binary files.
    pub line: Option<u32>,
    /// The text.
    pub text: String,
}

impl Finding {
    fn new(diagnostic: &Diagnostic) -> Self {
        let hints = diagnostic.hints.iter().map(|hint| Hint {
            text: hint.text.clone(),
            replacement: hint.replacement.as_ref().map(Place::new),
        });
        Self {
            code: diagnostic.code,
            severity: match diagnostic.severity {
                rtc::Severity::Error => Severity::Error,
                rtc::Severity::Warning => Severity::Warning,
                rtc::Severity::Note => Severity::Note,
            },
            message: diagnostic.message.clone(),
            place: diagnostic.primary.as_ref().map(Place::new),
            hints: hints.collect(),
            text: diagnostic.to_string(),
        }
    }
}

impl Place {
    fn new(label: &Label) -> Self {
        let location = &label.location;
        Self {
            file: location.file.clone(),
            start: location.bytes.start,
            end: location.bytes.end,
            line: location.line,
            text: label.text.clone(),
        }
    }
}

/// The effects of a picture.
#[derive(Serialize, Tsify)]
pub struct Effects(Vec<Effect>);

/// An effect, and whether the renderer simulates it for the scene.
#[derive(Serialize, Tsify)]
pub struct Effect {
    /// Its name, for example `shadows`.
    pub name: &'static str,
    /// The path of the light, material or surface that it concerns.
    pub of: Option<String>,
    /// Whether it is simulated.
    pub state: State,
    /// The rule that proves that the picture is the same without it.
    pub rule: Option<&'static str>,
    /// The reason.
    pub because: String,
}

/// Whether an effect is simulated.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "lowercase")]
pub enum State {
    Needed,
    Pruned,
    Absent,
}

impl Effect {
    fn new(effect: rtc::Effect) -> Self {
        Self {
            name: effect.name,
            of: effect.of,
            state: match effect.state {
                EffectState::Needed => State::Needed,
                EffectState::Pruned => State::Pruned,
                EffectState::Absent => State::Absent,
            },
            rule: effect.rule,
            because: effect.because,
        }
    }
}
