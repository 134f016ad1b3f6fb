//! Long lists of numbers and long strings, each in its own section; in older files also the pixels
//! of images and the vertices of meshes.
//!
//! They are found by their values alone; no entity of the IR is named here.

use super::section::{ElementType, Section, SectionContent, SectionWriter};
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};

/// Longer lists get their own section.
const LONG_LIST: usize = 32;

/// Longer strings, in bytes, get their own section.
const LONG_TEXT: usize = 256;

/// A section that is one value: a string, a list of numbers, or a list of lists with one record
/// each.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ValueSection {
    pub(super) section: usize,
    /// Each record is a list.
    nested: bool,
}

/// Puts the value into a section if it is long and uniform.
pub(super) fn store(value: &Value, body: &mut SectionWriter<'_>) -> Option<ValueSection> {
    match value {
        Value::String(text) if text.len() > LONG_TEXT => {
            let bytes = SectionContent::Bytes(text.as_bytes().to_vec().into());
            Some(ValueSection {
                section: body.push(ElementType::U8, 1, bytes),
                nested: false,
            })
        }
        Value::Array(items) if items.len() > LONG_LIST => {
            let stride = items[0].as_array().map(Vec::len);
            let (element, bytes) = numbers(items, stride)?;
            Some(ValueSection {
                section: body.push(
                    element,
                    stride.unwrap_or(1),
                    SectionContent::Bytes(bytes.into()),
                ),
                nested: stride.is_some(),
            })
        }
        Value::Null
        | Value::Bool(_)
        | Value::Number(_)
        | Value::String(_)
        | Value::Array(_)
        | Value::Object(_) => None,
    }
}

/// The bytes of all numbers, if each item is a number, or a list of `stride` numbers, and all have
/// one type.
fn numbers(items: &[Value], stride: Option<usize>) -> Option<(ElementType, Vec<u8>)> {
    // Flatten the list; all records must have the same length.
    let mut flat = Vec::with_capacity(items.len());
    for item in items {
        match (item, stride) {
            (Value::Number(number), None) => flat.push(number),
            (Value::Array(inner), Some(stride)) if inner.len() == stride && stride > 0 => {
                for number in inner {
                    flat.push(as_number(number)?);
                }
            }
            (_, _) => return None,
        }
    }
    // Integers, if all of them are.
    let integers: Option<Vec<u32>> = flat.iter().map(|number| as_u32(number)).collect();
    if let Some(integers) = integers {
        return Some((
            ElementType::U32,
            integers
                .iter()
                .flat_map(|number| number.to_le_bytes())
                .collect(),
        ));
    }
    // Otherwise floats.
    let floats: Option<Vec<f64>> = flat
        .iter()
        .map(|number| number.as_f64().filter(|_| number.is_f64()))
        .collect();
    floats.map(|floats| {
        (
            ElementType::F64,
            floats
                .iter()
                .flat_map(|number| number.to_le_bytes())
                .collect(),
        )
    })
}

fn as_number(value: &Value) -> Option<&Number> {
    match value {
        Value::Number(number) => Some(number),
        Value::Null | Value::Bool(_) | Value::String(_) | Value::Array(_) | Value::Object(_) => {
            None
        }
    }
}

/// The number, if it is an integer of 32 bits.
pub(super) fn as_u32(number: &Number) -> Option<u32> {
    number
        .as_u64()
        .and_then(|integer| u32::try_from(integer).ok())
}

/// Element `at` of a section of numbers.
pub(super) fn number(section: &Section<'_>, at: usize) -> Value {
    match section.element {
        ElementType::F64 => Number::from_f64(section.f64(at))
            .map(Value::Number)
            .expect("sections hold finite numbers: checked on opening"),
        ElementType::U32 => Value::from(section.u32(at)),
        ElementType::F32 | ElementType::U8 => {
            unreachable!(
                "tables hold no such numbers: refused in `Run::is_sound` and `Section::holds`"
            )
        }
    }
}

impl ValueSection {
    /// Whether the section holds a valid value of this run.
    pub(super) fn is_sound(&self, section: &Section<'_>) -> bool {
        match section.element {
            ElementType::U8 => !self.nested && section.stride == 1 && section.as_str().is_some(),
            ElementType::F32 => false,
            ElementType::F64 | ElementType::U32 => {
                section.stride > 0 && (self.nested || section.stride == 1)
            }
        }
    }

    /// The value of a section for which [`ValueSection::is_sound`] holds.
    pub(super) fn value(&self, section: &Section<'_>) -> Value {
        if let Some(text) = section.as_str() {
            return Value::from(text);
        }
        let numbers =
            |range: std::ops::Range<usize>| range.map(|at| number(section, at)).collect::<Value>();
        if !self.nested {
            return numbers(0..section.len());
        }
        let stride = section.stride;
        (0..section.len() / stride)
            .map(|record| numbers(record * stride..(record + 1) * stride))
            .collect()
    }
}
