//! What findings propose, put into the text of a scene where that makes it better and nothing worse.
//!
//! A changed text is checked in the place of the file before it is taken. It is better if each finding
//! that is obeyed is gone, there is no error that was not there before, and no warning either unless
//! an error is gone: behind errors, warnings are not seen. A change that puts in a key without a
//! meaning is never better, for the setting below it would be lost. What one change brings to light
//! may be mended by the next, so that a few are tried on. Where all changes together are not
//! better, each half of them is tried, and so on: few that are refused cost few checks.

use super::{Input, Options};
use rtc_diag::{Diagnostic, Severity, codes};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// The most bytes of text that are checked, and how often the largest text is none the less.
const MOST_BYTES: usize = 2 << 20;
const FEWEST_CHECKS: usize = 8;

/// The most times that a text is checked.
const MOST_CHECKS: usize = 200;

/// So often what a change brought to light is mended, too, before it is given up.
const FOLLOWED: usize = 4;

/// A text after what its findings propose.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FixedText {
    /// The text.
    pub text: String,
    /// How many changes are in it; none if it is as it was.
    pub changes: usize,
    /// How many were proposed for it and are not in it: they would make it no better.
    pub refused: usize,
    /// How many are guesses that were not wanted.
    pub guesses: usize,
}

/// Which of the changes that are proposed are wanted.
#[derive(Clone, Debug, Default)]
pub struct FixFilter {
    /// Also those that only guess what was meant.
    pub guesses: bool,
    /// Those for findings like this one alone.
    pub only: Option<DiagnosticRef>,
}

/// Obeys what is proposed for a text that stands at `path`, as far as it is wanted. Nothing is written.
#[must_use]
pub fn fix(path: &Path, text: &str, options: &Options, wish: &FixFilter) -> FixedText {
    Workshop::new(path, text, options, wish).fixed(text)
}

/// What says what is wrong, wherever it is: severity, code and message.
pub type DiagnosticRef = (Severity, &'static str, String);

/// A text and what was found in it.
struct FixDraft {
    text: String,
    /// How many changes led to it.
    changes: usize,
    /// How often there is each complaint.
    complaints: BTreeMap<DiagnosticRef, usize>,
    /// Not all findings were kept.
    is_flooded: bool,
    /// What is proposed for it, from its beginning on; no two at one place.
    edits: Vec<Edit>,
    /// How many guesses are proposed that were not wanted.
    guesses: usize,
    /// Where keys stand that mean nothing: what stands below them is lost.
    lost: Vec<Range<usize>>,
}

/// A text with changes.
struct EditedText {
    text: String,
    /// How many there are by now.
    changes: usize,
    /// Where the last of them put something in.
    added: Vec<Range<usize>>,
}

/// A change of a text.
#[derive(Clone)]
struct Edit {
    start: usize,
    end: usize,
    text: String,
    /// What it is to mend.
    complaint: DiagnosticRef,
}

struct Workshop<'w> {
    path: &'w Path,
    options: &'w Options,
    wish: &'w FixFilter,
    /// So many more checks are made.
    checks: usize,
}

impl<'w> Workshop<'w> {
    fn new(path: &'w Path, text: &str, options: &'w Options, wish: &'w FixFilter) -> Self {
        Self {
            path,
            options,
            wish,
            checks: (MOST_BYTES / text.len().max(1)).clamp(FEWEST_CHECKS, MOST_CHECKS),
        }
    }

    fn fixed(&mut self, text: &str) -> FixedText {
        let mut best = self.check(text.to_owned(), 0);
        while let Some(better) = self.improve(&best) {
            best = better;
        }
        FixedText {
            changes: best.changes,
            refused: best.edits.len(),
            guesses: best.guesses,
            text: best.text,
        }
    }

    fn check(&mut self, text: String, changes: usize) -> FixDraft {
        self.checks = self.checks.saturating_sub(1);
        let bytes = text.clone().into_bytes();
        let mut input = Input::edited(self.path, bytes, self.options.clone());
        if let Some(loaded) = input.load() {
            input.validate(loaded, |_, _| ());
        }
        let sink = input.take_findings();
        let mut draft = FixDraft {
            text,
            changes,
            complaints: BTreeMap::new(),
            is_flooded: sink.dropped() > 0,
            edits: Vec::new(),
            guesses: 0,
            lost: Vec::new(),
        };
        for finding in sink.kept() {
            *draft.complaints.entry(complaint(finding)).or_default() += 1;
            let place = finding.primary.as_ref().map(|label| label.span);
            let place = place.filter(|span| Some(span.file) == input.file_id());
            let lost = place.filter(|_| finding.code.id == codes::UNKNOWN_KEY.id);
            draft
                .lost
                .extend(lost.map(|span| span.start as usize..span.end as usize));
            self.propose(finding, &input, &mut draft);
        }
        draft.edits.sort_by_key(|edit| (edit.start, edit.end));
        draft
            .edits
            .dedup_by(|next, last| next.start < last.end || next.start == last.start);
        draft
    }

    /// Adds what a finding proposes for the text itself: the first that is wanted.
    fn propose(&self, finding: &Diagnostic, input: &Input, draft: &mut FixDraft) {
        let complaint = complaint(finding);
        if self.wish.only.as_ref().is_some_and(|own| *own != complaint) {
            return;
        }
        let proposed = finding.hints.iter();
        let mut proposed = proposed
            .filter_map(|hint| hint.replacement.as_ref())
            .filter(|change| Some(change.span.file) == input.file_id())
            .peekable();
        let is_any = proposed.peek().is_some();
        let wanted = proposed.find(|change| self.wish.guesses || !change.is_guess);
        draft.guesses += usize::from(is_any && wanted.is_none());
        draft.edits.extend(wanted.map(|change| Edit {
            start: change.span.start as usize,
            end: change.span.end as usize,
            text: change.text.clone(),
            complaint: complaint.clone(),
        }));
    }

    /// A better text, by all that is proposed or by the largest part that is found.
    fn improve(&mut self, draft: &FixDraft) -> Option<FixDraft> {
        let mut parts = vec![draft.edits.as_slice()];
        while !parts.is_empty() && self.checks > 0 {
            let better = parts.iter().find_map(|part| self.follow(draft, part));
            if better.is_some() {
                return better;
            }
            parts = parts
                .into_iter()
                .filter(|part| part.len() > 1)
                .flat_map(|part| <[_; 2]>::from(part.split_at(part.len() / 2)))
                .collect();
        }
        None
    }

    /// A better text by these changes, and those that they lead to.
    fn follow(&mut self, draft: &FixDraft, edits: &[Edit]) -> Option<FixDraft> {
        let mut next = draft.edited(edits);
        for _ in 0..FOLLOWED {
            let EditedText {
                text,
                changes,
                added,
            } = next.filter(|_| self.checks > 0)?;
            let found = self.check(text, changes);
            if found.loses(&added) {
                return None;
            }
            if found.is_better(draft, edits) {
                return Some(found);
            }
            next = found.edited(&found.edits);
        }
        None
    }
}

impl FixDraft {
    /// The text with these changes; `None` without any.
    fn edited(&self, edits: &[Edit]) -> Option<EditedText> {
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

    /// Whether what was put in is a key that means nothing, so that a setting is lost.
    fn loses(&self, added: &[Range<usize>]) -> bool {
        let touch = |a: &Range<usize>, b: &Range<usize>| a.start < b.end && b.start < a.end;
        let mut lost = self.lost.iter();
        lost.any(|lost| added.iter().any(|added| touch(lost, added)))
    }

    fn is_better(&self, before: &Self, edits: &[Edit]) -> bool {
        let of = |draft: &Self, complaint: &DiagnosticRef| {
            draft.complaints.get(complaint).copied().unwrap_or(0)
        };
        let is_gone = |edit: &Edit| {
            let mended = edits
                .iter()
                .filter(|other| other.complaint == edit.complaint);
            of(self, &edit.complaint) + mended.count() <= of(before, &edit.complaint)
        };
        let has_new = |severity| {
            let own = self.complaints.iter().filter(|((s, ..), _)| *s == severity);
            own.into_iter()
                .any(|(complaint, count)| *count > of(before, complaint))
        };
        let has_fewer_errors = self.errors() < before.errors();
        !self.is_flooded
            && !before.is_flooded
            && edits.iter().all(is_gone)
            && !has_new(Severity::Error)
            && (has_fewer_errors || !has_new(Severity::Warning))
    }

    fn errors(&self) -> usize {
        let own = self.complaints.iter();
        own.filter(|((severity, ..), _)| *severity == Severity::Error)
            .map(|(_, count)| count)
            .sum()
    }
}

/// What a finding says is wrong.
#[must_use]
pub fn complaint(finding: &Diagnostic) -> DiagnosticRef {
    (finding.severity, finding.code.id, finding.message.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write as _;

    const HEAD: &str = "Camera: {eye: [0, 1, 6], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\n\
                        Lights: []\nObjects:\n";

    /// A text of some objects, each of them misspelt, and each `every`th so that no fix makes it
    /// better.
    fn slips(count: usize, every: usize) -> String {
        let mut text = HEAD.to_owned();
        for at in 0..count {
            let radius = if at % every == 0 { "-1" } else { "1" };
            let _ = writeln!(
                text,
                "- {{type: sphere, position: [0, 0, 0], radus: {radius}, material: {{color: [1, 1, 1], ka: 1, kd: 1, ks: 0, n: 1}}}}"
            );
        }
        text
    }

    /// How much is checked, in bytes, and what comes of it.
    fn work(text: &str) -> (usize, FixedText) {
        let (options, path) = (Options::default(), Path::new("nowhere/a.yaml"));
        let wish = FixFilter {
            guesses: true,
            only: None,
        };
        let mut workshop = Workshop::new(path, text, &options, &wish);
        let before = workshop.checks;
        let fixed = workshop.fixed(text);
        ((before - workshop.checks) * text.len(), fixed)
    }

    #[test]
    fn what_is_checked_does_not_grow_with_the_square_of_the_text() {
        let [once, twice, four] = [500, 1000, 2000].map(|count| work(&slips(count, 7)).0);
        assert!(once <= MOST_BYTES, "{once}");
        assert!(twice <= MOST_BYTES && four <= MOST_BYTES, "{twice} {four}");
    }

    /// Halves are better, though the whole is not.
    #[test]
    fn one_that_is_refused_keeps_few_others_out() {
        let (_, fixed) = work(&slips(40, 64));
        assert!(fixed.changes >= 39, "{}", fixed.changes);
    }
}
