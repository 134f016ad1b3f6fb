//! The way from the root of a tree of JSON to each of its nodes, as findings name it.

use super::{NodeId, NodeKind, Tree};

/// The last step of the way to a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointerStep {
    /// The list or map the node lies in; the root lies in itself.
    pub(super) parent: u32,
    /// The index in a list; of no meaning elsewhere.
    pub(super) slot: u32,
}

/// The longest step of a pointer and the longest pointer in bytes: longer ones are cut, for
/// findings are many.
const LONG_STEP: usize = 256;
const LONG_POINTER: usize = 512;

impl Tree<'_> {
    fn step(&self, id: NodeId) -> PointerStep {
        let root = PointerStep { parent: 0, slot: 0 };
        self.steps.get(id.0 as usize).copied().unwrap_or(root)
    }

    /// The list or map the node lies in; the root lies in itself, and so does all of YAML.
    #[must_use]
    pub fn parent(&self, id: NodeId) -> NodeId {
        NodeId(self.step(id).parent)
    }

    /// The way from the root to the node, a JSON pointer (RFC 6901). Of a long one the beginning is
    /// left out, and of a long key the end: `…` stands there.
    #[must_use]
    pub fn pointer(&self, id: NodeId) -> String {
        let mut steps = Vec::new();
        let (mut at, mut length) = (id, 0);
        while at != self.root() && length <= LONG_POINTER {
            let PointerStep { parent, slot } = self.step(at);
            let step = if self.kind(NodeId(parent)) == NodeKind::List {
                slot.to_string()
            } else {
                self.key(at)
            };
            length += step.len() + 1;
            steps.push(format!("/{}", step.replace('~', "~0").replace('/', "~1")));
            at = NodeId(parent);
        }
        if at != self.root() {
            steps.push("…".to_owned());
        }
        steps.iter().rev().map(String::as_str).collect()
    }

    /// The key of a value of a map; of a key, itself. The beginning of a long one, as written.
    fn key(&self, id: NodeId) -> String {
        let after = self.source.as_bytes()[self.node(id).end as usize..].trim_ascii_start();
        let is_key = after.first() == Some(&b':');
        let key = if is_key { id } else { NodeId(id.0 - 1) };
        let written = self.written(key);
        if written.len() <= LONG_STEP {
            return self.text(key).unwrap_or_default().to_owned();
        }
        let end = written.floor_char_boundary(LONG_STEP);
        format!("{}…", written.get(1..end).unwrap_or_default())
    }
}
