//! The spanned tree: a YAML or JSON text as one flat vector of nodes with spans.
//!
//! # Overview
//! - [`yaml::parse`] and [`json::parse`] make a [`SyntaxTree`]; [`yaml::layout`] formats YAML.
//! - A [`NodeId`] is an index into the nodes. [`SyntaxTree::kind`] is the type of a node
//!   ([`NodeKind`]), [`SyntaxTree::shape`] its type and text,
//!   [`SyntaxTree::span`] its position in the file.
//! - [`SyntaxTree::get`], [`SyntaxTree::pairs`] and [`SyntaxTree::items`] navigate maps and lists.
//! - Of JSON, [`SyntaxTree::pointer`] is the JSON pointer of a node.
//!
//! # Representation
//! Nodes are in the order of the text. A list or map stores where its descendants end, so nothing
//! recurses. A node has 16 bytes, and in JSON 8 more for its parent. YAML aliases are links that
//! are never expanded, so a small text can't become a large tree.

pub mod json;
mod keys;
mod pointer;

impl<'s> SyntaxTree<'s> {
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
    pub fn is_equivalent(&self, other: &SyntaxTree<'_>) -> bool {
        let is_same = |id: NodeId| {
            let (mine, theirs) = (self.node(id), other.node(id));
            let has_link = matches!(
                mine.syntax,
                NodeSyntax::List | NodeSyntax::Map | NodeSyntax::Alias
            );
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

#[cfg(test)]
mod tests;
pub mod yaml;

use super::{FileId, Span};
use keys::KeyIndex;
use pointer::PointerStep;
use rtc_math::to_u32;
use std::ops::Range;

/// The index of a node in a [`SyntaxTree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(u32);

/// How a node is written; this also decides the meaning of its link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NodeSyntax {
    /// `null` in JSON.
    Null,
    /// `true` or `false` in JSON.
    Bool,
    /// A number in JSON.
    Number,
    /// An unquoted scalar of YAML.
    Word,
    /// A quoted string without escapes; the range includes the quotes.
    Quoted,
    /// A string whose value differs from its text; the link is its index among the unescaped
    /// strings.
    Unescaped,
    /// A list; the link is the index after its last descendant.
    List,
    /// A map: keys and values alternate; the link is the index after its last descendant.
    Map,
    /// An alias of the node at the link.
    Alias,
}

#[derive(Clone, Copy, Debug)]
struct TreeNode {
    start: u32,
    end: u32,
    link: u32,
    syntax: NodeSyntax,
}

/// The type of a node, with aliases resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeKind {
    /// `null` in JSON.
    Null,
    /// `true` or `false` in JSON.
    Bool,
    /// A number in JSON.
    Number,
    /// An unquoted scalar of YAML: a number, a boolean, null, or a string. The reader decides.
    Word,
    /// A quoted string or a block scalar; also each key of a map in JSON.
    Text,
    /// A list.
    List,
    /// A map.
    Map,
}

impl NodeKind {
    /// The name in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool => "a boolean",
            Self::Number => "a number",
            Self::Word => "a word",
            Self::Text => "a string",
            Self::List => "a list",
            Self::Map => "an object",
        }
    }
}

/// The type of a node with its text, aliases resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeContent<'t> {
    /// An unquoted scalar: a number, a boolean, null, or a string.
    Word(&'t str),
    /// A quoted string or a block scalar.
    Text(&'t str),
    /// A list.
    List,
    /// A map.
    Map,
}

/// A tree without its text, to be kept beside it.
#[derive(Debug)]
pub struct DetachedTree(SyntaxTree<'static>);

impl DetachedTree {
    /// The tree of its text, which must be the one that was parsed, in a file.
    #[must_use]
    pub fn attach<'s>(&self, file: FileId, source: &'s str) -> SyntaxTree<'s> {
        SyntaxTree {
            file,
            ..self.0.clone().of_text(source)
        }
    }
}

/// A parsed text. Offsets are relative to the text, spans to the file.
#[derive(Clone, Debug)]
pub struct SyntaxTree<'s> {
    source: &'s str,
    /// The offset of the text in its file.
    base: u32,
    file: FileId,
    nodes: Vec<TreeNode>,
    /// The parent and index of each node of JSON; empty for YAML.
    steps: Vec<PointerStep>,
    /// The concatenated values of strings that differ from their text, and the range of each.
    unescaped: String,
    ranges: Vec<(u32, u32)>,
    keys: KeyIndex,
}

impl<'s> SyntaxTree<'s> {
    /// A tree without nodes for a text that starts `base` bytes into its file.
    fn new(file: FileId, base: u32, source: &'s str) -> Self {
        Self {
            source,
            base,
            file,
            nodes: Vec::new(),
            steps: Vec::new(),
            unescaped: String::new(),
            ranges: Vec::new(),
            keys: KeyIndex::default(),
        }
    }

    /// The tree without its text.
    #[must_use]
    pub fn detach(self) -> DetachedTree {
        DetachedTree(self.of_text(""))
    }

    /// The same nodes of another copy of the text.
    fn of_text<'t>(self, source: &'t str) -> SyntaxTree<'t> {
        let Self {
            source: _,
            base,
            file,
            nodes,
            steps,
            unescaped,
            ranges,
            keys,
        } = self;
        SyntaxTree {
            source,
            base,
            file,
            nodes,
            steps,
            unescaped,
            ranges,
            keys,
        }
    }

    /// The node of the whole document.
    #[must_use]
    pub fn root(&self) -> NodeId {
        NodeId(0)
    }

    /// The number of nodes, keys included.
    #[must_use]
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// All nodes, in the order of the text.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> {
        (0..to_u32(self.nodes.len())).map(NodeId)
    }

    fn node(&self, id: NodeId) -> TreeNode {
        self.nodes[id.0 as usize]
    }

    /// The text of a range, unless it splits a character.
    fn slice(&self, range: Range<u32>) -> Option<&'s str> {
        self.source.get(range.start as usize..range.end as usize)
    }

    /// Stores a string value that differs from its text; returns its index.
    fn unescape_with(&mut self, write: impl FnOnce(&mut String)) -> u32 {
        let start = to_u32(self.unescaped.len());
        write(&mut self.unescaped);
        self.ranges.push((start, to_u32(self.unescaped.len())));
        to_u32(self.ranges.len() - 1)
    }

    /// The node of an alias, or the node itself. An alias never refers to another alias.
    #[must_use]
    pub fn target(&self, id: NodeId) -> NodeId {
        let node = self.node(id);
        if node.syntax == NodeSyntax::Alias {
            NodeId(node.link)
        } else {
            id
        }
    }

    /// The span of the node; for an alias, that of the alias.
    #[must_use]
    pub fn span(&self, id: NodeId) -> Span {
        let node = self.node(id);
        Span::new(self.file, node.start + self.base, node.end + self.base)
    }

    /// The byte range of the node in the text.
    #[must_use]
    pub fn range(&self, id: NodeId) -> (usize, usize) {
        let node = self.node(id);
        (node.start as usize, node.end as usize)
    }

    /// The source text; for an alias, the alias.
    #[must_use]
    pub fn written(&self, id: NodeId) -> &'s str {
        self.source_of(self.node(id))
    }

    fn source_of(&self, node: TreeNode) -> &'s str {
        self.slice(node.start..node.end)
            .expect("a node starts and ends between characters")
    }

    /// The node with aliases resolved.
    fn resolve_alias(&self, id: NodeId) -> TreeNode {
        let node = self.node(id);
        if node.syntax == NodeSyntax::Alias {
            self.node(NodeId(node.link))
        } else {
            node
        }
    }

    /// The type of the node, aliases resolved.
    #[must_use]
    pub fn kind(&self, id: NodeId) -> NodeKind {
        match self.resolve_alias(id).syntax {
            NodeSyntax::Null => NodeKind::Null,
            NodeSyntax::Bool => NodeKind::Bool,
            NodeSyntax::Number => NodeKind::Number,
            NodeSyntax::Word => NodeKind::Word,
            NodeSyntax::Quoted | NodeSyntax::Unescaped => NodeKind::Text,
            NodeSyntax::List => NodeKind::List,
            NodeSyntax::Map => NodeKind::Map,
            NodeSyntax::Alias => unreachable!("an alias never refers to another alias"),
        }
    }

    /// The type of the node with its text, aliases resolved.
    #[must_use]
    pub fn shape(&self, id: NodeId) -> NodeContent<'_> {
        let node = self.resolve_alias(id);
        match node.syntax {
            NodeSyntax::Null | NodeSyntax::Bool | NodeSyntax::Number | NodeSyntax::Word => {
                NodeContent::Word(self.source_of(node))
            }
            NodeSyntax::Quoted | NodeSyntax::Unescaped => NodeContent::Text(self.quoted(node)),
            NodeSyntax::List => NodeContent::List,
            NodeSyntax::Map => NodeContent::Map,
            NodeSyntax::Alias => unreachable!("an alias never refers to another alias"),
        }
    }

    /// Whether the node is a map, aliases followed.
    #[must_use]
    pub fn is_map(&self, id: NodeId) -> bool {
        self.resolve_alias(id).syntax == NodeSyntax::Map
    }

    /// Whether the node is a list, aliases followed.
    #[must_use]
    pub fn is_list(&self, id: NodeId) -> bool {
        self.resolve_alias(id).syntax == NodeSyntax::List
    }

    /// The value of a quoted string or a block scalar.
    fn quoted(&self, node: TreeNode) -> &str {
        let text = if node.syntax == NodeSyntax::Unescaped {
            let (start, end) = self.ranges[node.link as usize];
            self.unescaped.get(start as usize..end as usize)
        } else {
            self.slice(inside_quotes(node.start, node.end))
        };
        text.expect("a text starts and ends between characters")
    }

    /// The text of a scalar; in JSON, of strings only.
    #[must_use]
    pub fn text(&self, id: NodeId) -> Option<&str> {
        let node = self.resolve_alias(id);
        match node.syntax {
            NodeSyntax::Quoted | NodeSyntax::Unescaped => Some(self.quoted(node)),
            NodeSyntax::Word => Some(self.source_of(node)),
            NodeSyntax::Null
            | NodeSyntax::Bool
            | NodeSyntax::Number
            | NodeSyntax::List
            | NodeSyntax::Map => None,
            NodeSyntax::Alias => unreachable!("an alias never refers to another alias"),
        }
    }

    /// Whether the node is a scalar with this text.
    #[must_use]
    pub fn is(&self, id: NodeId, text: &str) -> bool {
        self.text(id).is_some_and(|found_text| found_text == text)
    }

    /// The value of a JSON number; infinite if it is out of the range of f64.
    #[must_use]
    pub fn number(&self, id: NodeId) -> Option<f64> {
        (self.kind(id) == NodeKind::Number)
            .then(|| self.written(id).parse().unwrap_or(f64::INFINITY))
    }

    /// The value of a JSON number that is an integer, not negative and below 2^53, in any notation.
    #[must_use]
    pub fn integer(&self, id: NodeId) -> Option<u64> {
        const EXACT: f64 = 9_007_199_254_740_992.0;
        let number = self
            .number(id)
            .filter(|number| (0.0..EXACT).contains(number) && number.fract() == 0.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and in range, see above"
        )]
        number.map(|number| number as u64)
    }

    /// The value of a JSON boolean.
    #[must_use]
    pub fn boolean(&self, id: NodeId) -> Option<bool> {
        (self.kind(id) == NodeKind::Bool).then(|| self.written(id) == "true")
    }

    /// The items of a list, or the alternating keys and values of a map; nothing for a scalar.
    pub fn items(&self, id: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let id = self.target(id);
        let end = self.end(id);
        let inside = move |id: u32| (id < end).then_some(NodeId(id));
        std::iter::successors(inside(id.0 + 1), move |id| inside(self.end(*id)))
    }

    /// The keys and values of a map in the order of the text, merge keys included; nothing for
    /// other nodes.
    pub fn pairs(&self, id: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let most = if self.is_map(id) { usize::MAX } else { 0 };
        let mut items = self.items(id).take(most);
        std::iter::from_fn(move || Some((items.next()?, items.next()?)))
    }

    /// The index after the node and its descendants.
    fn end(&self, id: NodeId) -> u32 {
        let node = self.node(id);
        if matches!(node.syntax, NodeSyntax::List | NodeSyntax::Map) {
            node.link
        } else {
            id.0 + 1
        }
    }

    /// The value of `key` in a map, without merged maps.
    #[must_use]
    pub fn get(&self, map: NodeId, key: &str) -> Option<NodeId> {
        let map = self.target(map);
        let found = match self.keys.sorted(map) {
            Some(sorted) => keys::search(self, sorted, key),
            None => self
                .pairs(map)
                .map(|(found_text, _)| found_text)
                .find(|found_text| self.is(*found_text, key)),
        };
        found.map(|found_text| NodeId(found_text.0 + 1))
    }

    /// The value at the end of a path of keys.
    #[must_use]
    pub fn at(&self, map: NodeId, keys: &[&str]) -> Option<NodeId> {
        keys.iter().try_fold(map, |map, key| self.get(map, key))
    }

    /// The value of `key`, or the map itself without one: the best span for a diagnostic.
    #[must_use]
    pub fn at_or(&self, map: NodeId, key: &str) -> NodeId {
        self.get(map, key).unwrap_or(map)
    }

    /// The items of the list at `key` of a map; nothing if it is not a list.
    pub fn list(&self, map: NodeId, key: &str) -> impl Iterator<Item = NodeId> + '_ {
        let list = self.get(map, key).filter(|list| self.is_list(*list));
        list.into_iter().flat_map(|list| self.items(list))
    }

    /// Whether the values of two keys have the same source text.
    #[must_use]
    pub fn are_alike(&self, first: NodeId, second: NodeId) -> bool {
        let value = |key: NodeId| self.written(NodeId(key.0 + 1));
        value(first) == value(second)
    }

    /// The duplicate keys: the first occurrence and a later one.
    #[must_use]
    pub fn duplicate_keys(&self) -> &[(NodeId, NodeId)] {
        self.keys.duplicates()
    }
}

/// The byte range between the quotes of a string.
fn inside_quotes(start: u32, end: u32) -> Range<u32> {
    start + 1..end.saturating_sub(1)
}
