//! Inlay hints: what the text does not show. The beginning of what an alias stands for, angles of
//! radians in degrees, and the defaults that the camera and the other settings of the scene leave
//! unsaid; those of objects, lights and materials are the same each time.

use super::hover::{default, unit};
use super::open_text::OpenText;
use super::outline::MOST;
use super::protocol::{InlayHint, Range};
use super::text::{Columns, TextLines};
use super::traverse::{VisitedNode, traverse};
use super::vocabulary::Vocabulary;
use rtc_source::tree::{NodeId, SyntaxTree};
use serde_json::{Map, Value};

/// The longest text of a default or of what an alias names, in bytes.
const LONGEST: usize = 40;

/// What the hints of a document are made from.
struct HintMaker<'d> {
    tree: &'d SyntaxTree<'d>,
    lines: &'d TextLines<'d>,
}

/// The hints of some lines.
pub(super) fn hints(
    document: &OpenText,
    shown: Range,
    vocabulary: &Vocabulary,
    columns: Columns,
) -> Vec<InlayHint> {
    let Some(tree) = document.tree() else {
        return Vec::new();
    };
    let lines = document.lines(columns);
    let bytes = lines.offset(shown.start)..lines.offset(shown.end);
    let maker = HintMaker {
        tree: &tree,
        lines: &lines,
    };
    let settings: Vec<NodeId> = tree.pairs(tree.root()).map(|(_, value)| value).collect();
    let mut hints = Vec::new();
    traverse(&tree, vocabulary, &bytes, |visited| {
        let VisitedNode { key, node, schemas } = *visited;
        let has_unsaid = settings.contains(&node);
        hints.extend(has_unsaid.then(|| maker.unsaid(node, schemas)).flatten());
        hints.extend(maker.alias(node));
        hints.extend(key.and_then(|_| maker.angle(node, schemas)));
    });
    hints.truncate(MOST);
    hints
}

impl HintMaker<'_> {
    fn hint(&self, offset: usize, label: String) -> InlayHint {
        InlayHint {
            position: self.lines.position(offset),
            label,
            padding_left: true,
        }
    }

    /// The defaults that a map leaves unsaid, at the end of its first line.
    fn unsaid(&self, map: NodeId, schemas: &[&Map<String, Value>]) -> Option<InlayHint> {
        /// The maximum number of defaults.
        const FIRST: usize = 4;
        if !self.tree.is_map(map) || self.tree.target(map) != map {
            return None;
        }
        let keys = Vocabulary::keys_of(schemas).into_iter();
        let unsaid = keys.filter(|(name, _)| self.tree.get(map, name).is_none());
        let defaults = unsaid.filter_map(|(name, schema)| {
            let default = default(schema).filter(|own| own.len() <= LONGEST)?;
            Some(format!("{name}: {default}"))
        });
        let mut defaults: Vec<String> = defaults.collect();
        let more = defaults.len() > FIRST;
        defaults.truncate(FIRST);
        let end = if more { ", …" } else { "" };
        let place = self.lines.line_end(self.tree.range(map).0);
        let label = format!("{}{end}", defaults.join(", "));
        (!defaults.is_empty()).then(|| self.hint(place, label))
    }

    /// The beginning of what an alias stands for.
    fn alias(&self, id: NodeId) -> Option<InlayHint> {
        let target = self.tree.target(id);
        if target == id {
            return None;
        }
        let words: Vec<&str> = self.tree.written(target).split_whitespace().collect();
        let text = words.join(" ");
        let end = text.floor_char_boundary(LONGEST.min(text.len()));
        let more = if end < text.len() { " …" } else { "" };
        let label = format!("= {}{more}", text.split_at(end).0);
        Some(self.hint(self.tree.range(id).1, label))
    }

    /// An angle, or three, in degrees.
    fn angle(&self, value: NodeId, schemas: &[&Map<String, Value>]) -> Option<InlayHint> {
        let is_angle = unit(schemas) == Some("radians");
        let numbers = if is_angle {
            self.numbers(value)
        } else {
            Vec::new()
        };
        if numbers.iter().all(|number| *number == 0.0) {
            return None;
        }
        let degrees = numbers.iter().map(|number| {
            let text = format!("{:.1}", number.to_degrees());
            format!("{}°", text.trim_end_matches('0').trim_end_matches('.'))
        });
        let label = format!("= {}", degrees.collect::<Vec<_>>().join(", "));
        Some(self.hint(self.tree.range(value).1, label))
    }

    /// The number at a node, or the three of a list; empty for anything else.
    fn numbers(&self, value: NodeId) -> Vec<f64> {
        let tree = self.tree;
        let is_list = tree.is_list(value) && tree.target(value) == value;
        let items: Vec<NodeId> = match is_list {
            true => tree.items(value).take(4).collect(),
            false => vec![value],
        };
        let number = |id: &NodeId| {
            tree.written(*id)
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite())
        };
        let numbers: Vec<f64> = items.iter().filter_map(number).collect();
        let is_whole = numbers.len() == items.len() && matches!(items.len(), 1 | 3);
        if is_whole { numbers } else { Vec::new() }
    }
}
