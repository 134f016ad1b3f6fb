//! The contents of a document: outline, colours, and the targets of names.

use super::completion::is_file;
use super::open_text::OpenText;
use super::path_at::path_at;
use super::place;
use super::protocol::{
    ColorInformation, ColorPresentation, DocumentSymbol, EditorColor, Location, Position, Range,
    SymbolKind,
};
use super::text::{Columns, TextLines};
use super::vocabulary::Vocabulary;
use rtc_source::tree::{NodeContent, NodeId, SyntaxTree};

/// The maximum number of results of one kind.
pub(super) const MOST: usize = 5000;

/// The keys of the scene, and the items of their lists.
pub(super) fn symbols(document: &OpenText, columns: Columns) -> Vec<DocumentSymbol> {
    let Some(tree) = document.tree() else {
        return Vec::new();
    };
    let lines = document.lines(columns);
    let range = |id: NodeId| range(&tree, id, &lines);
    let symbol = |name: String, kind, whole: Range, name_range: Range, children| DocumentSymbol {
        name,
        kind,
        range: whole,
        selection_range: name_range,
        children,
    };
    let item = |(at, id): (usize, NodeId)| {
        let name = named(&tree, id).unwrap_or_else(|| format!("{at}"));
        symbol(name, SymbolKind::OBJECT, range(id), range(id), Vec::new())
    };
    let pairs = tree.pairs(tree.root()).take(MOST);
    let symbols = pairs.map(|(key, value)| {
        let items = tree.items(value).filter(|_| tree.is_list(value));
        let items = items.enumerate().filter(|(_, id)| tree.is_map(*id));
        let children = items.take(MOST).map(item).collect();
        let whole = Range::new(range(key).start, range(value).end.max(range(key).end));
        let name = tree.text(key).unwrap_or_default().to_owned();
        symbol(name, SymbolKind::PROPERTY, whole, range(key), children)
    });
    symbols.filter(|symbol| !symbol.name.is_empty()).collect()
}

/// The name or type of a map.
fn named(tree: &SyntaxTree<'_>, id: NodeId) -> Option<String> {
    let mut names = ["name", "type", "file"].into_iter();
    let found = names.find_map(|key| tree.text(tree.get(id, key)?));
    found.filter(|name| !name.is_empty()).map(str::to_owned)
}

/// The range of a node.
pub(super) fn range(tree: &SyntaxTree<'_>, id: NodeId, lines: &TextLines<'_>) -> Range {
    let span = tree.span(id);
    lines.range(span.start as usize, span.end as usize)
}

/// The colours of a document: the values of keys with `color` in their name.
pub(super) fn colors(document: &OpenText, columns: Columns) -> Vec<ColorInformation> {
    let Some(tree) = document.tree() else {
        return Vec::new();
    };
    let lines = document.lines(columns);
    let pairs = maps(&tree).flat_map(|map| tree.pairs(map).collect::<Vec<_>>());
    let colors = pairs.filter_map(|(key, value)| {
        let name = tree.text(key)?.to_lowercase();
        let is_here = tree.target(value) == value && tree.is_list(value);
        let is_color = is_here && (name.contains("color") || name.contains("colour"));
        let values: Vec<f32> = tree
            .items(value)
            .filter_map(|id| number(&tree, id))
            .collect();
        let [red, green, blue] = values.try_into().ok().filter(|_| is_color)?;
        let [red, green, blue] = [red, green, blue].map(|v: f32| v.clamp(0.0, 1.0));
        let color = EditorColor {
            red,
            green,
            blue,
            alpha: 1.0,
        };
        let range = range(&tree, value, &lines);
        Some(ColorInformation { range, color })
    });
    colors.take(MOST).collect()
}

/// The maps that are written in the text, each once.
fn maps(tree: &SyntaxTree<'_>) -> impl Iterator<Item = NodeId> {
    let is_written = |id: &NodeId| tree.is_map(*id) && tree.target(*id) == *id;
    tree.nodes().filter(is_written)
}

fn number(tree: &SyntaxTree<'_>, id: NodeId) -> Option<f32> {
    match tree.shape(id) {
        NodeContent::Word(word) => word.parse().ok(),
        NodeContent::Text(_) | NodeContent::List | NodeContent::Map => None,
    }
}

/// The spelling of a colour.
pub(super) fn presentation(color: EditorColor) -> Vec<ColorPresentation> {
    let EditorColor {
        red, green, blue, ..
    } = color;
    let channels = [red, green, blue].map(|v| {
        let text = format!("{:.3}", f64::from(v));
        let short = text.trim_end_matches('0').trim_end_matches('.');
        short.to_owned()
    });
    vec![ColorPresentation {
        label: format!("[{}]", channels.join(", ")),
    }]
}

/// The target of the alias, or of the file name, at a position.
pub(super) fn definition(
    document: &OpenText,
    place: Position,
    vocabulary: &Vocabulary,
    columns: Columns,
) -> Option<Location> {
    let tree = document.tree()?;
    let lines = document.lines(columns);
    let steps = path_at(&tree, lines.offset(place));
    let value = steps.last()?.node();
    let target = tree.target(value);
    if target != value {
        let range = range(&tree, target, &lines);
        return Some(Location::new(document.uri.clone(), range));
    }
    let file = tree
        .text(value)
        .filter(|_| is_file(&vocabulary.at(&tree, &steps)))?;
    let path = document.path.parent()?.join(file);
    path.is_file()
        .then(|| Some(Location::new(place::uri(&path)?, Range::default())))?
}
