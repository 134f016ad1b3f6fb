//! What is wrong with a YAML text, as those who report it need it.

use crate::Span;

/// What stands between two items of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    /// A dash, in place of the blanks here.
    Dash(Span),
    /// `}, {`.
    Braces,
}

/// A mistake in a YAML text. All but tags and keys that only stand twice leave no tree.
#[derive(Debug)]
pub enum Mistake<'t> {
    /// The file is UTF-16.
    Utf16 {
        /// Its first two bytes.
        span: Span,
    },
    /// The file is not UTF-8.
    NotUtf8 {
        /// The first byte that is not.
        byte: u8,
        /// Where it is.
        span: Span,
    },
    /// A control character that no YAML text may hold.
    Control {
        /// Its code point.
        character: u32,
        /// Where it is.
        span: Span,
    },
    /// A word of more than a MiB.
    TooLong {
        /// Its first byte.
        span: Span,
    },
    /// There is nothing in the file.
    Empty {
        /// Its end.
        span: Span,
    },
    /// A second document starts in the file.
    TwoDocuments {
        /// Where it starts.
        span: Span,
    },
    /// A tag, which is ignored.
    Tag {
        /// What has the tag.
        span: Span,
    },
    /// An alias refers to what it stands in.
    SelfAlias {
        /// The alias.
        span: Span,
        /// From what it refers to up to the alias.
        anchor: Span,
    },
    /// Lists and maps lie deeper in each other than [`super::MAX_DEPTH`].
    TooDeep {
        /// Where they do.
        span: Span,
    },
    /// A bracket is never closed.
    Unclosed {
        /// The bracket.
        bracket: Span,
        /// What was taken to be inside.
        runs_into: Option<Span>,
        /// A comment in its line, which may hide the other bracket.
        comment: Option<Span>,
    },
    /// A key stands twice in its map.
    DuplicateKey {
        /// The key.
        key: &'t str,
        /// Where it stands first.
        first: Span,
        /// Where it stands again.
        second: Span,
        /// Whether both have the same value.
        is_same: bool,
        /// What is missing before the second, if a new item of a list begins with it: all else that
        /// stands twice in the map is of that item.
        separator: Option<Separator>,
    },
    /// Anything else that is not YAML.
    Syntax {
        /// What is wrong.
        message: String,
        /// What is at the place.
        label: String,
        /// What to do.
        hint: &'static str,
        /// The text to put in place of another one, if that is known.
        replacement: Option<Box<(Span, String)>>,
        /// The place.
        span: Span,
        /// The innermost bracket that is still open there.
        bracket: Option<Span>,
    },
}
