//! The versions that are read, older ones too.

use super::decoded::{Decoded, wrong_shape};
use super::upgrade;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{Scene, VERSION};
use rtc_source::Span;
use serde::Deserialize;
use serde_json::Value;

/// The field that every version of either encoding has.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct VersionField {
    pub(super) ir_version: u32,
}

pub(super) fn newer(version: u32, what: &str, newest: u32, span: Span) -> Box<Diagnostic> {
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

/// The scene that a tree of version `version` encodes.
pub(super) fn typed(version: u32, tree: Value, span: Span) -> Decoded<Scene> {
    debug_assert!(version <= VERSION, "newer versions are refused before");
    serde_json::from_value(upgrade::to_current(version, tree))
        .map_err(|error| wrong_shape(&error.to_string(), span))
}
