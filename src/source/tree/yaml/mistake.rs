//! Errors in YAML texts, with the details for their reports.

use crate::Span;

/// The missing separator of two list items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissingSeparator {
    /// A dash instead of these spaces.
    Dash(Span),
    /// `}, {`.
    Braces,
    /// The line or the brackets with the first key of the item, which is missing, too.
    FirstKey,
}

/// An error in a YAML text. All except tags and duplicate keys prevent a tree.
#[derive(Debug)]
pub enum YamlError<'t> {
    /// The file is UTF-16.
    Utf16 {
        /// Its first two bytes.
        span: Span,
    },
    /// The file is not UTF-8.
    NotUtf8 {
        /// The first byte that is not.
        byte: u8,
        /// Its position.
        span: Span,
    },
    /// A control character that YAML does not allow.
    Control {
        /// Its code point.
        character: u32,
        /// Its position.
        span: Span,
    },
    /// A scalar of more than one MiB.
    TooLong {
        /// Its first byte.
        span: Span,
    },
    /// The file has no content.
    Empty {
        /// Its end.
        span: Span,
    },
    /// A second document starts in the file.
    TwoDocuments {
        /// Its start.
        span: Span,
    },
    /// A tag, which is ignored.
    Tag {
        /// The node with the tag.
        span: Span,
    },
    /// An alias refers to a node that contains it.
    SelfAlias {
        /// The alias.
        span: Span,
        /// From the anchor to the alias.
        anchor: Span,
    },
    /// The nesting depth exceeds [`super::MAX_DEPTH`].
    TooDeep {
        /// The position.
        span: Span,
    },
    /// A bracket is never closed.
    Unclosed {
        /// The bracket.
        bracket: Span,
        /// The position where its content seems to continue.
        runs_into: Option<Span>,
        /// A comment in its line, which may hide the closing bracket.
        comment: Option<Span>,
    },
    /// A duplicate key.
    DuplicateKey {
        /// The key.
        key: &'t str,
        /// The first occurrence.
        first: Span,
        /// The second occurrence.
        second: Span,
        /// Whether both have the same value.
        is_same: bool,
        /// The missing separator before the second occurrence, if a new list item begins with it;
        /// all other duplicate keys in the map then belong to that item.
        separator: Option<MissingSeparator>,
    },
    /// Any other syntax error.
    Syntax {
        /// The message.
        message: String,
        /// The label of the position.
        label: String,
        /// The hint.
        hint: &'static str,
        /// The range to replace and its new text, if known.
        replacement: Option<Box<(Span, String)>>,
        /// The position.
        span: Span,
        /// The innermost open bracket.
        bracket: Option<Span>,
    },
}
