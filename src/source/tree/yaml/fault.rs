//! Converts errors of the YAML parser to messages for the author of the text.

use super::super::{NodeId, SyntaxTree};
use super::{YamlError, comma, lookalike, typo};
use crate::Span;
use granit_parser::{ErrorKind, ScanError};
use rtc_math::to_u32;

/// The mistake in an invalid text; `bracket` is the innermost open bracket.
pub(super) fn syntax(
    tree: &SyntaxTree<'_>,
    bracket: Option<NodeId>,
    error: &ScanError,
) -> YamlError<'static> {
    // Position of the error, and the innermost open bracket.
    let at = tree
        .source
        .floor_char_boundary(error.marker().byte_offset().unwrap_or(0));
    let here = character_at(tree, at);
    let bracket = bracket.map(|id| Span {
        end: tree.span(id).start + 1,
        ..tree.span(id)
    });
    let kind = error.kind();
    let spans_lines = |span: &Span| {
        tree.slice(span.start - tree.base..to_u32(at))
            .is_some_and(|text| text.contains('\n'))
    };
    let unclosed = |bracket: Span, runs_into| YamlError::Unclosed {
        bracket,
        runs_into,
        comment: comment_after(tree, bracket),
    };
    // Typos that explain any error.
    let near = lookalike::near(tree, at).or_else(|| lookalike::comment_near(tree, at));
    if let Some(typo) = near.or_else(|| typo::quote(tree, at)) {
        return typo;
    }
    let from = bracket.map_or(at, |bracket| (bracket.start - tree.base) as usize);
    let is_unclosed = matches!(kind, ErrorKind::UnclosedFlowCollection { .. }) || ends_early(kind);
    if let Some(typo) = is_unclosed.then(|| comma::doubled(tree, from)).flatten() {
        return typo;
    }
    // Unclosed brackets, missing commas, other typos, or the parser's message.
    match bracket {
        _ if matches!(kind, ErrorKind::RecursionLimitExceeded) => YamlError::TooDeep { span: here },
        _ if matches!(kind, ErrorKind::UnclosedFlowCollection { .. }) => unclosed(here, None),
        Some(bracket) if ends_early(kind) => unclosed(bracket, None),
        Some(bracket)
            if runs_on(kind) && spans_lines(&bracket) && !comma::is_closed(tree, from) =>
        {
            unclosed(bracket, Some(here))
        }
        bracket => {
            if let Some(typo) = typo::colon_after_key(tree, at) {
                return typo;
            }
            let missing = bracket.filter(|_| runs_on(kind) || trails(kind));
            if let Some(typo) = missing.and_then(|_| comma::missing(tree, at)) {
                return typo;
            }
            if let Some(typo) = typo::find(tree, at, kind) {
                return typo;
            }
            let (message, label, hint) = message_of(kind);
            YamlError::Syntax {
                message,
                label: label.to_owned(),
                hint,
                replacement: None,
                span: here,
                bracket,
            }
        }
    }
}

fn character_at(tree: &SyntaxTree<'_>, at: usize) -> Span {
    let next = tree
        .source
        .get(at..)
        .and_then(|rest| rest.chars().next())
        .filter(|next| *next != '\n');
    let end = at + next.map_or(0, char::len_utf8);
    Span::new(tree.file, to_u32(at) + tree.base, to_u32(end) + tree.base)
}

/// The comment after a bracket in its line, if any: it may hide the closing bracket.
fn comment_after(tree: &SyntaxTree<'_>, bracket: Span) -> Option<Span> {
    let from = (bracket.start - tree.base) as usize;
    let line = tree.source.get(from..)?.lines().next()?;
    let hash = line.find(" #")? + 1;
    let before = line.get(..hash)?;
    let is_quoted = before.matches(['"', '\'']).count() % 2 == 1;
    let start = bracket.start + to_u32(hash);
    let end = bracket.start + to_u32(line.trim_end().len());
    (!is_quoted).then(|| Span::new(tree.file, start, end))
}

fn ends_early(kind: &ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::UnexpectedEof
            | ErrorKind::UnexpectedEofFlowSequence
            | ErrorKind::UnexpectedEofFlowMapping
            | ErrorKind::UnexpectedEofImplicitFlowMapping
    )
}

/// Whether something follows a quoted string.
fn trails(kind: &ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::InvalidTrailingSingleQuotedScalar | ErrorKind::InvalidTrailingDoubleQuotedScalar
    )
}

fn runs_on(kind: &ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::InvalidColonPlacement
            | ErrorKind::BlockEntryInFlowCollection
            | ErrorKind::ExpectedFlowMappingSeparator
            | ErrorKind::ExpectedFlowSequenceSeparator
            | ErrorKind::MappingValueNotAllowed
    )
}

/// Message, label and hint.
fn message_of(kind: &ErrorKind) -> (String, &'static str, &'static str) {
    // Each error of the scanner has a message, a label and a hint.
    let parts = |message: &str, label, hint| (message.to_owned(), label, hint);
    if matches!(kind, ErrorKind::UnknownAnchor) {
        parts(
            "an alias without an anchor",
            "no `&` with this name before",
            "put `&name` before its value",
        )
    } else if matches!(kind, ErrorKind::MappingValueNotAllowed) {
        parts(
            "a colon where no key can stand",
            "this colon",
            "write `key: value` on a line of its own, with a space after each colon, or put text \
            with `: ` in quotes",
        )
    } else if matches!(kind, ErrorKind::SimpleKeyExpected) {
        parts(
            "a line that is no `key: value`",
            "no colon follows this",
            "write a colon and a space after the key",
        )
    } else if matches!(
        kind,
        ErrorKind::ExpectedFlowMappingSeparator | ErrorKind::ExpectedFlowSequenceSeparator
    ) {
        parts(
            "a comma is missing",
            "before this",
            "items in brackets are separated by commas",
        )
    } else if matches!(kind, ErrorKind::MisplacedFlowCollectionEnd) {
        parts(
            "a bracket closes nothing",
            "closed here",
            "remove it, or open it before",
        )
    } else if matches!(
        kind,
        ErrorKind::UnclosedQuotedScalar | ErrorKind::InvalidQuotedScalarIndent
    ) {
        parts(
            "a quote is never closed",
            "still inside quotes here",
            "close it with the same kind of quote",
        )
    } else {
        message_with_characters(kind)
    }
}

/// Message, label and hint, for messages that quote characters.
fn message_with_characters(kind: &ErrorKind) -> (String, &'static str, &'static str) {
    if let ErrorKind::MismatchedFlowCollectionEnd { open, close } = kind {
        (
            format!("`{open}` is closed by `{close}`"),
            "opened here",
            "close it with its own kind of bracket",
        )
    } else if let ErrorKind::UnexpectedCharacter { character } = kind {
        let message = format!("`{}` can't start a value", character.escape_debug());
        (
            message,
            "this character",
            "put the value in quotes if it is text",
        )
    } else {
        let (message, label, hint) = message_of_rest(kind);
        (message.to_owned(), label, hint)
    }
}

/// Message, label and hint, for errors that are rare.
fn message_of_rest(kind: &ErrorKind) -> (&'static str, &'static str, &'static str) {
    use ErrorKind as Kind;
    if matches!(
        kind,
        Kind::ExpectedBlockMappingKey | Kind::InvalidSimpleKey | Kind::MappingKeyNotAllowed
    ) {
        (
            "no key where one must stand",
            "not read as a key",
            "in a map each line is a key, a colon, a space and a value, indented alike; in a list \
             each item begins with a dash, the first one, too",
        )
    } else if matches!(
        kind,
        Kind::ExpectedBlockSequenceEntry
            | Kind::BlockSequenceEntryNotAllowed
            | Kind::InvalidBlockEntryWhitespace
            | Kind::PlainScalarStartsWithDashFlowIndicator
    ) {
        (
            "an item of a list where none can stand",
            "no item can begin here",
            "write each item in a line of its own, as `- value`, all of a list indented alike",
        )
    } else if matches!(
        kind,
        Kind::InvalidTrailingSingleQuotedScalar
            | Kind::InvalidTrailingDoubleQuotedScalar
            | Kind::DocumentIndicatorInQuotedScalar
    ) {
        (
            "something follows a text in quotes",
            "after the closing quote",
            "put all of the value between the quotes, or a comma after it",
        )
    } else if matches!(kind, Kind::MissingAnchorOrAliasName) {
        (
            "`&` or `*` without a name",
            "a name must follow",
            "`&name` marks a value, and `*name` repeats it; put other text in quotes",
        )
    } else if matches!(
        kind,
        Kind::InvalidIndentation | Kind::InvalidFlowScalarIndent | Kind::UnexpectedEndOfPlainScalar
    ) {
        (
            "a line is indented less than what it belongs to",
            "too far to the left",
            "indent lines that belong together alike",
        )
    } else if matches!(
        kind,
        Kind::CommentInterceptedScalar | Kind::CommentNotSeparated | Kind::ExpectedWhitespace
    ) {
        (
            "a space is missing, or a comment divides a value",
            "before this",
            "a comment begins with a space and `#`, after the value",
        )
    } else if is_escape(kind) {
        (
            "an unknown escape in a double-quoted string",
            "contains an unknown escape",
            "in single quotes, a backslash is literal",
        )
    } else {
        (
            "the text is not YAML from here on",
            "not understood",
            "compare with the lines before: indentation, colons, brackets, quotes",
        )
    }
}

/// Whether an escape in a string is the mistake.
fn is_escape(kind: &ErrorKind) -> bool {
    matches!(
        kind,
        ErrorKind::UnknownQuotedScalarEscape
            | ErrorKind::InvalidQuotedScalarHexEscape
            | ErrorKind::InvalidLowSurrogateHexEscape
            | ErrorKind::InvalidLowSurrogate
            | ErrorKind::MissingLowSurrogate
            | ErrorKind::UnpairedLowSurrogate
            | ErrorKind::InvalidUnicodeEscape
    )
}
