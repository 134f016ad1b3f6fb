//! The forms of a record: the sets of fields of which exactly one must be there.

use super::decode::Context;
use super::record::{Field, Need, Record};
use super::spelling::list;
use rtc_diag::{Severity, codes};
use rtc_source::Span;

/// The field that `--lenient` leaves out where a form has none.
const ROTATION: &str = "rotation";

/// Whether the fields that are there make up one of the forms of the record; if not, that is
/// reported; `slips` is the index of the first slip in the map.
pub(super) fn check(
    record: &Record,
    head: Span,
    is_there: impl Fn(usize) -> bool,
    slips: usize,
    context: &mut Context<'_>,
) -> bool {
    let Record {
        word,
        fields,
        forms,
        forms_are_lowered,
        doc: _,
    } = record;
    if forms.is_empty() || *forms_are_lowered {
        return true;
    }
    // A required field that is missing was reported as such; one with a default is part of no form.
    let given = |at: usize, field: &Field| match field.need {
        Need::Required => true,
        Need::Optional | Need::Unless(_) => is_there(at),
        Need::Default(_) => false,
    };
    let in_forms = |field: &Field| forms.iter().any(|form| form.contains(&field.name));
    let given = fields
        .iter()
        .enumerate()
        .filter(|(at, field)| given(*at, field) && in_forms(field));
    // Nearly every record has one of its forms: the way there allocates nothing.
    let is_it = |form: &&[&str]| {
        let within = given.clone().try_fold(0, |count, (_, field)| {
            form.contains(&field.name).then_some(count + 1)
        });
        within == Some(form.len())
    };
    if forms.iter().any(is_it) {
        return true;
    }
    let given: Vec<_> = given.map(|(_, field)| field.name).collect();
    if context.options.lenient && is_only_turned(record, &given) {
        let message = || format!("a {word} given in this way is not turned");
        context.report(&codes::NO_EFFECT, head, message, |d| {
            d.at(head, "its `rotation` is left out")
                .severity(Severity::Warning)
        });
        return true;
    }
    report(record, head, &given, slips, context);
    false
}

/// Whether what is given is one of the forms but for a rotation.
fn is_only_turned(record: &Record, given: &[&str]) -> bool {
    let rest = || given.iter().filter(|name| **name != ROTATION);
    let is_it =
        |form: &&[&str]| rest().count() == form.len() && rest().all(|name| form.contains(name));
    record.forms.iter().any(is_it)
}

/// Reports that what is given is none of the forms.
fn report(record: &Record, head: Span, given: &[&str], slips: usize, context: &mut Context<'_>) {
    let Record { word, forms, .. } = record;
    let missing = missing(record, given);
    let (code, message) = match missing.as_slice() {
        [] => (
            &codes::CONFLICTING_KEYS,
            format!("the {word} is given in more than one way"),
        ),
        _ => (
            &codes::MISSING_KEY,
            format!("the {word} has no {}", missing.join(" or ")),
        ),
    };
    let in_forms = |field: &&Field| forms.iter().any(|form| form.contains(&field.name));
    let meant = record.fields.iter().filter(in_forms);
    let meant = meant.flat_map(|field| field.rows.iter().copied().flatten().copied());
    let cause = context.slip_for(&meant.collect::<Vec<_>>(), slips);
    let ways: Vec<_> = forms.iter().map(|form| keys(record, form)).collect();
    let hint = format!("a {word} takes {}", ways.join("; or "));
    context.report(
        code,
        head,
        || message,
        |d| {
            d.at(head, format!("this {word}"))
                .because(cause, "perhaps this is it")
                .hint(hint)
        },
    );
}

/// What each form that has all that is given and lacks the least has besides, in words.
fn missing(record: &Record, given: &[&str]) -> Vec<String> {
    let has_all = |form: &&&[&str]| given.iter().all(|name| form.contains(name));
    let possible = record.forms.iter().filter(has_all);
    // With nothing given the first form is worth recommending.
    let least = match given {
        [] => record.forms.first().map(|form| form.len()),
        _ => possible.clone().map(|form| form.len()).min(),
    };
    let nearest = possible.filter(|form| Some(form.len()) == least);
    let missing = nearest.map(|form| {
        let lacks = |name: &&str| !given.contains(name);
        let missing: Vec<_> = form.iter().copied().filter(lacks).collect();
        keys(record, &missing)
    });
    missing
        .take(if given.is_empty() { 1 } else { usize::MAX })
        .collect()
}

/// The canonical keys of some fields, in words.
fn keys(record: &Record, names: &[&str]) -> String {
    let fields = names
        .iter()
        .filter_map(|name| record.fields.iter().find(|field| field.name == *name));
    list(
        fields
            .flat_map(|field| field.rows.first().copied().unwrap_or_default())
            .copied(),
    )
}
