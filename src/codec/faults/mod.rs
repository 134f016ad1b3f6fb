//! All faults of an IR text that is JSON: the document is decoded from its tree, and where a value
//! is wrong, that is noted and a stand-in takes its place, so that decoding goes on.
//!
//! The words are those of `serde_json`, which decodes texts without faults and says the first one.

mod access;
mod error;
mod reader;

use error::Error;
use reader::NodeReader;
use rtc_source::Span;
use rtc_source::tree::{NodeId, Tree};
use serde::de::DeserializeOwned;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// No more faults than this are noted.
const MAX_FAULTS: usize = 10_000;

/// The document is decoded this often at most: faults that no stand-in can take the place of at once
/// cost one more time each.
const MAX_RUNS: usize = 64;

/// A fault of a text.
#[derive(Debug)]
pub(super) struct TextFault {
    /// The bytes that are wrong.
    pub(super) span: Span,
    /// The way to them, a JSON pointer; none for what `serde_json` takes for a fault of JSON.
    pub(super) pointer: Option<String>,
    /// What is wrong.
    pub(super) what: String,
}

/// All that is wrong with a tree as a `T`.
pub(super) fn all<T: DeserializeOwned>(tree: &Tree<'_>) -> Vec<TextFault> {
    let mut notes = Notes::new(tree);
    notes.learn::<T>();
    for _ in 0..MAX_RUNS {
        match T::deserialize(NodeReader::new(&notes, tree.root())) {
            Err(error) if notes.mend(&error) => {}
            Ok(_) | Err(_) => break,
        }
    }
    let found = notes.found.into_inner().into_iter();
    found
        .map(|((at, what), part)| fault(tree, at, what, part))
        .collect()
}

fn fault(tree: &Tree<'_>, at: NodeId, what: String, part: FaultPart) -> TextFault {
    let Span { file, start, end } = tree.span(at);
    let (start, end) = match part {
        FaultPart::Whole => (start, end),
        FaultPart::Bracket => (start, start + 1),
        FaultPart::LastDigit => (end - 1, end),
    };
    TextFault {
        span: Span::new(file, start, end),
        pointer: (part != FaultPart::LastDigit).then(|| tree.pointer(at)),
        what,
    }
}

/// What is wrong of a node.
#[derive(Clone, Copy, PartialEq)]
enum FaultPart {
    /// All of it.
    Whole,
    /// The bracket that opens it: something else than a list or map should be here.
    Bracket,
    /// The last digit of a number that a 64-bit float can't hold.
    LastDigit,
}

/// The fields of a struct: they name it.
type Fields = &'static [&'static str];

/// What was noted so far.
struct Notes<'t> {
    tree: &'t Tree<'t>,
    found: RefCell<BTreeMap<(NodeId, String), FaultPart>>,
    /// Nodes that can't be read, and are stood in for.
    refused: BTreeSet<NodeId>,
    /// The fields that must be there, as far as is known.
    required: BTreeMap<Fields, Vec<&'static str>>,
}

impl<'t> Notes<'t> {
    fn new(tree: &'t Tree<'t>) -> Self {
        Self {
            tree,
            found: RefCell::default(),
            refused: BTreeSet::new(),
            required: BTreeMap::new(),
        }
    }

    /// Learns which fields must be there from a document in which nothing is.
    fn learn<T: DeserializeOwned>(&mut self) {
        loop {
            let missing = T::deserialize(NodeReader::stand_in(self)).err();
            let missing = missing.and_then(|error| error.missing);
            if !missing.is_some_and(|(fields, name)| self.require(fields, name)) {
                return;
            }
        }
    }

    /// Takes in that a field must be there. False if that was known.
    fn require(&mut self, fields: Fields, name: &'static str) -> bool {
        let known = self.required.entry(fields).or_default();
        let is_new = !known.contains(&name);
        known.extend(is_new.then_some(name));
        is_new
    }

    fn required(&self, fields: Fields) -> &[&'static str] {
        self.required.get(fields).map_or(&[], Vec::as_slice)
    }

    /// Sees to it that the next run passes an error. False if nothing helps.
    fn mend(&mut self, error: &Error) -> bool {
        if let Some((fields, name)) = error.missing {
            return self.require(fields, name);
        }
        let Some(at) = error.at else { return false };
        self.note(at, FaultPart::Whole, error.what.clone());
        self.refused.insert(at)
    }

    /// Notes a fault, once.
    fn note(&self, at: NodeId, part: FaultPart, what: String) {
        let mut found = self.found.borrow_mut();
        if found.len() < MAX_FAULTS {
            found.entry((at, what)).or_insert(part);
        }
    }
}
