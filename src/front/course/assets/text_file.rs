//! Text files that a scene names: each fault has its place in the file.

use super::{AssetLoader, MissingAssetPolicy, PendingAsset};
use crate::over_limit;
use crate::words::ParseFault;
use rtc_diag::{Code, Diagnostic};
use rtc_source::{Budget, FileId, FileKind, Found};

/// A kind of text file.
pub(super) struct TextKind {
    /// What it holds.
    pub(super) entity: &'static str,
    /// What is said of a file of another kind.
    pub(super) is_not: &'static str,
    /// The code of its faults.
    pub(super) code: &'static Code,
    /// What a lenient run does without the file.
    pub(super) policy: MissingAssetPolicy,
    /// The largest file read, in bytes.
    pub(super) max_bytes: u64,
    /// How such a file is told from others.
    pub(super) file: FileKind,
}

impl AssetLoader<'_> {
    /// What is in a text file, and the file in the source map; `None` is reported.
    pub(super) fn read_text<T>(
        &mut self,
        found: &Found,
        pending: &PendingAsset,
        kind: &TextKind,
        parse: fn(&[u8], &Budget) -> Result<T, ParseFault>,
    ) -> Option<(FileId, T)> {
        let file = self.open_text(found, pending, kind)?;
        match parse(self.map.bytes(file), self.map.budget()) {
            Ok(parsed) => return Some((file, parsed)),
            Err(ParseFault::Limit(fault)) => {
                let what = format!("the {} `{}`", kind.entity, found.shown.display());
                let finding = over_limit(&what, &fault).at(pending.span, "named here");
                self.reject(finding, kind.policy);
            }
            Err(ParseFault::Faults(faults)) => {
                // Lenient, what the file is for is left out once.
                let count = if self.options.lenient {
                    1
                } else {
                    faults.len()
                };
                for fault in faults.into_iter().take(count) {
                    let finding = Diagnostic::new(kind.code, fault.message.as_str())
                        .at(fault.span(file), fault.label)
                        .also(pending.span, "the file is named here");
                    self.reject(finding, kind.policy);
                }
            }
        }
        None
    }

    fn open_text(
        &mut self,
        found: &Found,
        pending: &PendingAsset,
        kind: &TextKind,
    ) -> Option<FileId> {
        match self.loader.found(found, kind.max_bytes, self.map) {
            Ok(bytes) if (kind.file.begins)(&bytes) => Some(self.map.add_found(found, bytes)),
            // A finding within would quote a file that is none of the scene's business.
            Ok(bytes) => {
                let name = found.shown.display();
                let message = match bytes.is_empty() {
                    true => format!("the {} file `{name}` is empty", kind.entity),
                    false => format!("`{name}` is {}", kind.is_not),
                };
                let finding = Diagnostic::new(kind.code, message).at(pending.span, "named here");
                self.reject(finding, kind.policy);
                None
            }
            Err(error) => {
                self.unreadable(found, &error.to_string(), pending.span, kind.policy);
                None
            }
        }
    }
}
