//! JSON pointers of the nodes of a JSON tree, for diagnostics.

use super::{NodeId, NodeKind, SyntaxTree};

/// The parent of a node and its index there.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointerStep {
    /// The list or map that contains the node; the root contains itself.
    pub(super) parent: u32,
    /// The index in a list; otherwise without meaning.
    pub(super) slot: u32,
}

/// The maximum length in bytes of a component and of a pointer. Longer ones are shortened, because
/// there may be many diagnostics.
const LONG_STEP: usize = 256;
const LONG_POINTER: usize = 512;

impl SyntaxTree<'_> {
    fn step(&self, id: NodeId) -> PointerStep {
        let root = PointerStep { parent: 0, slot: 0 };
        self.steps.get(id.0 as usize).copied().unwrap_or(root)
    }

    /// The list or map that contains the node; the root for the root and for YAML.
    #[must_use]
    pub fn parent(&self, id: NodeId) -> NodeId {
        NodeId(self.step(id).parent)
    }

    /// The JSON pointer (RFC 6901) of the node. `…` replaces the start of a long pointer and the
    /// end of a long key.
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

    /// The key of a map value, or the key itself for a key. A long key is shortened, in its source
    /// form.
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
