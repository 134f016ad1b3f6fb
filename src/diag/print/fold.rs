//! Folding: of many equal diagnostics the first is printed, with the lines of the others.

use super::text::clean;
use crate::Diagnostic;
use rtc_source::SourceMap;
use std::collections::BTreeMap;

/// Up to this many equal diagnostics are printed one by one.
const EACH: usize = 3;
/// Up to this many lines of the folded diagnostics are printed.
const LINES: usize = 6;

/// A diagnostic that is printed, and the equal ones that are not.
pub(super) struct FoldedDiagnostic<'a> {
    pub(super) first: &'a Diagnostic,
    pub(super) others: Vec<&'a Diagnostic>,
}

/// Each diagnostic by itself.
pub(super) fn none<'a>(found: &[&'a Diagnostic]) -> Vec<FoldedDiagnostic<'a>> {
    let alone = |first: &&'a Diagnostic| FoldedDiagnostic {
        first,
        others: Vec::new(),
    };
    found.iter().map(alone).collect()
}

/// Equal diagnostics folded into the first of them if there are more than [`EACH`].
pub(super) fn equal<'a>(found: &[&'a Diagnostic]) -> Vec<FoldedDiagnostic<'a>> {
    let key = |diagnostic: &'a Diagnostic| {
        (
            diagnostic.code.id,
            diagnostic.severity,
            diagnostic.message.as_str(),
        )
    };
    let mut counts = BTreeMap::new();
    for diagnostic in found {
        *counts.entry(key(diagnostic)).or_insert(0_usize) += 1;
    }
    let mut folds: Vec<FoldedDiagnostic<'a>> = Vec::new();
    let mut indices = BTreeMap::new();
    for diagnostic in found {
        match indices.get(&key(diagnostic)) {
            Some(index) if counts[&key(diagnostic)] > EACH => {
                let fold: &mut FoldedDiagnostic<'a> = &mut folds[*index];
                fold.others.push(diagnostic);
            }
            _ => {
                indices.insert(key(diagnostic), folds.len());
                folds.push(FoldedDiagnostic {
                    first: diagnostic,
                    others: Vec::new(),
                });
            }
        }
    }
    folds
}

impl FoldedDiagnostic<'_> {
    /// The number of the folded diagnostics and their lines; `None` if there are none.
    pub(super) fn note(&self, map: &SourceMap) -> Option<String> {
        if self.others.is_empty() {
            return None;
        }
        let file = self.first.primary.as_ref().map(|label| label.span.file);
        let line = |diagnostic: &&Diagnostic| {
            let span = diagnostic.primary.as_ref()?.span;
            let line = map.line_column(span.file, span.start).line;
            Some(match file == Some(span.file) {
                true => line.to_string(),
                false => format!("{}:{line}", clean(map.name(span.file))),
            })
        };
        let mut lines: Vec<String> = self.others.iter().filter_map(line).collect();
        lines.dedup();
        let tail = if lines.len() > LINES { ", …" } else { "" };
        lines.truncate(LINES);
        let at = if lines.is_empty() {
            String::new()
        } else {
            format!(", at lines {}{tail}", lines.join(", "))
        };
        Some(format!("the same {} times more{at}", self.others.len()))
    }
}
