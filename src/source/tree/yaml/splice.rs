//! The tree of a text after a change, from the tree before it, where the change is inside one item
//! of a list: only the lines of that item are parsed again.

use super::super::keys::KeyIndex;
use super::super::{DetachedTree, NodeId, NodeSyntax, SyntaxTree, TreeNode};
use super::parse;
use rtc_math::to_u32;
use std::ops::Range;

/// The maximum number of lists and maps in an item that is parsed by itself, which bounds its
/// depth.
const MAX_COLLECTIONS: usize = 64;

/// A change of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReplacedBytes {
    /// The bytes of the old text that were replaced.
    pub replaced: Range<usize>,
    /// The number of bytes that replaced them.
    pub inserted: usize,
}

impl ReplacedBytes {
    /// An offset after the change, in the new text.
    fn moved(&self, offset: u32) -> Option<u32> {
        let offset = (offset as usize + self.inserted).checked_sub(self.replaced.len())?;
        u32::try_from(offset).ok()
    }
}

/// The tree of `text` after a change, if that of the text before it, which was parsed without a
/// mistake, tells enough. It equals the tree of the whole text.
///
/// `None` if the whole text must be parsed: the change is not inside one item of a block list that
/// is a value of the top-level map, the new item has a mistake, an anchor that is used, or a string
/// with escapes.
#[must_use]
pub fn splice(before: &DetachedTree, change: &ReplacedBytes, text: &str) -> Option<DetachedTree> {
    let DetachedTree(old) = before;
    let is_alias = |node: &TreeNode| node.syntax == NodeSyntax::Alias;
    if old.base != 0 || old.nodes.iter().any(is_alias) {
        return None;
    }
    // Find the item and its lines.
    let place = ItemPlace::of(old, change, text)?;
    let lines = text.get(place.lines.clone())?;
    // Parse them by themselves: they must be a list of one item, without a mistake.
    let mut mistakes = 0;
    let new = parse(old.file, lines.as_bytes(), &mut |_| mistakes += 1)?;
    let is_collection = |id: &NodeId| new.is_list(*id) || new.is_map(*id);
    let is_plain = new.ranges.is_empty()
        && !new.nodes.iter().any(is_alias)
        && new.nodes().filter(is_collection).count() <= MAX_COLLECTIONS;
    let root = new.node(new.root());
    let is_item = new.is_list(new.root())
        && !lines.trim_start().starts_with('[')
        && new.end(NodeId(1)) == root.link;
    if mistakes > 0 || !is_plain || !is_item {
        return None;
    }
    place.join(old, &new, change)
}

/// An item of a list of the top-level map.
struct ItemPlace {
    list: NodeId,
    item: NodeId,
    /// The nodes of the item in the old tree.
    nodes: Range<usize>,
    /// The lines of the item in the new text, from its dash to the next item or key.
    lines: Range<usize>,
}

impl ItemPlace {
    fn of(old: &SyntaxTree<'_>, change: &ReplacedBytes, text: &str) -> Option<Self> {
        let root = old.root();
        if !old.is_map(root) {
            return None;
        }
        // The last pair that starts before the change, and the last item of its list that does.
        let starts_before = |id: NodeId| old.range(id).0 < change.replaced.start;
        let pairs = old.pairs(root).take_while(|(key, _)| starts_before(*key));
        let (_, list) = pairs.last()?;
        if !old.is_list(list) {
            return None;
        }
        let items = old.items(list).take_while(|item| starts_before(*item));
        let item = items.last()?;
        // Its lines: from the dash before it to the line of the node after it.
        let first = line_start(text, old.range(item).0);
        let dash = first + text.get(first..)?.find(|letter: char| letter != ' ')?;
        let is_dash = text.get(dash..)?.starts_with("- ");
        let nodes = item.0 as usize..old.end(item) as usize;
        let end = change.replaced.start + change.inserted;
        let (last, is_before) = match old.nodes.get(nodes.end) {
            None => (text.len(), true),
            Some(next) if (next.start as usize) < change.replaced.end => return None,
            Some(next) => {
                let last = line_start(text, change.moved(next.start)? as usize);
                (last, end < last)
            }
        };
        let is_inside = change.replaced.start > dash + 1 && is_before;
        (is_dash && is_inside).then_some(Self {
            list,
            item,
            nodes,
            lines: first..last,
        })
    }

    /// The old tree with the new nodes of the item.
    fn join(
        &self,
        old: &SyntaxTree<'_>,
        new: &SyntaxTree<'_>,
        change: &ReplacedBytes,
    ) -> Option<DetachedTree> {
        let Range { start, end } = self.nodes.clone();
        let grown = new.nodes.len() - 1;
        let moved_id = |id: u32| {
            if id as usize >= end {
                to_u32(id as usize + grown - (end - start))
            } else {
                id
            }
        };
        let offset = to_u32(self.lines.start);
        let own_id = |id: u32| to_u32(id as usize - 1 + start);
        let own_end = new.node(NodeId(1)).end + offset;
        let old_end = old.node(self.item).end;
        let links = |node: &TreeNode| matches!(node.syntax, NodeSyntax::List | NodeSyntax::Map);
        let mut nodes = Vec::with_capacity(old.nodes.len() + grown);
        // The nodes before the item stay; those around it end later or earlier.
        for (id, node) in (0..).zip(&old.nodes[..start]) {
            let mut node = *node;
            if id == old.root().0 || id == self.list.0 {
                node.end = if node.end == old_end {
                    own_end
                } else {
                    change.moved(node.end)?
                };
                node.link = moved_id(node.link);
            }
            nodes.push(node);
        }
        nodes.extend(new.nodes[1..].iter().map(|node| TreeNode {
            start: node.start + offset,
            end: node.end + offset,
            link: if links(node) {
                own_id(node.link)
            } else {
                node.link
            },
            syntax: node.syntax,
        }));
        for node in &old.nodes[end..] {
            nodes.push(TreeNode {
                start: change.moved(node.start)?,
                end: change.moved(node.end)?,
                link: if links(node) {
                    moved_id(node.link)
                } else {
                    node.link
                },
                syntax: node.syntax,
            });
        }
        let is_of_item = |id: NodeId| self.nodes.contains(&(id.0 as usize));
        let keys = KeyIndex::joined(
            [&old.keys, &new.keys],
            |id| (!is_of_item(id)).then(|| NodeId(moved_id(id.0))),
            |id| Some(NodeId(own_id(id.0))),
        );
        Some(DetachedTree(SyntaxTree {
            source: "",
            base: 0,
            file: old.file,
            nodes,
            steps: Vec::new(),
            unescaped: old.unescaped.clone(),
            ranges: old.ranges.clone(),
            keys,
        }))
    }
}

/// The start of the line with an offset.
fn line_start(text: &str, offset: usize) -> usize {
    let before = text.as_bytes().get(..offset).unwrap_or_default();
    before
        .iter()
        .rposition(|byte| *byte == b'\n')
        .map_or(0, |at| at + 1)
}

#[cfg(test)]
mod tests {
    use super::super::super::SyntaxTree;
    use super::{DetachedTree, ReplacedBytes, parse, splice};
    use crate::{FileId, SourceMap};

    const SCENE: &str = "Camera: {eye: [0, 0, 9]}\nLights:\n- {position: [1, 2, 3]}\nObjects:\n\
        - type: sphere # a ball\n  position: [0, 0, 0]\n  material:\n    color: [1, 0.5, 0]\n\
        - {type: quad, list: [1, [2, 3]]}\n\n# between\n- type: é\n  name: 'it''s'\n  m: {a: 1, b: 2, \
        c: 3, d: 4, e: 5, f: 6, g: 7, h: 8, i: 9, j: 10, k: 11, l: 12, m: 13}\n- last\nShadows: true\n";

    fn file() -> FileId {
        SourceMap::default().add("", Vec::new())
    }

    fn tree(text: &str) -> Option<DetachedTree> {
        let mut mistakes = 0;
        let tree = parse(file(), text.as_bytes(), &mut |_| mistakes += 1)?;
        (mistakes == 0).then(|| tree.detach())
    }

    fn all(tree: &SyntaxTree<'_>) -> String {
        let nodes = tree
            .nodes()
            .map(|id| (tree.range(id), tree.text(id), tree.end(id)));
        let sorted = tree.nodes().filter(|id| tree.is_map(*id));
        let sorted = sorted.map(|id| tree.get(id, "k").map(|value| tree.range(value)));
        format!(
            "{:?} {:?}",
            nodes.collect::<Vec<_>>(),
            sorted.collect::<Vec<_>>()
        )
    }

    #[test]
    fn a_spliced_tree_is_that_of_the_whole_text() {
        compare_all(SCENE);
    }

    #[test]
    fn lists_may_be_indented() {
        let is_key = |line: &&str| line.starts_with(|letter: char| letter.is_uppercase());
        let lines = SCENE.lines().map(|line| match is_key(&line) {
            true => line.to_owned(),
            false => format!("  {line}"),
        });
        compare_all(&lines.collect::<Vec<_>>().join("\n"));
    }

    #[test]
    fn lines_may_end_as_those_of_windows() {
        compare_all(&SCENE.replace('\n', "\r\n"));
    }

    /// Each letter is preceded and replaced by each of some texts, and taken away.
    fn compare_all(scene: &str) {
        let before = tree(scene).expect("a tree");
        let mut spliced = 0;
        for (at, letter) in scene.char_indices() {
            for inserted in [
                "", "7", " ", "\n", "- ", "\n- x", "\n  k: 1", ": ", "[", "}", "'", "#", "&a ",
                "\n\n",
            ] {
                for length in [0, letter.len_utf8()] {
                    let change = ReplacedBytes {
                        replaced: at..at + length,
                        inserted: inserted.len(),
                    };
                    let mut text = scene.to_owned();
                    text.replace_range(change.replaced.clone(), inserted);
                    let Some(found) = splice(&before, &change, &text) else {
                        continue;
                    };
                    spliced += 1;
                    let whole = tree(&text).unwrap_or_else(|| panic!("no tree of {text}"));
                    let [found, whole] =
                        [found, whole].map(|tree| all(&tree.attach(file(), &text)));
                    assert_eq!(found, whole, "{text}");
                }
            }
        }
        assert!(spliced > 1000, "{spliced}");
    }
}
