//! Vertices that no index refers to. They are not rendered, so they may hold numbers that are not
//! finite.

use super::accessor::Accessor;
use super::accessor_reader::AccessorReader;
use super::document::Document;
use super::primitive::Primitive;
use std::collections::{BTreeMap, BTreeSet};

/// The index lists that name elements of each accessor; none where a use takes all of them.
pub(super) struct AccessorIndexUses(BTreeMap<usize, Option<BTreeSet<usize>>>);

impl AccessorIndexUses {
    pub(super) fn new(doc: &Document<'_>) -> Self {
        let mut readers = Self(BTreeMap::new());
        let primitives = || doc.meshes.iter().flat_map(|mesh| &mesh.primitives);
        for primitive in primitives() {
            readers.of_primitive(primitive);
        }
        let samplers = doc.animations.iter().flat_map(|item| &item.samplers);
        let keyframes = samplers.flat_map(|item| [item.input, item.output]);
        let instances = doc.nodes.iter().filter_map(|node| node.instances.as_ref());
        let instances = instances.flat_map(|item| item.parts);
        let matrices = doc.skins.iter().map(|skin| skin.matrices);
        let integer = keyframes.chain(instances).chain(matrices);
        for accessor in integer.flatten() {
            readers.0.insert(accessor, None);
        }
        readers
    }

    fn of_primitive(&mut self, primitive: &Primitive) {
        let animated = primitive.targets.iter().flatten();
        for attribute in primitive.attributes.iter().chain(animated) {
            let slot = self.0.entry(attribute.accessor);
            let lists = slot.or_insert_with(|| Some(BTreeSet::new()));
            match (lists.as_mut(), primitive.indices) {
                (Some(lists), Some(indices)) => drop(lists.insert(indices)),
                (_, None) => *lists = None,
                (None, Some(_)) => {}
            }
        }
    }

    /// The maximum number of indices that `names_any` checks.
    pub(super) fn cost(&self, doc: &Document<'_>, accessor: usize) -> u64 {
        let lists = self.0.get(&accessor).into_iter().flatten().flatten();
        let indices = lists.filter_map(|list| doc.accessors.get(*list)?.count);
        indices.fold(0, |sum, count| sum.saturating_add(count as u64))
    }

    /// True if some use reads an element for which `is_bad` holds, or reads all elements.
    pub(super) fn names_any(
        &self,
        doc: &Document<'_>,
        accessor: usize,
        is_bad: impl Fn(usize) -> bool,
    ) -> bool {
        let Some(lists) = self.0.get(&accessor) else {
            return false;
        };
        let Some(lists) = lists else { return true };
        let names = |indices: &Accessor| {
            let elements = AccessorReader::of(doc, indices)?;
            Some(elements.integers().iter().any(|at| is_bad(*at as usize)))
        };
        let mut lists = lists.iter().map(|list| doc.accessors.get(*list));
        lists.any(|list| list.and_then(names).unwrap_or(true))
    }
}
