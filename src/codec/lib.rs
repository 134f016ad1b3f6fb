//! Encodes and decodes the IR: compact JSON and a binary container with checksums, both versioned.
//!
//! # Overview
//! - [`detect_format`] finds the [`Encoding`] of a file from its first bytes.
//! - [`decode`] turns bytes into a `Scene`. The scene still has to be validated.
//! - [`encode`] and [`prepare`] turn a scene into bytes; the same scene always gives the same
//!   bytes. [`hash()`] is the hash of these bytes.
//! - [`changes()`] lists the differences between two scenes, and [`schema()`] is the JSON Schema of
//!   the JSON encoding.
//!
//! # How decoding works
//! Both encodings hold the same tree of JSON values: detect the version, decode the tree, upgrade
//! it step by step to the current version (`upgrade`), and deserialise it. So an upgrade step is
//! written once for both encodings. Only mesh columns and image pixels bypass the tree: they are
//! copied between the scene and sections of the container (`section`, `mesh`, `image`). `columns`
//! packs lists of similar entities into tables of numbers.
//!
//! # Guarantees
//! - Every older version decodes; newer versions and corrupt bytes are errors with a position.
//! - Of a damaged container the first error is reported, because later bytes can't be trusted. Of a
//!   JSON document all errors are reported (`faults`).
//! - Memory use is bounded by a constant times the file length.

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
mod stored;
mod text;
mod upgrade;

pub use changes::{ValueChange, changes};
pub use schema::schema;

use rtc_diag::{Diagnostic, DiagnosticSink, clip_words, codes};
use rtc_ir::{Display, Scene, VERSION};
use rtc_source::{FileId, SourceMap, Span};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::io::{self, Write};

/// The two encodings of the IR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// JSON, one entity per line.
    Json,
    /// The binary container, `.rtir`.
    Binary,
}

/// The encoding of the bytes; `None` if they are not IR. A container with a damaged magic is still
/// detected.
#[must_use]
pub fn detect_format(bytes: &[u8]) -> Option<Encoding> {
    if binary::has_magic(bytes) {
        Some(Encoding::Binary)
    } else if text::has_magic(bytes) {
        Some(Encoding::Json)
    } else {
        None
    }
}

/// Decodes a scene and reports errors to the sink. The scene still has to be validated.
pub fn decode(
    encoding: Encoding,
    file: FileId,
    map: &SourceMap,
    sink: &mut DiagnosticSink,
) -> Option<Scene> {
    let scene = match encoding {
        Encoding::Json => text::decode(file, map.bytes(file), map.budget()),
        Encoding::Binary => binary::decode(file, map.bytes(file)).map_err(|fault| vec![*fault]),
    };
    scene
        .map_err(|faults| faults.into_iter().for_each(|fault| sink.push(fault)))
        .ok()
}

/// A scene that can't be encoded because a number is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NonFiniteNumber;

/// An encoded scene that has not been written yet.
pub struct EncodedScene<'s>(Writing<'s>);

enum Writing<'s> {
    Json(Vec<u8>),
    Binary(binary::ContainerDraft<'s>),
}

impl EncodedScene<'_> {
    /// Writes the file in pieces: columns and pixels are not copied in memory.
    ///
    /// # Errors
    /// The bytes of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        match &self.0 {
            Writing::Json(text) => out.write_all(text),
            Writing::Binary(draft) => draft.write(out),
        }
    }
}

/// Encodes a scene. The same scene always gives the same bytes.
///
/// # Errors
/// If a number is not finite: JSON has no syntax for it.
pub fn prepare(encoding: Encoding, scene: &Scene) -> Result<EncodedScene<'_>, NonFiniteNumber> {
    Ok(EncodedScene(match encoding {
        Encoding::Json => {
            let mut text = Vec::new();
            print::document(scene, &mut text)?;
            Writing::Json(text)
        }
        Encoding::Binary => Writing::Binary(binary::encode(scene, &scene.display, &[])?),
    }))
}

/// Encodes a scene as a binary container with its stored hierarchies, which [`prepare`] leaves
/// out.
///
/// # Errors
/// As [`prepare`].
pub fn prepare_with_trees(scene: &Scene) -> Result<EncodedScene<'_>, NonFiniteNumber> {
    let draft = binary::encode(scene, &scene.display, &scene.trees)?;
    Ok(EncodedScene(Writing::Binary(draft)))
}

/// The bytes of an encoded scene.
///
/// # Errors
/// As [`prepare`].
pub fn encode(encoding: Encoding, scene: &Scene) -> Result<Vec<u8>, NonFiniteNumber> {
    let mut bytes = Vec::new();
    prepare(encoding, scene)?
        .write(&mut bytes)
        .expect("memory takes all there is to write");
    Ok(bytes)
}

/// The 128-bit XXH3 hash of the binary encoding of a scene with default display settings. The bytes
/// are hashed in pieces.
///
/// # Errors
/// As [`prepare`].
pub fn hash(scene: &Scene) -> Result<u128, NonFiniteNumber> {
    let mut hash = section::HashWriter::default();
    let draft = binary::encode(scene, &Display::default(), &[])?;
    draft.write(&mut hash).expect("hashing does not fail");
    Ok(hash.0.digest128())
}

/// A part of a scene as a JSON tree.
fn tree(part: &impl Serialize) -> Result<Value, NonFiniteNumber> {
    let tree = serde_json::to_value(part)
        .expect("a scene is structs, lists and numbers, which JSON holds");
    if has_null(&tree) {
        Err(NonFiniteNumber)
    } else {
        Ok(tree)
    }
}

/// `serde_json` writes null for a number that is not finite, and the IR has no other nulls.
fn has_null(tree: &Value) -> bool {
    match tree {
        Value::Null => true,
        Value::Bool(_) | Value::Number(_) | Value::String(_) => false,
        Value::Array(items) => items.iter().any(has_null),
        Value::Object(members) => members.values().any(has_null),
    }
}

/// Whether checksums are verified. A fuzzer can't guess a checksum and would never reach the code
/// behind it.
const CHECKSUMS_COUNT: bool = !cfg!(fuzzing);

/// The field that every version of either encoding has.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct VersionField {
    ir_version: u32,
}

/// The result of decoding. The first error ends it, because nothing after it can be trusted.
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

/// A span; offsets of 4 GiB and more are clamped.
fn span(file: FileId, start: usize, end: usize) -> Span {
    let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Span::new(file, offset(start), offset(end))
}

/// The scene that a tree of version `version` encodes.
fn typed(version: u32, tree: Value, span: Span) -> Decoded<Scene> {
    debug_assert!(version <= VERSION, "newer versions are refused before");
    serde_json::from_value(upgrade::to_current(version, tree))
        .map_err(|error| wrong_shape(&error.to_string(), span))
}

fn wrong_shape(what: &str, span: Span) -> Box<Diagnostic> {
    let message = format!("this is not the shape of a scene: {}", clip_words(what));
    Box::new(Diagnostic::new(&codes::WRONG_SHAPE, message).at(span, "found here"))
}
