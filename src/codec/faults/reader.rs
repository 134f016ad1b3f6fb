//! Decodes values from the nodes of a tree; a wrong node yields a placeholder.

use super::access::{NodeListAccess, NodeMapAccess, NodeVariantAccess};
use super::error::NodeError;
use super::{ErrorCollector, FieldNames, NodePart};
use rtc_source::tree::{NodeId, NodeKind};
use serde::de::{Deserializer, Error as _, Expected, Unexpected, Visitor};

/// Decodes a node, or yields a placeholder if there is none.
#[derive(Clone, Copy)]
pub(super) struct NodeReader<'n, 't> {
    pub(super) notes: &'n ErrorCollector<'t>,
    pub(super) at: Option<NodeId>,
}

/// A JSON number, as `serde_json` classifies it.
#[derive(Clone, Copy)]
enum JsonNumber {
    Unsigned(u64),
    Signed(i64),
    Float(f64),
}

impl JsonNumber {
    fn of(written: &str) -> Self {
        let is_integer = written
            .bytes()
            .all(|byte| byte == b'-' || byte.is_ascii_digit());
        let unsigned = written.parse().ok().filter(|_| is_integer);
        let signed = written
            .parse()
            .ok()
            .filter(|number| is_integer && *number != 0);
        match (unsigned, signed) {
            (Some(number), _) => Self::Unsigned(number),
            (None, Some(number)) => Self::Signed(number),
            (None, None) => Self::Float(written.parse().unwrap_or(f64::INFINITY)),
        }
    }

    fn is_from(self, least: i128, most: i128) -> bool {
        let range = least..=most;
        match self {
            Self::Unsigned(number) => range.contains(&i128::from(number)),
            Self::Signed(number) => range.contains(&i128::from(number)),
            Self::Float(_) => false,
        }
    }

    fn is_out_of_range(self) -> bool {
        matches!(self, Self::Float(number) if number.is_infinite())
    }

    fn unexpected(self) -> Unexpected<'static> {
        match self {
            Self::Unsigned(number) => Unexpected::Unsigned(number),
            Self::Signed(number) => Unexpected::Signed(number),
            Self::Float(number) => Unexpected::Float(number),
        }
    }

    fn visit<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        match self {
            Self::Unsigned(number) => visitor.visit_u64(number),
            Self::Signed(number) => visitor.visit_i64(number),
            Self::Float(number) => visitor.visit_f64(number),
        }
    }
}

impl<'n, 't> NodeReader<'n, 't> {
    /// Decodes a node, unless it is to be replaced by a placeholder.
    pub(super) fn new(notes: &'n ErrorCollector<'t>, at: NodeId) -> Self {
        let at = (!notes.rejected.contains(&at)).then_some(at);
        Self { notes, at }
    }

    /// Yields a placeholder.
    pub(super) fn placeholder(notes: &'n ErrorCollector<'t>) -> Self {
        Self { notes, at: None }
    }

    fn kind(self) -> Option<NodeKind> {
        self.at.map(|at| self.notes.tree.kind(at))
    }

    /// The number of the node. A number out of range is reported and becomes 0.
    fn number(self) -> Option<JsonNumber> {
        let at = self.at.filter(|_| self.kind() == Some(NodeKind::Number))?;
        let number = JsonNumber::of(self.notes.tree.written(at));
        if !number.is_out_of_range() {
            return Some(number);
        }
        let what = "number out of range".to_owned();
        self.notes.note(at, NodePart::LastDigit, what);
        Some(JsonNumber::Unsigned(0))
    }

    fn text(self) -> Option<&'n str> {
        self.at.and_then(|at| self.notes.tree.text(at))
    }

    /// Reports that the node does not have the expected type.
    pub(super) fn wrong_type(self, expected: &dyn Expected) {
        let Some((at, kind)) = self.at.zip(self.kind()) else {
            return;
        };
        let (found, part) = match kind {
            NodeKind::Null => (Unexpected::Unit, NodePart::Whole),
            NodeKind::Bool => {
                let boolean = self.notes.tree.boolean(at).unwrap_or_default();
                (Unexpected::Bool(boolean), NodePart::Whole)
            }
            NodeKind::Number => {
                let number = JsonNumber::of(self.notes.tree.written(at));
                if number.is_out_of_range() {
                    // The range error is reported instead.
                    self.number();
                    return;
                }
                (number.unexpected(), NodePart::Whole)
            }
            NodeKind::Word | NodeKind::Text => (
                Unexpected::Str(self.text().unwrap_or_default()),
                NodePart::Whole,
            ),
            NodeKind::List => (Unexpected::Seq, NodePart::Bracket),
            NodeKind::Map => (Unexpected::Map, NodePart::Bracket),
        };
        let error = NodeError::invalid_type(found, expected);
        self.notes.note(at, part, error.what);
    }

    /// Reports an error for the whole node.
    pub(super) fn note(self, error: NodeError) {
        if let Some(at) = self.at {
            self.notes.note(at, NodePart::Whole, error.what);
        }
    }

    /// An integer from `least` to `most`.
    fn integer<'de, V: Visitor<'de>>(
        self,
        visitor: V,
        (least, most): (i128, i128),
    ) -> Result<V::Value, NodeError> {
        match self.number() {
            Some(number) if number.is_from(least, most) => return number.visit(visitor),
            Some(number @ (JsonNumber::Unsigned(_) | JsonNumber::Signed(_))) => {
                self.note(NodeError::invalid_value(number.unexpected(), &visitor));
            }
            Some(JsonNumber::Float(_)) | None => self.wrong_type(&visitor),
        }
        visitor.visit_u64(0)
    }

    fn float<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        if let Some(number) = self.number() {
            return number.visit(visitor);
        }
        self.wrong_type(&visitor);
        visitor.visit_f64(0.0)
    }

    /// A struct as a list of its fields, which `serde_json` accepts as well.
    fn positional<'de, V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        let list = self.at.into_iter();
        let items: Vec<NodeId> = list.flat_map(|list| self.notes.tree.items(list)).collect();
        if items.len() != length {
            let expected = format!("{} with {length} elements", &visitor as &dyn Expected);
            self.note(NodeError::invalid_length(items.len(), &expected.as_str()));
        }
        let items = NodeListAccess::new(self.notes, items, Some(length));
        visitor.visit_seq(items).map_err(|error| error.at(self.at))
    }

    fn list<'de, V: Visitor<'de>>(
        self,
        visitor: V,
        length: Option<usize>,
    ) -> Result<V::Value, NodeError> {
        let list = self.at.filter(|_| self.kind() == Some(NodeKind::List));
        let items: Vec<NodeId> = match list {
            Some(list) => self.notes.tree.items(list).collect(),
            None => {
                self.wrong_type(&visitor);
                Vec::new()
            }
        };
        if list.is_some() && length.is_some_and(|length| items.len() != length) {
            self.note(NodeError::invalid_length(items.len(), &visitor));
        }
        let items = NodeListAccess::new(self.notes, items, length);
        visitor.visit_seq(items).map_err(|error| error.at(self.at))
    }
}

/// Deserializer methods of the integer types.
macro_rules! integer {
    ($($method:ident $type:ident)+) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
            self.integer(visitor, (i128::from($type::MIN), i128::from($type::MAX)))
        })+
    };
}

impl<'de> Deserializer<'de> for NodeReader<'_, '_> {
    type Error = NodeError;

    integer! {
        deserialize_u8 u8 deserialize_u16 u16 deserialize_u32 u32 deserialize_u64 u64
        deserialize_i8 i8 deserialize_i16 i16 deserialize_i32 i32 deserialize_i64 i64
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        let tree = self.notes.tree;
        let Some((at, kind)) = self.at.zip(self.kind()) else {
            // Types that accept anything, such as columns, accept an empty list.
            return visitor.visit_seq(NodeListAccess::new(self.notes, Vec::new(), None));
        };
        let value: Result<V::Value, NodeError> = match kind {
            NodeKind::Null => visitor.visit_unit(),
            NodeKind::Bool => visitor.visit_bool(tree.boolean(at).unwrap_or_default()),
            NodeKind::Number => self
                .number()
                .unwrap_or(JsonNumber::Unsigned(0))
                .visit(visitor),
            NodeKind::Word | NodeKind::Text => visitor.visit_str(self.text().unwrap_or_default()),
            NodeKind::List => visitor.visit_seq(NodeListAccess::new(
                self.notes,
                tree.items(at).collect(),
                None,
            )),
            NodeKind::Map => visitor.visit_map(NodeMapAccess::any(self.notes, at)),
        };
        value.map_err(|error| error.at(self.at))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        let boolean = self.at.and_then(|at| self.notes.tree.boolean(at));
        if boolean.is_none() {
            self.wrong_type(&visitor);
        }
        visitor.visit_bool(boolean.unwrap_or_default())
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.float(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.float(visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        let text = self.text();
        if text.is_none() {
            self.wrong_type(&visitor);
        }
        let value = visitor.visit_str(text.unwrap_or_default());
        value.map_err(|error: NodeError| error.at(self.at))
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        match self.kind() {
            Some(NodeKind::Null) | None => visitor.visit_none(),
            Some(_) => visitor.visit_some(self),
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        if self.kind() != Some(NodeKind::Null) {
            self.wrong_type(&visitor);
        }
        visitor.visit_unit()
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        self.deserialize_unit(visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.list(visitor, None)
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        self.list(visitor, Some(length))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        self.list(visitor, Some(length))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: FieldNames,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        if self.kind() == Some(NodeKind::List) {
            return self.positional(fields.len(), visitor);
        }
        let map = self.at.filter(|_| self.kind() == Some(NodeKind::Map));
        if map.is_none() {
            self.wrong_type(&visitor);
        }
        let members = NodeMapAccess::of(self.notes, map, fields);
        let value = visitor.visit_map(members);
        value.map_err(|error| error.of(fields).at(self.at))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: FieldNames,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        let variant = NodeVariantAccess::of(self, variants, &visitor);
        let value = visitor.visit_enum(variant);
        value.map_err(|error| error.at(self.at))
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, NodeError> {
        visitor.visit_unit()
    }
}
