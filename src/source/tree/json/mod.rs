//! JSON as one flat vector of nodes, each with the bytes it was written in and its way from the
//! root.
//!
//! A list or map knows where its descendants end, so nothing recurses, and a node costs 24 bytes,
//! whatever it is.

mod scan;
mod text;

pub use scan::parse;

use crate::source::{FileId, Span};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Names a node of a [`Tree`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NodeId(u32);

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `null`.
    Null,
    /// `true` or `false`.
    Truth,
    /// A number.
    Number,
    /// A text; also each key of a map.
    Text,
    /// A list.
    List,
    /// A map: its keys and values are nodes in turn.
    Map,
}

impl Kind {
    /// As messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Truth => "a truth value",
            Self::Number => "a number",
            Self::Text => "a text",
            Self::List => "a list",
            Self::Map => "an object",
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    start: u32,
    end: u32,
    /// One past the last descendant.
    after: u32,
    /// The list or map this node lies in; the root lies in itself.
    parent: u32,
    /// The index in a list; 0 elsewhere.
    slot: u32,
    kind: Kind,
}

/// A parsed text; offsets are those of the text, spans those of the file.
#[derive(Debug)]
pub struct Tree<'s> {
    text: &'s str,
    base: u32,
    file: FileId,
    nodes: Vec<Node>,
    twice: Vec<(NodeId, NodeId)>,
    /// The keys of each map that has many, sorted by what they say.
    wide: BTreeMap<NodeId, Vec<NodeId>>,
}

/// The longest step of a pointer and the longest pointer in bytes: longer ones are cut, for
/// findings are many.
const LONG_STEP: usize = 256;
const LONG_POINTER: usize = 512;

impl<'s> Tree<'s> {
    /// The node of the whole document.
    pub fn root(&self) -> NodeId {
        NodeId(0)
    }

    /// How many values there are, and keys.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    fn node(&self, id: NodeId) -> Node {
        self.nodes[id.0 as usize]
    }

    /// What the node is.
    pub fn kind(&self, id: NodeId) -> Kind {
        self.node(id).kind
    }

    /// Where the node was written.
    pub fn span(&self, id: NodeId) -> Span {
        let node = self.node(id);
        Span::new(self.file, node.start + self.base, node.end + self.base)
    }

    /// As written.
    pub fn written(&self, id: NodeId) -> &'s str {
        let node = self.node(id);
        self.text
            .get(node.start as usize..node.end as usize)
            .expect("a node starts and ends between characters")
    }

    /// The items of a list; of a map, its keys and values in turn.
    pub fn items(&self, id: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let node = self.node(id);
        let end = if matches!(node.kind, Kind::List | Kind::Map) {
            node.after
        } else {
            0
        };
        let inside = move |id: u32| (id < end).then_some(NodeId(id));
        std::iter::successors(inside(id.0 + 1), move |id| inside(self.node(*id).after))
    }

    /// The items of the list that `key` of a map holds; none if there is no such list.
    pub fn list(&self, map: NodeId, key: &str) -> impl Iterator<Item = NodeId> + '_ {
        let list = self
            .get(map, key)
            .filter(|list| self.kind(*list) == Kind::List);
        list.into_iter().flat_map(|list| self.items(list))
    }

    /// The keys and values of a map; of anything else, nothing.
    pub fn pairs(&self, id: NodeId) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        let mut items = self.items(id).take(if self.kind(id) == Kind::Map {
            usize::MAX
        } else {
            0
        });
        std::iter::from_fn(move || Some((items.next()?, items.next()?)))
    }

    /// The value of `key` in a map.
    pub fn get(&self, map: NodeId, key: &str) -> Option<NodeId> {
        let Some(sorted) = self.wide.get(&map) else {
            return self
                .pairs(map)
                .find(|(name, _)| self.is(*name, key))
                .map(|(_, value)| value);
        };
        let first = sorted.partition_point(|own| self.text(*own).is_some_and(|own| *own < *key));
        sorted
            .get(first)
            .filter(|own| self.is(**own, key))
            .map(|own| NodeId(own.0 + 1))
    }

    /// The value at the end of a way of keys.
    pub fn at(&self, map: NodeId, keys: &[&str]) -> Option<NodeId> {
        keys.iter().try_fold(map, |map, key| self.get(map, key))
    }

    /// The value of `key`, or the map itself where it has none: the best place to point at.
    pub fn at_or(&self, map: NodeId, key: &str) -> NodeId {
        self.get(map, key).unwrap_or(map)
    }

    /// True if the node is the text given.
    pub fn is(&self, id: NodeId, text: &str) -> bool {
        self.text(id).is_some_and(|own| own == text)
    }

    /// The text of a text.
    pub fn text(&self, id: NodeId) -> Option<Cow<'s, str>> {
        (self.kind(id) == Kind::Text).then(|| text::value(self.written(id)))
    }

    /// The number of a number; infinite if a 64-bit float can't hold it.
    pub fn number(&self, id: NodeId) -> Option<f64> {
        let written = self.written(id);
        (self.kind(id) == Kind::Number).then(|| written.parse().unwrap_or(f64::INFINITY))
    }

    /// The number of a number that is whole, not negative and below 2^53, however it is written.
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

    /// The truth of a truth value.
    pub fn truth(&self, id: NodeId) -> Option<bool> {
        (self.kind(id) == Kind::Truth).then(|| self.written(id) == "true")
    }

    /// The keys that stand twice in their map: an earlier one and a later.
    pub fn twice(&self) -> &[(NodeId, NodeId)] {
        &self.twice
    }

    /// The list or map the node lies in; the root lies in itself.
    pub fn parent(&self, id: NodeId) -> NodeId {
        NodeId(self.node(id).parent)
    }

    /// The way from the root to the node, a JSON pointer (RFC 6901). Of a long one the beginning is
    /// left out, and of a long key the end: `…` stands there.
    pub fn pointer(&self, id: NodeId) -> String {
        let mut steps = Vec::new();
        let (mut at, mut length) = (id, 0);
        while at != self.root() && length <= LONG_POINTER {
            let node = self.node(at);
            let parent = NodeId(node.parent);
            let step = if self.kind(parent) == Kind::List {
                node.slot.to_string()
            } else {
                self.key(at)
            };
            length += step.len() + 1;
            steps.push(format!("/{}", step.replace('~', "~0").replace('/', "~1")));
            at = parent;
        }
        if at != self.root() {
            steps.push("…".to_owned());
        }
        steps.iter().rev().map(String::as_str).collect()
    }

    /// The key of a value of a map; of a key, itself. The beginning of a long one, as written.
    fn key(&self, id: NodeId) -> String {
        let before = NodeId(id.0 - 1);
        let node = self.node(id);
        let is_key = self.text.as_bytes()[node.end as usize..]
            .trim_ascii_start()
            .first()
            == Some(&b':');
        let key = if is_key { id } else { before };
        let written = self.written(key);
        if written.len() <= LONG_STEP {
            return self.text(key).unwrap_or_default().into_owned();
        }
        let end = written.floor_char_boundary(LONG_STEP);
        format!("{}…", written.get(1..end).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    fn file() -> FileId {
        SourceMap::default().add("x", Vec::new())
    }

    #[test]
    fn nodes_know_their_way_and_their_bytes() {
        let text = r#" {"a": [1, {"b/c": "x\u00e9\ud83d\ude00"}, true], "d": {}, "e": -2.5e1} "#;
        let tree = parse(file(), 10, text).unwrap();
        let at = |keys: &[&str]| tree.at(tree.root(), keys).unwrap();
        let inner = tree.items(at(&["a"])).nth(1).unwrap();
        let text = tree.get(inner, "b/c").unwrap();
        assert_eq!(
            (
                tree.pointer(text).as_str(),
                tree.text(text).unwrap().as_ref()
            ),
            ("/a/1/b~1c", "xé😀")
        );
        assert_eq!(
            (tree.number(at(&["e"])), tree.whole(at(&["e"]))),
            (Some(-25.0), None)
        );
        assert_eq!(
            tree.items(at(&["a"]))
                .filter_map(|id| tree.truth(id))
                .next(),
            Some(true)
        );
        assert_eq!(
            (
                tree.pairs(at(&["d"])).count(),
                tree.pairs(tree.root()).count()
            ),
            (0, 3)
        );
        assert_eq!(tree.span(tree.root()).start, 11);
        let (key, _) = tree.pairs(tree.root()).nth(1).unwrap();
        assert_eq!(tree.pointer(key), "/d");
    }

    #[test]
    fn what_is_no_json_is_found_where_it_is() {
        for (text, at) in [
            ("", 0),
            ("{", 1),
            ("[1,]", 3),
            ("{\"a\" 1}", 5),
            ("{\"a\":1,}", 7),
            ("01", 1),
            ("1.", 2),
            ("tru", 0),
            ("\"a", 2),
            ("\"\\x\"", 1),
            ("[1 2]", 3),
            ("{} {}", 3),
            ("\"\n\"", 1),
            ("-", 1),
            ("1e", 2),
            ("nan", 0),
        ] {
            assert_eq!(parse(file(), 0, text).unwrap_err().at, at, "{text}");
        }
    }

    #[test]
    fn keys_that_stand_twice_are_found_in_small_maps_and_large() {
        let twice = |text: &str| {
            let tree = parse(file(), 0, text).unwrap();
            tree.twice()
                .iter()
                .map(|(_, later)| tree.span(*later).start as usize)
                .collect::<Vec<_>>()
        };
        assert_eq!(twice(r#"{"a":1,"\u0061":2}"#), [7]);
        let many: String = (0..100).map(|key| format!("\"{key}\":0,")).collect();
        assert_eq!(twice(&format!("{{{many}\"50\":1}}")), [many.len() + 1]);
    }

    #[test]
    fn keys_of_wide_maps_are_found() {
        let text: String = (0..100)
            .map(|key| format!("\"\\u0061{key}\":{key},"))
            .collect();
        let text = format!("{{{text}\"b\":[1,{{\"c\":2}}]}}");
        let tree = parse(file(), 0, &text).unwrap();
        let found =
            (0..100).filter_map(|key| tree.whole(tree.get(tree.root(), &format!("a{key}"))?));
        assert!(found.eq(0..100));
        assert_eq!(tree.get(tree.root(), "a100"), None);
        assert_eq!(tree.list(tree.root(), "b").count(), 2);
    }

    #[test]
    fn long_pointers_are_cut() {
        let text = format!("{{\"{}\":{{\"b\":1}}}}", "ü".repeat(1_000));
        let tree = parse(file(), 0, &text).unwrap();
        let inner = tree.pairs(tree.root()).next().unwrap().1;
        let pointer = tree.pointer(tree.get(inner, "b").unwrap());
        assert!(
            pointer.starts_with("/ü") && pointer.ends_with("ü…/b") && pointer.len() < 300,
            "{pointer}"
        );
        let text = r#"{"key":"#.repeat(500) + "1" + &"}".repeat(500);
        let tree = parse(file(), 0, &text).unwrap();
        let pointer = tree.pointer(NodeId(1_000));
        assert!(
            pointer.starts_with("…/key/key/") && pointer.len() < 600,
            "{pointer}"
        );
    }

    #[test]
    fn depth_is_bounded() {
        assert!(parse(file(), 0, &("[".repeat(500) + &"]".repeat(500))).is_ok());
        assert_eq!(parse(file(), 0, &"[".repeat(100_000)).unwrap_err().at, 512);
    }
}
