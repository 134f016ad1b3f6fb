//! Records: the maps of the format. [`record!`] declares each one once; from the declaration
//! come its type, its decoder and its schema.
//!
//! A field holds one value, or a group of values that are written with several keys. A field may
//! have several spellings, the canonical one first; the declaration marks those of the course's
//! JSON files, and those that only rtc has (`own true`). Every key of a map is either read by one
//! field or reported.

use super::decode::{Decode, DecodeContext, MapEntry, Spanned, ValueKey};
use super::schema::SchemaDefinitions;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// The spellings of a field, the canonical one first. Each is a group of keys; all groups of a
/// field have the same length.
pub(super) type Spellings = &'static [&'static [&'static str]];

/// Whether a field is required.
pub(super) enum FieldRequirement {
    Required,
    Optional,
    /// Required, unless the field of this name is present.
    Unless(&'static str),
    /// Optional with this default, as the schema shows it.
    Default(fn() -> Json),
}

/// The declaration of a field.
pub(super) struct FieldDeclaration {
    pub(super) name: &'static str,
    pub(super) doc: &'static str,
    pub(super) spellings: Spellings,
    /// The spellings in the JSON files of the course, by their first keys.
    pub(super) json: &'static [&'static str],
    pub(super) requirement: FieldRequirement,
    /// Whether only rtc gives the key this meaning: no sheet of the course has it, and a file that
    /// is older may mean something else by it. A value that is none of rtc's is a warning.
    pub(super) is_own: bool,
    /// The schema of each value of the field.
    pub(super) schema: fn(&mut SchemaDefinitions) -> Json,
}

/// The declaration of a record.
pub(super) struct Record {
    pub(super) name: &'static str,
    pub(super) doc: &'static str,
    pub(super) fields: &'static [FieldDeclaration],
    /// The variants of the record: sets of fields, of which exactly one must be present. Empty if
    /// any fields may be combined.
    pub(super) variants: &'static [&'static [&'static str]],
    /// Whether the lowering checks the variants, because it has a better message or a repair.
    pub(super) variants_are_lowered: bool,
}

/// A type that is read from a map of its declaration.
pub(super) trait HasRecord: Sized {
    /// The declaration.
    const RECORD: &'static Record;

    /// Reads the map as one of this declaration, which may differ in name and description.
    fn read(record: &'static Record, node: NodeId, context: &mut DecodeContext<'_>)
    -> Option<Self>;
}

/// A type that is read from the keys of another declaration, by a name of its own.
pub(super) trait SameKeys: Sized {
    /// The type of that declaration.
    type Keys: HasRecord;
    /// The name of this one.
    const NAME: &'static str;
    /// Its description.
    const DOC: &'static str;

    /// From the values of the keys.
    fn from_keys(keys: Self::Keys) -> Self;
}

impl<T: SameKeys> HasRecord for T {
    const RECORD: &'static Record = &Record {
        name: T::NAME,
        doc: T::DOC,
        ..*T::Keys::RECORD
    };

    fn read(
        record: &'static Record,
        node: NodeId,
        context: &mut DecodeContext<'_>,
    ) -> Option<Self> {
        T::Keys::read(record, node, context).map(Self::from_keys)
    }
}

/// Declares a record: the struct, its decoder and its schema.
macro_rules! record {
    (
        $(#[doc = $doc:literal])+
        struct $name:ident, $record_name:literal {
            $(
                $(#[doc = $field_doc:literal])+
                $field:ident: $type:ty, $requirement:ident $(($default:expr))?, $spellings:expr
                    $(, json $json:literal)* $(, own $own:literal)?;
            )+
        }
        $(variants { $([$($member:ident)+])+ })?
        $(lowered_variants { $([$($lowered:ident)+])+ })?
    ) => {
        $(#[doc = $doc])+
        pub(crate) struct $name {
            $($(#[doc = $field_doc])+ pub(crate)
                $field: record!(@type $requirement $type),)+
        }

        impl $crate::course::record::HasRecord for $name {
            const RECORD: &'static $crate::course::record::Record =
                &$crate::course::record::Record {
                name: $record_name,
                doc: concat!($($doc),+),
                fields: &[$($crate::course::record::FieldDeclaration {
                    name: stringify!($field),
                    doc: concat!($($field_doc),+),
                    spellings: $spellings,
                    json: &[$($json),*],
                    requirement: record!(@requirement $requirement $type $(, $default)?),
                    is_own: false $(|| $own)?,
                    schema: <$type as $crate::course::record::FieldValue>::schema,
                }),+],
                variants: &[
                    $($(&[$(stringify!($member)),+]),+)?
                    $($(&[$(stringify!($lowered)),+]),+)?
                ],
                variants_are_lowered: !<[&str]>::is_empty(&[$($($(stringify!($lowered)),+),+)?]),
            };

            fn read(
                record: &'static $crate::course::record::Record,
                node: rtc_source::tree::NodeId,
                context: &mut $crate::course::decode::DecodeContext<'_>,
            ) -> Option<Self> {
                let mut reader = $crate::course::reader::MapReader::open(record, node, context)?;
                $(let $field = reader.next::<$type>(context);)+
                reader.close(context).then_some(())?;
                Some(Self { $($field: record!(@value $requirement $field $(, $default)?)),+ })
            }
        }

        impl $crate::course::decode::Decode for $name {
            fn decode(
                node: rtc_source::tree::NodeId,
                context: &mut $crate::course::decode::DecodeContext<'_>,
            ) -> Option<Self> {
                use $crate::course::record::HasRecord;
                Self::read(Self::RECORD, node, context)
            }

            fn schema(
                definitions: &mut $crate::course::schema::SchemaDefinitions,
            ) -> serde_json::Value {
                use $crate::course::record::HasRecord;
                $crate::course::schema::record(Self::RECORD, definitions)
            }
        }
    };
    (@type optional $type:ty) => { $crate::course::record::FieldResult<$type> };
    (@type unless $type:ty) => { $crate::course::record::FieldResult<$type> };
    (@type $requirement:ident $type:ty) => { $type };
    (@requirement required $type:ty) => { $crate::course::record::FieldRequirement::Required };
    (@requirement optional $type:ty) => { $crate::course::record::FieldRequirement::Optional };
    (@requirement unless $type:ty, $other:expr) => {
        $crate::course::record::FieldRequirement::Unless($other)
    };
    (@requirement default $type:ty, $default:expr) => {
        $crate::course::record::FieldRequirement::Default(|| {
            $crate::course::decode::Decode::json(&$default)
        })
    };
    (@value required $found:ident) => { $found.ok()? };
    (@value optional $found:ident) => { $found };
    (@value unless $found:ident, $other:expr) => { $found };
    (@value default $found:ident, $default:expr) => {
        $found.ok().unwrap_or_else(|| $crate::course::decode::Spanned::without_span($default))
    };
}

pub(super) use record;

/// The result of reading a field.
#[derive(Clone, Copy, Debug)]
pub(super) enum FieldResult<T> {
    /// The field is not present.
    Absent,
    /// The field is present but can't be read, which was reported.
    Broken,
    /// The field was read.
    Read(T),
}

impl<T> FieldResult<T> {
    pub(super) fn ok(self) -> Option<T> {
        match self {
            Self::Read(value) => Some(value),
            Self::Absent | Self::Broken => None,
        }
    }

    pub(super) fn is_absent(&self) -> bool {
        matches!(self, Self::Absent)
    }

    pub(super) fn is_broken(&self) -> bool {
        matches!(self, Self::Broken)
    }

    /// The value, if it was read.
    pub(super) fn read(&self) -> Option<&T> {
        match self {
            Self::Read(value) => Some(value),
            Self::Absent | Self::Broken => None,
        }
    }
}

/// The content of a field: one value, or a group of values.
pub(super) trait FieldValue: Sized {
    /// Reads the values of the entries of these indices. `None` if one of them can't be read, which
    /// is reported.
    fn take(entries: &[usize], context: &mut DecodeContext<'_>) -> Option<Self>;

    /// The schema of each value.
    fn schema(definitions: &mut SchemaDefinitions) -> Json;
}

impl<T: Decode> FieldValue for Spanned<T> {
    fn take(entries: &[usize], context: &mut DecodeContext<'_>) -> Option<Self> {
        let MapEntry {
            key: text,
            key_node,
            value: node,
            claimed: _,
        } = context.entries[*entries.first()?];
        let tree = context.tree;
        let key = tree.span(key_node);
        context.key = ValueKey {
            text,
            span: Some(key),
        };
        let node = if T::IS_LIST {
            node
        } else {
            only_item(node, context)
        };
        let value = T::decode(node, context)?;
        let span = if tree.is_map(node) {
            key
        } else {
            tree.span(node)
        };
        Some(Self {
            value,
            span: Some(span),
        })
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        one_or_only(T::schema(definitions), T::IS_LIST)
    }
}

impl<T: Decode, const N: usize> FieldValue for [Spanned<T>; N] {
    fn take(entries: &[usize], context: &mut DecodeContext<'_>) -> Option<Self> {
        // Collected first, so that a mistake in one value does not hide those in others.
        let read: Vec<_> = entries
            .chunks(1)
            .map(|entry| Spanned::take(entry, context))
            .collect();
        let read: Option<Vec<_>> = read.into_iter().collect();
        read?.try_into().ok()
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        one_or_only(T::schema(definitions), T::IS_LIST)
    }
}

/// The item of a list of one item, as some files write single values; any other node unchanged.
fn only_item(node: NodeId, context: &mut DecodeContext<'_>) -> NodeId {
    let tree = context.tree;
    if !tree.is_list(node) {
        return node;
    }
    let mut items = tree.items(node);
    match (items.next(), items.next()) {
        (Some(item), None) if !tree.is_list(item) => {
            context.record_spelling("[x]", "x", tree.span(node));
            item
        }
        _ => node,
    }
}

/// The schema of a value or of a list of that one value.
fn one_or_only(schema: Json, is_list: bool) -> Json {
    if is_list {
        return schema;
    }
    let mut only = json!({ "type": "array", "items": schema, "minItems": 1, "maxItems": 1 });
    only["deprecated"] = json!(true);
    json!({ "anyOf": [schema, only] })
}
