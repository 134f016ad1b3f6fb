//! Reads the maps of the file field by field, in the order of the declaration of the record, and
//! reports keys that are unknown or missing.

use super::decode::{DecodeContext, MapEntry, ValueKey, describe};
use super::material::is_material_key;
use super::record::{FieldDeclaration, FieldRequirement, FieldResult, FieldValue, Record};
use super::spelling::{quoted_list, same_letters};
use super::synonym::foreign_key_advice;
use super::variant;
use rtc_diag::{Diagnostic, clip, codes, nearest};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use std::collections::BTreeSet;

/// The number of diagnostics after which no more suggestions are computed.
const MAX_SUGGESTIONS: usize = 100;

/// The largest number of keys in one spelling of a field.
const MAX_GROUP: usize = 6;

/// The key of a comment. Every map may have it; it has no meaning.
pub(super) const COMMENT: &str = "comment";

/// The key of the material of an object.
pub(super) const MATERIAL: &str = "material";

/// The key of the texture of a material. Some files have it beside the material.
pub(super) const TEXTURE: &str = "texture";

/// Reads one map, field by field in the order of the declaration.
pub(super) struct MapReader {
    record: &'static Record,
    /// The spelling in which each field read so far was written, if it was.
    rows: Vec<Option<&'static [&'static str]>>,
    /// The index of the map's first entry in the entries of the context.
    first_entry: usize,
    /// The span of the map for diagnostics.
    head: Span,
    /// Whether the map is that of an object with a texture beside its material.
    offers_texture: bool,
}

impl MapReader {
    /// Starts to read a map; reports a node of any other kind.
    pub(super) fn open(
        record: &'static Record,
        node: NodeId,
        context: &mut DecodeContext<'_>,
    ) -> Option<Self> {
        if !context.tree.is_map(node) {
            return context.expected(node, "a map");
        }
        let head = context.key.span.unwrap_or_else(|| context.head(node));
        let first_entry = context.entries.len();
        collect_entries(node, context);
        if !context.options.strict {
            fold_case(record, first_entry, context);
        }
        let offers_texture = record.fields.iter().any(|field| field.name == MATERIAL);
        if offers_texture {
            let own = |key: &str| {
                let mut entries = context.entries[first_entry..].iter();
                entries.find(|entry| entry.key == key).copied()
            };
            context.object_texture = own(TEXTURE);
            if let (None, Some(outer)) = (own(MATERIAL), context.operand_material) {
                context.object_texture = context.object_texture.or(outer.texture);
                context.entries.push(outer.material);
            }
        } else if record.name == MATERIAL {
            take_object_texture(first_entry, context);
        }
        Some(Self {
            record,
            rows: Vec::with_capacity(record.fields.len()),
            first_entry,
            head,
            offers_texture,
        })
    }

    /// Reads the next field of the declaration.
    pub(super) fn next<S: FieldValue>(
        &mut self,
        context: &mut DecodeContext<'_>,
    ) -> FieldResult<S> {
        let field = &self.record.fields[self.rows.len()];
        let found = self.spelling(field, context);
        self.rows.push(found.map(|(spelling, _)| spelling));
        let Some((spelling, found)) = found else {
            return FieldResult::Absent;
        };
        for ((key, canonical), at) in spelling.iter().zip(field.spellings[0]).zip(found) {
            context.entries[at].claimed = true;
            if key != canonical {
                context.record_spelling(
                    key,
                    canonical,
                    context.tree.span(context.entries[at].key_node),
                );
            }
        }
        let found = &found[..spelling.len()];
        match context.reading(field.is_own, |context| S::take(found, context)) {
            Some(value) => FieldResult::Read(value),
            None if field.is_own && !context.options.strict => {
                self.rows.pop();
                self.rows.push(None);
                FieldResult::Absent
            }
            None => FieldResult::Broken,
        }
    }

    /// The first spelling of the field whose keys are all present and unused, with the indices of
    /// their entries.
    fn spelling(
        &self,
        field: &FieldDeclaration,
        context: &DecodeContext<'_>,
    ) -> Option<(&'static [&'static str], [usize; MAX_GROUP])> {
        let entries = &context.entries[self.first_entry..];
        let find = |key: &str| {
            Some(
                self.first_entry
                    + entries
                        .iter()
                        .position(|entry| entry.key == key && !entry.claimed)?,
            )
        };
        field.spellings.iter().find_map(|spelling| {
            let mut found = [find(spelling[0])?; MAX_GROUP];
            for (slot, key) in found.iter_mut().zip(*spelling).skip(1) {
                *slot = find(key)?;
            }
            Some((*spelling, found))
        })
    }

    /// Reports keys that were not read and keys that are missing. Returns false if the map has none
    /// of the variants of the record.
    pub(super) fn close(self, context: &mut DecodeContext<'_>) -> bool {
        let (mut partial, typos) = (0_u64, context.typos.len());
        for at in self.first_entry..context.entries.len() {
            let entry = context.entries[at];
            // The material has taken the texture beside it.
            let is_taken = entry.key == TEXTURE
                && self.offers_texture
                && context.taken_textures.contains(&entry.value);
            if !(entry.claimed || is_taken) && entry.key != COMMENT {
                partial |= self.report_unused_key(entry, context);
            }
        }
        context.entries.truncate(self.first_entry);
        // Missing keys.
        let has = |name: &str| {
            let at = self
                .record
                .fields
                .iter()
                .position(|field| field.name == name);
            at.is_some_and(|at| self.rows[at].is_some())
        };
        let required = |field: &FieldDeclaration| match field.requirement {
            FieldRequirement::Required => true,
            FieldRequirement::Unless(other) => !has(other),
            FieldRequirement::Optional | FieldRequirement::Default(_) => false,
        };
        let absent = |at: &usize| self.rows[*at].is_none() && partial & (1 << at) == 0;
        let fields = self.record.fields.iter().enumerate();
        let missing = fields.filter(|(at, field)| absent(at) && required(field));
        let missing: Vec<_> = missing
            .flat_map(|(_, field)| field.spellings[0].iter().copied())
            .collect();
        if !missing.is_empty() {
            let cause = context.typo_for(&missing, typos);
            missing_keys(self.record.name, self.head, &missing, cause, context);
        }
        // While a group of keys is incomplete, which was reported, the intended variant is unknown.
        partial != 0
            || variant::check(
                self.record,
                self.head,
                |at| self.rows[at].is_some(),
                typos,
                context,
            )
    }

    /// Reports a key that no field read. If the key belongs to an incomplete group of a field,
    /// returns the bit of that field.
    fn report_unused_key(&self, entry: MapEntry<'_>, context: &mut DecodeContext<'_>) -> u64 {
        let Record {
            name: record_name,
            fields,
            ..
        } = self.record;
        let span = context.tree.span(entry.key_node);
        let part_of = |field: &FieldDeclaration| {
            field
                .spellings
                .iter()
                .any(|spelling| spelling.contains(&entry.key))
        };
        // The same key was read elsewhere in the map: a duplicate, which was reported, or a merged
        // key that a key of the map itself overrides.
        if self
            .rows
            .iter()
            .flatten()
            .any(|spelling| spelling.contains(&entry.key))
        {
            return 0;
        }
        let has = |at: usize| self.rows[at].is_some();
        let used = fields
            .iter()
            .enumerate()
            .find(|(at, field)| has(*at) && part_of(field));
        if let Some((_, field)) = used {
            let message = || format!("`{}` repeats another key of the {record_name}", entry.key);
            context.report(&codes::CONFLICTING_KEYS, span, message, |d| {
                d.at(span, "redundant").hint(format!(
                    "the {record_name} takes {} once",
                    quoted_list(field.spellings[0].iter().copied())
                ))
            });
            return 0;
        }
        // A key of an incomplete group.
        if let Some((at, absent)) = self.nearest_group(entry.key, context) {
            let message = || {
                format!(
                    "the {record_name} has `{}` without {}",
                    entry.key,
                    quoted_list(absent)
                )
            };
            context.report(&codes::MISSING_KEY, span, message, |d| {
                d.at(span, "one of a group").hint("give all of them")
            });
            return 1 << at;
        }
        // A key of another record or program, or an unknown one.
        let Some((advice, suggestion)) = self.advice(entry.key) else {
            self.report_unknown(entry, context);
            return 0;
        };
        context
            .typos
            .extend(suggestion.map(|suggestion| (suggestion, span)));
        unknown_key(record_name, entry, context, |d| d.hint(advice));
        0
    }

    /// Reports an unknown key, with the key that was probably intended.
    fn report_unknown(&self, entry: MapEntry<'_>, context: &mut DecodeContext<'_>) {
        let Record {
            name: record_name,
            fields,
            ..
        } = self.record;
        let span = context.tree.span(entry.key_node);
        // A suggestion costs a comparison with every key, so it is made only for the first
        // diagnostics.
        let advise = context.diagnostics() < MAX_SUGGESTIONS;
        let fields = fields.iter().enumerate();
        let unused = fields.filter(|(at, _)| advise && self.rows[*at].is_none());
        let unused = unused.map(|(_, field)| field);
        let suggestion = nearest(entry.key, unused.flat_map(suggestible_keys));
        context
            .typos
            .extend(suggestion.map(|suggestion| (suggestion, span)));
        let replacement = suggestion.map(|suggestion| {
            (
                suggestion,
                context.with_quotes_of(entry.key_node, suggestion),
            )
        });
        unknown_key(record_name, entry, context, |d| match replacement {
            Some((suggestion, replacement)) => {
                with_suggestion(d, entry.key, suggestion, span, replacement)
            }
            None if entry.key.starts_with(|c: char| c.is_ascii_digit()) => d.hint(
                "a comma starts the next key: decimals follow a point, lists are in `[` and `]`",
            ),
            None => d,
        });
    }

    /// A hint for a key of another program or another record, and the key to use here.
    fn advice(&self, key: &str) -> Option<(String, Option<&'static str>)> {
        let Record {
            name: record_name,
            fields,
            ..
        } = self.record;
        let has_material = fields.iter().any(|field| field.name == MATERIAL);
        if has_material && is_material_key(key) {
            let advice = format!("`{key}` belongs in the `{MATERIAL}` of the {record_name}");
            return Some((advice, Some(MATERIAL)));
        }
        foreign_key_advice(record_name, key).map(|advice| (advice.to_owned(), None))
    }

    /// The group with this key that has the fewest missing keys: the index of its field and these
    /// keys.
    fn nearest_group(
        &self,
        key: &str,
        context: &DecodeContext<'_>,
    ) -> Option<(usize, Vec<&'static str>)> {
        let unused = context.entries[self.first_entry..]
            .iter()
            .filter(|entry| !entry.claimed);
        let is_there = |key: &str| unused.clone().any(|entry| entry.key == key);
        let absent = |spelling: &&[&'static str]| {
            let absent = spelling.iter().copied().filter(|key| !is_there(key));
            absent.collect::<Vec<_>>()
        };
        let groups = self.record.fields.iter().enumerate();
        let groups = groups.flat_map(|(at, field)| {
            let rows = field
                .spellings
                .iter()
                .filter(|spelling| spelling.contains(&key));
            rows.map(move |spelling| (at, absent(spelling)))
        });
        groups.min_by_key(|(_, absent)| absent.len())
    }
}

/// The keys of a field that a suggestion may name. Other spellings of one or two letters are
/// omitted, since they resemble too many keys.
fn suggestible_keys(field: &FieldDeclaration) -> impl Iterator<Item = &'static str> {
    let rows = field.spellings.iter().enumerate();
    rows.flat_map(|(at, spelling)| {
        let keys = spelling.iter().copied();
        keys.filter(move |key| at == 0 || key.len() > 2)
    })
}

/// Reports required keys that are missing.
pub(super) fn missing_keys(
    record_name: &str,
    head: Span,
    missing: &[&str],
    cause: Option<Span>,
    context: &mut DecodeContext<'_>,
) {
    let message = || {
        format!(
            "the {record_name} has no {}",
            quoted_list(missing.iter().copied())
        )
    };
    context.report(&codes::MISSING_KEY, head, message, |d| {
        d.at(head, format!("the {record_name}"))
            .caused_by(cause, "perhaps this is the cause")
    });
}

/// Adds the suggested key to a diagnostic. If it has the same letters and digits as the written
/// key, the fix is certain.
fn with_suggestion(
    d: Diagnostic,
    key: &str,
    suggestion: &str,
    span: Span,
    replacement: String,
) -> Diagnostic {
    let hint = format!("did you mean `{suggestion}`?");
    match same_letters(key, suggestion) {
        true => d.replace(hint, span, replacement),
        false => d.guess(hint, span, replacement),
    }
}

/// Reports a key that the record does not have, with the hint that `advise` adds.
fn unknown_key(
    record_name: &str,
    entry: MapEntry<'_>,
    context: &mut DecodeContext<'_>,
    advise: impl FnOnce(Diagnostic) -> Diagnostic,
) {
    let span = context.tree.span(entry.key_node);
    let severity = context.unknown_key_severity();
    context.report(
        &codes::UNKNOWN_KEY,
        span,
        || format!("unknown key `{}` in the {record_name}", clip(entry.key)),
        |d| advise(d.at(span, "ignored").severity(severity)),
    );
}

/// Replaces unknown keys by known ones that differ only in case, unless the map has these as well.
fn fold_case(record: &'static Record, first_entry: usize, context: &mut DecodeContext<'_>) {
    let keys = || {
        record
            .fields
            .iter()
            .flat_map(|field| field.spellings.iter().copied().flatten().copied())
    };
    for at in first_entry..context.entries.len() {
        let MapEntry { key, key_node, .. } = context.entries[at];
        if keys().any(|known| known == key) {
            continue;
        }
        let is_other = |known: &&str| {
            context.entries[first_entry..]
                .iter()
                .all(|entry| entry.key != *known)
        };
        let suggestion = keys().find(|known| known.eq_ignore_ascii_case(key) && is_other(known));
        if let Some(suggestion) = suggestion {
            context.entries[at].key = suggestion;
            context.record_case(key, suggestion, key_node);
        }
    }
}

/// Adds the texture beside a material to its entries, unless it has one of its own.
fn take_object_texture(first_entry: usize, context: &mut DecodeContext<'_>) {
    let mut entries = context.entries[first_entry..].iter();
    if !entries.any(|entry| entry.key == TEXTURE) {
        let texture = context.object_texture.take();
        context
            .taken_textures
            .extend(texture.map(|texture| texture.value));
        context.entries.extend(texture);
    }
}

/// Adds the entries of a map to those of the context: the entries of the map itself, then the
/// merged ones.
fn collect_entries(map: NodeId, context: &mut DecodeContext<'_>) {
    let tree = context.tree;
    let mut open_maps = vec![map];
    // Merging a map twice changes nothing. Without this set, merges of merges would grow without
    // bound.
    let mut seen = BTreeSet::new();
    while let Some(map) = open_maps.pop() {
        if !context.step(map) {
            return;
        }
        let mut merged = Vec::new();
        for (key_node, value) in tree.pairs(map) {
            if !context.step(key_node) {
                break;
            }
            match tree.text(key_node) {
                Some("<<") if tree.is_list(value) => merged.extend(tree.items(value)),
                Some("<<") => merged.push(value),
                Some(key) => context.entries.push(MapEntry {
                    key,
                    key_node,
                    value,
                    claimed: false,
                }),
                None => {
                    let (span, found) = (tree.span(key_node), describe(tree.shape(key_node)));
                    let message = || format!("a key must be a word, not {found}");
                    context.report(&codes::WRONG_TYPE, span, message, |d| {
                        d.at(span, found.clone())
                    });
                }
            }
        }
        for map in merged.into_iter().rev() {
            // Aliases can repeat a long list of maps in many maps.
            if !context.step(map) {
                return;
            }
            if tree.is_map(map) {
                open_maps.extend(seen.insert(tree.target(map)).then_some(map));
            } else {
                context.key = ValueKey {
                    text: "<<",
                    span: Some(tree.span(map)),
                };
                context.expected::<()>(map, "a map or a list of maps");
            }
        }
    }
}

/// The value of a key of a map or of the maps that it merges.
pub(super) fn look_up(key: &str, map: NodeId, context: &mut DecodeContext<'_>) -> Option<NodeId> {
    if let Some(value) = context.tree.get(map, key) {
        return Some(value);
    }
    let first_entry = context.entries.len();
    collect_entries(map, context);
    let is_strict = context.options.strict;
    let found = context.entries[first_entry..]
        .iter()
        .find(|entry| entry.key == key || (!is_strict && entry.key.eq_ignore_ascii_case(key)))
        .map(|entry| entry.value);
    context.entries.truncate(first_entry);
    found
}
