//! The forms of a record: the sets of fields of which exactly one must be there.

use super::decode::Context;
use super::record::{Need, Record};
use super::spelling::list;
use crate::diag::codes;
use crate::source::Span;

/// Whether the fields that are there make up one of the forms of the record; if not, that is reported.
pub(super) fn check(record: &Record, head: Span, is_there: impl Fn(usize) -> bool, context: &mut Context<'_>) -> bool {
    let Record { word, fields, forms, forms_are_lowered, doc: _ } = record;
    if forms.is_empty() || *forms_are_lowered {
        return true;
    }
    let in_forms = fields.iter().enumerate().filter(|(_, field)| forms.iter().any(|form| form.contains(&field.name)));
    // A required field that is missing was reported as such.
    let given = in_forms.filter(|(at, field)| is_there(*at) || matches!(field.need, Need::Required));
    let given: Vec<_> = given.map(|(_, field)| field.name).collect();
    let holds = |form: &&&[&str]| given.iter().all(|name| form.contains(name));
    if forms.iter().any(|form| form.len() == given.len() && holds(&form)) {
        return true;
    }
    let hint = || {
        let forms: Vec<_> = forms.iter().map(|form| keys(record, form)).collect();
        format!("a {word} takes {}", forms.join("; or "))
    };
    let possible: Vec<_> = forms.iter().filter(holds).collect();
    // A form with more keys than another is not worth recommending.
    let larger = |form: &[&str]| {
        possible.iter().any(|other| other.len() < form.len() && other.iter().all(|name| form.contains(name)))
    };
    let missing = possible.iter().filter(|form| !larger(form)).map(|form| {
        let missing: Vec<_> = form.iter().copied().filter(|name| !given.contains(name)).collect();
        keys(record, &missing)
    });
    // With nothing given, the first form is the one to recommend.
    let missing: Vec<_> = missing.take(if given.is_empty() { 1 } else { usize::MAX }).collect();
    let (code, message) = match missing.as_slice() {
        [] => (&codes::CONFLICTING_KEYS, format!("the {word} is given in more than one way")),
        _ => (&codes::MISSING_KEY, format!("the {word} has no {}", missing.join(" or "))),
    };
    context.report(code, head, || message, |d| d.at(head, format!("this {word}")).hint(hint()));
    false
}

/// The canonical keys of some fields, in words.
fn keys(record: &Record, names: &[&str]) -> String {
    let fields = names.iter().filter_map(|name| record.fields.iter().find(|field| field.name == *name));
    list(fields.flat_map(|field| field.rows.first().copied().unwrap_or_default()).copied())
}
