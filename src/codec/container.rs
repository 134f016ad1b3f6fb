//! The bytes of a binary file, and the errors at its places.

use super::decoded::span;
use rtc_diag::{Code, Diagnostic, codes};
use rtc_source::FileId;

/// Whether checksums are verified. A fuzzer can't guess a checksum and would never reach the code
/// behind it.
pub(super) const CHECKSUMS_COUNT: bool = !cfg!(fuzzing);

/// A binary file; nothing is known about its bytes.
pub(super) struct Container<'a> {
    pub(super) file: FileId,
    pub(super) bytes: &'a [u8],
}

impl Container<'_> {
    /// The error for a file that ends before `end`, the end of `what`.
    pub(super) fn truncated(&self, end: usize, what: &str) -> Box<Diagnostic> {
        let length = self.bytes.len();
        let message = format!("the file ends at byte {length}, but {what} ends at byte {end}");
        self.error_at(&codes::TRUNCATED, message, length, length)
    }

    /// An error at bytes `start..end`.
    pub(super) fn error_at(
        &self,
        code: &'static Code,
        message: String,
        start: usize,
        end: usize,
    ) -> Box<Diagnostic> {
        let length = self.bytes.len();
        let span = span(self.file, start.min(length), end.min(length));
        Box::new(Diagnostic::new(code, message).at(span, format!("at byte {start}")))
    }
}
