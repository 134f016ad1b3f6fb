//! The sink: collects findings, counts errors, and keeps no more than a hostile file can be allowed
//! to make.

use super::{Code, Diagnostic, FindingLevels, Severity};
use rtc_source::{Limits, Resource};

/// Where every stage pushes its findings.
#[derive(Clone, Debug)]
pub struct Sink {
    /// No more findings than this are kept; the rest is counted.
    capacity: usize,
    kept: Vec<Diagnostic>,
    errors: usize,
    dropped: usize,
    levels: FindingLevels,
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
            levels: FindingLevels::default(),
        }
    }

    /// The same with levels for what it takes from now on.
    #[must_use]
    pub fn with_levels(self, levels: FindingLevels) -> Self {
        Self { levels, ..self }
    }

    /// Takes one finding. An error always finds a place among the first of its kind, however many
    /// notes came before.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.push_with(diagnostic.code, diagnostic.severity, || diagnostic);
    }

    /// Takes one finding of this code and severity, which is made only if it is kept: a flood of them
    /// costs little.
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
    use super::super::{FindingLevel, LevelSubject, codes};
    use super::*;

    #[test]
    fn levels_change_what_is_taken_and_make_no_error_less() {
        let mut levels = FindingLevels::default();
        let of = |code| LevelSubject::Code(code);
        assert!(
            levels
                .set(of(&codes::NOT_UTF8), FindingLevel::Allow)
                .is_err()
        );
        assert_eq!(
            levels.set(LevelSubject::Warnings, FindingLevel::Deny),
            Ok(())
        );
        assert_eq!(
            levels.set(of(&codes::UNKNOWN_KEY), FindingLevel::Allow),
            Ok(())
        );
        assert_eq!(levels.set(of(&codes::TAG), FindingLevel::Warn), Ok(()));
        assert!(levels.set(of(&codes::TAG), FindingLevel::Deny).is_err());
        let mut levels = FindingLevels::default();
        levels
            .set(LevelSubject::Warnings, FindingLevel::Deny)
            .unwrap();
        levels
            .set(of(&codes::UNKNOWN_KEY), FindingLevel::Allow)
            .unwrap();
        levels.set(of(&codes::TAG), FindingLevel::Warn).unwrap();
        let mut sink = Sink::default().with_levels(levels);
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
            .map(|own| (own.code.id, own.severity))
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
        let mut sink = Sink::within(&limits);
        for _ in 0..15 {
            sink.push(Diagnostic::new(&codes::UNKNOWN_KEY, "x"));
        }
        sink.push(Diagnostic::new(&codes::NOT_UTF8, "y"));
        assert!(sink.has_errors());
        assert_eq!((sink.kept().len(), sink.dropped()), (11, 5));
    }
}
