//! Detects typos that the YAML parser reports late or in its own terms, from the text around the
//! error, with the suggested text.

use super::super::SyntaxTree;
use super::YamlError;
use crate::Span;
use granit_parser::ErrorKind;
use rtc_math::to_u32;

/// A quote that explains a syntax error in JSON, if one is found: it hides the brackets and commas
/// after it.
pub(super) fn quote(tree: &SyntaxTree<'_>, at: usize) -> Option<YamlError<'static>> {
    SourceText { tree }.quote_in_json(at)
}

/// A quoted key without a colon after it, or with `=`, before the position of a syntax error.
pub(super) fn colon_after_key(tree: &SyntaxTree<'_>, at: usize) -> Option<YamlError<'static>> {
    let (before, rest) = tree.source.split_at_checked(at)?;
    let key = before.trim_end();
    let open = key.strip_suffix('"')?.rfind('"')?;
    let is_key = key.get(..open)?.trim_end().ends_with(['{', ',']);
    let (sign, found) = match rest.starts_with('=') {
        true => (1, "`=` instead of a colon"),
        false => (0, "no colon after a key"),
    };
    let begins = |c: char| c.is_alphanumeric() || "[{\"-".contains(c);
    if !is_key || !rest.get(sign..)?.trim_start().starts_with(begins) {
        return None;
    }
    Some(typo(
        found.to_owned(),
        "the key".to_owned(),
        "write a colon between a key and its value",
        span(tree, open, key.len()),
        (
            span(tree, key.len(), at + sign),
            match sign {
                0 => ": ".to_owned(),
                _ => ":".to_owned(),
            },
        ),
    ))
}

/// The typo that explains a syntax error, if one is found.
pub(super) fn find(
    tree: &SyntaxTree<'_>,
    at: usize,
    kind: &ErrorKind,
) -> Option<YamlError<'static>> {
    let text = SourceText { tree };
    let typo = text.value_below(at).or_else(|| text.colon_above(at));
    if let Some(typo) = typo.or_else(|| text.key_without_line(at)) {
        return Some(typo);
    }
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

    /// A value in the line after its key that is not indented.
    fn value_below(&self, at: usize) -> Option<YamlError<'static>> {
        let (line, before) = self.lines_at(at)?;
        let value = IndentedLine::of(self.after(line).lines().next()?)?;
        let (key_line, key) = before;
        let begins = value
            .words
            .starts_with(|c: char| c.is_alphanumeric() || "[{\"'.-+".contains(c));
        let is_alone = !value.words.contains(": ") && !value.words.ends_with(':');
        let is_key = key.words.ends_with(':') && !key.words.starts_with('#');
        if !(begins && is_alone && is_key && value.dash.is_none() && value.spaces <= key.spaces) {
            return None;
        }
        let end = key_line + self.after(key_line).lines().next()?.trim_end().len();
        let start = line + value.spaces;
        Some(typo(
            format!("the value of `{}` is not indented", key.key()),
            "a value in the next line".to_owned(),
            "write it after the colon, or indent it by more than its key",
            self.span(start, start + value.words.len()),
            (self.span(end, start), " ".to_owned()),
        ))
    }

    /// A key without a colon in the line before: a word alone above lines that are indented, or a
    /// word and a value.
    fn colon_above(&self, at: usize) -> Option<YamlError<'static>> {
        let (line, (start, before)) = self.lines_at(at)?;
        let below = IndentedLine::of(self.after(line).lines().next()?)?;
        let words = before.words.trim_start_matches([' ', '-']);
        let (key, value) = words.split_once(' ').unwrap_or((words, ""));
        let is_word = key.chars().all(char::is_alphanumeric) && !words.contains([':', '#', '"']);
        let opens = value.is_empty() && below.spaces > before.spaces && before.dash.is_none();
        let has_value = !value.is_empty() && !value.contains(' ') && before.dash.is_some();
        if key.is_empty() || !is_word || !(opens || has_value) || !below.words.contains(':') {
            return None;
        }
        let first = start + before.spaces;
        let end = self.span(first + key.len(), first + key.len());
        Some(typo(
            "a line that is no `key: value`".to_owned(),
            "no colon follows this".to_owned(),
            "write a colon and a space after the key",
            self.span(first, first + key.len()),
            (end, ":".to_owned()),
        ))
    }

    /// Several keys that are indented as those of a map, below a key that has a value already.
    fn key_without_line(&self, at: usize) -> Option<YamlError<'static>> {
        let (line, (_, before)) = self.lines_at(at)?;
        let mut below = self.after(line).lines().filter_map(IndentedLine::of);
        let (first, second) = (below.next()?, below.next()?);
        let are_keys = [&first, &second]
            .iter()
            .all(|line| line.words.contains(':') && line.dash.is_none());
        let (_, value) = before.words.split_once(':')?;
        let is_map = are_keys && first.spaces == second.spaces && first.spaces > before.spaces;
        if !is_map || value.trim().is_empty() || value.trim_start().starts_with('#') {
            return None;
        }
        let start = line + first.spaces;
        Some(YamlError::Syntax {
            message: format!(
                "`{}` is indented as below a key, but `{}` before it has a value",
                first.key(),
                before.key()
            ),
            label: "no key above that it belongs to".to_owned(),
            hint: "a line with a key alone is missing before it, as `material:`, or these lines \
                   are indented too far",
            replacement: None,
            span: self.span(start, start + first.key().len()),
            bracket: None,
        })
    }

    /// The start of the line of an offset, and the start and the content of the last line before
    /// it that has any.
    fn lines_at(&self, at: usize) -> Option<(usize, (usize, IndentedLine<'_>))> {
        let line = self.line(at);
        let mut end = line;
        for _ in 0..MAX_LINES_BACK {
            let start = self.line(end.checked_sub(1)?);
            let text = self.tree.source.get(start..end)?;
            if let Some(found) = IndentedLine::of(text) {
                return Some((line, (start, found)));
            }
            end = start;
        }
        None
    }

    /// A quote in JSON that is never closed: in the line of the error or the one before it.
    fn quote_in_json(&self, at: usize) -> Option<YamlError<'static>> {
        if !self.tree.source.trim_start().starts_with(['{', '[']) {
            return None;
        }
        let mut start = self.line(at);
        for _ in 0..2 {
            let line = self.after(start).lines().next()?;
            if line.matches('"').count() % 2 == 1 && !line.contains(['\\', '\'']) {
                return self.close_quote(start, line);
            }
            start = self.line(start.checked_sub(1)?);
        }
        None
    }

    /// The report of the quote that is missing in a line of JSON: that of a value at the end of the
    /// line, or that of a key before its colon.
    fn close_quote(&self, start: usize, line: &str) -> Option<YamlError<'static>> {
        let quotes: Vec<_> = line.match_indices('"').map(|(at, _)| at).collect();
        let content = |open: usize, close: usize| line.get(open + 1..close);
        let pairs = quotes.chunks(2).map(|pair| match pair {
            [open, close] => (*open, content(*open, *close)),
            [open, ..] => (*open, content(*open, line.len())),
            [] => (0, None),
        });
        // A string with a colon is a key and what follows.
        let mut pairs = pairs.filter_map(|(open, inside)| Some((open, inside?)));
        let last = (*quotes.last()?, content(*quotes.last()?, line.len())?);
        let (open, inside) = pairs
            .find(|(_, inside)| inside.contains(':'))
            .unwrap_or(last);
        let length = match inside.find(':') {
            Some(colon) => colon,
            None => inside.trim_end_matches([',', '}', ']', ' ', '\r']).len(),
        };
        let close = start + open + 1 + length;
        Some(self.unclosed(start + open, (length > 0).then_some((close, '"'))))
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
                    let close = is_last.then_some((start + line.len(), quote));
                    return Some(self.unclosed(start + open, close));
                }
            }
            end = start;
        }
        None
    }

    /// The report of a quote that opens here, and which quote closes it where, if that is known.
    fn unclosed(&self, open: usize, close: Option<(usize, char)>) -> YamlError<'static> {
        YamlError::Syntax {
            message: "a quote is never closed".to_owned(),
            label: "opened here".to_owned(),
            hint: "close it with the same kind of quote",
            replacement: close.map(|(at, quote)| Box::new((self.span(at, at), quote.to_string()))),
            span: self.span(open, open + 1),
            bracket: None,
        }
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
