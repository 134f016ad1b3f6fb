//! glTF: hostile assets that are made here with what they must end in, and small ones with what
//! they become. Files that others made are in `tests/cases/gltf.rs`.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise and reads what it checks"
)]
use rtc::internals::diag::{DiagnosticSink, Severity};
use std::collections::BTreeSet;

mod hostile;
mod images;
mod lowering;

mod make;

/// The names of the errors among the findings, ours where Khronos has none.
fn errors(sink: &DiagnosticSink) -> BTreeSet<String> {
    let errors = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Error);
    errors
        .map(|finding| finding.alias.unwrap_or(finding.code.id).to_owned())
        .collect()
}
