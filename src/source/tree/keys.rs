//! The keys of maps: duplicate keys, and sorted keys of large maps.

use super::{NodeId, SyntaxTree};
use std::collections::BTreeMap;

/// Maps up to this size are searched linearly; the keys of larger ones are sorted.
const LINEAR_SEARCH_MAX: usize = 12;

/// The keys of a tree, collected as each map closes.
#[derive(Clone, Debug, Default)]
pub(super) struct KeyIndex {
    /// Duplicate keys, each with its first occurrence.
    duplicates: Vec<(NodeId, NodeId)>,
    /// The keys of each large map, sorted by text, then by position.
    sorted: BTreeMap<NodeId, Vec<NodeId>>,
}

impl KeyIndex {
    /// The sorted keys of a map, if it is large.
    pub(super) fn sorted(&self, map: NodeId) -> Option<&[NodeId]> {
        self.sorted.get(&map).map(Vec::as_slice)
    }

    /// The keys of two trees without duplicates, where each has its nodes renamed, or dropped.
    pub(super) fn joined(
        trees: [&Self; 2],
        first: impl Fn(NodeId) -> Option<NodeId>,
        second: impl Fn(NodeId) -> Option<NodeId>,
    ) -> Self {
        let [a, b] = trees;
        let renamed = |own: &Self, rename: &dyn Fn(NodeId) -> Option<NodeId>| {
            let sorted = own.sorted.iter().filter_map(|(map, keys)| {
                Some((
                    rename(*map)?,
                    keys.iter().copied().filter_map(rename).collect(),
                ))
            });
            sorted.collect::<Vec<_>>()
        };
        let sorted = renamed(a, &first).into_iter().chain(renamed(b, &second));
        Self {
            duplicates: Vec::new(),
            sorted: sorted.collect(),
        }
    }

    /// The duplicate keys so far.
    pub(super) fn duplicates(&self) -> &[(NodeId, NodeId)] {
        &self.duplicates
    }
}

/// The first of the sorted keys with this text.
pub(super) fn search(tree: &SyntaxTree<'_>, sorted: &[NodeId], text: &str) -> Option<NodeId> {
    let is_before = |key: &NodeId| tree.text(*key).is_some_and(|found_text| found_text < text);
    let first = *sorted.get(sorted.partition_point(is_before))?;
    tree.is(first, text).then_some(first)
}

/// Collects the keys of a map that was just closed.
pub(super) fn close(tree: &mut SyntaxTree<'_>, map: NodeId) {
    let texts = || {
        let keys = tree.pairs(map).map(|(key, _)| key);
        keys.filter_map(|key| Some((tree.text(key)?, key)))
    };
    let mut entries = [("", map); LINEAR_SEARCH_MAX];
    let mut count = 0;
    for entry in texts() {
        if let Some(slot) = entries.get_mut(count) {
            *slot = entry;
        }
        count += 1;
    }
    if count <= LINEAR_SEARCH_MAX {
        // Almost all maps end here: nothing is allocated unless there is a duplicate.
        let mut found = Vec::new();
        for (at, (text, key)) in entries[..count].iter().enumerate() {
            let first = entries[..at].iter().find(|(earlier, _)| earlier == text);
            found.extend(first.map(|(_, first)| (*first, *key)));
        }
        tree.keys.duplicates.append(&mut found);
        return;
    }
    let mut keys: Vec<_> = texts().collect();
    keys.sort_unstable();
    let mut found = Vec::new();
    for same in keys.chunk_by(|(a, _), (b, _)| a == b) {
        found.extend(same[1..].iter().map(|(_, key)| (same[0].1, *key)));
    }
    let sorted = keys.into_iter().map(|(_, key)| key).collect();
    tree.keys.sorted.insert(map, sorted);
    tree.keys.duplicates.append(&mut found);
}
