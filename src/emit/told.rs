//! What is told of a scene that is written in another format.

use rtc_diag::{Code, Diagnostic, Severity, Sink};
use rtc_ir::{Origins, Place};

/// Takes the findings about a scene.
pub(super) struct Told<'t> {
    origins: &'t Origins,
    sink: &'t mut Sink,
}

impl<'t> Told<'t> {
    pub(super) fn new(origins: &'t Origins, sink: &'t mut Sink) -> Self {
        Self { origins, sink }
    }

    /// Tells of something in the scene.
    pub(super) fn tell(&mut self, code: &'static Code, message: &str, place: Place) {
        self.push(Diagnostic::new(code, message), place);
    }

    /// Tells why the scene is not written.
    pub(super) fn refuse(&mut self, code: &'static Code, message: &str, place: Place) {
        let finding = Diagnostic::new(code, message).severity(Severity::Error);
        self.push(finding, place);
    }

    fn push(&mut self, finding: Diagnostic, place: Place) {
        let span = self.origins.span(place);
        self.sink
            .push(finding.at(span, "this").pointer(place.to_string()));
    }
}
