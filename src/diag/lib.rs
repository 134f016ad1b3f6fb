//! Diagnostics: one struct, one table of codes, one sink, and the printers.
//!
//! A diagnostic is made where the fault is seen and pushed into the sink; a user's mistake is never
//! an `Err`. Messages are lower case without a full stop and say what is wrong; hints say what to
//! do; labels say what is here.

mod clip;
pub mod codes;
mod levels;
mod nearest;
mod print;
mod sink;

pub use clip::{clip, clip_path, clip_words};
pub use codes::{Code, Severity};
pub use levels::{FindingLevel, FindingLevels, LevelSubject};
pub use nearest::nearest;
pub use print::{Format, PrintOptions, Printer, one};
pub use sink::Sink;

use rtc_source::Span;

/// A span with a few words on what stands there; the words may be empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is here.
    pub text: String,
}

/// What to do about it, if wanted with the text that does it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hint {
    /// The advice, lower case, no full stop.
    pub text: String,
    /// The replacement that follows the advice.
    pub replacement: Option<Replacement>,
}

/// New text for a span; an empty span is an insertion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// What is replaced.
    pub span: Span,
    /// By what.
    pub text: String,
    /// It says what was most likely meant, which only who wrote it knows; else it says the same in
    /// the right way.
    pub is_guess: bool,
}

/// One finding about the user's input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The stable code; `rtc explain` tells more.
    pub code: &'static Code,
    /// Usually the severity of the code; `--strict` and `--lenient` change it.
    pub severity: Severity,
    /// What is wrong, in one sentence.
    pub message: String,
    /// The culprit.
    pub primary: Option<Label>,
    /// Other places that matter.
    pub secondary: Vec<Label>,
    /// What to do.
    pub hints: Vec<Hint>,
    /// A JSON pointer to the culprit, for input that is JSON or has no text.
    pub pointer: Option<String>,
    /// What the glTF validator of Khronos calls it: one of the aliases of the code.
    pub alias: Option<&'static str>,
    /// The culprit of the finding that most likely caused this one, and is shown before it.
    pub cause: Option<Span>,
}

impl Diagnostic {
    /// A finding with the severity of its code.
    #[must_use]
    pub fn new(code: &'static Code, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            hints: Vec::new(),
            pointer: None,
            alias: None,
            cause: None,
        }
    }

    /// Sets the severity.
    #[must_use]
    pub fn severity(self, severity: Severity) -> Self {
        Self { severity, ..self }
    }

    /// Sets the culprit; without a span nothing happens.
    #[must_use]
    pub fn at(self, span: impl Into<Option<Span>>, text: impl Into<String>) -> Self {
        let primary = span.into().map(|span| Label {
            span,
            text: text.into(),
        });
        Self {
            primary: primary.or(self.primary),
            ..self
        }
    }

    /// Adds another place that matters; without a span nothing happens.
    #[must_use]
    pub fn also(mut self, span: impl Into<Option<Span>>, text: impl Into<String>) -> Self {
        self.secondary.extend(span.into().map(|span| Label {
            span,
            text: text.into(),
        }));
        self
    }

    /// Marks the culprit of the finding that most likely caused this one; without a span nothing
    /// happens.
    #[must_use]
    pub fn because(self, cause: Option<Span>, text: impl Into<String>) -> Self {
        Self {
            cause: cause.or(self.cause),
            ..self.also(cause, text)
        }
    }

    /// Adds advice.
    #[must_use]
    pub fn hint(mut self, text: impl Into<String>) -> Self {
        self.hints.push(Hint {
            text: text.into(),
            replacement: None,
        });
        self
    }

    /// Adds advice with the text that says the same in the right way; without a span it is plain
    /// advice.
    #[must_use]
    pub fn replace(
        self,
        hint: impl Into<String>,
        span: impl Into<Option<Span>>,
        by: impl Into<String>,
    ) -> Self {
        let replacement = span.into().map(|span| Replacement {
            span,
            text: by.into(),
            is_guess: false,
        });
        self.advise(hint.into(), replacement)
    }

    /// Adds advice with what was most likely meant; without a span it is plain advice.
    #[must_use]
    pub fn guess(
        self,
        hint: impl Into<String>,
        span: impl Into<Option<Span>>,
        by: impl Into<String>,
    ) -> Self {
        let replacement = span.into().map(|span| Replacement {
            span,
            text: by.into(),
            is_guess: true,
        });
        self.advise(hint.into(), replacement)
    }

    fn advise(mut self, text: String, replacement: Option<Replacement>) -> Self {
        self.hints.push(Hint { text, replacement });
        self
    }

    /// Sets the JSON pointer.
    #[must_use]
    pub fn pointer(self, pointer: impl Into<String>) -> Self {
        Self {
            pointer: Some(pointer.into()),
            ..self
        }
    }

    /// Sets the name that the glTF validator of Khronos has for it.
    #[must_use]
    pub fn alias(self, alias: impl Into<Option<&'static str>>) -> Self {
        Self {
            alias: alias.into(),
            ..self
        }
    }
}
