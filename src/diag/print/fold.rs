//! Folding: many findings that say the same are shown once, with the places of the others.

use super::text::clean;
use crate::Diagnostic;
use rtc_source::SourceMap;
use std::collections::BTreeMap;

/// So many equal findings are shown one by one.
const EACH: usize = 3;
/// So many places of those that are not shown are named.
const PLACES: usize = 6;

/// A finding that is shown, and those that say the same elsewhere.
pub(super) struct Fold<'a> {
    pub(super) first: &'a Diagnostic,
    pub(super) others: Vec<&'a Diagnostic>,
}

/// Findings in their order, each by itself.
pub(super) fn none<'a>(found: &[&'a Diagnostic]) -> Vec<Fold<'a>> {
    let alone = |first: &&'a Diagnostic| Fold {
        first,
        others: Vec::new(),
    };
    found.iter().map(alone).collect()
}

/// Findings in their order, equal ones folded into the first if there are more than three.
pub(super) fn equal<'a>(found: &[&'a Diagnostic]) -> Vec<Fold<'a>> {
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
    let mut folds: Vec<Fold<'a>> = Vec::new();
    let mut places = BTreeMap::new();
    for diagnostic in found {
        match places.get(&key(diagnostic)) {
            Some(place) if counts[&key(diagnostic)] > EACH => {
                let fold: &mut Fold<'a> = &mut folds[*place];
                fold.others.push(diagnostic);
            }
            _ => {
                places.insert(key(diagnostic), folds.len());
                folds.push(Fold {
                    first: diagnostic,
                    others: Vec::new(),
                });
            }
        }
    }
    folds
}

impl Fold<'_> {
    /// How many others there are, and where; `None` if there are none.
    pub(super) fn words(&self, map: &SourceMap) -> Option<String> {
        if self.others.is_empty() {
            return None;
        }
        let own = self.first.primary.as_ref().map(|label| label.span.file);
        let place = |diagnostic: &&Diagnostic| {
            let span = diagnostic.primary.as_ref()?.span;
            let line = map.line_column(span.file, span.start).line;
            Some(match own == Some(span.file) {
                true => line.to_string(),
                false => format!("{}:{line}", clean(map.name(span.file))),
            })
        };
        let mut places: Vec<String> = self.others.iter().filter_map(place).collect();
        places.dedup();
        let tail = if places.len() > PLACES { ", …" } else { "" };
        places.truncate(PLACES);
        let at = if places.is_empty() {
            String::new()
        } else {
            format!(", at lines {}{tail}", places.join(", "))
        };
        Some(format!("the same {} times more{at}", self.others.len()))
    }
}
