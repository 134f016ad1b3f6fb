//! The basis of decoding: the trait [`Decode`], values with spans, and the context that collects
//! all diagnostics.

use super::schema::SchemaDefinitions;
use super::suggestion;
use crate::FrontOptions;
use rtc_diag::clip;
use rtc_diag::{Code, Diagnostic, DiagnosticSink, Severity, codes};
use rtc_source::tree::{NodeContent, NodeId, SyntaxTree};
use rtc_source::{Budget, Resource, Span};
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::marker::PhantomData;

/// A type of the format: it is decoded from the tree and described by a schema.
pub(super) trait Decode: Sized {
    /// Whether the value may be a list. For other types a list of one item is read as that item.
    const IS_LIST: bool = false;

    /// Decodes the value; `None` if that fails, which is reported.
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self>;

    /// The JSON Schema of exactly the values that [`Decode::decode`] accepts without an error.
    fn schema(definitions: &mut SchemaDefinitions) -> Json;

    /// The value as the schema shows a default.
    fn json(&self) -> Json {
        Json::Null
    }
}

/// A value and its span; a default has no span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spanned<T> {
    pub(super) value: T,
    pub(super) span: Option<Span>,
}

impl<T> Spanned<T> {
    /// A default.
    pub(super) fn without_span(value: T) -> Self {
        Self { value, span: None }
    }

    /// Another value with the same span.
    pub(super) fn map<U>(&self, change: impl FnOnce(&T) -> U) -> Spanned<U> {
        Spanned {
            value: change(&self.value),
            span: self.span,
        }
    }
}

/// Three numbers with their span.
pub(super) type SpannedVector = Spanned<[f64; 3]>;

/// The node of a shared value, and that of the texture beside it: of objects with textures of their
/// own, each has a material of its own.
pub(super) type SharedNode = (NodeId, Option<NodeId>);

/// A value that aliases and merge keys may repeat: its node, and the value when it is decoded
/// first.
pub(super) struct SharedValue<T> {
    pub(super) node: SharedNode,
    pub(super) value: Option<T>,
}

impl<T: Decode> Decode for SharedValue<T> {
    const IS_LIST: bool = T::IS_LIST;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let texture = context.object_texture.map(|texture| texture.value);
        let target = (context.tree.target(node), texture);
        if context.decoded.contains(&target) {
            return Some(Self {
                node: target,
                value: None,
            });
        }
        let value = T::decode(node, context)?;
        context.decoded.insert(target);
        Some(Self {
            node: target,
            value: Some(value),
        })
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        T::schema(definitions)
    }
}

/// A list whose items are decoded one at a time, while they are lowered.
pub(super) struct LazyList<T> {
    list: Option<NodeId>,
    items: PhantomData<T>,
}

impl<T> LazyList<T> {
    /// No items.
    pub(super) fn none() -> Self {
        Self {
            list: None,
            items: PhantomData,
        }
    }
}

impl<T: Decode> LazyList<T> {
    /// The number of items, valid or not.
    pub(super) fn len(&self, context: &DecodeContext<'_>) -> usize {
        self.list.map_or(0, |list| context.tree.items(list).count())
    }

    /// Decodes each item and passes it to `take` with its span; items that fail are omitted.
    pub(super) fn decode_each(
        &self,
        context: &mut DecodeContext<'_>,
        name: &'static str,
        mut take: impl FnMut(&mut DecodeContext<'_>, Spanned<T>),
    ) {
        let tree = context.tree;
        for item in self.list.iter().flat_map(|list| tree.items(*list)) {
            context.key = ValueKey {
                text: name,
                span: None,
            };
            if let Some(value) = T::decode(item, context) {
                let span = Some(context.head(item));
                take(context, Spanned { value, span });
            }
        }
    }
}

impl<T: Decode> Decode for LazyList<T> {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::List => Some(Self {
                list: Some(node),
                items: PhantomData,
            }),
            NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::Map => {
                context.expected(node, "a list")
            }
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        serde_json::json!({ "type": "array", "items": T::schema(definitions) })
    }

    fn json(&self) -> Json {
        Json::Array(Vec::new())
    }
}

/// The key of a value.
#[derive(Clone, Copy)]
pub(super) struct ValueKey<'a> {
    pub(super) text: &'a str,
    /// The span of the key; the items of a list have none.
    pub(super) span: Option<Span>,
}

/// An entry of a map or of a map that it merges.
#[derive(Clone, Copy)]
pub(super) struct MapEntry<'a> {
    pub(super) key: &'a str,
    pub(super) key_node: NodeId,
    pub(super) value: NodeId,
    pub(super) claimed: bool,
}

/// The material of a solid for its operands, and the texture beside it.
#[derive(Clone, Copy)]
pub(super) struct OperandMaterial<'a> {
    pub(super) material: MapEntry<'a>,
    pub(super) texture: Option<MapEntry<'a>>,
}

/// The number of diagnostics that are remembered to prevent duplicates.
const MAX_REMEMBERED: usize = 10_000;

/// The state of decoding one tree, with its diagnostics.
pub(super) struct DecodeContext<'a> {
    pub(super) tree: &'a SyntaxTree<'a>,
    pub(super) options: &'a FrontOptions,
    pub(super) key: ValueKey<'a>,
    /// The entries of the maps being read, innermost last.
    pub(super) entries: Vec<MapEntry<'a>>,
    /// The material of operands that have none of their own.
    pub(super) operand_material: Option<OperandMaterial<'a>>,
    /// The texture beside the material of the object that is read; the material takes it.
    pub(super) object_texture: Option<MapEntry<'a>>,
    /// The textures that materials have taken.
    pub(super) taken_textures: BTreeSet<NodeId>,
    /// The spellings that are not canonical, each with the span of its first use.
    pub(super) spellings: Vec<(&'a str, &'static str, Span)>,
    /// The first key in another case of letters.
    pub(super) other_case: Option<(&'a str, &'static str, Span)>,
    /// Unknown keys: the key that was probably intended, and the span.
    pub(super) typos: Vec<(&'static str, Span)>,
    sink: &'a mut DiagnosticSink,
    /// Whether the value of a key is read that only rtc has.
    is_own_key: bool,
    /// The shared values decoded so far.
    decoded: BTreeSet<SharedNode>,
    /// The codes reported for each span: aliases visit a node several times.
    reported: BTreeSet<(Span, &'static str)>,
    steps: u64,
    /// The limit of entries read: those of the text and those that aliases and merge keys repeat.
    max_steps: u64,
}

impl<'a> DecodeContext<'a> {
    pub(super) fn new(
        tree: &'a SyntaxTree<'a>,
        options: &'a FrontOptions,
        budget: &Budget,
        sink: &'a mut DiagnosticSink,
    ) -> Self {
        Self {
            tree,
            options,
            key: ValueKey {
                text: "",
                span: None,
            },
            entries: Vec::new(),
            operand_material: None,
            object_texture: None,
            taken_textures: BTreeSet::new(),
            spellings: Vec::new(),
            other_case: None,
            typos: Vec::new(),
            sink,
            is_own_key: false,
            decoded: BTreeSet::new(),
            reported: BTreeSet::new(),
            steps: 0,
            max_steps: budget.limit(Resource::Nodes),
        }
    }

    /// Reports a diagnostic at `span`, unless the same code was reported there. `make` completes
    /// it.
    pub(super) fn report(
        &mut self,
        code: &'static Code,
        span: Span,
        message: impl FnOnce() -> String,
        make: impl FnOnce(Diagnostic) -> Diagnostic,
    ) {
        let known = self.reported.contains(&(span, code.id));
        if known || self.is_exhausted() {
            return;
        }
        if self.reported.len() < MAX_REMEMBERED {
            self.reported.insert((span, code.id));
        }
        let diagnostic = make(Diagnostic::new(code, message()).at(span, ""));
        let is_tolerated = self.is_own_key && !self.options.strict;
        self.sink.push(
            match is_tolerated && diagnostic.severity == Severity::Error {
                true => diagnostic
                    .severity(Severity::Warning)
                    .hint("the key is not of the course but of rtc, and such a value is ignored"),
                false => diagnostic,
            },
        );
    }

    /// Whether mistakes in the value that is read are warnings, and the value is ignored.
    pub(super) fn is_tolerant(&self) -> bool {
        self.is_own_key && !self.options.strict
    }

    /// Reads a value. If the key is `own`, only rtc has it: mistakes in its value are warnings,
    /// unless `strict` is on.
    pub(super) fn reading<T>(&mut self, own: bool, read: impl FnOnce(&mut Self) -> T) -> T {
        let outer = self.is_own_key;
        self.is_own_key |= own;
        let value = read(self);
        self.is_own_key = outer;
        value
    }

    /// The number of different diagnostics so far.
    pub(super) fn diagnostics(&self) -> usize {
        self.reported.len()
    }

    /// Reports a value of the wrong type. Always `None`.
    pub(super) fn expected<T>(&mut self, node: NodeId, what: &str) -> Option<T> {
        self.expected_as(node, what, what)
    }

    /// The same for a part of a value: `part` describes the expected part.
    pub(super) fn expected_as<T>(&mut self, node: NodeId, what: &str, part: &str) -> Option<T> {
        let (tree, key) = (self.tree, self.key);
        let found = describe(tree.shape(node));
        let name = match key.span {
            Some(_) => format!("`{}`", clip(key.text)),
            None => format!("each of `{}`", clip(key.text)),
        };
        let span = tree.span(node);
        let span_shown = if span.start == span.end {
            key.span.unwrap_or(span)
        } else {
            self.first_line(node)
        };
        let message = || format!("{name} must be {what}, not {found}");
        let suggestion = suggestion::suggest(tree, key, node, part);
        self.report(&codes::WRONG_TYPE, span_shown, message, |d| {
            let diagnostic = d.at(span_shown, found.clone());
            let Some(suggestion) = suggestion else {
                return diagnostic;
            };
            let (hint, is_certain) = (suggestion.hint, suggestion.is_certain);
            match suggestion.text {
                Some(text) if is_certain => diagnostic.replace(hint, span_shown, text),
                Some(text) => diagnostic.guess(hint, span, text),
                None => diagnostic.hint(hint),
            }
        });
        None
    }

    /// Records the first use of a spelling that is not canonical.
    pub(super) fn record_spelling(
        &mut self,
        written: &'a str,
        suggestion: &'static str,
        span: Span,
    ) {
        let known = |(w, m, _): &(&str, &str, Span)| (*w, *m) == (written, suggestion);
        if written != suggestion && !self.spellings.iter().any(known) {
            self.spellings.push((written, suggestion, span));
        }
    }

    /// Whether the scene is written as JSON: an opening brace, then a key in quotes.
    pub(super) fn is_json(&self) -> bool {
        let text = self.tree.written(self.tree.root());
        let inside = text.strip_prefix('{').map(str::trim_start);
        inside.is_some_and(|inside| inside.starts_with('"'))
    }

    /// Whether a key was written in this spelling instead of its canonical one.
    pub(super) fn is_spelled(&self, written: &str, canonical: &str) -> bool {
        let mut spellings = self.spellings.iter();
        spellings.any(|(w, c, _)| (*w, *c) == (written, canonical))
    }

    /// The replacement of a scalar, with the same quotes: JSON requires them.
    pub(super) fn with_quotes_of(&self, node: NodeId, word: &str) -> String {
        match self.tree.written(node).chars().next() {
            Some(quote @ ('"' | '\'')) => format!("{quote}{word}{quote}"),
            _ => word.to_owned(),
        }
    }

    /// Records the first key that differs in case from the declared one.
    pub(super) fn record_case(&mut self, written: &'a str, suggestion: &'static str, key: NodeId) {
        if self.other_case.is_none() {
            self.other_case = Some((written, suggestion, self.tree.span(key)));
        }
    }

    /// The last unknown key, from the typo of index `from` on, that was probably one of these keys.
    pub(super) fn typo_for(&self, keys: &[&str], from: usize) -> Option<Span> {
        let typos = self.typos[from..].iter().rev();
        let mut suggestion = typos.filter(|(suggestion, _)| keys.contains(suggestion));
        suggestion.next().map(|(_, span)| *span)
    }

    /// The severity of an unknown key: an error with `--strict`.
    pub(super) fn unknown_key_severity(&self) -> Severity {
        if self.options.strict {
            Severity::Error
        } else {
            Severity::Warning
        }
    }

    /// A short span to represent a node: the first entry of a map, else the node.
    pub(super) fn head(&self, node: NodeId) -> Span {
        match self.tree.pairs(node).next() {
            Some((key, value)) if self.tree.is_map(node) => match self.tree.shape(value) {
                NodeContent::Word(_) | NodeContent::Text(_) => {
                    self.tree.span(key).to(self.tree.span(value))
                }
                NodeContent::List | NodeContent::Map => self.tree.span(key),
            },
            Some(_) | None => self.tree.span(node),
        }
    }

    /// The span of a node, or only its head if it is a map.
    fn first_line(&self, node: NodeId) -> Span {
        if self.tree.is_map(node) {
            self.head(node)
        } else {
            self.tree.span(node)
        }
    }

    /// Counts work that aliases can repeat. Returns false if the limit is exceeded, which is
    /// reported once.
    pub(super) fn step(&mut self, node: NodeId) -> bool {
        if self.is_exhausted() {
            return false;
        }
        self.steps += 1;
        if self.is_exhausted() {
            let diagnostic = Diagnostic::new(
                &codes::REPETITION,
                "aliases and merge keys make the scene too large",
            );
            self.sink.push(
                diagnostic
                    .at(self.first_line(node), "the limit was exceeded here")
                    .hint("write it out, or allow more by `--limit nodes=…`"),
            );
        }
        !self.is_exhausted()
    }

    fn is_exhausted(&self) -> bool {
        self.steps > self.max_steps
    }
}

/// A description of a node for messages.
pub(super) fn describe(shape: NodeContent<'_>) -> String {
    match shape {
        NodeContent::Word("" | "~" | "null" | "Null" | "NULL") => "nothing".to_owned(),
        NodeContent::Word(word) => format!("`{}`", clip(word)),
        NodeContent::Text(text) => format!("the text `{}`", clip(text)),
        NodeContent::List => "a list".to_owned(),
        NodeContent::Map => "a map".to_owned(),
    }
}
