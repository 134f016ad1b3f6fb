//! Diagnostics: one struct, one table of codes, one sink, and the printers.
//!
//! A stage that detects an error of the user creates a [`Diagnostic`] and pushes it into the
//! [`DiagnosticSink`]; a user's error is never an `Err`. The stage continues, so that one run
//! reports all errors. When a file is finished, a [`DiagnosticPrinter`] turns the contents of the
//! sink into text:
//!
//! ```text
//! stage → Diagnostic → Sink (levels, capacity) → Printer (sort, fold, cap) → text
//! ```
//!
//! - [`Diagnostic`]: the code, the severity, the message, a primary label, secondary labels, hints
//!   with replacements, and for JSON a pointer.
//! - [`codes`]: the table of codes. The page of each code is a Markdown file in `codes/pages`.
//! - [`DiagnosticLevels`]: the levels that `--deny`, `--warn` and `--allow` set for a code.
//! - [`DiagnosticSink`]: applies the levels, counts errors, and keeps a limited number of
//!   diagnostics.
//! - [`DiagnosticPrinter`]: formats for people ([`Format::Human`]), editors, programs, SARIF and
//!   GitHub.
//!
//! Callers may rely on this: no text of the input can send commands to a terminal, an error is kept
//! even after a flood of notes, and the order of the output depends on the input alone.
//!
//! A message is in lower case without a full stop and states the error. A hint is an instruction. A
//! label describes the text at its span.

mod clip;
pub mod codes;
mod levels;
mod nearest;
mod print;
mod sink;

pub use clip::{clip, clip_path, clip_words};
pub use codes::{Code, Severity};
pub use levels::{DiagnosticLevel, DiagnosticLevels, LevelSubject};
pub use nearest::nearest;
pub use print::{
    DiagnosticPrinter, Format, PrintOptions, clean, clean_json, clean_lines, each, json_schema,
    one, plural,
};
pub use sink::DiagnosticSink;

use rtc_source::Span;

/// A span and a short description of it; the text may be empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// The description.
    pub text: String,
}

/// Advice, optionally with a replacement that follows it.
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
    /// The replaced span.
    pub span: Span,
    /// The replacement.
    pub text: String,
    /// Whether the replacement is a guess. Otherwise it has the same meaning as the original text.
    pub is_guess: bool,
}

impl Replacement {
    /// What it does to the text that is written at its span, in a few words; `None` if a text is
    /// long.
    #[must_use]
    pub fn summary(&self, written: &str) -> Option<String> {
        /// The maximum length of a text, in bytes.
        const MOST: usize = 60;
        let [before, after] = [written, &self.text].map(str::trim);
        let is_short = |text: &str| text.len() <= MOST && !text.contains('\n');
        (is_short(before) && is_short(after)).then(|| match (before, after) {
            ("", _) => format!("insert `{after}`"),
            (_, "") => format!("remove `{before}`"),
            _ => format!("replace `{before}` by `{after}`"),
        })
    }
}

/// One problem in the user's input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The stable code; `rtc explain` prints its page.
    pub code: &'static Code,
    /// Usually the severity of the code; `--strict` and `--lenient` change it.
    pub severity: Severity,
    /// The error, in one sentence.
    pub message: String,
    /// The span that is wrong.
    pub primary: Option<Label>,
    /// Other spans that matter.
    pub secondary: Vec<Label>,
    /// The instruction.
    pub hints: Vec<Hint>,
    /// A JSON pointer to the value, for input that is JSON or has no text.
    pub pointer: Option<String>,
    /// The code that Khronos' glTF validator has for it: one of the aliases of `code`.
    pub alias: Option<&'static str>,
    /// The span of the diagnostic that probably caused this one; that one is printed first.
    pub cause: Option<Span>,
}

impl Diagnostic {
    /// A diagnostic with the severity of its code.
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

    /// Sets the primary label; `None` changes nothing.
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

    /// Adds a secondary label; `None` changes nothing.
    #[must_use]
    pub fn also(mut self, span: impl Into<Option<Span>>, text: impl Into<String>) -> Self {
        self.secondary.extend(span.into().map(|span| Label {
            span,
            text: text.into(),
        }));
        self
    }

    /// Sets the cause and adds a label for it; `None` changes nothing.
    #[must_use]
    pub fn caused_by(self, cause: Option<Span>, text: impl Into<String>) -> Self {
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

    /// Adds advice with a replacement of the same meaning; without a span it has no replacement.
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

    /// Adds advice with a replacement that is a guess; without a span it has no replacement.
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

    /// Sets the code of Khronos' glTF validator.
    #[must_use]
    pub fn alias(self, alias: impl Into<Option<&'static str>>) -> Self {
        Self {
            alias: alias.into(),
            ..self
        }
    }
}
