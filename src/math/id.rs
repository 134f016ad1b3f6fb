//! Typed indices, and the lists that they index.

use super::to_u32;
use std::cmp::Ordering;
use std::fmt::{self, Debug, Formatter};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// The index of an entity of kind `K` in a [`IdTable`] of such entities.
pub struct Id<K>(u32, PhantomData<fn() -> K>);

impl<K> Id<K> {
    /// The id of the entity at an index, which is below 2³² − 1.
    #[inline(always)]
    #[must_use]
    pub fn new(index: usize) -> Self {
        Self(to_u32(index), PhantomData)
    }

    /// The id of no entity.
    pub const NONE: Self = Self(u32::MAX, PhantomData);

    /// The index.
    #[inline(always)]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl<K> Clone for Id<K> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<K> Copy for Id<K> {}

impl<K> PartialEq for Id<K> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<K> Eq for Id<K> {}

impl<K> PartialOrd for Id<K> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<K> Ord for Id<K> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.cmp(&other.0)
    }
}

impl<K> Debug for Id<K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A list of values, one for each entity of kind `K`, indexed by [`Id<K>`]; it is a slice
/// otherwise.
#[derive(Clone)]
pub struct IdTable<K, V = K>(Vec<V>, PhantomData<fn() -> K>);

impl<K, V> IdTable<K, V> {
    /// The id of each entity, in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = Id<K>> + use<K, V> {
        (0..self.0.len()).map(Id::new)
    }

    /// Each value with the id of its entity.
    pub fn entries(&self) -> impl Iterator<Item = (Id<K>, &V)> {
        self.ids().zip(&self.0)
    }

    /// Appends a value; returns its id.
    pub fn push(&mut self, value: V) -> Id<K> {
        self.0.push(value);
        Id::new(self.0.len() - 1)
    }
}

impl<K, V: Debug> Debug for IdTable<K, V> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<K, V> Default for IdTable<K, V> {
    fn default() -> Self {
        Self::from(Vec::new())
    }
}

impl<K, V: PartialEq> PartialEq for IdTable<K, V> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<K, V> From<Vec<V>> for IdTable<K, V> {
    fn from(values: Vec<V>) -> Self {
        Self(values, PhantomData)
    }
}

impl<K, V> FromIterator<V> for IdTable<K, V> {
    fn from_iter<I: IntoIterator<Item = V>>(values: I) -> Self {
        Self::from(Vec::from_iter(values))
    }
}

impl<K, V> IntoIterator for IdTable<K, V> {
    type Item = V;
    type IntoIter = std::vec::IntoIter<V>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'table, K, V> IntoIterator for &'table IdTable<K, V> {
    type Item = &'table V;
    type IntoIter = std::slice::Iter<'table, V>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<K, V> Deref for IdTable<K, V> {
    type Target = [V];

    #[inline(always)]
    fn deref(&self) -> &[V] {
        &self.0
    }
}

impl<K, V> DerefMut for IdTable<K, V> {
    fn deref_mut(&mut self) -> &mut [V] {
        &mut self.0
    }
}

impl<K, V> Index<Id<K>> for IdTable<K, V> {
    type Output = V;

    #[inline(always)]
    fn index(&self, id: Id<K>) -> &V {
        &self.0[id.index()]
    }
}

impl<K, V> IndexMut<Id<K>> for IdTable<K, V> {
    #[inline(always)]
    fn index_mut(&mut self, id: Id<K>) -> &mut V {
        &mut self.0[id.index()]
    }
}
