//! Access to lists, maps and enum variants. A missing value gets a placeholder; a surplus value is
//! reported and skipped.

use super::error::NodeError;
use super::reader::NodeReader;
use super::{ErrorCollector, FieldNames, NodePart};
use rtc_source::tree::{NodeId, NodeKind};
use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};

/// The items of a list.
pub(super) struct NodeListAccess<'n, 't> {
    notes: &'n ErrorCollector<'t>,
    items: std::vec::IntoIter<NodeId>,
    /// The number of items still expected, present or not; `None` for the items that are present.
    remaining: Option<usize>,
}

impl<'n, 't> NodeListAccess<'n, 't> {
    pub(super) fn new(
        notes: &'n ErrorCollector<'t>,
        items: Vec<NodeId>,
        length: Option<usize>,
    ) -> Self {
        Self {
            notes,
            items: items.into_iter(),
            remaining: length,
        }
    }
}

impl<'de> SeqAccess<'de> for NodeListAccess<'_, '_> {
    type Error = NodeError;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, NodeError> {
        let item = self.items.next();
        let is_expected = match &mut self.remaining {
            None => item.is_some(),
            Some(0) => false,
            Some(remaining) => {
                *remaining -= 1;
                true
            }
        };
        if !is_expected {
            return Ok(None);
        }
        let placeholder = || NodeReader::placeholder(self.notes);
        let reader = item.map_or_else(placeholder, |item| NodeReader::new(self.notes, item));
        seed.deserialize(reader).map(Some)
    }
}

/// The members of a map.
pub(super) struct NodeMapAccess<'n, 't> {
    notes: &'n ErrorCollector<'t>,
    map: Option<NodeId>,
    pairs: std::vec::IntoIter<(NodeId, NodeId)>,
    /// The fields of the struct; `None` to accept any key.
    fields: Option<FieldNames>,
    /// Required fields that were not seen yet.
    absent: Vec<&'static str>,
    seen: Vec<&'n str>,
    /// A key is unknown: it may be a misspelling of a missing one.
    has_unknown: bool,
    /// The value after the last key.
    value: Option<NodeId>,
}

impl<'n, 't> NodeMapAccess<'n, 't> {
    /// The members of a map as the fields of a struct; placeholders if there is no map.
    pub(super) fn of(
        notes: &'n ErrorCollector<'t>,
        map: Option<NodeId>,
        fields: FieldNames,
    ) -> Self {
        let pairs: Vec<_> = map.map_or_else(Vec::new, |map| notes.tree.pairs(map).collect());
        Self {
            notes,
            map,
            pairs: pairs.into_iter(),
            fields: Some(fields),
            absent: notes.required(fields).to_vec(),
            seen: Vec::new(),
            has_unknown: false,
            value: None,
        }
    }

    /// All members of a map.
    pub(super) fn any(notes: &'n ErrorCollector<'t>, map: NodeId) -> Self {
        Self {
            fields: None,
            absent: Vec::new(),
            ..Self::of(notes, Some(map), &[])
        }
    }

    /// The next known key.
    fn next_key(&mut self) -> Option<&'n str> {
        for (key, value) in self.pairs.by_ref() {
            let text = self.notes.tree.text(key).unwrap_or_default();
            let fault = match self.fields {
                Some(fields) if !fields.contains(&text) => NodeError::unknown_field(text, fields),
                // Which duplicate field it is does not change the message.
                Some(_) if self.seen.contains(&text) => {
                    NodeError::custom(format_args!("duplicate field `{text}`"))
                }
                Some(_) | None => {
                    self.seen.push(text);
                    self.absent.retain(|name| *name != text);
                    self.value = Some(value);
                    return Some(text);
                }
            };
            self.has_unknown |= !self.seen.contains(&text);
            self.notes.note(key, NodePart::Whole, fault.what);
        }
        let name = self.absent.pop()?;
        if let Some(map) = self.map.filter(|_| !self.has_unknown) {
            self.notes
                .note(map, NodePart::Whole, NodeError::missing_field(name).what);
        }
        self.value = None;
        Some(name)
    }
}

impl<'de> MapAccess<'de> for NodeMapAccess<'_, '_> {
    type Error = NodeError;

    fn next_key_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, NodeError> {
        let key = self.next_key();
        key.map(|key| seed.deserialize(deserializer(key)))
            .transpose()
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, NodeError> {
        let placeholder = || NodeReader::placeholder(self.notes);
        seed.deserialize(
            self.value
                .map_or_else(placeholder, |value| NodeReader::new(self.notes, value)),
        )
    }
}

/// An enum variant and its content.
pub(super) struct NodeVariantAccess<'n, 't> {
    name: &'n str,
    content: NodeReader<'n, 't>,
    /// The node, if the variant is a name without content.
    bare: Option<NodeReader<'n, 't>>,
}

impl<'n, 't> NodeVariantAccess<'n, 't> {
    /// The variant at a node; the first variant if the node is none.
    pub(super) fn of(
        at: NodeReader<'n, 't>,
        variants: FieldNames,
        expected: &dyn Expected,
    ) -> Self {
        let (notes, tree) = (at.notes, at.notes.tree);
        // The first variant stands in for a broken value.
        let first = Self {
            name: variants.first().copied().unwrap_or_default(),
            content: NodeReader::placeholder(notes),
            bare: None,
        };
        // A variant is a text, or a map with its name as only key.
        let Some(node) = at.at else { return first };
        let kind = tree.kind(node);
        let mut pairs = tree.pairs(node);
        let (name, variant) = match (kind, pairs.next(), pairs.next()) {
            (NodeKind::Text, ..) => {
                let bare = Some(at);
                (node, Self { bare, ..first })
            }
            (NodeKind::Map, Some((key, value)), None) => {
                let content = NodeReader::new(notes, value);
                (key, Self { content, ..first })
            }
            (NodeKind::Map, ..) => {
                at.note(NodeError::invalid_value(
                    Unexpected::Map,
                    &"a map with one key",
                ));
                return first;
            }
            _ => {
                at.wrong_type(expected);
                return first;
            }
        };
        // The name must be that of a variant.
        let text = tree.text(name).unwrap_or_default();
        if variants.contains(&text) {
            return Self {
                name: text,
                ..variant
            };
        }
        notes.note(
            name,
            NodePart::Whole,
            NodeError::unknown_variant(text, variants).what,
        );
        Self {
            content: NodeReader::placeholder(notes),
            bare: None,
            ..variant
        }
    }

    /// Reports that a variant without content needs one.
    fn need(&self, what: &str) {
        if let Some(bare) = self.bare {
            bare.note(NodeError::invalid_type(Unexpected::UnitVariant, &what));
        }
    }
}

impl<'de, 'n, 't> EnumAccess<'de> for NodeVariantAccess<'n, 't> {
    type Error = NodeError;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), NodeError> {
        Ok((seed.deserialize(deserializer(self.name))?, self))
    }
}

impl<'de> VariantAccess<'de> for NodeVariantAccess<'_, '_> {
    type Error = NodeError;

    fn unit_variant(self) -> Result<(), NodeError> {
        let content = self.content;
        let kind = content.at.map(|at| content.notes.tree.kind(at));
        if kind.is_some_and(|kind| kind != NodeKind::Null) {
            content.wrong_type(&"unit");
        }
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, NodeError> {
        self.need("newtype variant");
        seed.deserialize(self.content)
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        self.need("tuple variant");
        self.content.deserialize_tuple(length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: FieldNames,
        visitor: V,
    ) -> Result<V::Value, NodeError> {
        self.need("struct variant");
        self.content.deserialize_struct("", fields, visitor)
    }
}

fn deserializer(text: &str) -> StrDeserializer<'_, NodeError> {
    text.into_deserializer()
}
