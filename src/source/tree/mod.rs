//! The spanned tree: a text of YAML or JSON as one flat vector of nodes, each with the bytes it was
//! written in.
//!
//! Nodes are in the order of the text; a list or map knows where its descendants end, so nothing
//! recurses. A node is 16 bytes; of JSON it has a way to the root as well, and is 24. Aliases of
//! YAML are links and are never expanded, so a small text can't become a large tree.

pub mod json;
mod keys;
mod pointer;
#[cfg(test)]
mod tests;
mod written;
pub mod yaml;

use super::{FileId, Span};
use keys::Keys;
use pointer::PointerStep;
use std::ops::Range;

/// Names a node of a [`Tree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(u32);

/// How a node is written, and what its link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// `null` in JSON.
    Null,
    /// `true` or `false` in JSON.
    Bool,
    /// A number in JSON.
    Number,
    /// A word of YAML as written.
    Word,
    /// Text in quotes without escapes, quotes included in the range.
    Quoted,
    /// Text that differs from how it is written; the link is its index among the cooked ones.
    Cooked,
    /// A list; the link is one past its last descendant.
    List,
    /// A map, keys and values in turn; the link is one past its last descendant.
    Map,
    /// An alias for the node at the link.
    Alias,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    start: u32,
    end: u32,
    link: u32,
    form: Form,
}

/// What a node is, aliases followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeKind {
    /// `null` in JSON.
    Null,
    /// `true` or `false` in JSON.
    Bool,
    /// A number in JSON.
    Number,
    /// A plain word of YAML: a number, a truth value, nothing, or text. Who reads it decides.
    Word,
    /// Text in quotes or a block; also each key of a map in JSON.
    Text,
    /// A list.
    List,
    /// A map.
    Map,
}

impl NodeKind {
    /// As messages call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Bool => "a truth value",
            Self::Number => "a number",
            Self::Word => "a word",
            Self::Text => "a text",
            Self::List => "a list",
            Self::Map => "an object",
        }
    }
}

/// What a node is, with its text, aliases followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeContent<'t> {
    /// A plain word: a number, a truth value, nothing, or text.
    Word(&'t str),
    /// Text in quotes or a block.
    Text(&'t str),
    /// A list.
    List,
    /// A map.
    Map,
}

/// A parsed text. Offsets are those of the text, spans those of the file.
#[derive(Debug)]
pub struct Tree<'s> {
    source: &'s str,
    /// Where the text begins in its file.
    base: u32,
    file: FileId,
    nodes: Vec<Node>,
    /// The step that leads to each node of JSON; none of YAML.
    steps: Vec<PointerStep>,
    /// Texts that differ from how they are written, one after the other, and where each lies.
    cooked: String,
    places: Vec<(u32, u32)>,
    keys: Keys,
}

impl<'s> Tree<'s> {
    /// A tree without nodes, of a text that begins `base` bytes into its file.
    fn new(file: FileId, base: u32, source: &'s str) -> Self {
        Self {
            source,
            base,
            file,
            nodes: Vec::new(),
            steps: Vec::new(),
            cooked: String::new(),
            places: Vec::new(),
            keys: Keys::default(),
        }
    }

    /// The node of the whole document.
    #[must_use]
    pub fn root(&self) -> NodeId {
        NodeId(0)
    }

    /// How many values there are, and keys.
    #[must_use]
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// All nodes, in the order of the text.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> {
        (0..to_u32(self.nodes.len())).map(NodeId)
    }

    fn node(&self, id: NodeId) -> Node {
        self.nodes[id.0 as usize]
    }

    /// The text in these bytes, unless they cut a character.
    fn slice(&self, range: Range<u32>) -> Option<&'s str> {
        self.source.get(range.start as usize..range.end as usize)
    }

    /// Keeps a text that differs from how it is written; its index among the cooked ones.
    fn cook(&mut self, write: impl FnOnce(&mut String)) -> u32 {
        let start = to_u32(self.cooked.len());
        write(&mut self.cooked);
        self.places.push((start, to_u32(self.cooked.len())));
        to_u32(self.places.len() - 1)
    }

    /// The node an alias stands for, or the node itself. An alias never points at another.
    #[must_use]
    pub fn target(&self, id: NodeId) -> NodeId {
        let node = self.node(id);
        if node.form == Form::Alias {
            NodeId(node.link)
        } else {
            id
        }
    }

    /// Where the node was written; for an alias, where the alias stands.
    #[must_use]
    pub fn span(&self, id: NodeId) -> Span {
        let node = self.node(id);
        Span::new(self.file, node.start + self.base, node.end + self.base)
    }

    /// The bytes of the text that the node was written in.
    #[must_use]
    pub fn place(&self, id: NodeId) -> (usize, usize) {
        let node = self.node(id);
        (node.start as usize, node.end as usize)
    }

    /// As written; for an alias, the alias.
    #[must_use]
    pub fn written(&self, id: NodeId) -> &'s str {
        self.word(self.node(id))
    }

    fn word(&self, node: Node) -> &'s str {
        self.slice(node.start..node.end)
            .expect("a node starts and ends between characters")
    }

    /// The node that is meant, aliases followed.
    fn meant(&self, id: NodeId) -> Node {
        let node = self.node(id);
        if node.form == Form::Alias {
            self.node(NodeId(node.link))
        } else {
            node
        }
    }

    /// What the node is, aliases followed.
    #[must_use]
    pub fn kind(&self, id: NodeId) -> NodeKind {
        match self.meant(id).form {
            Form::Null => NodeKind::Null,
            Form::Bool => NodeKind::Bool,
            Form::Number => NodeKind::Number,
            Form::Word => NodeKind::Word,
            Form::Quoted | Form::Cooked => NodeKind::Text,
            Form::List => NodeKind::List,
            Form::Map => NodeKind::Map,
            Form::Alias => unreachable!("an alias never stands for another"),
        }
    }

    /// What the node is, with its text, aliases followed.
    #[must_use]
    pub fn shape(&self, id: NodeId) -> NodeContent<'_> {
        let node = self.meant(id);
        match node.form {
            Form::Null | Form::Bool | Form::Number | Form::Word => {
                NodeContent::Word(self.word(node))
            }
            Form::Quoted | Form::Cooked => NodeContent::Text(self.quoted(node)),
            Form::List => NodeContent::List,
            Form::Map => NodeContent::Map,
            Form::Alias => unreachable!("an alias never stands for another"),
        }
    }

    /// Whether the node is a map, aliases followed.
    #[must_use]
    pub fn is_map(&self, id: NodeId) -> bool {
        self.meant(id).form == Form::Map
    }

    /// Whether the node is a list, aliases followed.
    #[must_use]
    pub fn is_list(&self, id: NodeId) -> bool {
        self.meant(id).form == Form::List
    }

    /// What is said by a text in quotes or a block.
    fn quoted(&self, node: Node) -> &str {
        let text = if node.form == Form::Cooked {
            let (start, end) = self.places[node.link as usize];
            self.cooked.get(start as usize..end as usize)
        } else {
            self.slice(inside_quotes(node.start, node.end))
        };
        text.expect("a text starts and ends between characters")
    }

    /// The text of a word, quoted or not; of JSON, of texts alone.
    #[must_use]
    pub fn text(&self, id: NodeId) -> Option<&str> {
        let node = self.meant(id);
        match node.form {
            Form::Quoted | Form::Cooked => Some(self.quoted(node)),
            Form::Word => Some(self.word(node)),
            Form::Null | Form::Bool | Form::Number | Form::List | Form::Map => None,
            Form::Alias => unreachable!("an alias never stands for another"),
        }
    }

    /// True if the node is the text given.
    #[must_use]
    pub fn is(&self, id: NodeId, text: &str) -> bool {
        self.text(id).is_some_and(|own| own == text)
    }

    /// The number of a number in JSON; infinite if a 64-bit float can't hold it.
    #[must_use]
    pub fn number(&self, id: NodeId) -> Option<f64> {
        (self.kind(id) == NodeKind::Number)
            .then(|| self.written(id).parse().unwrap_or(f64::INFINITY))
    }

    /// The number of a number in JSON that is whole, not negative and below 2^53, however it is
    /// written.
    #[must_use]
    pub fn whole(&self, id: NodeId) -> Option<u64> {
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

    /// The truth of a truth value in JSON.
    #[must_use]
    pub fn boolean(&self, id: NodeId) -> Option<bool> {
        (self.kind(id) == NodeKind::Bool).then(|| self.written(id) == "true")
    }

    /// The items of a list; of a map, its keys and values in turn; of a word, nothing.
    pub fn items(&self, id: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let id = self.target(id);
        let end = self.end(id);
        let inside = move |id: u32| (id < end).then_some(NodeId(id));
        std::iter::successors(inside(id.0 + 1), move |id| inside(self.end(*id)))
    }

    /// The keys and values of a map as written, merge keys included; of anything else, nothing.
    pub fn pairs(&self, id: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let most = if self.is_map(id) { usize::MAX } else { 0 };
        let mut items = self.items(id).take(most);
        std::iter::from_fn(move || Some((items.next()?, items.next()?)))
    }

    /// The index after the node and its descendants.
    fn end(&self, id: NodeId) -> u32 {
        let node = self.node(id);
        if matches!(node.form, Form::List | Form::Map) {
            node.link
        } else {
            id.0 + 1
        }
    }

    /// The value of `key` in a map, its own alone.
    #[must_use]
    pub fn get(&self, map: NodeId, key: &str) -> Option<NodeId> {
        let map = self.target(map);
        let found = match self.keys.sorted(map) {
            Some(sorted) => keys::search(self, sorted, key),
            None => self
                .pairs(map)
                .map(|(own, _)| own)
                .find(|own| self.is(*own, key)),
        };
        found.map(|own| NodeId(own.0 + 1))
    }

    /// The value at the end of a way of keys.
    #[must_use]
    pub fn at(&self, map: NodeId, keys: &[&str]) -> Option<NodeId> {
        keys.iter().try_fold(map, |map, key| self.get(map, key))
    }

    /// The value of `key`, or the map itself where it has none: the best place to point at.
    #[must_use]
    pub fn at_or(&self, map: NodeId, key: &str) -> NodeId {
        self.get(map, key).unwrap_or(map)
    }

    /// The items of the list that `key` of a map holds; none if there is no such list.
    pub fn list(&self, map: NodeId, key: &str) -> impl Iterator<Item = NodeId> + '_ {
        let list = self.get(map, key).filter(|list| self.is_list(*list));
        list.into_iter().flat_map(|list| self.items(list))
    }

    /// Whether the values behind two keys are written alike.
    #[must_use]
    pub fn are_alike(&self, first: NodeId, second: NodeId) -> bool {
        let value = |key: NodeId| self.written(NodeId(key.0 + 1));
        value(first) == value(second)
    }

    /// The keys that stand again in their map: the first of each, and another.
    #[must_use]
    pub fn duplicate_keys(&self) -> &[(NodeId, NodeId)] {
        self.keys.duplicates()
    }
}

/// The bytes between the quotes of a quoted word.
fn inside_quotes(start: u32, end: u32) -> Range<u32> {
    start + 1..end.saturating_sub(1)
}

/// An offset or index of a text; the loader refuses files of 4 GiB and more.
fn to_u32(count: usize) -> u32 {
    u32::try_from(count).expect("the loader refuses files of 4 GiB and more")
}
