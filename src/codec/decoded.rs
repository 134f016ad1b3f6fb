//! The result of decoding, and the error of what is not a scene.

use rtc_diag::{Diagnostic, clip_words, codes};
use rtc_source::{FileId, Span};

/// The result of decoding. The first error ends it, because nothing after it can be trusted.
pub(super) type Decoded<T> = Result<T, Box<Diagnostic>>;

/// A span; offsets of 4 GiB and more are clamped.
pub(super) fn span(file: FileId, start: usize, end: usize) -> Span {
    let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Span::new(file, offset(start), offset(end))
}

pub(super) fn wrong_shape(what: &str, span: Span) -> Box<Diagnostic> {
    let message = format!("this is not the shape of a scene: {}", clip_words(what));
    Box::new(Diagnostic::new(&codes::WRONG_SHAPE, message).at(span, "found here"))
}
