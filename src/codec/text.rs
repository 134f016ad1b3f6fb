//! The text form read back: the version first, then the tree of that version, every fault with its
//! span and pointer.
//!
//! Memory and depth are bounded by the text: numbers too large, keys twice and deep nesting are
//! located errors.

use super::{Decoded, locate, newer, span, typed, wrong_shape};
use crate::diag::{Diagnostic, codes};
use crate::ir::{
    Camera, Environment, Image, Light, Material, Mesh, Scene, Settings, Surface, Texture, VERSION,
};
use crate::source::FileId;
use locate::Part;
use serde::Deserialize;
use serde::de::IgnoredAny;
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
        let Document {
            _version,
            camera,
            settings,
            lights,
            images,
            textures,
            ..
        } = document;
        let Document {
            meshes,
            materials,
            surfaces,
            names,
            environment,
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
        }
    }
}

/// True if the bytes open a JSON object whose first key is `irVersion`.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let bytes = bytes
        .strip_prefix(BOM.as_bytes())
        .unwrap_or(bytes)
        .trim_ascii_start();
    let key = bytes.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    key.is_some_and(|key| key.starts_with(b"\"irVersion\""))
}

/// Decodes the text.
///
/// # Errors
/// All faults that can be told apart, at least one.
pub(super) fn decode(file: FileId, bytes: &[u8]) -> Result<Scene, Vec<Diagnostic>> {
    let text =
        std::str::from_utf8(bytes).map_err(|error| vec![*not_utf8(file, error.valid_up_to())])?;
    let (base, text) = text
        .strip_prefix(BOM)
        .map_or((0, text), |rest| (BOM.len(), rest));
    let source = Source { file, base, text };
    scene(&source, bytes.len()).map_err(|first| source.faults(*first))
}

fn scene(source: &Source<'_>, end: usize) -> Decoded<Scene> {
    let Source { file, base, .. } = *source;
    let Head { ir_version } = source.parse()?;
    if ir_version > VERSION {
        let (start, end) = source.version_place();
        Err(newer(ir_version, "IR", VERSION, span(file, start, end)))
    } else if ir_version == VERSION {
        let document: Document = source.parse()?;
        Ok(document.into())
    } else {
        let mut tree: Value = source.parse()?;
        tree.as_object_mut()
            .map(|members| members.shift_remove("irVersion"));
        typed(ir_version, tree, span(file, base, end))
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
        let what = full
            .rsplit_once(" at line ")
            .map_or(full.as_str(), |(what, _)| what);
        let read = locate::offset(self.text, error.line(), error.column());
        let place = |start, end| span(self.file, self.base + start, self.base + end);
        match error.classify() {
            Category::Data => {
                let locate::Culprit {
                    start,
                    end,
                    pointer,
                } = locate::culprit(self.text, read);
                Box::new(wrong_shape(what, place(start, end)).pointer(pointer))
            }
            Category::Eof => not_json(
                "the text ends too early",
                what,
                place(self.text.len(), self.text.len()),
            ),
            Category::Syntax | Category::Io => {
                let start = self.text.floor_char_boundary(read.saturating_sub(1));
                not_json(
                    "the text is not JSON",
                    what,
                    place(start, self.text.ceil_char_boundary(read)),
                )
            }
        }
    }

    /// The first fault, and those of the other parts of the document, each decoded by itself.
    fn faults(&self, first: Diagnostic) -> Vec<Diagnostic> {
        let is_located =
            |fault: &Diagnostic| fault.code == &codes::WRONG_SHAPE && fault.pointer.is_some();
        if !is_located(&first) {
            return vec![first];
        }
        let parts = locate::parts(self.text);
        let mut faults: Vec<_> = parts
            .iter()
            .filter_map(|part| self.fault_of(part))
            .collect();
        let place = |fault: &Diagnostic| {
            fault
                .primary
                .as_ref()
                .map(|label| (label.span.start, label.span.end))
        };
        if !faults.iter().any(|fault| place(fault) == place(&first)) {
            faults.push(first);
        }
        faults.sort_by_key(place);
        faults
    }

    fn fault_of(&self, part: &Part) -> Option<Diagnostic> {
        let Part {
            key,
            index,
            start,
            end,
        } = part;
        let text = self.text.get(*start..*end)?;
        let own = Source {
            file: self.file,
            base: self.base + start,
            text,
        };
        let found = match (key.as_str(), index) {
            ("camera", None) => own.parse::<Camera>().err(),
            ("settings", None) => own.parse::<Settings>().err(),
            ("environment", None) => own.parse::<Option<Environment>>().err(),
            ("lights", Some(_)) => own.parse::<Light>().err(),
            ("images", Some(_)) => own.parse::<Image>().err(),
            ("textures", Some(_)) => own.parse::<Texture>().err(),
            ("meshes", Some(_)) => own.parse::<Mesh>().err(),
            ("materials", Some(_)) => own.parse::<Material>().err(),
            ("surfaces", Some(_)) => own.parse::<Surface>().err(),
            ("names", Some(_)) => own.parse::<String>().err(),
            (
                "lights" | "images" | "textures" | "meshes" | "materials" | "surfaces" | "names",
                None,
            ) => own.parse::<Vec<IgnoredAny>>().err(),
            _ => None,
        };
        let place = index.map_or_else(|| format!("/{key}"), |index| format!("/{key}/{index}"));
        found.map(|fault| {
            let within = fault.pointer.clone().unwrap_or_default();
            fault.pointer(place + &within)
        })
    }

    /// The bytes of the value of `irVersion`, where it is the first key; else where the text
    /// starts.
    fn version_place(&self) -> (usize, usize) {
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

fn not_json(how: &str, what: &str, place: crate::source::Span) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(&codes::NOT_JSON, format!("{how}: {what}")).at(place, "here"))
}
