//! The text form read back: the version first, then the tree of that version, every fault with its span and pointer.
//!
//! Memory and depth are bounded by the text: numbers too large, keys twice and deep nesting are located errors.

use super::{Decoded, locate, newer, span, typed, wrong_shape};
use crate::diag::{Diagnostic, codes};
use crate::ir::{Camera, Environment, Image, Light, Material, Mesh, Scene, Settings, Surface, Texture, VERSION};
use crate::source::FileId;
use serde::Deserialize;
use serde_json::Value;
use serde_json::error::Category;

const BOM: &str = "\u{feff}";

/// What every version has.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    ir_version: u32,
}

/// The document of the current version.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields, expecting = "a scene")]
struct Document {
    #[serde(rename = "irVersion")]
    _version: u32,
    camera: Camera,
    settings: Settings,
    lights: Vec<Light>,
    #[serde(default)]
    images: Vec<Image>,
    #[serde(default)]
    textures: Vec<Texture>,
    #[serde(default)]
    meshes: Vec<Mesh>,
    materials: Vec<Material>,
    surfaces: Vec<Surface>,
    #[serde(default)]
    names: Vec<String>,
    #[serde(default)]
    environment: Option<Environment>,
}

impl From<Document> for Scene {
    fn from(document: Document) -> Self {
        let Document { _version, camera, settings, lights, images, textures, .. } = document;
        let Document { meshes, materials, surfaces, names, environment, .. } = document;
        Self { camera, settings, lights, images, textures, meshes, materials, surfaces, names, environment }
    }
}

/// True if the bytes open a JSON object whose first key is `irVersion`.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(BOM.as_bytes()).unwrap_or(bytes).trim_ascii_start();
    let key = bytes.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    key.is_some_and(|key| key.starts_with(b"\"irVersion\""))
}

/// Decodes the text.
pub(super) fn decode(file: FileId, bytes: &[u8]) -> Decoded<Scene> {
    let text = std::str::from_utf8(bytes).map_err(|error| not_utf8(file, error.valid_up_to()))?;
    let (base, text) = text.strip_prefix(BOM).map_or((0, text), |rest| (BOM.len(), rest));
    let source = Source { file, base, text };
    let Head { ir_version } = source.parse()?;
    if ir_version > VERSION {
        let (start, end) = source.version_place();
        Err(newer(ir_version, "IR", VERSION, span(file, start, end)))
    } else if ir_version == VERSION {
        let document: Document = source.parse()?;
        Ok(document.into())
    } else {
        let mut tree: Value = source.parse()?;
        tree.as_object_mut().map(|members| members.shift_remove("irVersion"));
        typed(ir_version, tree, span(file, base, bytes.len()))
    }
}

fn not_utf8(file: FileId, at: usize) -> Box<Diagnostic> {
    let message = format!("the byte at offset {at} is not UTF-8");
    Box::new(Diagnostic::new(&codes::NOT_UTF8, message).at(span(file, at, at + 1), "not UTF-8"))
}

/// A text that begins `base` bytes into its file.
struct Source<'a> {
    file: FileId,
    base: usize,
    text: &'a str,
}

impl<'a> Source<'a> {
    fn parse<T: Deserialize<'a>>(&self) -> Decoded<T> {
        serde_json::from_str(self.text).map_err(|error| self.fault(&error))
    }

    fn fault(&self, error: &serde_json::Error) -> Box<Diagnostic> {
        let full = error.to_string();
        let what = full.rsplit_once(" at line ").map_or(full.as_str(), |(what, _)| what);
        let read = locate::offset(self.text, error.line(), error.column());
        let place = |start, end| span(self.file, self.base + start, self.base + end);
        match error.classify() {
            Category::Data => {
                let locate::Culprit { start, end, pointer } = locate::culprit(self.text, read);
                Box::new(wrong_shape(what, place(start, end)).pointer(pointer))
            }
            Category::Eof => not_json("the text ends too early", what, place(self.text.len(), self.text.len())),
            Category::Syntax | Category::Io => {
                let start = self.text.floor_char_boundary(read.saturating_sub(1));
                not_json("the text is not JSON", what, place(start, self.text.ceil_char_boundary(read)))
            }
        }
    }

    /// The bytes of the value of `irVersion`, where it is the first key; else where the text starts.
    fn version_place(&self) -> (usize, usize) {
        let key = "\"irVersion\"";
        let after = self.text.find(key).map_or(0, |at| at + key.len());
        let bytes = self.text.as_bytes();
        let number = (after..bytes.len()).find(|at| bytes[*at].is_ascii_digit()).unwrap_or(0);
        let length = bytes.iter().skip(number).take_while(|byte| byte.is_ascii_digit()).count();
        (self.base + number, self.base + number + length)
    }
}

fn not_json(how: &str, what: &str, place: crate::source::Span) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(&codes::NOT_JSON, format!("{how}: {what}")).at(place, "here"))
}
