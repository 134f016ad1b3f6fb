//! Lists of entities as tables of numbers. Entities that differ only in their numbers share a
//! template: their JSON tree with null for each number, each long list of numbers and each long
//! string.
//!
//! No entity of the IR is named here. The tables describe themselves, so a file of an older version
//! decodes to the tree of that version. Integers stay integers and floats keep every bit.

use super::container::Container;
use super::decoded::Decoded;
use super::run::{self, ValueSection};
use super::section::{ElementType, Section, SectionContent, SectionWriter};
use super::tree::{NonFiniteNumber, tree};
use rtc_diag::codes;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// One list of the scene.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EntityTable {
    /// Its key in the scene.
    pub(super) key: String,
    /// The section with the template index of each entity, in order.
    order: usize,
    kinds: Vec<EntityTemplate>,
}

/// A template: entities that differ only in their numbers.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct EntityTemplate {
    /// The entity with null for each number, long list or long string.
    entity: Value,
    /// The values that the nulls replace, in order.
    numbers: Vec<TemplateSlot>,
    /// The section of the floats, one record per entity.
    floats: usize,
    /// The section of the integers, one record per entity.
    integers: usize,
    /// The long lists and strings, entity by entity.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    runs: Vec<ValueSection>,
}

/// The value that a null replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
enum TemplateSlot {
    F64,
    U32,
    /// A long list or string, in a section of its own.
    Run,
}

/// The numbers, lists and strings extracted from the entities of one template.
#[derive(Default)]
struct ExtractedNumbers {
    slots: Vec<TemplateSlot>,
    floats: Vec<u8>,
    integers: Vec<u8>,
    runs: Vec<ValueSection>,
}

/// Moves the numbers of `entities` into sections of `body`. Only one entity at a time is a tree.
pub(super) fn pack<T: Serialize>(
    key: &str,
    entities: &[T],
    body: &mut SectionWriter<'_>,
) -> Result<EntityTable, NonFiniteNumber> {
    // Extract the numbers of each entity and group entities by template.
    let mut found: BTreeMap<String, u32> = BTreeMap::new();
    let mut kinds: Vec<(Value, ExtractedNumbers)> = Vec::new();
    let mut order = Vec::new();
    for entity in entities {
        let mut entity = tree(entity)?;
        let mut extracted = ExtractedNumbers::default();
        extract(&mut entity, &mut extracted, body);
        let name = format!("{entity}{:?}", extracted.slots);
        let next = u32::try_from(found.len())
            .expect("kinds are fewer than entities, whose indices are u32");
        let index = *found.entry(name).or_insert(next);
        order.extend(index.to_le_bytes());
        match kinds.get_mut(index as usize) {
            None => kinds.push((entity, extracted)),
            Some((_, earlier)) => {
                earlier.floats.extend(extracted.floats);
                earlier.integers.extend(extracted.integers);
                earlier.runs.extend(extracted.runs);
            }
        }
    }
    // Write the sections.
    let order = body.push(ElementType::U32, 1, SectionContent::Bytes(order.into()));
    let kinds = kinds
        .into_iter()
        .map(|(entity, extracted)| store(entity, extracted, body))
        .collect();
    Ok(EntityTable {
        key: key.to_owned(),
        order,
        kinds,
    })
}

fn store(
    entity: Value,
    extracted: ExtractedNumbers,
    body: &mut SectionWriter<'_>,
) -> EntityTemplate {
    let ExtractedNumbers {
        slots: numbers,
        floats,
        integers,
        runs,
    } = extracted;
    let floats = body.push(
        ElementType::F64,
        count(&numbers, TemplateSlot::F64),
        SectionContent::Bytes(floats.into()),
    );
    let integers = body.push(
        ElementType::U32,
        count(&numbers, TemplateSlot::U32),
        SectionContent::Bytes(integers.into()),
    );
    EntityTemplate {
        entity,
        numbers,
        floats,
        integers,
        runs,
    }
}

fn count(numbers: &[TemplateSlot], slot: TemplateSlot) -> usize {
    numbers.iter().filter(|kind| **kind == slot).count()
}

/// Replaces each number, long list and long string of the tree by null. Integers beyond u32 stay:
/// the IR has none.
fn extract(tree: &mut Value, extracted: &mut ExtractedNumbers, body: &mut SectionWriter<'_>) {
    if let Some(run) = run::store(tree, body) {
        extracted.runs.push(run);
        extracted.slots.push(TemplateSlot::Run);
        *tree = Value::Null;
        return;
    }
    match tree {
        Value::Null | Value::Bool(_) | Value::String(_) => {}
        Value::Array(items) => items
            .iter_mut()
            .for_each(|item| extract(item, extracted, body)),
        Value::Object(members) => members
            .values_mut()
            .for_each(|member| extract(member, extracted, body)),
        Value::Number(number) => {
            if let Some(integer) = run::as_u32(number) {
                extracted.integers.extend(integer.to_le_bytes());
                extracted.slots.push(TemplateSlot::U32);
            } else if let Some(float) = number.as_f64().filter(|_| number.is_f64()) {
                extracted.floats.extend(float.to_le_bytes());
                extracted.slots.push(TemplateSlot::F64);
            } else {
                return;
            }
            *tree = Value::Null;
        }
    }
}

/// Hands out the sections of a file and limits the memory made from them to a constant times the
/// length of the file.
pub(super) struct SectionReader<'a> {
    sections: &'a [Section<'a>],
    /// Which sections were handed out: each may be used once.
    spent: Vec<bool>,
    /// The bytes of template text that may still be repeated.
    text: usize,
}

impl<'a> SectionReader<'a> {
    pub(super) fn new(sections: &'a [Section<'a>], file: &Container<'_>) -> Self {
        Self {
            sections,
            spent: vec![false; sections.len()],
            text: file.bytes.len().saturating_mul(8),
        }
    }

    /// The section, unless it was handed out before.
    pub(super) fn take(&mut self, section: usize) -> Option<&'a Section<'a>> {
        let spent = self.spent.get_mut(section)?;
        (!std::mem::replace(spent, true)).then(|| &self.sections[section])
    }

    /// Takes the sections of these runs; false if a run is invalid or its section was taken before.
    fn spend(&mut self, runs: &[ValueSection]) -> bool {
        runs.iter().all(|run| {
            self.take(run.section)
                .is_some_and(|section| run.is_sound(section))
        })
    }
}

/// Decodes a table; calls `take` with each entity in order.
pub(super) fn unpack(
    table: &EntityTable,
    reader: &mut SectionReader<'_>,
    file: &Container,
    mut take: impl FnMut(Value) -> Decoded<()>,
) -> Decoded<()> {
    let malformed = |what: &str| {
        file.error_at(
            &codes::MALFORMED,
            format!("table `{}` {what}", table.key.escape_debug()),
            0,
            file.bytes.len(),
        )
    };
    // Read the template index of each entity and count the entities per template.
    let order = reader
        .sections
        .get(table.order)
        .filter(|order| order.holds(ElementType::U32, 1, order.len()));
    let order = order.ok_or_else(|| malformed("has no section for the order of its entities"))?;
    let order: Vec<u32> = (0..order.len()).map(|at| order.u32(at)).collect();
    let mut records = vec![0_usize; table.kinds.len()];
    for kind in &order {
        *records
            .get_mut(*kind as usize)
            .ok_or_else(|| malformed("names a kind that is not there"))? += 1;
    }
    // Find the sections of each template, within the limit on repeated text.
    let mut sources = Vec::new();
    for (kind, records) in table.kinds.iter().zip(records) {
        let size = records.saturating_mul(kind.entity.to_string().len());
        let remaining = reader.text.checked_sub(size);
        reader.text = remaining
            .ok_or_else(|| malformed("repeats more text than the file can have been made from"))?;
        let source = kind
            .source(reader.sections, records)
            .filter(|_| reader.spend(&kind.runs));
        sources
            .push(source.ok_or_else(|| {
                malformed("has sections of another length or kind than declared")
            })?);
    }
    // Fill the templates in order.
    order.iter().try_for_each(|kind| {
        let mut entity = table.kinds[*kind as usize].entity.clone();
        put(&mut entity, &mut sources[*kind as usize]);
        take(entity)
    })
}

/// Iterates over the values that replace the nulls of one template.
struct NullSource<'a> {
    slots: std::iter::Cycle<std::slice::Iter<'a, TemplateSlot>>,
    floats: &'a Section<'a>,
    integers: &'a Section<'a>,
    next_float: usize,
    next_integer: usize,
    runs: std::slice::Iter<'a, ValueSection>,
    sections: &'a [Section<'a>],
}

impl EntityTemplate {
    /// The values of this template, if the sections hold `records` records of them.
    fn source<'a>(&'a self, sections: &'a [Section<'a>], records: usize) -> Option<NullSource<'a>> {
        let Self {
            entity,
            numbers,
            floats,
            integers,
            runs,
        } = self;
        let section = |index: &usize, element, slot| {
            sections
                .get(*index)
                .filter(|section| section.holds(element, count(numbers, slot), records))
        };
        let floats = section(floats, ElementType::F64, TemplateSlot::F64)?;
        let integers = section(integers, ElementType::U32, TemplateSlot::U32)?;
        let fits = nulls(entity) == numbers.len()
            && count(numbers, TemplateSlot::Run).checked_mul(records) == Some(runs.len());
        let (slots, runs) = (numbers.iter().cycle(), runs.iter());
        fits.then_some(NullSource {
            slots,
            floats,
            integers,
            next_float: 0,
            next_integer: 0,
            runs,
            sections,
        })
    }
}

fn nulls(tree: &Value) -> usize {
    match tree {
        Value::Null => 1,
        Value::Bool(_) | Value::String(_) | Value::Number(_) => 0,
        Value::Array(items) => items.iter().map(nulls).sum(),
        Value::Object(members) => members.values().map(nulls).sum(),
    }
}

/// Replaces each null by its value.
fn put(tree: &mut Value, source: &mut NullSource) {
    match tree {
        Value::Bool(_) | Value::String(_) | Value::Number(_) => {}
        Value::Array(items) => items.iter_mut().for_each(|item| put(item, source)),
        Value::Object(members) => members.values_mut().for_each(|member| put(member, source)),
        Value::Null => *tree = source.next(),
    }
}

impl NullSource<'_> {
    fn next(&mut self) -> Value {
        match self
            .slots
            .next()
            .expect("there are as many slots as nulls: checked in `Kind::source`")
        {
            TemplateSlot::F64 => {
                self.next_float += 1;
                run::number(self.floats, self.next_float - 1)
            }
            TemplateSlot::U32 => {
                self.next_integer += 1;
                run::number(self.integers, self.next_integer - 1)
            }
            TemplateSlot::Run => {
                let run = self
                    .runs
                    .next()
                    .expect("there are as many runs as slots: checked in `Kind::source`");
                run.value(&self.sections[run.section])
            }
        }
    }
}
