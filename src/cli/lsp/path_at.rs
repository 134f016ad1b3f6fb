//! The position of a byte in the tree: the keys and items that lead to it.

use rtc_source::tree::{NodeId, SyntaxTree};

/// A step from a list or a map to an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathStep {
    /// The value of a key.
    Key {
        map: NodeId,
        key: NodeId,
        value: NodeId,
    },
    /// An item of a list.
    Item { at: usize, item: NodeId },
}

impl PathStep {
    /// The node after the step.
    pub(super) fn node(self) -> NodeId {
        match self {
            Self::Key { value, .. } => value,
            Self::Item { item, .. } => item,
        }
    }
}

/// The steps from the root to the node at a byte.
pub(super) fn path_at(tree: &SyntaxTree<'_>, offset: usize) -> Vec<PathStep> {
    let holds = |id: NodeId| {
        let span = tree.span(id);
        (span.start as usize..=span.end as usize).contains(&offset)
    };
    let (mut steps, mut here) = (Vec::new(), tree.root());
    loop {
        // The value of an alias is written elsewhere.
        let is_alias = tree.target(here) != here;
        let key = tree
            .pairs(here)
            .find(|(key, value)| !is_alias && (holds(*key) || holds(*value)));
        let item = || tree.items(here).enumerate().find(|(_, item)| holds(*item));
        let (step, next) = match key {
            Some((key, value)) => (
                PathStep::Key {
                    map: here,
                    key,
                    value,
                },
                value,
            ),
            None if tree.is_list(here) && !is_alias => match item() {
                Some((at, item)) => (PathStep::Item { at, item }, item),
                None => return steps,
            },
            None => return steps,
        };
        steps.push(step);
        here = next;
    }
}
