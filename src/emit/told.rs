//! What is told of a scene that is written in another format.

use rtc_diag::{Code, Diagnostic, Severity, Sink};
use rtc_ir::{SourceSpans, ValuePath};

/// Takes the findings about a scene.
pub(super) struct Told<'t> {
    source_spans: &'t SourceSpans,
    sink: &'t mut Sink,
}

impl<'t> Told<'t> {
    pub(super) fn new(source_spans: &'t SourceSpans, sink: &'t mut Sink) -> Self {
        Self { source_spans, sink }
    }

    /// Tells of something in the scene.
    pub(super) fn tell(&mut self, code: &'static Code, message: &str, place: ValuePath) {
        self.push(Diagnostic::new(code, message), place);
    }

    /// Tells why the scene is not written.
    pub(super) fn refuse(&mut self, code: &'static Code, message: &str, place: ValuePath) {
        let finding = Diagnostic::new(code, message).severity(Severity::Error);
        self.push(finding, place);
    }

    fn push(&mut self, finding: Diagnostic, place: ValuePath) {
        let span = self.source_spans.span(place);
        self.sink
            .push(finding.at(span, "this").pointer(place.to_string()));
    }
}
