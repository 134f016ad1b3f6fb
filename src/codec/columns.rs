//! Lists of entities as tables of numbers: entities that differ only in their numbers share a kind, and a kind is its
//! tree with a null for each number.
//!
//! No entity of the IR is named here: the tables describe themselves, so a file of an older version yields the tree of
//! that version. Integers stay integers and floats keep every bit.

use super::Decoded;
use super::binary::Container;
use super::section::{Body, Element, Section};
use crate::diag::codes;
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};
use std::collections::BTreeMap;

/// One list of the scene.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Table {
    /// Its key in the scene.
    pub(super) key: String,
    /// The section with the kind of each entity, in order.
    order: usize,
    kinds: Vec<Kind>,
}

/// Entities that differ only in their numbers.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Kind {
    /// The entity with a null for each number.
    entity: Value,
    /// What each null stands for, in order.
    numbers: Vec<Element>,
    /// The section with the floats, a record for each entity of this kind.
    floats: usize,
    /// The section with the integers, likewise.
    integers: usize,
}

/// The numbers taken out of the entities of one kind.
#[derive(Default)]
struct Numbers {
    kinds: Vec<Element>,
    floats: Vec<u8>,
    integers: Vec<u8>,
}

/// Moves the numbers of `entities` into sections of `body`.
pub(super) fn pack(key: String, entities: Vec<Value>, body: &mut Body) -> Table {
    let mut found: BTreeMap<String, u32> = BTreeMap::new();
    let mut kinds: Vec<(Value, Numbers)> = Vec::new();
    let mut order = Vec::new();
    for mut entity in entities {
        let mut numbers = Numbers::default();
        take(&mut entity, &mut numbers);
        let name = format!("{entity}{:?}", numbers.kinds);
        let next = u32::try_from(found.len()).expect("kinds are fewer than entities, whose indices are u32");
        let index = *found.entry(name).or_insert(next);
        order.extend(index.to_le_bytes());
        match kinds.get_mut(index as usize) {
            None => kinds.push((entity, numbers)),
            Some((_, earlier)) => {
                earlier.floats.extend(numbers.floats);
                earlier.integers.extend(numbers.integers);
            }
        }
    }
    let order = body.push(Element::U32, 1, &order);
    let kinds = kinds.into_iter().map(|(entity, numbers)| store(entity, numbers, body)).collect();
    Table { key, order, kinds }
}

fn store(entity: Value, numbers: Numbers, body: &mut Body) -> Kind {
    let Numbers { kinds: numbers, floats, integers } = numbers;
    let floats = body.push(Element::F64, count(&numbers, Element::F64), &floats);
    let integers = body.push(Element::U32, count(&numbers, Element::U32), &integers);
    Kind { entity, numbers, floats, integers }
}

fn count(numbers: &[Element], element: Element) -> usize {
    numbers.iter().filter(|kind| **kind == element).count()
}

/// Replaces each number of the tree by a null. Integers beyond u32 stay: the IR has none.
fn take(tree: &mut Value, numbers: &mut Numbers) {
    match tree {
        Value::Null | Value::Bool(_) | Value::String(_) => {}
        Value::Array(items) => items.iter_mut().for_each(|item| take(item, numbers)),
        Value::Object(members) => members.values_mut().for_each(|member| take(member, numbers)),
        Value::Number(number) => {
            let integer = number.as_u64().and_then(|integer| u32::try_from(integer).ok());
            if let Some(integer) = integer {
                numbers.integers.extend(integer.to_le_bytes());
                numbers.kinds.push(Element::U32);
            } else if let Some(float) = number.as_f64().filter(|_| number.is_f64()) {
                numbers.floats.extend(float.to_le_bytes());
                numbers.kinds.push(Element::F64);
            } else {
                return;
            }
            *tree = Value::Null;
        }
    }
}

/// The list a table was packed from. Memory stays within a constant times the length of the file.
pub(super) fn unpack(table: &Table, sections: &[Section], file: &Container) -> Decoded<Vec<Value>> {
    let malformed = |what: &str| {
        file.fault(&codes::MALFORMED, format!("table `{}` {what}", table.key.escape_debug()), 0, file.bytes.len())
    };
    let order = sections.get(table.order).filter(|order| order.holds(Element::U32, 1, order.len()));
    let order = order.ok_or_else(|| malformed("has no section for the order of its entities"))?;
    let order: Vec<u32> = (0..order.len()).map(|at| order.u32(at)).collect();
    let mut records = vec![0_usize; table.kinds.len()];
    for kind in &order {
        *records.get_mut(*kind as usize).ok_or_else(|| malformed("names a kind that is not there"))? += 1;
    }
    let mut sources = Vec::new();
    let mut size = 0_usize;
    for (kind, records) in table.kinds.iter().zip(records) {
        size = size.saturating_add(records.saturating_mul(kind.entity.to_string().len()));
        let source = kind.source(sections, records);
        sources.push(source.ok_or_else(|| malformed("has sections of another length than it says"))?);
    }
    if size > 8 * file.bytes.len() {
        return Err(malformed("repeats more text than the file can have been made from"));
    }
    let mut entity = |kind: &u32| {
        let mut entity = table.kinds[*kind as usize].entity.clone();
        put(&mut entity, &mut sources[*kind as usize]);
        entity
    };
    Ok(order.iter().map(&mut entity).collect())
}

/// Where the numbers of one kind are read from.
struct Source<'a> {
    numbers: std::iter::Cycle<std::slice::Iter<'a, Element>>,
    floats: &'a Section<'a>,
    integers: &'a Section<'a>,
    next_float: usize,
    next_integer: usize,
}

impl Kind {
    /// The source of this kind's numbers, if the sections hold `records` records of them.
    fn source<'a>(&'a self, sections: &'a [Section<'a>], records: usize) -> Option<Source<'a>> {
        let Self { entity, numbers, floats, integers } = self;
        let section = |index: &usize, element| {
            sections.get(*index).filter(|section| section.holds(element, count(numbers, element), records))
        };
        let (floats, integers) = (section(floats, Element::F64)?, section(integers, Element::U32)?);
        let source = Source { numbers: numbers.iter().cycle(), floats, integers, next_float: 0, next_integer: 0 };
        (nulls(entity) == numbers.len()).then_some(source)
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

/// Replaces each null by the next number.
fn put(tree: &mut Value, source: &mut Source) {
    match tree {
        Value::Bool(_) | Value::String(_) | Value::Number(_) => {}
        Value::Array(items) => items.iter_mut().for_each(|item| put(item, source)),
        Value::Object(members) => members.values_mut().for_each(|member| put(member, source)),
        Value::Null => *tree = source.next(),
    }
}

impl Source<'_> {
    fn next(&mut self) -> Value {
        match self.numbers.next().expect("there are as many numbers as nulls: checked in `Kind::source`") {
            Element::F64 => {
                self.next_float += 1;
                let number = Number::from_f64(self.floats.f64(self.next_float - 1));
                Value::Number(number.expect("sections hold finite numbers: checked on opening"))
            }
            Element::U32 => {
                self.next_integer += 1;
                Value::from(self.integers.u32(self.next_integer - 1))
            }
        }
    }
}
