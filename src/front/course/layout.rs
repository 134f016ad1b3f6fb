//! Formats the text of a scene.

use super::syntax;
use rtc_diag::Sink;
use rtc_source::tree::yaml::{self, LayoutFault, Mistake};
use rtc_source::{FileId, SourceMap};

/// The formatted text of a file. Syntax errors are reported only if there is no tree.
///
/// # Errors
/// If there is no tree, or no layout with the same meaning.
pub fn lay_out(file: FileId, map: &SourceMap, sink: &mut Sink) -> Result<String, LayoutFault> {
    let mut found = Vec::new();
    let report = &mut |mistake: Mistake<'_>| found.push(syntax::diagnostic(mistake));
    let laid_out = yaml::layout(file, map.bytes(file), report);
    if laid_out == Err(LayoutFault::Mistakes) {
        found
            .into_iter()
            .for_each(|diagnostic| sink.push(diagnostic));
    }
    laid_out
}
