//! The YAML of the course: text to spanned tree, tree to declaration, declaration to IR, and the IR back to text.

use crate::diag::Sink;
use crate::ir::{Lowered, Scene};
use crate::source::{FileId, SourceMap};

/// Reads a scene text and lowers it. `None` if the text is no scene at all; every mistake is in the sink.
pub fn lower(_file: FileId, _map: &SourceMap, _options: &super::Options, _sink: &mut Sink) -> Option<Lowered> {
    None
}

/// Writes the scene in the canonical spelling with a `Camera`.
///
/// # Errors
/// The reason, in words, why the scene can't be said in this format.
pub fn emit(_scene: &Scene) -> Result<String, String> {
    Err("not yet".to_owned())
}

/// The JSON Schema (2020-12) of the format.
#[must_use]
pub fn schema() -> serde_json::Value {
    serde_json::Value::Null
}
