//! The anchors of YAML and their aliases: references and renaming.

use super::open_text::OpenText;
use super::outline;
use super::protocol::{Location, Position, TextEdit};
use super::text::{Columns, TextLines};
use rtc_source::tree::{NodeId, SyntaxTree};
use std::ops::Range;

/// An anchor.
pub(super) struct Anchor<'t> {
    /// Its name, without `&`.
    pub(super) name: &'t str,
    /// The bytes of the name.
    pub(super) bytes: Range<usize>,
    /// What it names.
    pub(super) node: NodeId,
}

/// The anchors of a text, in its order.
pub(super) fn anchors<'t>(text: &'t str, tree: &SyntaxTree<'_>) -> Vec<Anchor<'t>> {
    let mut found = Vec::new();
    // Most texts have none.
    if !text.contains('&') {
        return found;
    }
    let mut end = 0;
    for node in tree.nodes() {
        // Anchors stand before nodes, between scalars.
        let (start, own_end) = tree.range(node);
        let gap = text.get(end..start).unwrap_or_default();
        for bytes in names(gap) {
            let bytes = end + bytes.start..end + bytes.end;
            let name = text.get(bytes.clone()).unwrap_or_default();
            found.push(Anchor { name, bytes, node });
        }
        let is_open = tree.target(node) == node && (tree.is_map(node) || tree.is_list(node));
        end = end.max(if is_open { start } else { own_end });
    }
    found
}

/// The names of the anchors in a text without scalars.
fn names(gap: &str) -> Vec<Range<usize>> {
    let mut names = Vec::new();
    let mut start = 0;
    for line in gap.split_inclusive('\n') {
        let code = line.split('#').next().unwrap_or_default();
        for (at, _) in code.match_indices('&') {
            let name = code.split_at(at + 1).1;
            let length = name.find(|c: char| !is_of_name(c)).unwrap_or(name.len());
            names.push(start + at + 1..start + at + 1 + length);
        }
        start += line.len();
    }
    names
}

fn is_of_name(c: char) -> bool {
    !c.is_whitespace() && !",[]{}".contains(c)
}

/// All places of the name at a byte: that of the anchor, then those of its aliases.
struct NamePlaces {
    anchor: Range<usize>,
    aliases: Vec<Range<usize>>,
}

impl NamePlaces {
    fn at(text: &str, tree: &SyntaxTree<'_>, offset: usize) -> Option<Self> {
        let alias_name = |id: NodeId| tree.range(id).0 + 1..tree.range(id).1;
        let is_alias = |id: NodeId| tree.target(id) != id;
        let touches = |bytes: &Range<usize>| bytes.start <= offset + 1 && offset <= bytes.end;
        let all = anchors(text, tree);
        let mut aliases = tree.nodes().filter(|id| is_alias(*id));
        let node = match all.iter().find(|anchor| touches(&anchor.bytes)) {
            Some(anchor) => anchor.node,
            None => tree.target(aliases.find(|id| touches(&alias_name(*id)))?),
        };
        let anchor = all.into_iter().find(|anchor| anchor.node == node)?;
        let aliases = tree
            .nodes()
            .filter(|id| is_alias(*id) && tree.target(*id) == node);
        Some(Self {
            anchor: anchor.bytes,
            aliases: aliases.map(alias_name).collect(),
        })
    }

    fn all(&self) -> impl Iterator<Item = &Range<usize>> {
        std::iter::once(&self.anchor).chain(&self.aliases)
    }
}

fn location(document: &OpenText, lines: &TextLines<'_>, bytes: &Range<usize>) -> Location {
    // With the sign before the name.
    let range = lines.range(bytes.start - 1, bytes.end);
    Location::new(document.uri.clone(), range)
}

/// The aliases of the anchor at a position, and the anchor itself if it is asked for.
pub(super) fn references(
    document: &OpenText,
    position: Position,
    has_anchor: bool,
    columns: Columns,
) -> Option<Vec<Location>> {
    let (tree, lines) = (document.tree()?, document.lines(columns));
    let places = NamePlaces::at(&document.text, &tree, lines.offset(position))?;
    let shown = places.all().skip(usize::from(!has_anchor));
    let located = shown.map(|bytes| location(document, &lines, bytes));
    Some(located.take(outline::MOST).collect())
}

/// The range of the name at a position.
pub(super) fn name_range(
    document: &OpenText,
    position: Position,
    columns: Columns,
) -> Option<super::protocol::Range> {
    let (tree, lines) = (document.tree()?, document.lines(columns));
    let offset = lines.offset(position);
    let places = NamePlaces::at(&document.text, &tree, offset)?;
    let mut all = places.all();
    let here = all.find(|bytes| bytes.start <= offset + 1 && offset <= bytes.end)?;
    Some(lines.range(here.start, here.end))
}

/// The changes that give the anchor at a position another name.
///
/// # Errors
/// If it can't be the name of an anchor, or is that of another.
pub(super) fn rename(
    document: &OpenText,
    position: Position,
    name: &str,
    columns: Columns,
) -> Result<Option<Vec<TextEdit>>, String> {
    if name.is_empty() || !name.chars().all(is_of_name) {
        return Err("the name of an anchor has no spaces and none of `,[]{}`".to_owned());
    }
    let Some(tree) = document.tree() else {
        return Ok(None);
    };
    let lines = document.lines(columns);
    let offset = lines.offset(position);
    let Some(places) = NamePlaces::at(&document.text, &tree, offset) else {
        return Ok(None);
    };
    let mut others = anchors(&document.text, &tree).into_iter();
    if others.any(|anchor| anchor.name == name && anchor.bytes != places.anchor) {
        return Err(format!("there is an anchor `{name}`"));
    }
    let edit =
        |bytes: &Range<usize>| TextEdit::new(lines.range(bytes.start, bytes.end), name.to_owned());
    Ok(Some(places.all().map(edit).collect()))
}
