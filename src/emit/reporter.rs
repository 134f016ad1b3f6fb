//! Diagnostics raised while exporting a scene.

use rtc_diag::{Code, Diagnostic, DiagnosticSink, Severity};
use rtc_ir::{SourceSpans, ValuePath};

/// Pushes diagnostics at values of the scene to a sink.
pub(super) struct ExportReporter<'t> {
    source_spans: &'t SourceSpans,
    sink: &'t mut DiagnosticSink,
}

impl<'t> ExportReporter<'t> {
    pub(super) fn new(source_spans: &'t SourceSpans, sink: &'t mut DiagnosticSink) -> Self {
        Self { source_spans, sink }
    }

    /// Reports a diagnostic at a value.
    pub(super) fn report(&mut self, code: &'static Code, message: &str, path: ValuePath) {
        self.push(Diagnostic::new(code, message), path);
    }

    /// Reports an error: the scene is not exported.
    pub(super) fn report_error(&mut self, code: &'static Code, message: &str, path: ValuePath) {
        let diagnostic = Diagnostic::new(code, message).severity(Severity::Error);
        self.push(diagnostic, path);
    }

    fn push(&mut self, diagnostic: Diagnostic, path: ValuePath) {
        let span = self.source_spans.span(path);
        self.sink
            .push(diagnostic.at(span, "").pointer(path.to_string()));
    }
}
