//! Columns: vectors of a fixed number of components, one per vertex of a mesh, in the precision of
//! their source.
//!
//! They are shared, not copied: all readers hold the columns of the scene itself. In JSON a column
//! of 64-bit floats is a list, and one of 32-bit floats a map of `f32` to a list.

use arbitrary::Arbitrary;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, MapAccess, SeqAccess, Visitor, value::SeqAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// A list shared by its copies (copy on write).
#[derive(Debug, PartialEq, Arbitrary)]
pub struct SharedList<T>(Arc<Vec<T>>);

impl<T> Clone for SharedList<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Default for SharedList<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> From<Vec<T>> for SharedList<T> {
    fn from(list: Vec<T>) -> Self {
        Self(Arc::new(list))
    }
}

impl<T> FromIterator<T> for SharedList<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Vec::from_iter(items).into()
    }
}

impl<T> Deref for SharedList<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Clone> DerefMut for SharedList<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        Arc::make_mut(&mut self.0)
    }
}

impl<T: Serialize> Serialize for SharedList<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for SharedList<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

impl<T: JsonSchema> JsonSchema for SharedList<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        Vec::<T>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<T>::json_schema(generator)
    }
}

/// `N` numbers for each vertex.
#[derive(Clone, Debug, Arbitrary)]
pub enum VertexColumn<const N: usize> {
    /// As binary files have them.
    Single(SharedList<[f32; N]>),
    /// As texts have them.
    Double(SharedList<[f64; N]>),
}

impl<const N: usize> VertexColumn<N> {
    /// The numbers rounded to 32 bits.
    pub fn rounded(vectors: impl IntoIterator<Item = [f64; N]>) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounding is what is asked for"
        )]
        let round = |vector: [f64; N]| vector.map(|number| number as f32);
        vectors.into_iter().map(round).collect::<Vec<_>>().into()
    }

    /// The number of vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Single(vectors) => vectors.len(),
            Self::Double(vectors) => vectors.len(),
        }
    }

    /// Whether there are no vertices.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of bytes of its values.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Single(vectors) => size_of_val(vectors.as_slice()),
            Self::Double(vectors) => size_of_val(vectors.as_slice()),
        }
    }

    /// The value at vertex `index`, which is below the length.
    #[must_use]
    #[inline]
    pub fn at(&self, index: usize) -> [f64; N] {
        match self {
            Self::Single(vectors) => {
                let mut vector = [0.0; N];
                vector
                    .iter_mut()
                    .zip(vectors[index])
                    .for_each(|(wide, number)| *wide = f64::from(number));
                vector
            }
            Self::Double(vectors) => vectors[index],
        }
    }

    /// The values in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [f64; N]> + Clone {
        (0..self.len()).map(|index| self.at(index))
    }

    /// The values at these vertices, whose indices are below the length; an empty column stays
    /// empty.
    #[must_use]
    pub fn pick(&self, vertices: &[u32]) -> Self {
        fn pick<T: Copy>(from: &[T], vertices: &[u32]) -> Vec<T> {
            vertices
                .iter()
                .map(|vertex| from[*vertex as usize])
                .collect()
        }
        match self {
            _ if self.is_empty() => Self::default(),
            Self::Single(vectors) => pick(vectors, vertices).into(),
            Self::Double(vectors) => pick(vectors, vertices).into(),
        }
    }
}

impl<const N: usize> Default for VertexColumn<N> {
    fn default() -> Self {
        Self::Double(SharedList::default())
    }
}

/// Empty columns are equal regardless of precision: a file does not distinguish them.
impl<const N: usize> PartialEq for VertexColumn<N> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Single(own), Self::Single(other)) => own == other,
            (Self::Double(own), Self::Double(other)) => own == other,
            (Self::Single(_), Self::Double(_)) | (Self::Double(_), Self::Single(_)) => {
                self.is_empty() && other.is_empty()
            }
        }
    }
}

impl<const N: usize> From<Vec<[f32; N]>> for VertexColumn<N> {
    fn from(vectors: Vec<[f32; N]>) -> Self {
        if vectors.is_empty() {
            Self::default()
        } else {
            Self::Single(vectors.into())
        }
    }
}

impl<const N: usize> From<Vec<[f64; N]>> for VertexColumn<N> {
    fn from(vectors: Vec<[f64; N]>) -> Self {
        Self::Double(vectors.into())
    }
}

impl<const N: usize> FromIterator<[f64; N]> for VertexColumn<N> {
    fn from_iter<I: IntoIterator<Item = [f64; N]>>(vectors: I) -> Self {
        Vec::from_iter(vectors).into()
    }
}

/// The key of a column of 32-bit floats.
const SINGLE: &str = "f32";

impl<const N: usize> Serialize for VertexColumn<N>
where
    [f32; N]: Serialize,
    [f64; N]: Serialize,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Single(vectors) if !vectors.is_empty() => {
                serializer.collect_map([(SINGLE, vectors)])
            }
            Self::Single(_) => serializer.collect_seq([(); 0]),
            Self::Double(vectors) => vectors.serialize(serializer),
        }
    }
}

impl<'de, const N: usize> Deserialize<'de> for VertexColumn<N>
where
    [f32; N]: Deserialize<'de>,
    [f64; N]: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColumnReader)
    }
}

/// Reads a column of `N` numbers a vertex.
struct ColumnReader<const N: usize>;

impl<'de, const N: usize> Visitor<'de> for ColumnReader<N>
where
    [f32; N]: Deserialize<'de>,
    [f64; N]: Deserialize<'de>,
{
    type Value = VertexColumn<N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a list of {N} numbers each, or a map of `{SINGLE}` to one"
        )
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<VertexColumn<N>, A::Error> {
        Vec::<[f64; N]>::deserialize(SeqAccessDeserializer::new(list)).map(VertexColumn::from)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<VertexColumn<N>, A::Error> {
        let key = map
            .next_key::<Cow<'_, str>>()?
            .ok_or_else(|| Error::missing_field(SINGLE))?;
        if key != SINGLE {
            return Err(Error::unknown_field(&key, &[SINGLE]));
        }
        let vectors = map.next_value::<Vec<[f32; N]>>()?;
        match map.next_key::<Cow<'_, str>>()? {
            None => Ok(VertexColumn::from(vectors)),
            Some(key) => Err(Error::unknown_field(&key, &[])),
        }
    }
}

impl<const N: usize> JsonSchema for VertexColumn<N>
where
    [f64; N]: JsonSchema,
{
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Column{N}").into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let list = Vec::<[f64; N]>::json_schema(generator);
        let single = json_schema!({
            "type": "object",
            "properties": { SINGLE: list },
            "required": [SINGLE],
            "additionalProperties": false,
        });
        json_schema!({ "anyOf": [list, single] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_precisions_keep_every_bit_in_json() {
        let single = VertexColumn::from(vec![[0.1_f32, -0.0], [f32::MAX, 1e-45]]);
        let double = VertexColumn::from(vec![[0.1_f64, -0.0], [f64::MAX, 5e-324]]);
        let text = serde_json::to_string(&single).unwrap();
        assert_eq!(text, r#"{"f32":[[0.1,-0.0],[3.4028235e+38,1e-45]]}"#);
        for column in [single, double, VertexColumn::default()] {
            let text = serde_json::to_string(&column).unwrap();
            assert_eq!(
                format!(
                    "{:?}",
                    serde_json::from_str::<VertexColumn<2>>(&text).unwrap()
                ),
                format!("{column:?}")
            );
            let tree = serde_json::to_value(&column).unwrap();
            assert_eq!(
                format!(
                    "{:?}",
                    serde_json::from_value::<VertexColumn<2>>(tree).unwrap()
                ),
                format!("{column:?}")
            );
        }
    }

    #[test]
    fn what_is_no_column_is_refused() {
        for text in [
            "{}",
            r#"{"f64":[]}"#,
            r#"{"f32":[],"f32":[]}"#,
            r#"{"f32":[[1]]}"#,
            "[[1]]",
            "1",
            r#"{"f32":[[1e39,0]]}"#,
        ] {
            assert!(
                serde_json::from_str::<VertexColumn<2>>(text).is_err(),
                "{text}"
            );
        }
    }

    #[test]
    fn what_changes_is_no_longer_shared() {
        let first = SharedList::from(vec![1, 2]);
        let mut second = first.clone();
        assert!(std::ptr::eq(first.as_ptr(), second.as_ptr()));
        second.push(3);
        assert_eq!(
            (first.as_slice(), second.as_slice()),
            (&[1, 2][..], &[1, 2, 3][..])
        );
    }
}
