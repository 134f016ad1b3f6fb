//! What the text around a node says, and whether two nodes were written to say the same.

use super::{Form, NodeId, Tree};
use crate::Span;

impl<'s> Tree<'s> {
    /// The rest of the line that follows a span in this text.
    #[must_use]
    pub fn rest_of_line(&self, span: Span) -> &'s str {
        let end = span.end.saturating_sub(self.base) as usize;
        let rest = self.source.get(end..).unwrap_or_default();
        rest.split(['\n', '\r']).next().unwrap_or_default()
    }

    /// Whether two values are the same: words and texts, lists and maps of the same in one order.
    #[must_use]
    pub fn is_same(&self, a: NodeId, b: NodeId) -> bool {
        /// Nodes of what an alias stands for that are compared: it may stand for much, and often.
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
            self.node(a).form == self.node(b).form
                && self.target(a) == a
                && self.target(b) == b
                && self.shape(a) == self.shape(b)
        };
        inside(a).len() == inside(b).len() && inside(a).zip(inside(b)).all(is_same)
    }

    /// Whether another text says the same: the same nodes with the same texts, aliases of the same.
    #[must_use]
    pub fn says_the_same(&self, other: &Tree<'_>) -> bool {
        let is_same = |id: NodeId| {
            let (own, its) = (self.node(id), other.node(id));
            let has_link = matches!(own.form, Form::List | Form::Map | Form::Alias);
            own.form == its.form
                && if has_link {
                    own.link == its.link
                } else {
                    self.shape(id) == other.shape(id)
                }
        };
        self.count() == other.count() && self.nodes().all(is_same)
    }
}
