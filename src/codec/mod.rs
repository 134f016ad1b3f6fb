//! The IR as bytes: a compact JSON text and a binary container with checksums, both with a version.
//!
//! Every older version decodes; newer or corrupt bytes are one clear error with its place.

use crate::diag::Sink;
use crate::ir::Scene;
use crate::source::{FileId, SourceMap};

/// The two forms the IR is stored in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// JSON, one entity a line.
    Text,
    /// The container, `.rtir`.
    Binary,
}

/// The form of the bytes, if they look like the IR at all.
#[must_use]
pub fn recognise(_bytes: &[u8]) -> Option<Form> {
    None
}

/// Decodes a scene; what is wrong goes to the sink. The scene still has to be validated.
pub fn decode(_form: Form, _file: FileId, _map: &SourceMap, _sink: &mut Sink) -> Option<Scene> {
    None
}

/// A scene that can't be stored: it holds a number that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// Encodes a scene.
///
/// # Errors
/// If a number is not finite: JSON has no word for it.
pub fn encode(_form: Form, _scene: &Scene) -> Result<Vec<u8>, NotFinite> {
    Err(NotFinite)
}

/// The JSON Schema (2020-12) of the text form.
#[must_use]
pub fn schema() -> serde_json::Value {
    serde_json::Value::Null
}
