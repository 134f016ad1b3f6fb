//! The library in a page: a scene in memory is checked, explained and rendered. What is told goes out as JSON, pictures as
//! bytes; rendering holds the thread, so the page calls it from a worker.

use rtc::{Effect, EffectState, Error, Diagnostic, Label, Options, Severity};
use serde_json::{Value, json};
use wasm_bindgen::prelude::wasm_bindgen;

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

    /// Puts in a file; its path has `/` between components.
    pub fn add(&mut self, path: String, bytes: Vec<u8>) {
        self.0.push((path, bytes));
    }
}

/// What is asked of a picture; what is not said is as `rtc render` has it.
#[wasm_bindgen]
#[derive(Default)]
pub struct Settings(Options);

#[wasm_bindgen]
impl Settings {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Width and height in pixels.
    pub fn size(self, width: u32, height: u32) -> Self {
        Self(self.0.size(width, height))
    }

    /// Paths of each pixel.
    pub fn samples(self, paths: u32) -> Self {
        Self(self.0.samples(paths))
    }

    /// Rays of each pixel by row and by column.
    pub fn supersampling(self, side: u32) -> Self {
        Self(self.0.supersampling(side))
    }

    /// The most bounces of light.
    pub fn depth(self, bounces: u32) -> Self {
        Self(self.0.depth(bounces))
    }
}

/// A scene that was read.
#[wasm_bindgen]
pub struct Scene(rtc::Scene);

#[wasm_bindgen]
impl Scene {
    /// The scene at a path of the files. What is thrown is the JSON of [`thrown`].
    pub fn read(path: &str, files: Files) -> Result<Self, String> {
        let scene = rtc::Scene::from_files(path, files.0);
        scene.map(Self).map_err(|error| thrown(&error))
    }

    /// All that is to be said of it, in the order of its text: an array of JSON.
    pub fn check(&self) -> String {
        told(&self.0.check()).to_string()
    }

    /// What its picture needs and what is left out of it, each with the reason: an array of JSON.
    pub fn effects(&self, settings: &Settings) -> Result<String, String> {
        let effects = self.0.effects(&settings.0);
        let effects = effects.map_err(|error| thrown(&error))?;
        Ok(Value::Array(effects.iter().map(explained).collect()).to_string())
    }

    /// Its picture.
    pub fn render(&self, settings: &Settings) -> Result<Picture, String> {
        let picture = self.0.render(&settings.0);
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

    /// The bytes of its file, the same as those of `rtc render`.
    pub fn png(&self) -> Result<Vec<u8>, String> {
        self.0.encode().map_err(|error| thrown(&error))
    }

    /// The rays that it took.
    pub fn rays(&self) -> f64 {
        self.0.statistics().rays as f64
    }

    /// What was found in the scene and the picture: an array of JSON.
    pub fn findings(&self) -> String {
        told(self.0.diagnostics()).to_string()
    }
}

/// `message` in words and `findings`, which may be empty.
fn thrown(error: &Error) -> String {
    json!({"message": error.to_string(), "findings": told(error.diagnostics())}).to_string()
}

fn told(findings: &[Diagnostic]) -> Value {
    Value::Array(findings.iter().map(finding).collect())
}

/// A finding; `text` is what `rtc check` prints.
fn finding(finding: &Diagnostic) -> Value {
    let severity = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let hints = finding.hints.iter().map(|hint| {
        json!({"text": hint.text, "replacement": hint.replacement.as_ref().map(place)})
    });
    json!({
        "code": finding.code,
        "severity": severity,
        "message": finding.message,
        "place": finding.primary.as_ref().map(place),
        "hints": hints.collect::<Vec<_>>(),
        "text": finding.to_string(),
    })
}

/// Bytes of a file and the words for them.
fn place(label: &Label) -> Value {
    let at = &label.location;
    json!({"file": at.file, "start": at.bytes.start, "end": at.bytes.end, "line": at.line, "text": label.text})
}

fn explained(effect: &Effect) -> Value {
    let state = match effect.state {
        EffectState::Needed => "needed",
        EffectState::Pruned => "pruned",
        EffectState::Absent => "absent",
    };
    json!({"name": effect.name, "of": effect.of, "state": state, "rule": effect.rule, "because": effect.because})
}
