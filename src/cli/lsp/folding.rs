//! What an editor folds and selects: the values of several lines, blocks of comments, and the
//! ranges around a position.

use super::open_text::OpenText;
use super::outline::MOST;
use super::path_at::{PathStep, path_at};
use super::protocol::{FoldingRange, Position, Range, SelectionRange};
use super::text::Columns;
use rtc_math::to_u32;
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// The ranges that can be folded, in the order of the text; one for each first line.
pub(super) fn folding(document: &OpenText, columns: Columns) -> Vec<FoldingRange> {
    let lines = document.lines(columns);
    let mut ends: BTreeMap<usize, (usize, Option<&'static str>)> = BTreeMap::new();
    if let Some(tree) = document.tree() {
        let mut fold = |start: usize, value: NodeId| {
            let (from, to) = tree.range(value);
            let written = document.text.get(start..to).unwrap_or_default();
            if !written.contains('\n') {
                return;
            }
            let written = document.text.get(from..to).unwrap_or_default();
            let end = lines.line(from + written.trim_end().len());
            let first = lines.line(start);
            if first < end && tree.target(value) == value {
                let known = ends.entry(first).or_insert((end, None));
                known.0 = known.0.max(end);
            }
        };
        for node in tree.nodes().filter(|id| tree.target(*id) == *id) {
            for (key, value) in tree.pairs(node) {
                fold(tree.range(key).0, value);
            }
            if tree.is_list(node) {
                tree.items(node)
                    .for_each(|item| fold(tree.range(item).0, item));
            }
        }
        fold_comments(&document.text, &mut ends);
    }
    let ranges = ends.into_iter().map(|(start, (end, kind))| FoldingRange {
        start_line: to_u32(start),
        end_line: to_u32(end),
        kind,
    });
    ranges.take(MOST).collect()
}

/// Adds the blocks of at least two lines of comments.
fn fold_comments(text: &str, ends: &mut BTreeMap<usize, (usize, Option<&'static str>)>) {
    let mut first = None;
    for (line, own) in text.lines().chain([""]).enumerate() {
        match (own.trim_start().starts_with('#'), first) {
            (true, None) => first = Some(line),
            (false, Some(start)) => {
                if line - start > 1 {
                    ends.insert(start, (line - 1, Some("comment")));
                }
                first = None;
            }
            (true, Some(_)) | (false, None) => {}
        }
    }
}

/// The ranges around each position, from the innermost to the whole text.
pub(super) fn selections(
    document: &OpenText,
    positions: &[Position],
    columns: Columns,
) -> Vec<SelectionRange> {
    let lines = document.lines(columns);
    let whole = lines.range(0, document.text.len());
    let tree = document.tree();
    let around = |position: &Position| {
        let offset = lines.offset(*position);
        let mut ranges: Vec<Range> = vec![whole];
        let steps = tree.as_ref().map(|tree| (tree, path_at(tree, offset)));
        if let Some((tree, steps)) = steps {
            let mut add = |start: usize, end: usize| {
                let range = lines.range(start, end);
                let is_inside = start <= offset && offset <= end;
                if is_inside && ranges.last() != Some(&range) {
                    ranges.push(range);
                }
            };
            let (start, end) = tree.range(tree.root());
            add(start, end);
            for step in steps {
                let (start, end) = tree.range(step.node());
                if let PathStep::Key { key, .. } = step {
                    let (key_start, key_end) = tree.range(key);
                    add(key_start, end);
                    add(key_start, key_end);
                }
                add(start, end);
            }
        }
        let nested = |parent: Option<SelectionRange>, range: &Range| {
            Some(SelectionRange {
                range: *range,
                parent: parent.map(Box::new),
            })
        };
        ranges.iter().fold(None, nested)
    };
    positions.iter().filter_map(around).collect()
}
