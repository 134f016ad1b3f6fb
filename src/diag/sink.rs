//! The sink: collects diagnostics and counts errors. It keeps a limited number, so that a hostile
//! file cannot fill the memory.

use super::{Code, Diagnostic, DiagnosticLevels, Severity};
use rtc_source::{Limits, Resource};

/// The collection into which every stage pushes its diagnostics.
#[derive(Clone, Debug)]
pub struct DiagnosticSink {
    /// The largest number of diagnostics that are kept; the others are counted.
    capacity: usize,
    kept: Vec<Diagnostic>,
    errors: usize,
    dropped: usize,
    levels: DiagnosticLevels,
}

impl Default for DiagnosticSink {
    fn default() -> Self {
        Self::within(&Limits::default())
    }
}

impl DiagnosticSink {
    /// An empty sink whose capacity is the limit [`Resource::Findings`].
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        let capacity = usize::try_from(limits.of(Resource::Findings, 0)).unwrap_or(usize::MAX);
        Self {
            capacity,
            kept: Vec::new(),
            errors: 0,
            dropped: 0,
            levels: DiagnosticLevels::default(),
        }
    }

    /// The same sink with levels for the diagnostics that follow.
    #[must_use]
    pub fn with_levels(self, levels: DiagnosticLevels) -> Self {
        Self { levels, ..self }
    }

    /// Adds a diagnostic. The first error is always kept, even if the sink is full.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.push_with(diagnostic.code, diagnostic.severity, || diagnostic);
    }

    /// Adds a diagnostic of this code and severity. It is created only if it is kept, so many of
    /// them cost little.
    pub fn push_with(
        &mut self,
        code: &Code,
        severity: Severity,
        make: impl FnOnce() -> Diagnostic,
    ) {
        let Some(severity) = self.levels.of(code, severity) else {
            return;
        };
        let first_error = severity == Severity::Error && self.errors == 0;
        self.errors += usize::from(severity == Severity::Error);
        if self.kept.len() < self.capacity || first_error {
            self.kept.push(make().severity(severity));
        } else {
            self.dropped += 1;
        }
    }

    /// Whether any diagnostic was an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// The diagnostics that were kept, in the order of creation, or of [`DiagnosticSink::sort`].
    #[must_use]
    pub fn kept(&self) -> &[Diagnostic] {
        &self.kept
    }

    /// The number of diagnostics that were counted and not kept.
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Sorts by span, each diagnostic after its cause; those without a span come last, in the order
    /// of creation.
    pub fn sort(&mut self) {
        self.kept.sort_by_key(|d| {
            let span = d.primary.as_ref().map(|label| label.span);
            let is_consequence = d.cause > span;
            (span.is_none(), span.max(d.cause), is_consequence)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DiagnosticLevel, LevelSubject, codes};
    use super::*;

    #[test]
    fn levels_change_what_is_taken_and_make_no_error_less() {
        let mut levels = DiagnosticLevels::default();
        let of = |code| LevelSubject::Code(code);
        assert!(
            levels
                .set(of(&codes::NOT_UTF8), DiagnosticLevel::Allow)
                .is_err()
        );
        assert_eq!(
            levels.set(LevelSubject::Warnings, DiagnosticLevel::Deny),
            Ok(())
        );
        assert_eq!(
            levels.set(of(&codes::UNKNOWN_KEY), DiagnosticLevel::Allow),
            Ok(())
        );
        assert_eq!(levels.set(of(&codes::TAG), DiagnosticLevel::Warn), Ok(()));
        assert!(levels.set(of(&codes::TAG), DiagnosticLevel::Deny).is_err());
        let mut levels = DiagnosticLevels::default();
        levels
            .set(LevelSubject::Warnings, DiagnosticLevel::Deny)
            .unwrap();
        levels
            .set(of(&codes::UNKNOWN_KEY), DiagnosticLevel::Allow)
            .unwrap();
        levels.set(of(&codes::TAG), DiagnosticLevel::Warn).unwrap();
        let mut sink = DiagnosticSink::default().with_levels(levels);
        let made = |code, severity| Diagnostic::new(code, "x").severity(severity);
        for (code, severity) in [
            (&codes::UNKNOWN_KEY, Severity::Warning),
            (&codes::UNKNOWN_KEY, Severity::Error),
            (&codes::TAG, Severity::Note),
            (&codes::DUPLICATE_KEY, Severity::Warning),
            (&codes::DUPLICATE_KEY, Severity::Note),
        ] {
            sink.push(made(code, severity));
        }
        let kept: Vec<_> = sink
            .kept()
            .iter()
            .map(|diagnostic| (diagnostic.code.id, diagnostic.severity))
            .collect();
        let [key, tag, twice] = [&codes::UNKNOWN_KEY, &codes::TAG, &codes::DUPLICATE_KEY];
        let wanted = [
            (key.id, Severity::Error),
            (tag.id, Severity::Warning),
            (twice.id, Severity::Error),
            (twice.id, Severity::Note),
        ];
        assert_eq!(kept, wanted);
        assert_eq!(sink.errors, 2);
    }

    #[test]
    fn a_flood_of_warnings_hides_no_error() {
        let mut limits = Limits::default();
        limits.set(Resource::Findings, 10);
        let mut sink = DiagnosticSink::within(&limits);
        for _ in 0..15 {
            sink.push(Diagnostic::new(&codes::UNKNOWN_KEY, "x"));
        }
        sink.push(Diagnostic::new(&codes::NOT_UTF8, "y"));
        assert!(sink.has_errors());
        assert_eq!((sink.kept().len(), sink.dropped()), (11, 5));
    }
}
