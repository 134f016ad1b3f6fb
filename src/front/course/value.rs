//! The other value types of the format: vectors, colours, booleans, switches and strings.

use super::decode::{Decode, DecodeContext, describe};
use super::keyword::{KeywordTable, keyword_schema};
use super::number::{is_number, json_number, number, plain_number, radians};
use super::schema::SchemaDefinitions;
use super::suggestion::{as_list, decimal_commas};
use rtc_diag::{clip, codes, nearest};
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

/// Reads a list of exactly `N` items, each with `item`. All items are read, so that one mistake
/// does not hide another.
pub(super) fn tuple<T, const N: usize>(
    node: NodeId,
    what: &str,
    context: &mut DecodeContext<'_>,
    item: impl FnMut(NodeId, &mut DecodeContext<'_>) -> Option<T>,
) -> Option<[T; N]> {
    list(node, N, what, context, item)?.try_into().ok()
}

/// As [`tuple()`], of a number of items that is no constant.
pub(super) fn list<T>(
    node: NodeId,
    expected: usize,
    what: &str,
    context: &mut DecodeContext<'_>,
    mut item: impl FnMut(NodeId, &mut DecodeContext<'_>) -> Option<T>,
) -> Option<Vec<T>> {
    let tree = context.tree;
    if !tree.is_list(node) {
        return context.expected(node, what);
    }
    // Aliases can repeat a very long list many times, so count no further than needed.
    let count = tree.items(node).take(expected + 1).count();
    if count != expected {
        wrong_length(node, count, expected, context);
        return None;
    }
    let read: Vec<_> = tree.items(node).map(|node| item(node, context)).collect();
    read.into_iter().collect()
}

/// Reports a list that has `count` items instead of `expected`.
fn wrong_length(node: NodeId, count: usize, expected: usize, context: &mut DecodeContext<'_>) {
    let (tree, key) = (context.tree, context.key);
    let span = tree.span(node);
    let found = if count > expected {
        format!("more than {expected}")
    } else {
        format!("{count}")
    };
    let written = tree.written(node);
    let suggestion = match count > expected {
        true => decimal_commas(written, expected).map(|list| ("decimals follow a point", list)),
        false => as_list(written, expected).map(|list| ("separate them by commas", list)),
    };
    let message = || {
        format!(
            "`{}` must have {expected} numbers, not {found}",
            clip(key.text)
        )
    };
    context.report(&codes::WRONG_LENGTH, span, message, |d| {
        let diagnostic = d.at(span, format!("{found} here"));
        match suggestion {
            Some((hint, list)) => diagnostic.replace(hint, span, list),
            None => diagnostic,
        }
    });
}

/// Declares a type of the format: a list of a few numbers, each read by a function.
macro_rules! numbers {
    ($(#[doc = $doc:literal])+ $name:ident, $count:literal, $what:literal, $item:tt $(, $read:path)?) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name(pub(super) [f64; $count]);

        impl Decode for $name {
            const IS_LIST: bool = true;

            fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
                tuple(node, $what, context, |node, context| {
                    let number = number(node, $what, context)?;
                    $(let number = $read(number, node, context);)?
                    Some(number)
                })
                .map(Self)
            }

            fn schema(_: &mut SchemaDefinitions) -> Json {
                json!({ "type": "array", "items": $item, "minItems": $count, "maxItems": $count })
            }

            fn json(&self) -> Json {
                self.0.map(json_number).to_vec().into()
            }
        }

        impl From<[f64; $count]> for $name {
            fn from(numbers: [f64; $count]) -> Self {
                Self(numbers)
            }
        }
    };
}

pub(super) use numbers;

numbers! {
    /// A point.
    Point, 3, "a list of three numbers",
    { "type": "number", "minimum": -1e60, "maximum": 1e60, "x-unit": "scene units" }
}

numbers! {
    /// A direction; the key that takes it says whether its length matters.
    Vector, 3, "a list of three numbers",
    { "type": "number", "minimum": -1e60, "maximum": 1e60 }
}

numbers! {
    /// Three angles in radians.
    Angles, 3, "a list of three numbers",
    { "type": "number", "minimum": -1e60, "maximum": 1e60, "x-unit": "radians" }, radians
}

numbers! {
    /// Red, green and blue, each at least 0; values above 1 are allowed.
    Color, 3, "a list of three numbers",
    { "type": "number", "minimum": 0 }
}

numbers! {
    /// When a shutter opens and closes, in seconds.
    Shutter, 2, "a list of two numbers",
    { "type": "number", "minimum": -1e60, "maximum": 1e60 }
}

/// Declares a type of the format: a list of three numbers, or one number for all three.
macro_rules! spread {
    ($(#[doc = $doc:literal])+ $name:ident, $item:tt) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name(pub(super) [f64; 3]);

        impl Decode for $name {
            const IS_LIST: bool = true;

            fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
                const WHAT: &str = "a number or a list of three numbers";
                match context.tree.shape(node) {
                    NodeContent::List => {
                        tuple(node, WHAT, context, |node, context| number(node, WHAT, context))
                            .map(Self)
                    }
                    NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::Map => {
                        number(node, WHAT, context).map(|number| Self([number; 3]))
                    }
                }
            }

            fn schema(_: &mut SchemaDefinitions) -> Json {
                let number = json!($item);
                let mut list = json!({ "type": "array", "items": number });
                (list["minItems"], list["maxItems"]) = (json!(3), json!(3));
                json!({ "anyOf": [number, list] })
            }

            fn json(&self) -> Json {
                json_number(self.0[0])
            }
        }
    };
}

spread! {
    /// Red, green and blue, or one number for grey; each at least 0.
    Channels, { "type": "number", "minimum": 0, "maximum": 1e60 }
}

spread! {
    /// A scale factor for each of x, y and z, or one factor for all.
    Scale, { "type": "number", "minimum": -1e60, "maximum": 1e60 }
}

/// Texture coordinates (u, v).
#[derive(Clone, Copy, Debug)]
pub(super) struct Uv(pub(super) [f64; 2]);

impl Decode for Uv {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        const WHAT: &str = "a list of two numbers";
        tuple(node, WHAT, context, |node, context| {
            number(node, WHAT, context)
        })
        .map(Self)
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 })
    }
}

/// Booleans that some files write as numbers.
const NUMBERED: &[(u8, &str, bool)] = &[(0, "false", false), (1, "true", true)];

impl Decode for bool {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        // A number instead of a boolean.
        let value = plain_number(node, context);
        if let Some((_, scalar, boolean)) = NUMBERED
            .iter()
            .find(|(number, ..)| value == Some(f64::from(*number)))
        {
            context.record_spelling(
                if *boolean { "1" } else { "0" },
                scalar,
                context.tree.span(node),
            );
            return Some(*boolean);
        }
        let Some(text) = context.tree.text(node) else {
            return context.expected(node, "`true` or `false`");
        };
        match (context.tree.shape(node), text) {
            (NodeContent::Word(_), "true" | "True" | "TRUE") => return Some(true),
            (NodeContent::Word(_), "false" | "False" | "FALSE") => return Some(false),
            _ => {}
        }
        // A boolean of YAML 1.1, or one in quotes.
        let suggestion = match text.to_ascii_lowercase().as_str() {
            "true" | "yes" | "y" | "on" => "true",
            "false" | "no" | "n" | "off" => "false",
            _ => return misspelt_boolean(text, node, context),
        };
        let (key, span) = (context.key, context.tree.span(node));
        let found = describe(context.tree.shape(node));
        let message = || {
            format!(
                "`{}` must be `true` or `false`, not {found}",
                clip(key.text)
            )
        };
        let label = match context.tree.shape(node) {
            NodeContent::Text(_) => "a string, because of the quotes",
            NodeContent::Word(_) | NodeContent::List | NodeContent::Map => {
                "not a boolean in YAML 1.2"
            }
        };
        context.report(&codes::WRONG_TYPE, span, message, |d| {
            d.at(span, label)
                .replace(format!("write `{suggestion}`"), span, suggestion)
        });
        None
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        let numbers: Vec<_> = NUMBERED
            .iter()
            .map(|(number, ..)| json!({ "const": number, "deprecated": true }))
            .collect();
        let mut schema = json!({ "anyOf": [{ "type": "boolean" }] });
        schema["anyOf"]
            .as_array_mut()
            .into_iter()
            .for_each(|variants| variants.extend(numbers.clone()));
        schema
    }

    fn json(&self) -> Json {
        json!(self)
    }
}

/// Words for booleans that are nearly what is written.
const BOOLEANS: [(&str, &str); 6] = [
    ("true", "true"),
    ("false", "false"),
    ("enabled", "true"),
    ("disabled", "false"),
    ("enable", "true"),
    ("disable", "false"),
];

/// Reports a word that is no boolean, with the one that was probably meant. Always `None`.
fn misspelt_boolean(text: &str, node: NodeId, context: &mut DecodeContext<'_>) -> Option<bool> {
    const WHAT: &str = "`true` or `false`";
    let word = nearest(text, BOOLEANS.iter().map(|(word, _)| *word));
    let Some((_, meaning)) = BOOLEANS.iter().find(|(known, _)| Some(*known) == word) else {
        return context.expected(node, WHAT);
    };
    let (key, span) = (context.key, context.tree.span(node));
    let found = describe(context.tree.shape(node));
    let message = || format!("`{}` must be {WHAT}, not {found}", clip(key.text));
    context.report(&codes::WRONG_TYPE, span, message, |d| {
        d.at(span, found.clone())
            .guess(format!("did you mean `{meaning}`?"), span, *meaning)
    });
    None
}

/// A switch: `On`, `Off`, or a boolean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Switch(pub(super) bool);

/// The keywords of a switch.
const SWITCH_KEYWORDS: KeywordTable<bool> = &[("on", true, "Yes."), ("off", false, "No.")];

impl Decode for Switch {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let written = context.tree.text(node).unwrap_or_default();
        let known = SWITCH_KEYWORDS
            .iter()
            .find(|(scalar, ..)| scalar.eq_ignore_ascii_case(written));
        match known {
            Some((_, is_on, _)) => Some(Self(*is_on)),
            None => bool::decode(node, context).map(Self),
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let mut schema = keyword_schema(SWITCH_KEYWORDS);
        let variants = schema["anyOf"].as_array_mut();
        variants
            .into_iter()
            .for_each(|variants| variants.push(bool::schema(definitions)));
        schema
    }
}

/// Any scalar; its value is not used.
#[derive(Clone, Copy, Debug)]
pub(super) struct AnyScalar;

impl Decode for AnyScalar {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Word(_) | NodeContent::Text(_) => Some(Self),
            NodeContent::List | NodeContent::Map => context.expected(node, "text"),
        }
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        json!({ "type": ["string", "number", "boolean", "null"] })
    }
}

/// A name for people to read: any scalar.
#[derive(Clone, Debug)]
pub(super) struct DisplayName(pub(super) String);

impl Decode for DisplayName {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Word(text) | NodeContent::Text(text) => Some(Self(text.to_owned())),
            NodeContent::List | NodeContent::Map => context.expected(node, "text"),
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        AnyScalar::schema(definitions)
    }
}

/// The name of a file, or a keyword instead.
#[derive(Clone, Debug)]
pub(super) struct FileName(pub(super) String);

impl Decode for FileName {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Word(scalar) if is_string(scalar) => Some(Self(scalar.to_owned())),
            NodeContent::Text(text) if !text.is_empty() => Some(Self(text.to_owned())),
            NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List | NodeContent::Map => {
                context.expected(node, "the name of a file")
            }
        }
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        json!({ "title": FILE, "type": "string", "minLength": 1 })
    }
}

/// The title of file names in the schema. Editors complete files for it.
pub const FILE: &str = "file";

/// Whether an unquoted scalar is a string by the core schema: no number, no boolean and not null.
fn is_string(scalar: &str) -> bool {
    !is_number(scalar)
        && !matches!(
            scalar,
            "" | "~"
                | "null"
                | "Null"
                | "NULL"
                | "true"
                | "True"
                | "TRUE"
                | "false"
                | "False"
                | "FALSE"
        )
}
