//! The spanned tree: YAML text as one flat vector of nodes, each with the bytes it was written in.
//!
//! A node is 16 bytes, in the order of the text; a list or map knows where its descendants end.
//! Aliases are links and are never expanded, so a small text can't become a large tree. Only this
//! folder names the YAML parser.

mod build;
mod fault;
mod mistake;
mod text;

pub use build::{MAX_DEPTH, parse};
pub use mistake::Mistake;

use crate::source::{FileId, Span};
use std::ops::Range;

/// Names a node of a [`Tree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(u32);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A word as written; `link` is unused.
    Plain,
    /// A word in quotes without escapes, quotes included in the range; `link` is unused.
    Quoted,
    /// A word that differs from its text; `link` is its index among the cooked ones.
    Cooked,
    /// A list; `link` is one past its last descendant.
    List,
    /// A map, keys and values in turn; `link` is one past its last descendant.
    Map,
    /// A link to the node at `link`.
    Alias,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    start: u32,
    end: u32,
    link: u32,
    kind: Kind,
}

/// What a node is, aliases followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<'s> {
    /// A plain word: a number, a truth value, nothing, or text.
    Word(&'s str),
    /// Text in quotes or a block.
    Text(&'s str),
    /// A list.
    List,
    /// A map.
    Map,
}

/// A parsed text. Offsets are those of the file.
#[derive(Debug)]
pub struct Tree<'s> {
    source: &'s str,
    base: u32,
    file: FileId,
    nodes: Vec<Node>,
    cooked: Vec<String>,
}

impl Tree<'_> {
    /// The node of the whole document.
    pub fn root(&self) -> NodeId {
        NodeId(0)
    }

    /// The text written in these bytes, unless they cut a character.
    fn written(&self, range: Range<u32>) -> Option<&str> {
        self.source.get(range.start as usize..range.end as usize)
    }

    fn node(&self, id: NodeId) -> Node {
        self.nodes[id.0 as usize]
    }

    /// The node an alias stands for, or the node itself. An alias never points at another.
    pub fn target(&self, id: NodeId) -> NodeId {
        let node = self.node(id);
        if node.kind == Kind::Alias {
            NodeId(node.link)
        } else {
            id
        }
    }

    /// Where the node was written; for an alias, where the alias stands.
    pub fn span(&self, id: NodeId) -> Span {
        let node = self.node(id);
        Span::new(self.file, node.start + self.base, node.end + self.base)
    }

    /// What the node is, aliases followed.
    pub fn shape(&self, id: NodeId) -> Shape<'_> {
        let node = self.node(self.target(id));
        let written = |range| {
            self.written(range)
                .expect("a word was read where it was written")
        };
        match node.kind {
            Kind::Plain => Shape::Word(written(node.start..node.end)),
            Kind::Quoted => Shape::Text(written(inside_quotes(node.start, node.end))),
            Kind::Cooked => Shape::Text(&self.cooked[node.link as usize]),
            Kind::List => Shape::List,
            Kind::Map => Shape::Map,
            Kind::Alias => {
                unreachable!("`target` follows aliases, and an alias can't carry an anchor")
            }
        }
    }

    /// Whether the node is a map, aliases followed.
    pub fn is_map(&self, id: NodeId) -> bool {
        self.node(self.target(id)).kind == Kind::Map
    }

    /// Whether the node is a list, aliases followed.
    pub fn is_list(&self, id: NodeId) -> bool {
        self.node(self.target(id)).kind == Kind::List
    }

    /// The text of a word, quoted or not.
    pub fn text(&self, id: NodeId) -> Option<&str> {
        match self.shape(id) {
            Shape::Word(text) | Shape::Text(text) => Some(text),
            Shape::List | Shape::Map => None,
        }
    }

    /// The items of a list; of a map, its keys and values in turn; of a word, nothing.
    pub fn items(&self, id: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let id = self.target(id);
        let node = self.node(id);
        let end = if matches!(node.kind, Kind::List | Kind::Map) {
            node.link
        } else {
            0
        };
        let inside = move |id: u32| (id < end).then_some(NodeId(id));
        std::iter::successors(inside(id.0 + 1), move |id| inside(self.after(*id)))
    }

    /// The keys and values of a map as written, merge keys included.
    pub fn pairs(&self, id: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let mut items = self.items(id);
        std::iter::from_fn(move || Some((items.next()?, items.next()?)))
    }

    /// The index after the node and its descendants.
    fn after(&self, id: NodeId) -> u32 {
        let node = self.node(id);
        if matches!(node.kind, Kind::List | Kind::Map) {
            node.link
        } else {
            id.0 + 1
        }
    }
}

/// The bytes between the quotes of a quoted word.
fn inside_quotes(start: u32, end: u32) -> Range<u32> {
    start + 1..end.saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    fn with<R>(text: &str, look: impl FnOnce(&Tree<'_>) -> R) -> R {
        let mut map = SourceMap::default();
        let file = map.add("t", text.as_bytes().to_vec());
        let tree = parse(file, map.bytes(file), &mut |mistake| panic!("{mistake:?}")).unwrap();
        look(&tree)
    }

    #[test]
    fn a_node_is_sixteen_bytes() {
        assert_eq!(size_of::<Node>(), 16);
    }

    #[test]
    fn aliases_are_links_and_spans_are_bytes_of_the_file() {
        with("\u{feff}a: &x [1, 'q', \"\\u0041\"]\nb: *x\n", |tree| {
            let pairs: Vec<_> = tree.pairs(tree.root()).collect();
            assert_eq!(pairs.len(), 2);
            let words: Vec<_> = tree.items(pairs[1].1).map(|id| tree.shape(id)).collect();
            assert_eq!(
                words,
                [Shape::Word("1"), Shape::Text("q"), Shape::Text("A")]
            );
            assert_eq!(tree.target(pairs[1].1), pairs[0].1);
            let (list, alias) = (tree.span(pairs[0].1), tree.span(pairs[1].1));
            assert_eq!(
                (list.start, list.end, alias.start, alias.end),
                (9, 27, 31, 33)
            );
        });
    }

    #[test]
    fn a_block_is_text_whatever_it_begins_with() {
        for (text, word) in [
            ("a: |\n  \"b \u{1cc}", "\"b \u{1cc}"),
            ("a: |\n  'b \u{e9}", "'b \u{e9}"),
            ("a: >\n  \"b\"", "\"b\""),
            ("a: |-\n  '\n", "'"),
            ("a: |\n  5", "5"),
        ] {
            with(text, |tree| {
                let (_, value) = tree.pairs(tree.root()).next().unwrap();
                let Shape::Text(found) = tree.shape(value) else {
                    panic!("{text:?} is no text")
                };
                // Whether a last line that does not end gets an end is the parser's affair.
                assert_eq!(found.trim_end_matches('\n'), word, "{text:?}");
            });
        }
    }

    #[test]
    fn nothing_written_is_the_empty_word_after_its_key() {
        with("Objects:\nLights: []\n", |tree| {
            let (_, nothing) = tree.pairs(tree.root()).next().unwrap();
            assert_eq!(tree.shape(nothing), Shape::Word(""));
            assert_eq!((tree.span(nothing).start, tree.span(nothing).end), (7, 7));
        });
    }
}
