//! The nodes of a document in a range of bytes, each with its schemas.

use super::path_at::PathStep;
use super::vocabulary::{MERGE, Vocabulary};
use rtc_source::tree::{NodeId, SyntaxTree};
use serde_json::{Map, Value};
use std::ops::Range;

/// A node that is visited.
pub(super) struct VisitedNode<'w, 'v> {
    /// The key of the node, if it is the value of one.
    pub(super) key: Option<NodeId>,
    pub(super) node: NodeId,
    /// The schemas of the node; empty if the format knows nothing of it.
    pub(super) schemas: &'w [&'v Map<String, Value>],
}

/// Visits the nodes of a tree that touch a range, but no numbers in lists.
pub(super) fn traverse<'v>(
    tree: &SyntaxTree<'_>,
    vocabulary: &'v Vocabulary,
    bytes: &Range<usize>,
    mut visit: impl FnMut(&VisitedNode<'_, 'v>),
) {
    let touches = |id: NodeId| {
        let (start, end) = tree.range(id);
        start <= bytes.end && bytes.start <= end
    };
    let mut open = vec![(None, tree.root(), vocabulary.root(tree))];
    while let Some((key, node, schemas)) = open.pop() {
        visit(&VisitedNode {
            key,
            node,
            schemas: &schemas,
        });
        // The value of an alias is written elsewhere.
        if tree.target(node) != node {
            continue;
        }
        for (key, value) in tree.pairs(node) {
            if !touches(key) && !touches(value) {
                continue;
            }
            let step = PathStep::Key {
                map: node,
                key,
                value,
            };
            let below = match tree.is(key, MERGE) {
                true => schemas.clone(),
                false => vocabulary.below(&schemas, tree, step),
            };
            open.push((Some(key), value, below));
        }
        if !tree.is_list(node) {
            continue;
        }
        for (at, item) in tree.items(node).enumerate() {
            if touches(item) && !is_number(tree, item) {
                let step = PathStep::Item { at, item };
                open.push((None, item, vocabulary.below(&schemas, tree, step)));
            }
        }
    }
}

fn is_number(tree: &SyntaxTree<'_>, id: NodeId) -> bool {
    let first = tree.written(id).bytes().next();
    first.is_some_and(|byte| byte.is_ascii_digit() || b"+-.".contains(&byte))
}
