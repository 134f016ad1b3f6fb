//! Lists of entities as tables of numbers: entities that differ only in their numbers share a kind,
//! and a kind is its tree with a null for each number, each long list of numbers and each long
//! text.
//!
//! No entity of the IR is named here: the tables describe themselves, so a file of an older version
//! yields the tree of that version. Integers stay integers and floats keep every bit.

use super::binary::Container;
use super::run::{self, Run};
use super::section::{Content, ElementType, Section, SectionWriter};
use super::{Decoded, NotFinite, tree};
use rtc_diag::codes;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// One list of the scene.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Table {
    /// Its key in the scene.
    pub(super) key: String,
    /// The section with the kind of each entity, in order.
    order: usize,
    kinds: Vec<EntityShape>,
}

/// Entities that differ only in their numbers.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct EntityShape {
    /// The entity with a null for each number, long list or long text.
    entity: Value,
    /// What each null stands for, in order.
    numbers: Vec<Slot>,
    /// The section with the floats, a record for each entity of this kind.
    floats: usize,
    /// The section with the integers, likewise.
    integers: usize,
    /// Long lists and texts, entity by entity.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    runs: Vec<Run>,
}

/// What a null stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
enum Slot {
    F64,
    U32,
    /// A long list or text, in a section of its own.
    Run,
}

/// What was taken out of the entities of one kind.
#[derive(Default)]
struct Taken {
    slots: Vec<Slot>,
    floats: Vec<u8>,
    integers: Vec<u8>,
    runs: Vec<Run>,
}

/// Moves the numbers of `entities` into sections of `body`; only one entity at a time is a tree.
pub(super) fn pack<T: Serialize>(
    key: &str,
    entities: &[T],
    body: &mut SectionWriter<'_>,
) -> Result<Table, NotFinite> {
    let mut found: BTreeMap<String, u32> = BTreeMap::new();
    let mut kinds: Vec<(Value, Taken)> = Vec::new();
    let mut order = Vec::new();
    for entity in entities {
        let mut entity = tree(entity)?;
        let mut taken = Taken::default();
        take(&mut entity, &mut taken, body);
        let name = format!("{entity}{:?}", taken.slots);
        let next = u32::try_from(found.len())
            .expect("kinds are fewer than entities, whose indices are u32");
        let index = *found.entry(name).or_insert(next);
        order.extend(index.to_le_bytes());
        match kinds.get_mut(index as usize) {
            None => kinds.push((entity, taken)),
            Some((_, earlier)) => {
                earlier.floats.extend(taken.floats);
                earlier.integers.extend(taken.integers);
                earlier.runs.extend(taken.runs);
            }
        }
    }
    let order = body.push(ElementType::U32, 1, Content::Bytes(order.into()));
    let kinds = kinds
        .into_iter()
        .map(|(entity, taken)| store(entity, taken, body))
        .collect();
    Ok(Table {
        key: key.to_owned(),
        order,
        kinds,
    })
}

fn store(entity: Value, taken: Taken, body: &mut SectionWriter<'_>) -> EntityShape {
    let Taken {
        slots: numbers,
        floats,
        integers,
        runs,
    } = taken;
    let floats = body.push(
        ElementType::F64,
        count(&numbers, Slot::F64),
        Content::Bytes(floats.into()),
    );
    let integers = body.push(
        ElementType::U32,
        count(&numbers, Slot::U32),
        Content::Bytes(integers.into()),
    );
    EntityShape {
        entity,
        numbers,
        floats,
        integers,
        runs,
    }
}

fn count(numbers: &[Slot], slot: Slot) -> usize {
    numbers.iter().filter(|kind| **kind == slot).count()
}

/// Replaces each number, long list and long text of the tree by a null. Integers beyond u32 stay:
/// the IR has none.
fn take(tree: &mut Value, taken: &mut Taken, body: &mut SectionWriter<'_>) {
    if let Some(run) = run::store(tree, body) {
        taken.runs.push(run);
        taken.slots.push(Slot::Run);
        *tree = Value::Null;
        return;
    }
    match tree {
        Value::Null | Value::Bool(_) | Value::String(_) => {}
        Value::Array(items) => items.iter_mut().for_each(|item| take(item, taken, body)),
        Value::Object(members) => members
            .values_mut()
            .for_each(|member| take(member, taken, body)),
        Value::Number(number) => {
            if let Some(integer) = run::as_u32(number) {
                taken.integers.extend(integer.to_le_bytes());
                taken.slots.push(Slot::U32);
            } else if let Some(float) = number.as_f64().filter(|_| number.is_f64()) {
                taken.floats.extend(float.to_le_bytes());
                taken.slots.push(Slot::F64);
            } else {
                return;
            }
            *tree = Value::Null;
        }
    }
}

/// The sections of a file, and how much more may be made of them: memory stays within a constant
/// times its length.
pub(super) struct Stock<'a> {
    sections: &'a [Section<'a>],
    /// Which sections a run, a column or an image was made of: no two may be made of one.
    spent: Vec<bool>,
    /// How many bytes of text the kinds may still repeat.
    text: usize,
}

impl<'a> Stock<'a> {
    pub(super) fn new(sections: &'a [Section<'a>], file: &Container<'_>) -> Self {
        Self {
            sections,
            spent: vec![false; sections.len()],
            text: file.bytes.len().saturating_mul(8),
        }
    }

    /// The section, unless something else was made of it before.
    pub(super) fn take(&mut self, section: usize) -> Option<&'a Section<'a>> {
        let spent = self.spent.get_mut(section)?;
        (!std::mem::replace(spent, true)).then(|| &self.sections[section])
    }

    /// True for runs that are sound and of sections that nothing else is made of.
    fn spend(&mut self, runs: &[Run]) -> bool {
        runs.iter().all(|run| {
            self.take(run.section)
                .is_some_and(|section| run.is_sound(section))
        })
    }
}

/// Hands on each entity of the list a table was packed from.
pub(super) fn unpack(
    table: &Table,
    stock: &mut Stock<'_>,
    file: &Container,
    mut take: impl FnMut(Value) -> Decoded<()>,
) -> Decoded<()> {
    let malformed = |what: &str| {
        file.fault(
            &codes::MALFORMED,
            format!("table `{}` {what}", table.key.escape_debug()),
            0,
            file.bytes.len(),
        )
    };
    let order = stock
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
    let mut sources = Vec::new();
    for (kind, records) in table.kinds.iter().zip(records) {
        let size = records.saturating_mul(kind.entity.to_string().len());
        let left = stock.text.checked_sub(size);
        stock.text = left
            .ok_or_else(|| malformed("repeats more text than the file can have been made from"))?;
        let source = kind
            .source(stock.sections, records)
            .filter(|_| stock.spend(&kind.runs));
        sources.push(
            source
                .ok_or_else(|| malformed("has sections of another length or kind than it says"))?,
        );
    }
    order.iter().try_for_each(|kind| {
        let mut entity = table.kinds[*kind as usize].entity.clone();
        put(&mut entity, &mut sources[*kind as usize]);
        take(entity)
    })
}

/// Where what the nulls of one kind stand for is read from.
struct NullSource<'a> {
    slots: std::iter::Cycle<std::slice::Iter<'a, Slot>>,
    floats: &'a Section<'a>,
    integers: &'a Section<'a>,
    next_float: usize,
    next_integer: usize,
    runs: std::slice::Iter<'a, Run>,
    sections: &'a [Section<'a>],
}

impl EntityShape {
    /// The source of this kind's numbers, if the sections hold `records` records of them.
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
        let floats = section(floats, ElementType::F64, Slot::F64)?;
        let integers = section(integers, ElementType::U32, Slot::U32)?;
        let fits = nulls(entity) == numbers.len()
            && count(numbers, Slot::Run).checked_mul(records) == Some(runs.len());
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

/// Replaces each null by what it stands for.
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
            Slot::F64 => {
                self.next_float += 1;
                run::number(self.floats, self.next_float - 1)
            }
            Slot::U32 => {
                self.next_integer += 1;
                run::number(self.integers, self.next_integer - 1)
            }
            Slot::Run => {
                let run = self
                    .runs
                    .next()
                    .expect("there are as many runs as slots: checked in `Kind::source`");
                run.value(&self.sections[run.section])
            }
        }
    }
}
