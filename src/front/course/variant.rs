//! The variants of a record: sets of fields, of which exactly one must be present.

use super::decode::DecodeContext;
use super::record::{FieldDeclaration, FieldRequirement, Record};
use super::spelling::quoted_list;
use rtc_diag::{Severity, codes};
use rtc_source::Span;

/// The field that `--lenient` ignores if it belongs to no variant.
const ROTATION: &str = "rotation";

/// Whether the fields that are present are one of the variants of the record; if not, that is
/// reported. `first_typo` is the index of the first typo in the map.
pub(super) fn check(
    record: &Record,
    head: Span,
    is_there: impl Fn(usize) -> bool,
    first_typo: usize,
    context: &mut DecodeContext<'_>,
) -> bool {
    let Record {
        name,
        fields,
        variants,
        variants_are_lowered,
        doc: _,
    } = record;
    if variants.is_empty() || *variants_are_lowered {
        return true;
    }
    // A required field counts as present: if it is missing, that was reported. A field with a
    // default belongs to no variant.
    let present = |at: usize, field: &FieldDeclaration| match field.requirement {
        FieldRequirement::Required => true,
        FieldRequirement::Optional | FieldRequirement::Unless(_) => is_there(at),
        FieldRequirement::Default(_) => false,
    };
    let in_variants =
        |field: &FieldDeclaration| variants.iter().any(|variant| variant.contains(&field.name));
    let present = fields
        .iter()
        .enumerate()
        .filter(|(at, field)| present(*at, field) && in_variants(field));
    // Nearly every record has a valid variant, so this check does not allocate.
    let is_variant = |variant: &&[&str]| {
        let within = present.clone().try_fold(0, |count, (_, field)| {
            variant.contains(&field.name).then_some(count + 1)
        });
        within == Some(variant.len())
    };
    if variants.iter().any(is_variant) {
        return true;
    }
    let present: Vec<_> = present.map(|(_, field)| field).collect();
    if !context.options.strict
        && let Some(variant) = without_own_keys(variants, &present)
    {
        let is_ignored = |field: &&&FieldDeclaration| !variant.contains(&field.name);
        let ignored = present.iter().filter(is_ignored);
        report_ignored(
            name,
            head,
            ignored.map(|field| field.spellings[0][0]),
            context,
        );
        return true;
    }
    let present: Vec<_> = present.iter().map(|field| field.name).collect();
    if context.options.lenient && differs_only_by_rotation(record, &present) {
        let message = || format!("the {name} has no `rotation` with these keys");
        context.report(&codes::NO_EFFECT, head, message, |d| {
            d.at(head, "the `rotation` is ignored")
                .severity(Severity::Warning)
        });
        return true;
    }
    report(record, head, &present, first_typo, context);
    false
}

/// If the present fields of the course are a variant, and those that only rtc has are none: the
/// largest variant of the fields of the course and perhaps some of the others.
fn without_own_keys(
    variants: &'static [&'static [&'static str]],
    present: &[&FieldDeclaration],
) -> Option<&'static [&'static str]> {
    let has = |name: &&str, own: bool| {
        let mut fields = present.iter();
        fields.any(|field| field.name == *name && field.is_own == own)
    };
    let sheet = || present.iter().filter(|field| !field.is_own);
    let is_older = |variant: &&[&str]| {
        variant.len() == sheet().count() && variant.iter().all(|name| has(name, false))
    };
    let is_own = |variant: &&[&str]| variant.iter().all(|name| has(name, true));
    if !variants.iter().any(is_older) || variants.iter().any(is_own) {
        return None;
    }
    let is_read = |variant: &&&[&str]| {
        let is_there = |name: &&str| has(name, false) || has(name, true);
        variant.iter().all(is_there) && sheet().all(|field| variant.contains(&field.name))
    };
    let read = variants.iter().filter(is_read);
    read.max_by_key(|variant| variant.len()).copied()
}

/// Warns of keys that only rtc has, beside keys of the course that are complete without them.
fn report_ignored<'k>(
    record_name: &str,
    head: Span,
    keys: impl Iterator<Item = &'k str>,
    context: &mut DecodeContext<'_>,
) {
    let keys = quoted_list(keys);
    let message = || format!("the {record_name} is read without {keys}");
    context.report(&codes::NO_EFFECT, head, message, |d| {
        d.at(head, "no effect beside its other keys")
            .severity(Severity::Warning)
    });
}

/// Whether the present fields without the rotation are one of the variants.
fn differs_only_by_rotation(record: &Record, present: &[&str]) -> bool {
    let rest = || present.iter().filter(|name| **name != ROTATION);
    let is_variant = |variant: &&[&str]| {
        rest().count() == variant.len() && rest().all(|name| variant.contains(name))
    };
    record.variants.iter().any(is_variant)
}

/// Reports that the present fields are not one of the variants.
fn report(
    record: &Record,
    head: Span,
    present: &[&str],
    first_typo: usize,
    context: &mut DecodeContext<'_>,
) {
    let Record { name, variants, .. } = record;
    // The variants are in conflict, or none is complete.
    let missing = missing(record, present);
    let (code, message) = match missing.as_slice() {
        [] => (
            &codes::CONFLICTING_KEYS,
            format!("the {name} is given in more than one way"),
        ),
        _ => (
            &codes::MISSING_KEY,
            format!("the {name} needs {}", missing.join(" or ")),
        ),
    };
    // A misspelled key may be the cause.
    let in_variants =
        |field: &&FieldDeclaration| variants.iter().any(|variant| variant.contains(&field.name));
    let candidates = record.fields.iter().filter(in_variants);
    let candidates =
        candidates.flat_map(|field| field.spellings.iter().copied().flatten().copied());
    let cause = context.typo_for(&candidates.collect::<Vec<_>>(), first_typo);
    // Show the keys of the nearest variants.
    let alternatives: Vec<_> = nearest(variants, present)
        .map(|variant| keys(record, variant))
        .collect();
    let hint = format!("a {name} takes {}", alternatives.join("; or "));
    context.report(
        code,
        head,
        || message,
        |d| {
            d.at(head, format!("the {name}"))
                .caused_by(cause, "perhaps this is the cause")
                .hint(hint)
        },
    );
}

/// The most variants that a hint lists.
const MAX_ALTERNATIVES: usize = 3;

/// The variants that differ by the fewest keys from those that are present, in their order; all of
/// them if they are few.
fn nearest<'v>(
    variants: &'v [&'static [&'static str]],
    present: &[&str],
) -> impl Iterator<Item = &'v &'static [&'static str]> {
    let difference = |variant: &[&str]| {
        let shared = variant.iter().filter(|name| present.contains(name)).count();
        variant.len() + present.len() - 2 * shared
    };
    let mut ranks: Vec<_> = variants.iter().map(|variant| difference(variant)).collect();
    let ranked = ranks.clone();
    ranks.sort_unstable();
    let most = ranks.get(MAX_ALTERNATIVES - 1).or(ranks.last()).copied();
    let near = variants
        .iter()
        .zip(ranked)
        .filter(move |(_, rank)| Some(*rank) <= most);
    near.map(|(variant, _)| variant).take(MAX_ALTERNATIVES)
}

/// For each variant that contains all present fields and lacks the fewest: the missing keys.
fn missing(record: &Record, present: &[&str]) -> Vec<String> {
    let has_all = |variant: &&&[&str]| present.iter().all(|name| variant.contains(name));
    let possible = record.variants.iter().filter(has_all);
    // Without any field only the first variant is recommended.
    let min_len = match present {
        [] => record.variants.first().map(|variant| variant.len()),
        _ => possible.clone().map(|variant| variant.len()).min(),
    };
    let nearest = possible.filter(|variant| Some(variant.len()) == min_len);
    let missing = nearest.map(|variant| {
        let lacks = |name: &&str| !present.contains(name);
        let missing: Vec<_> = variant.iter().copied().filter(lacks).collect();
        keys(record, &missing)
    });
    missing
        .take(if present.is_empty() { 1 } else { usize::MAX })
        .collect()
}

/// The canonical keys of some fields, as a list for messages.
fn keys(record: &Record, names: &[&str]) -> String {
    let fields = names
        .iter()
        .filter_map(|name| record.fields.iter().find(|field| field.name == *name));
    quoted_list(
        fields
            .flat_map(|field| field.spellings.first().copied().unwrap_or_default())
            .copied(),
    )
}
