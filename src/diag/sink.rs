//! The sink: collects findings, counts errors, and keeps no more than a hostile file can be allowed
//! to make.

use super::{Diagnostic, Severity};
use crate::source::{Limits, Resource};

/// Where every stage pushes its findings.
#[derive(Clone, Debug)]
pub struct Sink {
    /// No more findings than this are kept; the rest is counted.
    capacity: usize,
    kept: Vec<Diagnostic>,
    errors: usize,
    dropped: usize,
}

impl Default for Sink {
    fn default() -> Self {
        Self::within(&Limits::default())
    }
}

impl Sink {
    /// An empty sink that keeps as many findings as the limits say.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        let capacity = usize::try_from(limits.of(Resource::Findings, 0)).unwrap_or(usize::MAX);
        Self {
            capacity,
            kept: Vec::new(),
            errors: 0,
            dropped: 0,
        }
    }

    /// Takes one finding. An error always finds a place among the first of its kind, however many
    /// notes came before.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.push_with(diagnostic.severity, || diagnostic);
    }

    /// Takes one finding of this severity, which is made only if it is kept: a flood of them costs
    /// little.
    pub fn push_with(&mut self, severity: Severity, make: impl FnOnce() -> Diagnostic) {
        let first_error = severity == Severity::Error && self.errors == 0;
        self.errors += usize::from(severity == Severity::Error);
        if self.kept.len() < self.capacity || first_error {
            self.kept.push(make());
        } else {
            self.dropped += 1;
        }
    }

    /// True if any finding was an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// The findings so far, in the order they were made.
    #[must_use]
    pub fn kept(&self) -> &[Diagnostic] {
        &self.kept
    }

    /// How many findings were only counted.
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Sorts the findings by place, each after its cause; those without a place come last, in the
    /// order they were made.
    pub fn sort(&mut self) {
        self.kept.sort_by_key(|d| {
            let place = d.primary.as_ref().map(|label| label.span);
            let is_consequence = d.cause > place;
            (place.is_none(), place.max(d.cause), is_consequence)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::codes;
    use super::*;

    #[test]
    fn a_flood_of_warnings_hides_no_error() {
        let mut limits = Limits::default();
        limits.set(Resource::Findings, 10);
        let mut sink = Sink::within(&limits);
        for _ in 0..15 {
            sink.push(Diagnostic::new(&codes::UNKNOWN_KEY, "x"));
        }
        sink.push(Diagnostic::new(&codes::NOT_UTF8, "y"));
        assert!(sink.has_errors());
        assert_eq!((sink.kept().len(), sink.dropped()), (11, 5));
    }
}
