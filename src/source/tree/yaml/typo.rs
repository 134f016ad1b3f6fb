//! Detects typos that the YAML parser reports late or in its own terms, from the text around the
//! error, with the suggested text.

use super::super::SyntaxTree;
use super::YamlError;
use crate::Span;
use granit_parser::ErrorKind;
use rtc_math::to_u32;

/// The typo that explains a syntax error, if one is found.
pub(super) fn find(
    tree: &SyntaxTree<'_>,
    at: usize,
    kind: &ErrorKind,
) -> Option<YamlError<'static>> {
    let text = SourceText { tree };
    let is_tab = matches!(
        kind,
        ErrorKind::TabNotAllowed | ErrorKind::TabInBlockIndentation | ErrorKind::TabInPlainScalar
    );
    if is_tab {
        text.tab(at)
    } else if matches!(kind, ErrorKind::SimpleKeyExpected) {
        text.colon(at)
    } else if matches!(
        kind,
        ErrorKind::UnclosedQuotedScalar | ErrorKind::InvalidQuotedScalarIndent
    ) {
        text.quote(at)
    } else if text.after(at).starts_with('"') {
        text.backslash(at)
    } else {
        text.dash(at).or_else(|| text.indentation(at))
    }
}

/// The text of a tree.
struct SourceText<'t, 's> {
    tree: &'t SyntaxTree<'s>,
}

impl SourceText<'_, '_> {
    /// A tab in the indentation of this line or a later one.
    fn tab(&self, at: usize) -> Option<YamlError<'static>> {
        let line = self.line(at);
        let found = self.after(line).find('\t')? + line;
        let rest = self.after(found);
        let count = rest.len() - rest.trim_start_matches('\t').len();
        let span = self.span(found, found + count);
        let spaces = "  ".repeat(count);
        Some(typo(
            "a tab can't indent".to_owned(),
            "a tab".to_owned(),
            "indent with spaces",
            span,
            (span, spaces),
        ))
    }

    /// A backslash in double quotes, for example in a file path, that is taken for an escape.
    fn backslash(&self, at: usize) -> Option<YamlError<'static>> {
        let line = self.after(at + 1).split(['\n', '\r']).next()?;
        let inside = line.split('"').next()?;
        if !inside.contains('\\') || inside.contains('\'') || inside.len() == line.len() {
            return None;
        }
        let span = self.span(at, at + inside.len() + 2);
        Some(typo(
            "an unknown escape in a double-quoted string".to_owned(),
            "contains an unknown escape".to_owned(),
            "in single quotes, a backslash is literal",
            span,
            (span, format!("'{inside}'")),
        ))
    }

    /// A line without a colon, or without a space after it.
    fn colon(&self, at: usize) -> Option<YamlError<'static>> {
        let line = self.line(at);
        let words = self.after(line).lines().next()?;
        let first = line + words.len() - words.trim_start_matches([' ', '-']).len();
        let words = words.trim_start_matches([' ', '-']).trim_end();
        let end = words.find(|c: char| !c.is_alphanumeric())?;
        let (key, rest) = words.split_at(end);
        let value = rest.trim_start_matches([' ', ':', '=']);
        let between = rest.strip_suffix(value)?;
        let message = match between.trim() {
            ":" => "no space after a colon",
            "=" => "`=` instead of a colon",
            "" => "a line that is no `key: value`",
            _ => return None,
        };
        let span = self.span(first, first + key.len() + between.len());
        Some(typo(
            message.to_owned(),
            String::new(),
            "write a colon and a space after the key",
            span,
            (span, format!("{key}: ")),
        ))
    }

    /// A quote that is never closed: the last quote before the error that opens and does not close
    /// in its line.
    fn quote(&self, at: usize) -> Option<YamlError<'static>> {
        let mut end = self.line(at);
        while end > 0 {
            let start = self.line(end - 1);
            let line = self.tree.source.get(start..end)?.trim_end();
            for quote in ['"', '\''] {
                let open = line
                    .rfind(quote)
                    .filter(|_| line.matches(quote).count() % 2 == 1);
                if let Some(open) = open {
                    let is_last = !line.get(open..)?.contains([',', '}', ']', '#']);
                    let close = self.span(start + line.len(), start + line.len());
                    return Some(YamlError::Syntax {
                        message: "a quote is never closed".to_owned(),
                        label: "opened here".to_owned(),
                        hint: "close it with the same kind of quote",
                        replacement: is_last.then(|| Box::new((close, quote.to_string()))),
                        span: self.span(start + open, start + open + 1),
                        bracket: None,
                    });
                }
            }
            end = start;
        }
        None
    }

    /// A dash without a space, in the line before.
    fn dash(&self, at: usize) -> Option<YamlError<'static>> {
        let line = self.line(at);
        let start = self.line(line.checked_sub(1)?);
        let before = self.tree.source.get(start..line)?;
        let words = before.trim_start();
        let is_dash = words.strip_prefix('-')?.starts_with(char::is_alphabetic);
        let dash = start + before.len() - words.len();
        let span = self.span(dash, dash + 1);
        is_dash.then(|| {
            typo(
                "no space after a dash".to_owned(),
                "begins no item".to_owned(),
                "each item of a list begins with a dash and a space",
                span,
                (span, "- ".to_owned()),
            )
        })
    }

    /// A line whose indentation differs slightly from that of the lines above to which it seems to
    /// belong.
    fn indentation(&self, at: usize) -> Option<YamlError<'static>> {
        // Compare with the siblings above.
        let line = self.line(at);
        let found_text = IndentedLine::of(self.after(line).lines().next()?)?;
        let lines = self.tree.source.get(..line)?.lines().rev();
        let mut above = lines
            .filter_map(IndentedLine::of)
            .take(MAX_LINES_BACK)
            .peekable();
        // A key without a value in its line has the following lines as its value.
        let is_value_of = |before: &IndentedLine<'_>| {
            before.words.ends_with(':') && found_text.spaces > before.spaces
        };
        let is_value = is_value_of(above.peek()?);
        let distance = |column: usize| found_text.column().abs_diff(column);
        let neighbours =
            above.filter_map(|other| Some((other.sibling_column(&found_text)?, other.key())));
        let (expected, neighbour) = neighbours.min_by_key(|(column, _)| distance(*column))?;
        let distance = distance(expected);
        if is_value || distance == 0 || distance > 3 || !found_text.words.contains(':') {
            return None;
        }
        // Suggest the indentation of the closest one.
        let (key, column) = (found_text.key(), found_text.column());
        let first = line + column;
        let spaces = |count: usize| match count {
            0 => "no space".to_owned(),
            1 => "1 space".to_owned(),
            _ => format!("{count} spaces"),
        };
        let has = spaces(column);
        Some(typo(
            format!(
                "`{key}` has {has} before it, and its neighbour `{neighbour}` {}",
                spaces(expected)
            ),
            format!("{has} before this"),
            "indent lines that belong together alike",
            self.span(first, first + found_text.words.split(':').next()?.len()),
            (self.span(line, first), " ".repeat(expected)),
        ))
    }

    /// The text from an offset on.
    fn after(&self, at: usize) -> &str {
        self.tree.source.get(at..).unwrap_or_default()
    }

    /// The start of the line of an offset.
    fn line(&self, at: usize) -> usize {
        let before = self.tree.source.get(..at).unwrap_or_default();
        before.rfind('\n').map_or(0, |end| end + 1)
    }

    fn span(&self, start: usize, end: usize) -> Span {
        span(self.tree, start, end)
    }
}

/// The span of a byte range of the text.
pub(super) fn span(tree: &SyntaxTree<'_>, start: usize, end: usize) -> Span {
    Span::new(
        tree.file,
        to_u32(start) + tree.base,
        to_u32(end) + tree.base,
    )
}

pub(super) fn typo(
    message: String,
    label: String,
    hint: &'static str,
    span: Span,
    replacement: (Span, String),
) -> YamlError<'static> {
    YamlError::Syntax {
        message,
        label,
        hint,
        replacement: Some(Box::new(replacement)),
        span,
        bracket: None,
    }
}

/// The number of lines above that are compared.
const MAX_LINES_BACK: usize = 200;

/// An indented line.
struct IndentedLine<'t> {
    /// The number of characters before its first key, including the dash of an item and the space
    /// after it.
    spaces: usize,
    /// The column of its dash, if it starts an item.
    dash: Option<usize>,
    words: &'t str,
}

impl<'t> IndentedLine<'t> {
    /// The line, unless it is empty or a comment.
    fn of(line: &'t str) -> Option<Self> {
        let words = line.trim();
        if words.is_empty() || words.starts_with('#') {
            return None;
        }
        let inner = line.trim_start_matches([' ', '-']);
        let dash = line.len() - line.trim_start_matches(' ').len();
        Some(Self {
            spaces: line.len() - inner.len(),
            dash: words.starts_with('-').then_some(dash),
            words,
        })
    }

    /// The column of its first character.
    fn column(&self) -> usize {
        self.dash.unwrap_or(self.spaces)
    }

    /// The column of a line that is a sibling of this one: dashes below dashes, keys below keys.
    fn sibling_column(&self, other: &Self) -> Option<usize> {
        match other.dash {
            Some(_) => self.dash,
            None => Some(self.spaces),
        }
    }

    /// Its first key.
    fn key(&self) -> &'t str {
        let words = self.words.trim_start_matches([' ', '-']);
        words.split(':').next().unwrap_or(words)
    }
}
