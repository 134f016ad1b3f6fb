//! The IR as bytes: a compact JSON text and a binary container with checksums, both with a version.
//!
//! Every older version decodes; newer or corrupt bytes are one clear error with its place. Both
//! forms hold the same tree of JSON values, so a step of `upgrade.rs` is written once and serves
//! both; only the columns of meshes and the pixels of images go from the scene to a container and
//! back as they are.

mod binary;
mod changes;
mod columns;
mod faults;
mod image;
mod locate;
mod mesh;
mod print;
mod run;
mod schema;
mod section;
mod text;
mod upgrade;

pub use changes::{Change, changes};
pub use schema::schema;

use rtc_diag::{Diagnostic, Sink, clip_words, codes};
use rtc_ir::{Display, Scene, VERSION};
use rtc_source::{FileId, SourceMap, Span};
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};

/// The two forms the IR is stored in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// JSON, one entity a line.
    Text,
    /// The container, `.rtir`.
    Binary,
}

/// The form of the bytes, if they look like the IR at all; a container with a damaged beginning
/// still does.
#[must_use]
pub fn recognise(bytes: &[u8]) -> Option<Form> {
    if binary::looks_like(bytes) {
        Some(Form::Binary)
    } else if text::looks_like(bytes) {
        Some(Form::Text)
    } else {
        None
    }
}

/// Decodes a scene; what is wrong goes to the sink. The scene still has to be validated.
pub fn decode(form: Form, file: FileId, map: &SourceMap, sink: &mut Sink) -> Option<Scene> {
    let scene = match form {
        Form::Text => text::decode(file, map.bytes(file), map.budget()),
        Form::Binary => binary::decode(file, map.bytes(file)).map_err(|fault| vec![*fault]),
    };
    scene
        .map_err(|faults| faults.into_iter().for_each(|fault| sink.push(fault)))
        .ok()
}

/// A scene that can't be stored: it holds a number that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// A scene encoded, and not yet written.
pub struct Encoded<'s>(Writing<'s>);

enum Writing<'s> {
    Text(Vec<u8>),
    Binary(binary::ContainerDraft<'s>),
}

impl Encoded<'_> {
    /// Writes the file, a part at a time: columns and pixels are never in memory twice.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match &self.0 {
            Writing::Text(text) => out.write_all(text),
            Writing::Binary(draft) => draft.write(out),
        }
    }
}

/// Encodes a scene. The same scene gives the same bytes, always.
///
/// # Errors
/// If a number is not finite: JSON has no word for it.
pub fn prepare(form: Form, scene: &Scene) -> Result<Encoded<'_>, NotFinite> {
    Ok(Encoded(match form {
        Form::Text => {
            let mut text = Vec::new();
            print::document(scene, &mut text)?;
            Writing::Text(text)
        }
        Form::Binary => Writing::Binary(binary::encode(scene, &scene.display)?),
    }))
}

/// The bytes of an encoded scene.
///
/// # Errors
/// As [`prepare`].
pub fn encode(form: Form, scene: &Scene) -> Result<Vec<u8>, NotFinite> {
    let mut bytes = Vec::new();
    prepare(form, scene)?
        .write(&mut bytes)
        .expect("memory takes all there is to write");
    Ok(bytes)
}

/// The hash of the container of a scene, XXH3 of 128 bits, as if nothing were said of how its values are
/// shown; the bytes are never all in memory.
///
/// # Errors
/// As [`prepare`].
pub fn hash(scene: &Scene) -> Result<u128, NotFinite> {
    let mut hash = section::Hash::default();
    let draft = binary::encode(scene, &Display::default())?;
    draft.write(&mut hash).expect("hashing does not fail");
    Ok(hash.0.digest128())
}

/// A part of a scene as a tree.
fn tree(part: &impl Serialize) -> Result<Value, NotFinite> {
    let tree = serde_json::to_value(part)
        .expect("a scene is structs, lists and numbers, which JSON holds");
    if has_null(&tree) {
        Err(NotFinite)
    } else {
        Ok(tree)
    }
}

/// `serde_json` makes a null of a number that is not finite, and the IR has no other nulls.
fn has_null(tree: &Value) -> bool {
    match tree {
        Value::Null => true,
        Value::Bool(_) | Value::Number(_) | Value::String(_) => false,
        Value::Array(items) => items.iter().any(has_null),
        Value::Object(members) => members.values().any(has_null),
    }
}

/// Checksums are looked at, except by a fuzzer: it can't guess one, and would never see what stands
/// behind.
const CHECKSUMS_COUNT: bool = !cfg!(fuzzing);

/// What decoding ends with: the first fault ends it, since nothing after it can be trusted.
type Decoded<T> = Result<T, Box<Diagnostic>>;

fn newer(version: u32, what: &str, newest: u32, span: Span) -> Box<Diagnostic> {
    let message =
        format!("{what} version {version} is newer than {newest}, the newest this rtc reads");
    let label = format!("version {version}");
    let hint = "use a newer rtc, or compile the scene again with this one";
    Box::new(
        Diagnostic::new(&codes::NEWER_VERSION, message)
            .at(span, label)
            .hint(hint),
    )
}

/// A span of a file below 4 GiB; larger offsets are cut off.
fn span(file: FileId, start: usize, end: usize) -> Span {
    let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Span::new(file, offset(start), offset(end))
}

/// The scene a tree of version `version` stands for.
fn typed(version: u32, tree: Value, place: Span) -> Decoded<Scene> {
    debug_assert!(version <= VERSION, "newer versions are refused before");
    serde_json::from_value(upgrade::to_current(version, tree))
        .map_err(|error| wrong_shape(&error.to_string(), place))
}

fn wrong_shape(what: &str, place: Span) -> Box<Diagnostic> {
    let message = format!("this is not the shape of a scene: {}", clip_words(what));
    Box::new(Diagnostic::new(&codes::WRONG_SHAPE, message).at(place, "found here"))
}
