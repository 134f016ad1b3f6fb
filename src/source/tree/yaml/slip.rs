//! Slips of the hand that the YAML parser notices late, or tells of in its own words: found in the
//! text around the place, with the text that was meant.

use super::super::{Tree, to_u32};
use super::Mistake;
use crate::Span;
use granit_parser::ErrorKind;

/// The slip that explains an error at a place, if one is found there.
pub(super) fn find(tree: &Tree<'_>, at: usize, kind: &ErrorKind) -> Option<Mistake<'static>> {
    let text = Text { tree };
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

/// The text that a tree was to be made of.
struct Text<'t, 's> {
    tree: &'t Tree<'s>,
}

impl Text<'_, '_> {
    /// A tab before the first word of the line, or of one after it.
    fn tab(&self, at: usize) -> Option<Mistake<'static>> {
        let line = self.line(at);
        let found = self.after(line).find('\t')? + line;
        let rest = self.after(found);
        let count = rest.len() - rest.trim_start_matches('\t').len();
        let span = self.span(found, found + count);
        let spaces = "  ".repeat(count);
        Some(slip(
            "a tab can't indent".to_owned(),
            "a tab".to_owned(),
            "indent with spaces",
            span,
            (span, spaces),
        ))
    }

    /// A backslash in double quotes, as in the path of a file, that is taken for an escape.
    fn backslash(&self, at: usize) -> Option<Mistake<'static>> {
        let line = self.after(at + 1).split(['\n', '\r']).next()?;
        let inside = line.split('"').next()?;
        if !inside.contains('\\') || inside.contains('\'') || inside.len() == line.len() {
            return None;
        }
        let span = self.span(at, at + inside.len() + 2);
        Some(slip(
            "a backslash in double quotes starts an escape".to_owned(),
            "no such escape in here".to_owned(),
            "in single quotes it is a backslash",
            span,
            (span, format!("'{inside}'")),
        ))
    }

    /// A line without a colon, or without the space after it.
    fn colon(&self, at: usize) -> Option<Mistake<'static>> {
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
            "=" => "`=` in place of a colon",
            "" => "a line that is no `key: value`",
            _ => return None,
        };
        let span = self.span(first, first + key.len() + between.len());
        Some(slip(
            message.to_owned(),
            String::new(),
            "write a colon and a space after the key",
            span,
            (span, format!("{key}: ")),
        ))
    }

    /// A quote that is never closed: the last one before a place that opens and does not close in its
    /// line.
    fn quote(&self, at: usize) -> Option<Mistake<'static>> {
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
                    return Some(Mistake::Syntax {
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
    fn dash(&self, at: usize) -> Option<Mistake<'static>> {
        let line = self.line(at);
        let start = self.line(line.checked_sub(1)?);
        let before = self.tree.source.get(start..line)?;
        let words = before.trim_start();
        let is_dash = words.strip_prefix('-')?.starts_with(char::is_alphabetic);
        let dash = start + before.len() - words.len();
        let span = self.span(dash, dash + 1);
        is_dash.then(|| {
            slip(
                "no space after a dash".to_owned(),
                "begins no item".to_owned(),
                "each item of a list begins with a dash and a space",
                span,
                (span, "- ".to_owned()),
            )
        })
    }

    /// A line that is indented a little more or less than the one before, which it seems to belong to.
    fn indentation(&self, at: usize) -> Option<Mistake<'static>> {
        let line = self.line(at);
        let own = Indented::of(self.after(line).lines().next()?)?;
        let before = self.tree.source.get(..line)?.lines().rev();
        let before = before.filter_map(Indented::of).next()?;
        // A key without a value on its line has the next lines for its value.
        let is_value = before.words.ends_with(':');
        let apart = own.spaces.abs_diff(before.spaces);
        if is_value || own.starts_item || apart == 0 || apart > 3 || !own.words.contains(':') {
            return None;
        }
        let key = own.words.split(':').next()?;
        let (spaces, wanted) = (own.spaces, before.spaces);
        let first = line + spaces;
        Some(slip(
            format!("`{key}` has {spaces} spaces before it, and its neighbour {wanted}"),
            format!("{spaces} spaces before this"),
            "indent lines that belong together alike",
            self.span(first, first + key.len()),
            (
                self.span(line, first + key.len()),
                format!("{}{key}", " ".repeat(wanted)),
            ),
        ))
    }

    /// The text from a place on.
    fn after(&self, at: usize) -> &str {
        self.tree.source.get(at..).unwrap_or_default()
    }

    /// Where the line of a place starts.
    fn line(&self, at: usize) -> usize {
        let before = self.tree.source.get(..at).unwrap_or_default();
        before.rfind('\n').map_or(0, |end| end + 1)
    }

    fn span(&self, start: usize, end: usize) -> Span {
        let base = self.tree.base;
        Span::new(self.tree.file, to_u32(start) + base, to_u32(end) + base)
    }
}

fn slip(
    message: String,
    label: String,
    hint: &'static str,
    span: Span,
    replacement: (Span, String),
) -> Mistake<'static> {
    Mistake::Syntax {
        message,
        label,
        hint,
        replacement: Some(Box::new(replacement)),
        span,
        bracket: None,
    }
}

/// A line with words.
struct Indented<'t> {
    /// How many spaces stand before its first key; the dash of an item and what follows it count.
    spaces: usize,
    /// Whether it starts an item.
    starts_item: bool,
    words: &'t str,
}

impl<'t> Indented<'t> {
    /// A line, unless it is empty or a comment.
    fn of(line: &'t str) -> Option<Self> {
        let words = line.trim();
        if words.is_empty() || words.starts_with('#') {
            return None;
        }
        let inner = line.trim_start_matches([' ', '-']);
        Some(Self {
            spaces: line.len() - inner.len(),
            starts_item: words.starts_with('-'),
            words,
        })
    }
}
