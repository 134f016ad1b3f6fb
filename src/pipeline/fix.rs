//! Applies suggested fixes to the text of a scene where they improve it.
//!
//! A changed text is checked instead of the file before it is accepted. It is an improvement if
//! each fixed diagnostic is gone, and there is no new error, and no new warning either unless an
//! error is gone (errors hide warnings). A change that inserts an unknown key is never accepted,
//! because the setting below it would be lost. Errors that a change reveals may be fixed by the
//! next round, so a few rounds are tried. If all changes together are no improvement, each half is
//! tried, and so on; so a few bad fixes cost few checks.

use super::{Input, Options};
use rtc_diag::{Diagnostic, Severity, codes};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// The maximum number of bytes that are checked, and the minimum number of checks of a large text.
const MAX_BYTES: usize = 2 << 20;
const MIN_CHECKS: usize = 8;

/// The maximum number of checks.
const MAX_CHECKS: usize = 200;

/// The maximum number of rounds for errors that a change reveals.
const MAX_ROUNDS: usize = 4;

/// A text with fixes applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FixedText {
    /// The text.
    pub text: String,
    /// The number of changes; 0 if it is unchanged.
    pub changes: usize,
    /// The number of fixes that were not applied because they would not improve the text.
    pub rejected: usize,
    /// The number of guesses that were not requested.
    pub guesses: usize,
}

/// Which fixes are requested.
#[derive(Clone, Debug, Default)]
pub struct FixFilter {
    /// Whether to apply guesses as well.
    pub guesses: bool,
    /// Apply only fixes of diagnostics like this one.
    pub only: Option<DiagnosticRef>,
}

/// Applies the requested fixes to a text whose path is `path`. Nothing is written.
#[must_use]
pub fn fix(path: &Path, text: &str, options: &Options, filter: &FixFilter) -> FixedText {
    FixSession::new(path, text, options, filter).fixed(text)
}

/// Identifies a diagnostic independently of its position: severity, code and message.
pub type DiagnosticRef = (Severity, &'static str, String);

/// A text and its diagnostics.
struct FixCandidate {
    text: String,
    /// The number of changes that led to it.
    changes: usize,
    /// The number of occurrences of each diagnostic.
    occurrences: BTreeMap<DiagnosticRef, usize>,
    /// Whether some diagnostics were dropped.
    is_flooded: bool,
    /// The fixes for it, sorted and without overlaps.
    edits: Vec<TextChange>,
    /// The number of guesses that were not requested.
    guesses: usize,
    /// The unknown keys: settings below them are lost.
    unknown_keys: Vec<Range<usize>>,
}

/// A text with changes.
struct EditedText {
    text: String,
    /// The total number of changes.
    changes: usize,
    /// The ranges that the last changes inserted.
    added: Vec<Range<usize>>,
}

/// A change of a text.
#[derive(Clone)]
struct TextChange {
    start: usize,
    end: usize,
    text: String,
    /// The diagnostic that it fixes.
    diagnostic_ref: DiagnosticRef,
}

struct FixSession<'w> {
    path: &'w Path,
    options: &'w Options,
    filter: &'w FixFilter,
    /// The number of checks that remain.
    checks: usize,
}

impl<'w> FixSession<'w> {
    fn new(path: &'w Path, text: &str, options: &'w Options, filter: &'w FixFilter) -> Self {
        Self {
            path,
            options,
            filter,
            checks: (MAX_BYTES / text.len().max(1)).clamp(MIN_CHECKS, MAX_CHECKS),
        }
    }

    fn fixed(&mut self, text: &str) -> FixedText {
        let mut best = self.check(text.to_owned(), 0);
        while let Some(improved) = self.improve(&best) {
            best = improved;
        }
        FixedText {
            changes: best.changes,
            rejected: best.edits.len(),
            guesses: best.guesses,
            text: best.text,
        }
    }

    fn check(&mut self, text: String, changes: usize) -> FixCandidate {
        // Check the text instead of the file.
        self.checks = self.checks.saturating_sub(1);
        let bytes = text.clone().into_bytes();
        let mut input = Input::edited(self.path, bytes, self.options.clone());
        if let Some(loaded) = input.load() {
            input.validate(loaded, |_, _| ());
        }
        let sink = input.take_diagnostics();
        // Collect its diagnostics, their fixes and unknown keys.
        let mut candidate = FixCandidate {
            text,
            changes,
            occurrences: BTreeMap::new(),
            is_flooded: sink.dropped() > 0,
            edits: Vec::new(),
            guesses: 0,
            unknown_keys: Vec::new(),
        };
        for diagnostic in sink.kept() {
            *candidate
                .occurrences
                .entry(diagnostic_ref(diagnostic))
                .or_default() += 1;
            let span = diagnostic.primary.as_ref().map(|label| label.span);
            let span = span.filter(|span| Some(span.file) == input.file_id());
            let unknown_keys = span.filter(|_| diagnostic.code.id == codes::UNKNOWN_KEY.id);
            candidate
                .unknown_keys
                .extend(unknown_keys.map(|span| span.start as usize..span.end as usize));
            self.add_fix(diagnostic, &input, &mut candidate);
        }
        // Drop fixes that overlap.
        candidate.edits.sort_by_key(|edit| (edit.start, edit.end));
        candidate
            .edits
            .dedup_by(|next, last| next.start < last.end || next.start == last.start);
        candidate
    }

    /// Adds the first requested fix of a diagnostic that applies to the text itself.
    fn add_fix(&self, diagnostic: &Diagnostic, input: &Input, candidate: &mut FixCandidate) {
        let diagnostic_ref = diagnostic_ref(diagnostic);
        if self
            .filter
            .only
            .as_ref()
            .is_some_and(|only| *only != diagnostic_ref)
        {
            return;
        }
        let replacements = diagnostic.hints.iter();
        let mut replacements = replacements
            .filter_map(|hint| hint.replacement.as_ref())
            .filter(|change| Some(change.span.file) == input.file_id())
            .peekable();
        let is_any = replacements.peek().is_some();
        let requested = replacements.find(|change| self.filter.guesses || !change.is_guess);
        candidate.guesses += usize::from(is_any && requested.is_none());
        candidate.edits.extend(requested.map(|change| TextChange {
            start: change.span.start as usize,
            end: change.span.end as usize,
            text: change.text.clone(),
            diagnostic_ref: diagnostic_ref.clone(),
        }));
    }

    /// An improved text, with all fixes or with the largest subset that is found.
    fn improve(&mut self, candidate: &FixCandidate) -> Option<FixCandidate> {
        let mut subsets = vec![candidate.edits.as_slice()];
        while !subsets.is_empty() && self.checks > 0 {
            let improved = subsets
                .iter()
                .find_map(|subset| self.apply_and_follow(candidate, subset));
            if improved.is_some() {
                return improved;
            }
            subsets = subsets
                .into_iter()
                .filter(|subset| subset.len() > 1)
                .flat_map(|subset| <[_; 2]>::from(subset.split_at(subset.len() / 2)))
                .collect();
        }
        None
    }

    /// An improved text with these changes and with fixes of the errors they reveal.
    fn apply_and_follow(
        &mut self,
        candidate: &FixCandidate,
        edits: &[TextChange],
    ) -> Option<FixCandidate> {
        let mut next = candidate.edited(edits);
        for _ in 0..MAX_ROUNDS {
            let EditedText {
                text,
                changes,
                added,
            } = next.filter(|_| self.checks > 0)?;
            let next_candidate = self.check(text, changes);
            if next_candidate.inserts_unknown_key(&added) {
                return None;
            }
            if next_candidate.is_better(candidate, edits) {
                return Some(next_candidate);
            }
            next = next_candidate.edited(&next_candidate.edits);
        }
        None
    }
}

impl FixCandidate {
    /// The text with these changes; `None` if nothing changes.
    fn edited(&self, edits: &[TextChange]) -> Option<EditedText> {
        let mut text = String::with_capacity(self.text.len());
        let mut added = Vec::with_capacity(edits.len());
        let mut from = 0;
        for edit in edits {
            text.push_str(self.text.get(from..edit.start)?);
            let start = text.len();
            text.push_str(&edit.text);
            added.push(start..text.len());
            from = edit.end;
        }
        text.push_str(self.text.get(from..)?);
        (text != self.text).then(|| EditedText {
            text,
            changes: self.changes + edits.len(),
            added,
        })
    }

    /// Whether an inserted key is unknown, so that a setting is lost.
    fn inserts_unknown_key(&self, added: &[Range<usize>]) -> bool {
        let overlap = |a: &Range<usize>, b: &Range<usize>| a.start < b.end && b.start < a.end;
        let mut unknown_keys = self.unknown_keys.iter();
        unknown_keys.any(|unknown_keys| added.iter().any(|added| overlap(unknown_keys, added)))
    }

    fn is_better(&self, before: &Self, edits: &[TextChange]) -> bool {
        let of = |candidate: &Self, diagnostic_ref: &DiagnosticRef| {
            candidate
                .occurrences
                .get(diagnostic_ref)
                .copied()
                .unwrap_or(0)
        };
        let is_gone = |edit: &TextChange| {
            let fixed_by_edits = edits
                .iter()
                .filter(|other| other.diagnostic_ref == edit.diagnostic_ref);
            of(self, &edit.diagnostic_ref) + fixed_by_edits.count()
                <= of(before, &edit.diagnostic_ref)
        };
        let has_new = |severity| {
            let counts = self
                .occurrences
                .iter()
                .filter(|((s, ..), _)| *s == severity);
            counts
                .into_iter()
                .any(|(diagnostic_ref, count)| *count > of(before, diagnostic_ref))
        };
        let has_fewer_errors = self.errors() < before.errors();
        !self.is_flooded
            && !before.is_flooded
            && edits.iter().all(is_gone)
            && !has_new(Severity::Error)
            && (has_fewer_errors || !has_new(Severity::Warning))
    }

    fn errors(&self) -> usize {
        let counts = self.occurrences.iter();
        counts
            .filter(|((severity, ..), _)| *severity == Severity::Error)
            .map(|(_, count)| count)
            .sum()
    }
}

/// The identity of a diagnostic.
#[must_use]
pub fn diagnostic_ref(diagnostic: &Diagnostic) -> DiagnosticRef {
    (
        diagnostic.severity,
        diagnostic.code.id,
        diagnostic.message.clone(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;

    const HEAD: &str = "Camera: {eye: [0, 1, 6], center: [0, 0, 0], up: [0, 1, 0], \
                        viewSize: [8, 8]}\n\
                        Lights: []\nObjects:\n";

    /// A text of objects with a misspelt key each; every `every`th can't be improved by the fix.
    fn with_typos(count: usize, every: usize) -> String {
        let mut text = HEAD.to_owned();
        for at in 0..count {
            let radius = if at % every == 0 { "-1" } else { "1" };
            let _ = writeln!(
                text,
                "- {{type: sphere, position: [0, 0, 0], radus: {radius}, material: {{color: [1, \
                1, 1], ka: 1, kd: 1, ks: 0, n: 1}}}}"
            );
        }
        text
    }

    /// The number of bytes checked, and the result.
    fn work(text: &str) -> (usize, FixedText) {
        let (options, path) = (Options::default(), Path::new("nowhere/a.yaml"));
        let filter = FixFilter {
            guesses: true,
            only: None,
        };
        let mut session = FixSession::new(path, text, &options, &filter);
        let before = session.checks;
        let fixed = session.fixed(text);
        ((before - session.checks) * text.len(), fixed)
    }

    #[test]
    fn what_is_checked_does_not_grow_with_the_square_of_the_text() {
        let [once, twice, four] = [500, 1000, 2000].map(|count| work(&with_typos(count, 7)).0);
        assert!(once <= MAX_BYTES, "{once}");
        assert!(twice <= MAX_BYTES && four <= MAX_BYTES, "{twice} {four}");
    }

    /// A half is an improvement although the whole is not.
    #[test]
    fn one_that_is_refused_keeps_few_others_out() {
        let (_, fixed) = work(&with_typos(40, 64));
        assert!(fixed.changes >= 39, "{}", fixed.changes);
    }
}
