//! The text after a node, and comparison of nodes.

use super::{NodeId, Syntax, Tree};
use crate::Span;

impl<'s> Tree<'s> {
    /// The text after a span, up to the end of its line.
    #[must_use]
    pub fn rest_of_line(&self, span: Span) -> &'s str {
        let end = span.end.saturating_sub(self.base) as usize;
        let rest = self.source.get(end..).unwrap_or_default();
        rest.split(['\n', '\r']).next().unwrap_or_default()
    }

    /// Whether two values are equal: the same scalars, lists and maps in the same order.
    #[must_use]
    pub fn is_same(&self, a: NodeId, b: NodeId) -> bool {
        /// The maximum number of nodes of an alias target that are compared: it may be large and
        /// used often.
        const MOST: u32 = 1 << 10;
        let is_alias = [a, b].iter().any(|id| self.target(*id) != *id);
        let (a, b) = (self.target(a), self.target(b));
        if a == b {
            return true;
        }
        if is_alias && self.end(a) - a.0 > MOST {
            return false;
        }
        let inside = |id: NodeId| (id.0..self.end(id)).map(NodeId);
        let is_same = |(a, b): (NodeId, NodeId)| {
            self.node(a).syntax == self.node(b).syntax
                && self.target(a) == a
                && self.target(b) == b
                && self.shape(a) == self.shape(b)
        };
        inside(a).len() == inside(b).len() && inside(a).zip(inside(b)).all(is_same)
    }

    /// Whether another tree is equal: the same nodes with the same texts and the same aliases.
    #[must_use]
    pub fn is_equivalent(&self, other: &Tree<'_>) -> bool {
        let is_same = |id: NodeId| {
            let (mine, theirs) = (self.node(id), other.node(id));
            let has_link = matches!(mine.syntax, Syntax::List | Syntax::Map | Syntax::Alias);
            mine.syntax == theirs.syntax
                && if has_link {
                    mine.link == theirs.link
                } else {
                    self.shape(id) == other.shape(id)
                }
        };
        self.count() == other.count() && self.nodes().all(is_same)
    }
}
