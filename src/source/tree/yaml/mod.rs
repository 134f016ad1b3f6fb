//! Builds a tree from the events of the YAML parser, with bounded depth. Only this folder uses that
//! parser.

mod comma;
mod fault;
mod layout;
mod lookalike;
mod mistake;
mod splice;
mod text;
mod typo;

pub use layout::{FormatTextFault, layout};
pub use mistake::{MissingSeparator, YamlError};
pub use splice::{ReplacedBytes, splice};

use super::{NodeId, NodeSyntax, SyntaxTree, TreeNode, inside_quotes, keys};
use crate::{FileId, Span};
use granit_parser::{Event, Parser, ScalarStyle, StructureStyle};
use rtc_math::to_u32;
use std::borrow::Cow;
use std::ops::Range;
use text::{MAX_WORD, text, too_long};

/// The maximum nesting depth.
pub const MAX_DEPTH: usize = 128;

/// Parses a file to a tree. Mistakes go to `report`; if there is no tree, the last one is the
/// reason.
pub fn parse<'s>(
    file: FileId,
    bytes: &'s [u8],
    report: &mut dyn FnMut(YamlError<'_>),
) -> Option<SyntaxTree<'s>> {
    // Decode the text.
    let (source, base) = match text(file, bytes) {
        Ok(text) => text,
        Err(mistake) => {
            report(mistake);
            return None;
        }
    };
    // Build the tree from the events of the parser.
    let mut builder = TreeBuilder {
        tree: SyntaxTree::new(file, base, source),
        open: Vec::new(),
        anchors: Vec::new(),
        ended: false,
        last_end: 0,
        has_failed: false,
        report,
    };
    let options = granit_parser::options! {
        flow_nesting_limit: MAX_DEPTH,
        block_nesting_limit: MAX_DEPTH,
    };
    for event in Parser::new_from_str_with_options(source, options) {
        let step = match event {
            Ok((event, span)) => {
                let range = span.byte_range().unwrap_or_default();
                builder.event(event, to_u32(range.start), to_u32(range.end))
            }
            Err(error) => Err(fault::syntax(&builder.tree, builder.open_bracket(), &error)),
        };
        if let Err(fault) = step {
            // An earlier mistake may be the cause of this one.
            if !builder.has_failed {
                (builder.report)(fault);
            }
            return None;
        }
    }
    builder.finish()
}

/// An open list or map.
struct OpenCollection {
    node: NodeId,
    flow: bool,
}

struct TreeBuilder<'s, 'k> {
    tree: SyntaxTree<'s>,
    open: Vec<OpenCollection>,
    /// Anchor numbers, ascending, and their nodes.
    anchors: Vec<(usize, NodeId)>,
    ended: bool,
    /// The end of the last scalar or bracket: block lists and maps end there too.
    last_end: u32,
    /// Whether a mistake was reported that prevents a tree.
    has_failed: bool,
    report: &'k mut dyn FnMut(YamlError<'_>),
}

type StepResult = Result<(), YamlError<'static>>;

impl<'s> TreeBuilder<'s, '_> {
    fn event(&mut self, event: Event<'s>, start: u32, end: u32) -> StepResult {
        if let Event::Scalar(value, style, anchor, tag) = event {
            self.tag(tag.is_some(), start, end);
            if style == ScalarStyle::Plain {
                self.plain(start as usize, end as usize);
            }
            let syntax = self.scalar(value, style, start, end)?;
            self.push_scalar(syntax, anchor, start, end);
            Ok(())
        } else if let Event::Alias(anchor) = event {
            self.alias(anchor, start, end)
        } else if let Event::SequenceStart(style, anchor, tag) = event {
            self.tag(tag.is_some(), start, end);
            self.start(NodeSyntax::List, style, anchor, start, end)
        } else if let Event::MappingStart(style, anchor, tag) = event {
            self.tag(tag.is_some(), start, end);
            self.start(NodeSyntax::Map, style, anchor, start, end)
        } else if matches!(event, Event::SequenceEnd | Event::MappingEnd) {
            self.end(end);
            Ok(())
        } else if matches!(event, Event::DocumentStart(..)) && self.ended {
            let span = self.span(start, end);
            Err(YamlError::TwoDocuments { span })
        } else {
            self.ended |= matches!(event, Event::DocumentEnd);
            Ok(())
        }
    }

    fn span(&self, start: u32, end: u32) -> Span {
        Span::new(self.tree.file, start + self.tree.base, end + self.tree.base)
    }

    fn tag(&mut self, tagged: bool, start: u32, end: u32) {
        if tagged {
            let span = self.span(start, end.max(start + 1));
            (self.report)(YamlError::Tag { span });
        }
    }

    /// Checks an unquoted scalar for characters that look like YAML indicators.
    fn plain(&mut self, start: usize, end: usize) {
        if let Some(mistake) = lookalike::in_word(&self.tree, start, end) {
            (self.report)(mistake);
            self.has_failed = true;
        }
    }

    /// The syntax of a scalar and its link. The style decides, because a block scalar may begin
    /// with a quote.
    fn scalar(
        &mut self,
        value: Cow<'s, str>,
        style: ScalarStyle,
        start: u32,
        end: u32,
    ) -> Result<(NodeSyntax, u32), YamlError<'static>> {
        if value.len() > MAX_WORD {
            let at = start + self.tree.base;
            return Err(too_long(self.tree.file, at as usize));
        }
        let is_written = |range: Range<u32>| self.tree.slice(range) == Some(value.as_ref());
        let syntax = match style {
            ScalarStyle::Plain if start == end || is_written(start..end) => NodeSyntax::Word,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted
                if is_written(inside_quotes(start, end)) =>
            {
                NodeSyntax::Quoted
            }
            ScalarStyle::Plain
            | ScalarStyle::SingleQuoted
            | ScalarStyle::DoubleQuoted
            | ScalarStyle::Literal
            | ScalarStyle::Folded => {
                return Ok((
                    NodeSyntax::Unescaped,
                    self.tree.unescape_with(|text| text.push_str(&value)),
                ));
            }
        };
        Ok((syntax, 0))
    }

    fn push_scalar(
        &mut self,
        (syntax, link): (NodeSyntax, u32),
        anchor: usize,
        start: u32,
        end: u32,
    ) {
        self.last_end = end;
        self.push(
            TreeNode {
                start,
                end,
                link,
                syntax,
            },
            anchor,
        );
    }

    fn alias(&mut self, anchor: usize, start: u32, end: u32) -> StepResult {
        let at = self
            .anchors
            .binary_search_by_key(&anchor, |(anchor, _)| *anchor);
        let target = self.anchors[at.expect("the parser refuses aliases without an anchor")].1;
        if self.open.iter().any(|open| open.node == target) {
            return Err(YamlError::SelfAlias {
                span: self.span(start, end),
                anchor: self.span(self.tree.node(target).start, start),
            });
        }
        self.last_end = end;
        self.push(
            TreeNode {
                start,
                end,
                link: target.0,
                syntax: NodeSyntax::Alias,
            },
            0,
        );
        Ok(())
    }

    fn start(
        &mut self,
        syntax: NodeSyntax,
        style: StructureStyle,
        anchor: usize,
        start: u32,
        end: u32,
    ) -> StepResult {
        if self.open.len() >= MAX_DEPTH {
            let span = self.span(start, end.max(start + 1));
            return Err(YamlError::TooDeep { span });
        }
        self.last_end = end;
        let node = self.push(
            TreeNode {
                start,
                end,
                link: 0,
                syntax,
            },
            anchor,
        );
        self.open.push(OpenCollection {
            node,
            flow: style == StructureStyle::Flow,
        });
        Ok(())
    }

    fn end(&mut self, end: u32) {
        let OpenCollection { node: id, flow } = self
            .open
            .pop()
            .expect("the parser closes only what it opened");
        self.last_end = if flow { end } else { self.last_end };
        let link = to_u32(self.tree.nodes.len());
        let node = &mut self.tree.nodes[id.0 as usize];
        (node.end, node.link) = (self.last_end, link);
        if node.syntax == NodeSyntax::Map {
            self.keys(id, flow);
        }
    }

    fn push(&mut self, node: TreeNode, anchor: usize) -> NodeId {
        let nodes = &mut self.tree.nodes;
        if nodes.len() == nodes.capacity() {
            // Doubling the capacity would waste as much memory as the tree of a large scene.
            nodes.reserve_exact(nodes.len() / 4 + 64);
        }
        let id = NodeId(to_u32(nodes.len()));
        nodes.push(node);
        if anchor != 0 {
            self.anchors.push((anchor, id));
        }
        id
    }

    /// Checks the keys of a map that was just closed.
    fn keys(&mut self, map: NodeId, flow: bool) {
        let known = self.tree.duplicate_keys().len();
        keys::close(&mut self.tree, map);
        let has_two_items = self.has_two_items(known);
        for at in known..self.tree.duplicate_keys().len() {
            let (first, second) = self.tree.duplicate_keys()[at];
            let separator = self.separator(map, flow, [first, second]);
            let separator =
                separator.or_else(|| has_two_items.then_some(MissingSeparator::FirstKey));
            (self.report)(YamlError::DuplicateKey {
                key: self.tree.text(second).unwrap_or_default(),
                first: self.tree.span(first),
                second: self.tree.span(second),
                is_same: self.tree.is_same(NodeId(first.0 + 1), NodeId(second.0 + 1)),
                separator,
            });
            if separator.is_some() {
                self.has_failed = true;
                break;
            }
        }
    }

    /// Whether the item of a list that was just closed has several keys twice, with other values:
    /// it is two items. Its duplicate keys begin at the index `from`.
    fn has_two_items(&self, from: usize) -> bool {
        let is_item = self
            .open
            .last()
            .is_some_and(|open| self.tree.is_list(open.node));
        let pairs = self.tree.duplicate_keys()[from..].iter();
        let is_other = |(first, second): &&(NodeId, NodeId)| {
            !self.tree.is_same(NodeId(first.0 + 1), NodeId(second.0 + 1))
        };
        is_item && pairs.filter(is_other).take(2).count() == 2
    }

    /// The missing separator before the second of two equal keys, if it begins a new list item: an
    /// item begins with the first key of the map and has more than one key.
    fn separator(
        &self,
        map: NodeId,
        flow: bool,
        [first, second]: [NodeId; 2],
    ) -> Option<MissingSeparator> {
        let parent = self.open.last()?.node;
        let pairs = self.tree.pairs(map).take_while(|(key, _)| *key != second);
        let is_item = self.tree.is_list(parent) && first.0 == map.0 + 1 && pairs.count() > 1;
        if !is_item || flow {
            return is_item.then_some(MissingSeparator::Braces);
        }
        let start = self.tree.node(second).start;
        let before = Span::new(self.tree.file, start.checked_sub(2)?, start);
        (self.tree.slice(before.start..before.end)? == "  ").then(|| {
            MissingSeparator::Dash(Span {
                start: before.start + self.tree.base,
                end: before.end + self.tree.base,
                ..before
            })
        })
    }

    /// The innermost open bracket.
    fn open_bracket(&self) -> Option<NodeId> {
        self.open
            .iter()
            .rev()
            .find(|open| open.flow)
            .map(|open| open.node)
    }

    fn finish(self) -> Option<SyntaxTree<'s>> {
        if self.tree.nodes.is_empty() {
            let end = to_u32(self.tree.source.len()) + self.tree.base;
            let span = Span::new(self.tree.file, end, end);
            (self.report)(YamlError::Empty { span });
            return None;
        }
        (!self.has_failed).then_some(self.tree)
    }
}
