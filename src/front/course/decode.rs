//! What decoding stands on: values with their spans, and the context that collects every finding.

use super::schema::Definitions;
use super::spelling::same_letters;
use super::suggestion;
use crate::FrontOptions;
use rtc_diag::clip;
use rtc_diag::{Code, Diagnostic, Severity, Sink, codes};
use rtc_source::tree::{NodeContent, NodeId, Tree};
use rtc_source::{Budget, Resource, Span};
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::marker::PhantomData;

/// A type of the format: read from the tree, described in the schema.
pub(super) trait Value: Sized {
    /// Whether the value is a list, or may be one; a list of one item is that item for the others.
    const IS_LIST: bool = false;

    /// Reads the value; `None` if it can't be read, and then the sink has an error.
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self>;

    /// The JSON Schema of exactly what [`Value::decode`] takes without an error.
    fn schema(definitions: &mut Definitions) -> Json;

    /// The value as the schema shows a default.
    fn json(&self) -> Json {
        Json::Null
    }
}

/// A value and where it was written; a default was written nowhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spanned<T> {
    pub(super) value: T,
    pub(super) span: Option<Span>,
}

impl<T> Spanned<T> {
    /// A default.
    pub(super) fn unwritten(value: T) -> Self {
        Self { value, span: None }
    }

    /// Another value from the same place.
    pub(super) fn map<U>(&self, change: impl FnOnce(&T) -> U) -> Spanned<U> {
        Spanned {
            value: change(&self.value),
            span: self.span,
        }
    }
}

/// Three numbers and where they were written.
pub(super) type Numbers = Spanned<[f64; 3]>;

/// A value that aliases and merge keys may bring us to again: its node, and the value the first
/// time.
pub(super) struct SharedValue<T> {
    pub(super) node: NodeId,
    pub(super) value: Option<T>,
}

impl<T: Value> Value for SharedValue<T> {
    const IS_LIST: bool = T::IS_LIST;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let target = context.tree.target(node);
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

    fn schema(definitions: &mut Definitions) -> Json {
        T::schema(definitions)
    }
}

/// A list whose items are decoded one by one, as they are lowered.
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

impl<T: Value> LazyList<T> {
    /// How many items there are, sound or not.
    pub(super) fn len(&self, context: &Context<'_>) -> usize {
        self.list.map_or(0, |list| context.tree.items(list).count())
    }

    /// Decodes every item and hands it on with its span; those that fail are left out.
    pub(super) fn decode_each(
        &self,
        context: &mut Context<'_>,
        name: &'static str,
        mut take: impl FnMut(&mut Context<'_>, Spanned<T>),
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

impl<T: Value> Value for LazyList<T> {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
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

    fn schema(definitions: &mut Definitions) -> Json {
        serde_json::json!({ "type": "array", "items": T::schema(definitions) })
    }

    fn json(&self) -> Json {
        Json::Array(Vec::new())
    }
}

/// The key a value belongs to.
#[derive(Clone, Copy)]
pub(super) struct ValueKey<'a> {
    pub(super) text: &'a str,
    /// Where the key stands; an item of a list has none of its own.
    pub(super) span: Option<Span>,
}

/// A key of a map, its own or merged, with its value.
#[derive(Clone, Copy)]
pub(super) struct MapEntry<'a> {
    pub(super) key: &'a str,
    pub(super) key_node: NodeId,
    pub(super) value: NodeId,
    pub(super) claimed: bool,
}

/// More findings than this are no longer looked through for repetition.
const MAX_REMEMBERED: usize = 10_000;

/// One pass over a tree: the findings, and what the pass remembers.
pub(super) struct Context<'a> {
    pub(super) tree: &'a Tree<'a>,
    pub(super) options: &'a FrontOptions,
    pub(super) key: ValueKey<'a>,
    /// The entries of the maps being read, innermost last.
    pub(super) entries: Vec<MapEntry<'a>>,
    /// Other spellings met, once each, with the first place.
    pub(super) spellings: Vec<(&'a str, &'static str, Span)>,
    /// The first key in another case of letters.
    pub(super) other_case: Option<(&'a str, &'static str, Span)>,
    /// Unknown keys, and the keys that were probably meant.
    pub(super) typos: Vec<(&'static str, Span)>,
    sink: &'a mut Sink,
    /// The shared values decoded so far.
    decoded: BTreeSet<NodeId>,
    /// What has been said about which bytes: an alias brings a reader to the same place again.
    reported: BTreeSet<(Span, &'static str)>,
    steps: u64,
    /// How many entries may be looked at: those of the text, and those that aliases and merge keys
    /// repeat.
    max_steps: u64,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        tree: &'a Tree<'a>,
        options: &'a FrontOptions,
        budget: &Budget,
        sink: &'a mut Sink,
    ) -> Self {
        Self {
            tree,
            options,
            key: ValueKey {
                text: "",
                span: None,
            },
            entries: Vec::new(),
            spellings: Vec::new(),
            other_case: None,
            typos: Vec::new(),
            sink,
            decoded: BTreeSet::new(),
            reported: BTreeSet::new(),
            steps: 0,
            max_steps: budget.limit(Resource::Nodes),
        }
    }

    /// Pushes what `make` adds to a finding at `span`, unless the same was said there before.
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
        self.sink
            .push(make(Diagnostic::new(code, message()).at(span, "")));
    }

    /// How many different findings there were so far.
    pub(super) fn findings(&self) -> usize {
        self.reported.len()
    }

    /// Reports a value of the wrong type. Always `None`.
    pub(super) fn expected<T>(&mut self, node: NodeId, what: &str) -> Option<T> {
        self.expected_as(node, what, what)
    }

    /// The same of a part of a value: `part` says what that must be.
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
        let text = suggestion.as_ref().and_then(|(_, text)| text.as_deref());
        let same = text.is_some_and(|text| same_letters(tree.written(node), text));
        self.report(&codes::WRONG_TYPE, span_shown, message, |d| {
            let finding = d.at(span_shown, found.clone());
            match suggestion {
                Some((hint, Some(text))) if same => finding.replace(hint, span_shown, text),
                Some((hint, Some(text))) => finding.guess(hint, span_shown, text),
                Some((hint, None)) => finding.hint(hint),
                None => finding,
            }
        });
        None
    }

    /// Remembers that something was written otherwise than it should be, unless that is known.
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

    /// A word in place of one that was written, in the same quotes: JSON needs them.
    pub(super) fn with_quotes_of(&self, node: NodeId, word: &str) -> String {
        match self.tree.written(node).chars().next() {
            Some(quote @ ('"' | '\'')) => format!("{quote}{word}{quote}"),
            _ => word.to_owned(),
        }
    }

    /// Remembers that a key was written in another case of letters, the first time.
    pub(super) fn record_case(&mut self, written: &'a str, suggestion: &'static str, key: NodeId) {
        if self.other_case.is_none() {
            self.other_case = Some((written, suggestion, self.tree.span(key)));
        }
    }

    /// The last unknown key from the slip of this index on for which one of these was meant.
    pub(super) fn typo_for(&self, keys: &[&str], from: usize) -> Option<Span> {
        let typos = self.typos[from..].iter().rev();
        let mut suggestion = typos.filter(|(suggestion, _)| keys.contains(suggestion));
        suggestion.next().map(|(_, span)| *span)
    }

    /// The severity of what is left unread: an error if the user asked for strictness.
    pub(super) fn unknown_key_severity(&self) -> Severity {
        if self.options.strict {
            Severity::Error
        } else {
            Severity::Warning
        }
    }

    /// A span that stands for a node as a whole: its first pair if it is a map, else its first
    /// line.
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

    /// The node, or only its head if it is a map or list in block form.
    fn first_line(&self, node: NodeId) -> Span {
        if self.tree.is_map(node) {
            self.head(node)
        } else {
            self.tree.span(node)
        }
    }

    /// Counts work that aliases can repeat. False once there was too much of it, which is reported
    /// once.
    pub(super) fn step(&mut self, node: NodeId) -> bool {
        if self.is_exhausted() {
            return false;
        }
        self.steps += 1;
        if self.is_exhausted() {
            let finding = Diagnostic::new(
                &codes::REPETITION,
                "aliases and merge keys make this scene too large",
            );
            self.sink.push(
                finding
                    .at(
                        self.first_line(node),
                        "the limit was passed while reading this",
                    )
                    .hint("write it out, or allow more by `--limit nodes=…`"),
            );
        }
        !self.is_exhausted()
    }

    fn is_exhausted(&self) -> bool {
        self.steps > self.max_steps
    }
}

/// What a node is, in the user's words.
pub(super) fn describe(shape: NodeContent<'_>) -> String {
    match shape {
        NodeContent::Word("" | "~" | "null" | "Null" | "NULL") => "nothing".to_owned(),
        NodeContent::Word(word) => format!("`{}`", clip(word)),
        NodeContent::Text(text) => format!("the text `{}`", clip(text)),
        NodeContent::List => "a list".to_owned(),
        NodeContent::Map => "a map".to_owned(),
    }
}
