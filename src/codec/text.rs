//! Decodes the JSON encoding: first the version, then the tree of that version. Every error has a
//! span and a JSON pointer.
//!
//! Memory and depth are bounded by the length of the text. Numbers out of range, duplicate keys and
//! deep nesting are errors with a position.

use super::decoded::{Decoded, span, wrong_shape};
use super::version::{VersionField, newer, typed};
use super::{faults, locate};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{
    Camera, Display, Environment, Image, Light, Material, Medium, Mesh, Scene, Settings, Surface,
    Texture, VERSION,
};
use rtc_source::tree::{SyntaxTree, json};
use rtc_source::{Budget, FileId, Resource};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use serde_json::error::Category;

const BOM: &str = "\u{feff}";

/// The document of the current version.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields, expecting = "a scene")]
struct DecodedDocument {
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
    #[serde(default)]
    medium: Option<Medium>,
    #[serde(default)]
    display: Display,
}

impl From<DecodedDocument> for Scene {
    fn from(document: DecodedDocument) -> Self {
        let DecodedDocument {
            _version,
            camera,
            settings,
            lights,
            images,
            textures,
            ..
        } = document;
        let DecodedDocument {
            meshes,
            materials,
            surfaces,
            names,
            environment,
            medium,
            display,
            ..
        } = document;
        Self {
            camera,
            settings,
            lights,
            images,
            textures,
            meshes,
            materials,
            surfaces,
            names,
            environment,
            medium,
            display,
            trees: Vec::new(),
        }
    }
}

/// Whether the bytes start a JSON object whose first key is `irVersion`.
pub(super) fn has_magic(bytes: &[u8]) -> bool {
    let bytes = bytes
        .strip_prefix(BOM.as_bytes())
        .unwrap_or(bytes)
        .trim_ascii_start();
    let key = bytes.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    key.is_some_and(|key| key.starts_with(b"\"irVersion\""))
}

/// Decodes a JSON document.
///
/// # Errors
/// All errors that can be distinguished, at least one.
pub(super) fn decode(
    file: FileId,
    bytes: &[u8],
    budget: &Budget,
) -> Result<Scene, Vec<Diagnostic>> {
    let text =
        std::str::from_utf8(bytes).map_err(|error| vec![*not_utf8(file, error.valid_up_to())])?;
    let (base, text) = text
        .strip_prefix(BOM)
        .map_or((0, text), |text| (BOM.len(), text));
    let source = TextSlice { file, base, text };
    scene(&source, bytes.len()).map_err(|stop| match stop {
        DecodeStop::Reported(fault) => vec![*fault],
        DecodeStop::Json(error) => source.faults(&error, budget),
    })
}

/// Why decoding ended.
enum DecodeStop {
    /// The only error to report.
    Reported(Box<Diagnostic>),
    /// The text is not a document of the current version.
    Json(serde_json::Error),
}

fn scene(source: &TextSlice<'_>, end: usize) -> Result<Scene, DecodeStop> {
    let TextSlice { file, text, .. } = *source;
    let VersionField { ir_version } = serde_json::from_str(text).map_err(DecodeStop::Json)?;
    if ir_version > VERSION {
        let (start, end) = source.version_range();
        let span = span(file, start, end);
        Err(DecodeStop::Reported(newer(ir_version, "IR", VERSION, span)))
    } else if ir_version == VERSION {
        let document: DecodedDocument = serde_json::from_str(text).map_err(DecodeStop::Json)?;
        Ok(document.into())
    } else {
        older(source, ir_version, end).map_err(DecodeStop::Reported)
    }
}

/// The scene that a document of an older version encodes.
fn older(source: &TextSlice<'_>, version: u32, end: usize) -> Decoded<Scene> {
    let TextSlice { file, base, text } = *source;
    let tree = serde_json::from_str::<Value>(text);
    let mut tree = tree.map_err(|error| Box::new(source.fault(&error, None)))?;
    tree.as_object_mut()
        .map(|members| members.shift_remove("irVersion"));
    typed(version, tree, span(file, base, end))
}

fn not_utf8(file: FileId, at: usize) -> Box<Diagnostic> {
    let message = format!("the byte at offset {at} is not UTF-8");
    Box::new(Diagnostic::new(&codes::NOT_UTF8, message).at(span(file, at, at + 1), "not UTF-8"))
}

/// A text that starts `base` bytes into its file.
struct TextSlice<'a> {
    file: FileId,
    base: usize,
    text: &'a str,
}

/// The message for a text that is not JSON.
const NOT_JSON: &str = "the text is not JSON";

/// The bytes that a tree may need per node while it grows.
const NODE: u64 = 48;

impl<'a> TextSlice<'a> {
    /// The error at which `serde_json` stopped.
    fn fault(&self, error: &serde_json::Error, tree: Option<&SyntaxTree<'_>>) -> Diagnostic {
        let full = error.to_string();
        let what = full
            .rsplit_once(" at line ")
            .map_or(full.as_str(), |(what, _)| what);
        let read = locate::offset(self.text, error.line(), error.column());
        let span = |start, end| span(self.file, self.base + start, self.base + end);
        match error.classify() {
            Category::Data => {
                let locate::ErrorNode {
                    start,
                    end,
                    pointer,
                } = locate::error_node(tree, self.text, read);
                wrong_shape(what, span(start, end)).pointer(pointer)
            }
            Category::Eof => not_json(
                "the text ends too early",
                what,
                span(self.text.len(), self.text.len()),
            ),
            Category::Syntax | Category::Io => {
                let start = self.text.floor_char_boundary(read.saturating_sub(1));
                not_json(
                    NOT_JSON,
                    what,
                    span(start, self.text.ceil_char_boundary(read)),
                )
            }
        }
    }

    /// The tree of the text, and whether the text is valid JSON; after a syntax error the tree
    /// ends. `None` if it needs too much memory.
    fn tree(&self, budget: &Budget) -> Option<(SyntaxTree<'a>, bool)> {
        let begins_node = |byte: &u8| matches!(*byte, b',' | b':' | b'[' | b'{');
        let nodes = 1 + self.text.bytes().filter(begins_node).count() as u64;
        let cost = nodes
            .saturating_mul(NODE)
            .saturating_add(self.text.len() as u64);
        budget.has(Resource::Memory, cost).ok()?;
        let base = u32::try_from(self.base).ok()?;
        let (tree, fault) = json::parse_prefix(self.file, base, self.text);
        Some((tree, fault.is_none()))
    }

    /// The error at which `serde_json` stopped, and all others.
    fn faults(&self, first: &serde_json::Error, budget: &Budget) -> Vec<Diagnostic> {
        // Without a tree, only the first error is known.
        let Some((tree, is_json)) = self.tree(budget) else {
            return vec![self.fault(first, None)];
        };
        let first_fault = self.fault(first, Some(&tree));
        if !is_json {
            // The version is read before the rest of the text.
            let error = serde_json::from_str::<IgnoredAny>(self.text).err();
            let error = error.filter(|_| first.is_data());
            let second = error.map(|error| self.fault(&error, None));
            return std::iter::once(first_fault).chain(second).collect();
        }
        // Decode the tree and collect all errors.
        let mut faults = Vec::new();
        for faults::JsonTextError {
            span,
            pointer,
            what,
        } in faults::all::<DecodedDocument>(&tree)
        {
            faults.push(match pointer {
                Some(pointer) => wrong_shape(&what, span).pointer(pointer),
                None => not_json(NOT_JSON, &what, span),
            });
        }
        if !faults
            .iter()
            .any(|fault| covers(fault, &first_fault, first.is_data()))
        {
            faults.push(first_fault);
        }
        // Sort by position.
        let start = |fault: &Diagnostic| fault.primary.as_ref().map(|label| label.span.start);
        let end = |fault: &Diagnostic| fault.primary.as_ref().map(|label| label.span.end);
        faults.sort_by_key(|fault| (start(fault), end(fault)));
        faults
    }

    /// The bytes of the value of `irVersion` if it is the first key; else the start of the text.
    fn version_range(&self) -> (usize, usize) {
        let key = "\"irVersion\"";
        let after = self.text.find(key).map_or(0, |at| at + key.len());
        let bytes = self.text.as_bytes();
        let number = (after..bytes.len())
            .find(|at| bytes[*at].is_ascii_digit())
            .unwrap_or(0);
        let length = bytes
            .iter()
            .skip(number)
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        (self.base + number, self.base + number + length)
    }
}

/// Whether an error is the one at which `serde_json` stopped. What `serde_json` reports as a syntax
/// error (such as a list that is too long) may lie inside the span of the error.
fn covers(fault: &Diagnostic, first: &Diagnostic, is_data: bool) -> bool {
    let span = |fault: &Diagnostic| fault.primary.as_ref().map(|label| label.span);
    let Some((found, first)) = span(fault).zip(span(first)) else {
        return false;
    };
    if is_data {
        found == first
    } else {
        found.start <= first.start && first.end <= found.end
    }
}

fn not_json(how: &str, what: &str, span: rtc_source::Span) -> Diagnostic {
    Diagnostic::new(&codes::NOT_JSON, format!("{how}: {what}")).at(span, "here")
}
