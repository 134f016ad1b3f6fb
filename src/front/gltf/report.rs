//! Findings about an asset, each with its bytes, its JSON pointer, and the name that the validator
//! of Khronos has for it.

use super::advice::advice;
use crate::FrontOptions;
use rtc_diag::{Code, Diagnostic, DiagnosticSink, Severity, codes};
use rtc_source::tree::{NodeId, NodeKind, SyntaxTree};
use rtc_source::{Budget, LimitExceeded, Resource};

/// Collects the diagnostics of one asset.
pub(super) struct AssetReport<'r, 's> {
    /// The text that they are about.
    pub(super) json: &'r SyntaxTree<'s>,
    sink: &'r mut DiagnosticSink,
    options: &'r FrontOptions,
    /// The remaining budget of the run.
    pub(super) budget: &'r Budget,
    /// Whether a limit was exceeded, which is reported once.
    is_over: bool,
}

impl<'r, 's> AssetReport<'r, 's> {
    pub(super) fn new(
        json: &'r SyntaxTree<'s>,
        sink: &'r mut DiagnosticSink,
        options: &'r FrontOptions,
        budget: &'r Budget,
    ) -> Self {
        Self {
            json,
            sink,
            options,
            budget,
            is_over: false,
        }
    }

    /// Adds a diagnostic at a node. `alias` is the code of the validator, empty if it has none.
    pub(super) fn add(
        &mut self,
        code: &'static Code,
        alias: &'static str,
        at: NodeId,
        message: impl Into<String>,
    ) {
        let severity = self.severity(code);
        self.push(
            (code, severity),
            alias,
            at,
            message.into(),
            advice(code, alias),
        );
    }

    /// Adds the diagnostic that an object exceeds a limit. `what` names it, as `the image`.
    pub(super) fn exceeded(&mut self, at: NodeId, what: &str, fault: &LimitExceeded) {
        if !std::mem::replace(&mut self.is_over, true) {
            self.add_with_hint(
                &codes::OVER_LIMIT,
                "",
                at,
                format!("{what} exceeds a limit: {fault}"),
                fault.hint(),
            );
        }
    }

    /// Charges the resource that an object takes. False if a limit is exceeded, here or before:
    /// then the asset is rejected, and further diagnostics are of no use.
    pub(super) fn charge(
        &mut self,
        resource: Resource,
        amount: u64,
        at: NodeId,
        what: &str,
    ) -> bool {
        if self.is_over {
            return false;
        }
        let charged = self.budget.charge(resource, amount);
        charged
            .map_err(|fault| self.exceeded(at, what, &fault))
            .is_ok()
    }

    /// Adds a diagnostic of an error that importers repair: a warning with `--lenient`, else an
    /// error with a hint. `repair` completes the message, as `they are computed`.
    pub(super) fn repair(
        &mut self,
        code: &'static Code,
        alias: &'static str,
        at: NodeId,
        message: &str,
        repair: &str,
    ) {
        if self.is_lenient() {
            let push = format!("{message}: {repair}");
            let hint = advice(code, alias);
            return self.push((code, Severity::Warning), alias, at, push, hint);
        }
        let hints = advice(code, alias).map(str::to_owned);
        let hints = hints.into_iter().chain([lenient(repair)]);
        let severity = code.severity;
        self.push((code, severity), alias, at, message.to_owned(), hints);
    }

    /// Whether repairable errors are repaired.
    pub(super) fn is_lenient(&self) -> bool {
        self.options.lenient
    }

    /// The same as [`Self::add`], with a hint of its own.
    pub(super) fn add_with_hint(
        &mut self,
        code: &'static Code,
        alias: &'static str,
        at: NodeId,
        message: String,
        hint: String,
    ) {
        self.push((code, self.severity(code)), alias, at, message, Some(hint));
    }

    fn push(
        &mut self,
        (code, severity): (&'static Code, Severity),
        alias: &'static str,
        at: NodeId,
        message: String,
        hints: impl IntoIterator<Item = impl Into<String>>,
    ) {
        let json = self.json;
        self.sink.push_with(code, severity, || {
            let diagnostic = diagnostic(json, (code, severity), alias, at, message);
            hints.into_iter().fold(diagnostic, Diagnostic::hint)
        });
    }

    fn severity(&self, code: &'static Code) -> Severity {
        if self.options.strict && *code == codes::GLTF_UNKNOWN {
            Severity::Error
        } else {
            code.severity
        }
    }

    /// Whether the value at a node is an object. The schema has reported other values.
    pub(super) fn is_part(&self, at: NodeId) -> bool {
        self.json.kind(at) == NodeKind::Map
    }

    /// True if an error was reported, here or before.
    pub(super) fn has_errors(&self) -> bool {
        self.sink.has_errors()
    }

    /// The value of a node, formatted for a message.
    pub(super) fn shown(&self, at: NodeId) -> String {
        shown(self.json.written(at))
    }
}

fn diagnostic(
    json: &SyntaxTree<'_>,
    (code, severity): (&'static Code, Severity),
    alias: &'static str,
    at: NodeId,
    message: String,
) -> Diagnostic {
    debug_assert!(
        alias.is_empty() || code.aliases.contains(&alias),
        "{code} has no alias {alias}"
    );
    let pointer = json.pointer(at);
    let label = if pointer.is_empty() {
        "the asset".to_owned()
    } else {
        pointer.clone()
    };
    Diagnostic::new(code, message)
        .severity(severity)
        .at(json.span(at), label)
        .pointer(pointer)
        .alias((!alias.is_empty()).then_some(alias))
}

/// The hint that an error is a warning with `--lenient`, which makes the `repair`.
pub(super) fn lenient(repair: &str) -> String {
    format!("with `--lenient` this is a warning: {repair}")
}

/// A part of the text, clipped and without control characters.
pub(super) fn shown(written: &str) -> String {
    const LONG: usize = 40;
    let mut text: String = written
        .chars()
        .take(LONG)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.len() < written.len() {
        text.push('…');
    }
    text.replace('`', "'")
}
