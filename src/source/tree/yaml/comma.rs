//! Detects missing and surplus commas in brackets.

use super::super::SyntaxTree;
use super::YamlError;
use super::typo::{span, typo};

/// A missing comma before the position of a syntax error: a value ends before it and another begins
/// there.
pub(super) fn missing(tree: &SyntaxTree<'_>, at: usize) -> Option<YamlError<'static>> {
    let source = tree.source;
    let (before, rest) = source.split_at_checked(at)?;
    // For an unquoted key, the error is at the colon after it.
    let start = match rest.starts_with(':') {
        true => before.trim_end().rfind(char::is_whitespace)? + 1,
        false => at,
    };
    let before = source.get(..start)?;
    let (mut end, mut value) = (before.trim_end().len(), before.trim_end());
    if before.get(end..)?.contains('\n') {
        let line = value.rfind('\n').map_or(0, |line| line + 1);
        if let Some(comment) = value.get(line..)?.find(" #") {
            value = value.get(..line + comment)?.trim_end();
            end = value.len();
        }
    }
    let ends = |c: char| c.is_alphanumeric() || matches!(c, ']' | '}' | '"' | '\'' | '.');
    let begins = |c: char| c.is_alphanumeric() || matches!(c, '[' | '{' | '"' | '\'' | '-' | '.');
    let first = source.get(start..)?.chars().next()?;
    if end == start || !value.ends_with(ends) || !begins(first) {
        return None;
    }
    Some(typo(
        "a comma is missing".to_owned(),
        "before this".to_owned(),
        "items in brackets are separated by commas",
        span(tree, start, start + first.len_utf8()),
        (span(tree, end, end), ",".to_owned()),
    ))
}

/// Whether the bracket at a position is closed. Brackets in quotes and comments don't count.
pub(super) fn is_closed(tree: &SyntaxTree<'_>, bracket: usize) -> bool {
    let mut depth = 0_usize;
    significant_characters(tree, bracket).any(|(_, character)| {
        match character {
            '[' | '{' => depth += 1,
            ']' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    })
}

/// The second of two commas without a value between them, in a closed bracket.
pub(super) fn doubled(tree: &SyntaxTree<'_>, bracket: usize) -> Option<YamlError<'static>> {
    if !is_closed(tree, bracket) {
        return None;
    }
    let mut before = ' ';
    let second =
        significant_characters(tree, bracket).filter(|(_, character)| !character.is_whitespace());
    let (at, _) = second.into_iter().find(|(_, character)| {
        let last = std::mem::replace(&mut before, *character);
        *character == ',' && matches!(last, ',' | '[' | '{')
    })?;
    let span = span(tree, at, at + 1);
    Some(typo(
        "a comma too many".to_owned(),
        "there is nothing before this".to_owned(),
        "remove it",
        span,
        (span, String::new()),
    ))
}

/// The characters from an offset on that are outside quotes and comments, with their offsets; a
/// quoted string yields its opening quote only.
fn significant_characters<'t>(
    tree: &'t SyntaxTree<'_>,
    from: usize,
) -> impl Iterator<Item = (usize, char)> + use<'t> {
    let (mut quote, mut last) = (None, ' ');
    let mut is_comment = false;
    let text = tree.source.get(from..).unwrap_or_default();
    text.char_indices().filter_map(move |(offset, c)| {
        let before = std::mem::replace(&mut last, c);
        match (c, quote) {
            ('\n', _) => is_comment = false,
            _ if is_comment => return None,
            (_, Some(open)) => {
                let ends = c == open && before != '\\';
                quote = Some(open).filter(|_| !ends);
                return None;
            }
            ('"' | '\'', None) if !before.is_alphanumeric() => quote = Some(c),
            ('#', None) if before.is_whitespace() => {
                is_comment = true;
                return None;
            }
            _ => {}
        }
        Some((from + offset, c))
    })
}
