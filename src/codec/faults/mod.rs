//! Finds all errors of a JSON document that is not a valid scene. The document is decoded from its
//! tree; each wrong value is recorded and replaced by a placeholder, so that decoding continues.
//!
//! Messages have the wording of `serde_json`, which decodes valid documents and stops at the first
//! error of others.

mod access;
mod error;
mod reader;

use error::NodeError;
use reader::NodeReader;
use rtc_source::Span;
use rtc_source::tree::{NodeId, SyntaxTree};
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of errors that are recorded.
const MAX_FAULTS: usize = 10_000;

/// The maximum number of decoding runs: an error that no placeholder can replace costs one more
/// run.
const MAX_RUNS: usize = 64;

/// An error of a JSON document.
#[derive(Debug)]
pub(super) struct JsonTextError {
    /// The wrong bytes.
    pub(super) span: Span,
    /// Their JSON pointer; `None` for syntax errors, which `serde_json` reports.
    pub(super) pointer: Option<String>,
    /// The message.
    pub(super) what: String,
}

/// All errors of decoding a tree as a `T`.
pub(super) fn all<T: DeserializeOwned>(tree: &SyntaxTree<'_>) -> Vec<JsonTextError> {
    let mut notes = ErrorCollector::new(tree);
    notes.find_required::<T>();
    for _ in 0..MAX_RUNS {
        match T::deserialize(NodeReader::new(&notes, tree.root())) {
            Err(error) if notes.repair(&error) => {}
            Ok(_) | Err(_) => break,
        }
    }
    let found = notes.found.into_inner().into_iter();
    found
        .map(|((at, what), part)| fault(tree, at, what, part))
        .collect()
}

fn fault(tree: &SyntaxTree<'_>, at: NodeId, what: String, part: NodePart) -> JsonTextError {
    let Span { file, start, end } = tree.span(at);
    let (start, end) = match part {
        NodePart::Whole => (start, end),
        NodePart::Bracket => (start, start + 1),
        NodePart::LastDigit => (end - 1, end),
    };
    JsonTextError {
        span: Span::new(file, start, end),
        pointer: (part != NodePart::LastDigit).then(|| tree.pointer(at)),
        what,
    }
}

/// Which part of a node is wrong.
#[derive(Clone, Copy, PartialEq)]
enum NodePart {
    /// All of it.
    Whole,
    /// The opening bracket: a list or map is not allowed here.
    Bracket,
    /// The last digit of a number that is out of the range of f64.
    LastDigit,
}

/// The fields of a struct, which identify it.
type FieldNames = &'static [&'static str];

/// The state of error collection.
struct ErrorCollector<'t> {
    tree: &'t SyntaxTree<'t>,
    found: RefCell<BTreeMap<(NodeId, String), NodePart>>,
    /// Nodes that can't be decoded and are replaced by placeholders.
    rejected: BTreeSet<NodeId>,
    /// The required fields of each struct, as far as known.
    required: BTreeMap<FieldNames, Vec<&'static str>>,
}

impl<'t> ErrorCollector<'t> {
    fn new(tree: &'t SyntaxTree<'t>) -> Self {
        Self {
            tree,
            found: RefCell::default(),
            rejected: BTreeSet::new(),
            required: BTreeMap::new(),
        }
    }

    /// Finds the required fields by decoding an empty document.
    fn find_required<T: DeserializeOwned>(&mut self) {
        loop {
            let missing = T::deserialize(NodeReader::placeholder(self)).err();
            let missing = missing.and_then(|error| error.missing);
            if !missing.is_some_and(|(fields, name)| self.require(fields, name)) {
                return;
            }
        }
    }

    /// Records a required field. False if it was known.
    fn require(&mut self, fields: FieldNames, name: &'static str) -> bool {
        let known = self.required.entry(fields).or_default();
        let is_new = !known.contains(&name);
        known.extend(is_new.then_some(name));
        is_new
    }

    fn required(&self, fields: FieldNames) -> &[&'static str] {
        self.required.get(fields).map_or(&[], Vec::as_slice)
    }

    /// Makes the next run pass an error. False if that is impossible.
    fn repair(&mut self, error: &NodeError) -> bool {
        if let Some((fields, name)) = error.missing {
            return self.require(fields, name);
        }
        let Some(at) = error.at else { return false };
        self.note(at, NodePart::Whole, error.what.clone());
        self.rejected.insert(at)
    }

    /// Records an error, once.
    fn note(&self, at: NodeId, part: NodePart, what: String) {
        let mut found = self.found.borrow_mut();
        if found.len() < MAX_FAULTS {
            found.entry((at, what)).or_insert(part);
        }
    }
}
