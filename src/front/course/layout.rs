//! Formats the text of a scene.

use super::syntax;
use rtc_diag::DiagnosticSink;
use rtc_source::tree::yaml::{self, FormatTextFault, YamlError};
use rtc_source::{FileId, SourceMap};

/// The formatted text of a file. Syntax errors are reported only if there is no tree.
///
/// # Errors
/// If there is no tree, or no layout with the same meaning.
pub fn format_text(
    file: FileId,
    map: &SourceMap,
    sink: &mut DiagnosticSink,
) -> Result<String, FormatTextFault> {
    let mut found = Vec::new();
    let report = &mut |mistake: YamlError<'_>| found.push(syntax::diagnostic(mistake));
    let formatted = yaml::layout(file, map.bytes(file), report);
    if formatted == Err(FormatTextFault::Mistakes) {
        found
            .into_iter()
            .for_each(|diagnostic| sink.push(diagnostic));
    }
    formatted
}
