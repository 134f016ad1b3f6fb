//! Inlay hints: what the text does not show. The beginning of what an alias stands for, angles of
//! radians in degrees, and the defaults that the camera and the other settings of the scene leave
//! unsaid; those of objects, lights and materials are the same each time.

use super::hover::{default, unit};
use super::open_text::OpenText;
use super::outline::{MOST, maps};
use super::path_at::{PathStep, path_at};
use super::protocol::{InlayHint, Range};
use super::text::{Columns, TextLines};
use super::vocabulary::Vocabulary;
use rtc_source::tree::{NodeId, SyntaxTree};

/// The longest text of a default or of what an alias names, in bytes.
const LONGEST: usize = 40;

/// What the hints of a document are made from.
struct HintMaker<'d> {
    tree: &'d SyntaxTree<'d>,
    lines: &'d TextLines<'d>,
    vocabulary: &'d Vocabulary,
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
    let (first, last) = (shown.start.line as usize, shown.end.line as usize);
    let is_shown = |id: &NodeId| {
        let (start, end) = tree.range(*id);
        lines.line(start) <= last && first <= lines.line(end)
    };
    let maker = HintMaker {
        tree: &tree,
        lines: &lines,
        vocabulary,
    };
    let settings: Vec<NodeId> = tree.pairs(tree.root()).map(|(_, value)| value).collect();
    let defaults = settings.iter().filter(|id| is_shown(id));
    let defaults = defaults.filter_map(|map| maker.unsaid(*map));
    let aliases = tree.nodes().filter(is_shown);
    let aliases = aliases.filter_map(|id| maker.alias(id));
    let angles = maps(&tree).filter(|map| *map != tree.root() && is_shown(map));
    let angles = angles.flat_map(|map| maker.angles(map));
    defaults.chain(aliases).chain(angles).take(MOST).collect()
}

impl HintMaker<'_> {
    fn hint(&self, offset: usize, label: String) -> InlayHint {
        InlayHint {
            position: self.lines.position(offset),
            label,
            padding_left: true,
        }
    }

    /// The path of a map. It may begin with its first key, to which the path of that byte leads.
    fn steps(&self, map: NodeId) -> Vec<PathStep> {
        let mut steps = path_at(self.tree, self.tree.range(map).0);
        while steps.last().is_some_and(|step| step.node() != map) {
            steps.pop();
        }
        steps
    }

    /// The defaults that a map leaves unsaid, at the end of its first line.
    fn unsaid(&self, map: NodeId) -> Option<InlayHint> {
        /// The maximum number of defaults.
        const FIRST: usize = 4;
        if !self.tree.is_map(map) || self.tree.target(map) != map {
            return None;
        }
        let keys = self
            .vocabulary
            .keys(self.tree, &self.steps(map))
            .into_iter();
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

    /// The angles of a map in degrees.
    fn angles(&self, map: NodeId) -> Vec<InlayHint> {
        let steps = self.steps(map);
        let angle = |(key, value): (NodeId, NodeId)| {
            let numbers = self.numbers(value);
            if numbers.iter().all(|number| *number == 0.0) {
                return None;
            }
            let mut steps = steps.clone();
            steps.push(PathStep::Key { map, key, value });
            let is_angle = unit(&self.vocabulary.at(self.tree, &steps)) == Some("radians");
            let degrees = numbers.iter().map(|number| {
                let text = format!("{:.1}", number.to_degrees());
                format!("{}°", text.trim_end_matches('0').trim_end_matches('.'))
            });
            let label = format!("= {}", degrees.collect::<Vec<_>>().join(", "));
            is_angle.then(|| self.hint(self.tree.range(value).1, label))
        };
        self.tree.pairs(map).filter_map(angle).collect()
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
