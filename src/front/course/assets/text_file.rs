//! Text files that a scene names. Each error is reported at its position in the file.

use super::{AssetLoader, MissingAssetPolicy, PendingAsset};
use crate::over_limit;
use crate::words::{TextParseError, WordError};
use rtc_diag::{Code, Diagnostic};
use rtc_source::{Budget, FileId, FileKind, FoundFile};

/// A kind of text file.
pub(super) struct TextFileKind {
    /// The entity in the file.
    pub(super) entity: &'static str,
    /// The message about a file of another format.
    pub(super) is_not: &'static str,
    /// The code of its errors.
    pub(super) code: &'static Code,
    /// The policy for a missing file.
    pub(super) policy: MissingAssetPolicy,
    /// The largest file read, in bytes.
    pub(super) max_bytes: u64,
    /// The file format.
    pub(super) file: FileKind,
}

/// The diagnostic of an error in a text file.
pub(super) fn diagnostic(code: &'static Code, fault: WordError, file: FileId) -> Diagnostic {
    let span = fault.span(file);
    let hint = |repair| format!("with `--lenient` this is a warning: {repair}");
    let diagnostic = Diagnostic::new(code, fault.message).at(span, fault.label);
    match fault.repair.map(hint) {
        Some(hint) => diagnostic.hint(hint),
        None => diagnostic,
    }
}

impl AssetLoader<'_> {
    /// Reads a text file, adds it to the source map and parses it. `None` if that fails, which is
    /// reported.
    pub(super) fn read_text<T>(
        &mut self,
        found: &FoundFile,
        pending: &PendingAsset,
        kind: &TextFileKind,
        parse: impl FnOnce(&[u8], &Budget) -> Result<T, TextParseError>,
    ) -> Option<(FileId, T)> {
        let file = self.open_text(found, pending, kind)?;
        match parse(self.map.bytes(file), self.map.budget()) {
            Ok(parsed) => return Some((file, parsed)),
            Err(TextParseError::Limit(fault)) => {
                let what = format!("the {} `{}`", kind.entity, found.shown.display());
                let diagnostic = over_limit(&what, &fault).at(pending.span, "named here");
                self.reject(diagnostic, kind.policy);
            }
            Err(TextParseError::Faults(faults)) => {
                // With `--lenient` the entity is omitted once, so one diagnostic is enough.
                let count = if self.options.lenient {
                    1
                } else {
                    faults.len()
                };
                for fault in faults.into_iter().take(count) {
                    let diagnostic = diagnostic(kind.code, fault, file);
                    let diagnostic = diagnostic.also(pending.span, "the file is named here");
                    self.reject(diagnostic, kind.policy);
                }
            }
        }
        None
    }

    fn open_text(
        &mut self,
        found: &FoundFile,
        pending: &PendingAsset,
        kind: &TextFileKind,
    ) -> Option<FileId> {
        match self.loader.found(found, kind.max_bytes, self.map) {
            Ok(bytes) if (kind.file.begins)(&bytes) => Some(self.map.add_found(found, bytes)),
            // Other formats are not added to the source map: a diagnostic would quote a file that
            // is unrelated to the scene.
            Ok(bytes) => {
                let name = found.shown.display();
                let message = match bytes.is_empty() {
                    true => format!("the {} file `{name}` is empty", kind.entity),
                    false => format!("`{name}` is {}", kind.is_not),
                };
                let diagnostic = Diagnostic::new(kind.code, message).at(pending.span, "named here");
                self.reject(diagnostic, kind.policy);
                None
            }
            Err(error) => {
                self.unreadable(found, &error.to_string(), pending.span, kind.policy);
                None
            }
        }
    }
}
