//! Writes the tokens of a YAML text in their new positions.

use super::tokens::{BlockKind, LayoutItem, Token, TokenKind};

/// Spaces per level.
const STEP: usize = 2;

/// The formatted text of the tokens of `source`.
pub(super) fn write(source: &str, items: &[LayoutItem]) -> String {
    let mut writer = LayoutWriter {
        source,
        next_opened: next_opened(items),
        text: String::with_capacity(source.len()),
        column: 0,
        end: 0,
        last: None,
        line_shift: (0, 0),
        levels: Vec::new(),
        brackets: Vec::new(),
        inside: None,
    };
    for (index, item) in items.iter().enumerate() {
        match item {
            LayoutItem::Token(token) => writer.token(index, token),
            LayoutItem::End => {
                writer.levels.pop();
            }
        }
    }
    if !writer.text.is_empty() {
        writer.text.push('\n');
    }
    writer.text
}

/// For each item, the list or map that is opened by the next token that is not a comment, and its
/// offset.
fn next_opened(items: &[LayoutItem]) -> Vec<Option<(usize, BlockKind)>> {
    let mut next = None;
    let mut opened: Vec<_> = items
        .iter()
        .rev()
        .map(|item| {
            let after = next;
            match item {
                LayoutItem::Token(token) if token.kind == TokenKind::Comment => {}
                LayoutItem::Token(token) => next = token.opens.map(|kind| (token.start, kind)),
                LayoutItem::End => next = None,
            }
            after
        })
        .collect();
    opened.reverse();
    opened
}

/// An open block list or map.
struct BlockLevel {
    kind: BlockKind,
    /// The column of its dashes or keys in the result, and in the source.
    column: usize,
    source_column: usize,
}

struct LayoutWriter<'s> {
    source: &'s str,
    /// For each item, the list or map that is opened by the next token that is not a comment.
    next_opened: Vec<Option<(usize, BlockKind)>>,
    text: String,
    /// The current column in the result.
    column: usize,
    /// The end of the last token in the source.
    end: usize,
    last: Option<TokenKind>,
    /// The column of the current line in the result, and in the source.
    line_shift: (usize, usize),
    levels: Vec<BlockLevel>,
    /// For each open bracket, the column of the line that closes it.
    brackets: Vec<usize>,
    /// The column of the current line, if it starts inside a bracket.
    inside: Option<usize>,
}

impl<'s> LayoutWriter<'s> {
    fn token(&mut self, index: usize, token: &Token) {
        let before = self.source.get(self.end..token.start).unwrap_or_default();
        let breaks = before.matches('\n').count();
        let starts_line = self.last.is_none() || breaks > 0;
        let column = if token.kind == TokenKind::Block {
            self.column
        } else if starts_line {
            let column = self.line_column(index, token);
            self.line_shift = (column, self.source_column(token.start));
            if self.last.is_some() {
                self.text.push_str(if breaks > 1 { "\n\n" } else { "\n" });
            }
            self.column = 0;
            self.inside = self.brackets.last().map(|_| column);
            column
        } else {
            self.column_in_line(token)
        };
        let missing = column.saturating_sub(self.column);
        self.text.extend(std::iter::repeat_n(' ', missing));
        self.column = column;
        if let Some(kind) = token.opens {
            let source_column = self.source_column(token.start);
            self.levels.push(BlockLevel {
                kind,
                column,
                source_column,
            });
        }
        self.bracket(token.kind, starts_line.then_some(column));
        self.put(token);
        (self.end, self.last) = (token.end, Some(token.kind));
    }

    /// The column of an offset in the source.
    fn source_column(&self, at: usize) -> usize {
        let before = self.source.get(..at).unwrap_or_default();
        before.chars().rev().take_while(|c| *c != '\n').count()
    }

    /// The column of a token that starts its line.
    fn line_column(&self, index: usize, token: &Token) -> usize {
        let bracket = self.brackets.last();
        let level = self.levels.last();
        match (token.kind, bracket, level) {
            (TokenKind::Directive | TokenKind::Marker, ..) => 0,
            (TokenKind::Closing, Some(bracket), _) => *bracket,
            (_, Some(bracket), _) => bracket + STEP,
            (TokenKind::Comment, None, _) => self.comment_column(index, token),
            (_, None, None) => 0,
            (kind, None, Some(level)) => match token.opens {
                Some(opens) => self.opened(opens),
                None if token.is_key => level.column,
                None => match kind {
                    TokenKind::Dash | TokenKind::Question | TokenKind::Colon => level.column,
                    TokenKind::Directive
                    | TokenKind::Marker
                    | TokenKind::Comma
                    | TokenKind::Opening
                    | TokenKind::Closing
                    | TokenKind::Property
                    | TokenKind::Alias
                    | TokenKind::Plain
                    | TokenKind::Quoted
                    | TokenKind::Header
                    | TokenKind::Block
                    | TokenKind::Comment => level.column + STEP,
                },
            },
        }
    }

    /// The column of a list or map that starts on a new line.
    fn opened(&self, kind: BlockKind) -> usize {
        match (kind, self.levels.last()) {
            (_, None) => 0,
            (BlockKind::List, Some(level)) if level.kind == BlockKind::Map => level.column,
            (BlockKind::List | BlockKind::Map, Some(level)) => level.column + STEP,
        }
    }

    /// The column of a comment on its own line: that of the list or map that it was aligned with,
    /// which may be the next one.
    fn comment_column(&self, index: usize, comment: &Token) -> usize {
        let source_column = self.source_column(comment.start);
        if let Some((start, kind)) = self.next_opened[index]
            && self.source_column(start) <= source_column
        {
            return self.opened(kind);
        }
        let levels = || self.levels.iter();
        let found_text = levels()
            .rev()
            .find(|level| level.source_column <= source_column);
        found_text
            .or_else(|| levels().next())
            .map_or(0, |level| level.column)
    }

    /// The column of a token within its line.
    fn column_in_line(&self, token: &Token) -> usize {
        if token.kind == TokenKind::Comment {
            let (starts, started) = self.line_shift;
            let moved = (self.source_column(token.start) + starts).saturating_sub(started);
            return moved.max(self.column + 1);
        }
        let is_close = match (self.last, token.kind) {
            // Without a space, these and a following bracket or comma could form a scalar.
            (Some(TokenKind::Question | TokenKind::Dash), _) => false,
            (Some(TokenKind::Opening), _) | (_, TokenKind::Closing | TokenKind::Comma) => true,
            // After an alias, the colon would belong to its name.
            (Some(last), TokenKind::Colon) => matches!(
                last,
                TokenKind::Plain | TokenKind::Quoted | TokenKind::Closing
            ),
            _ => false,
        };
        self.column + usize::from(!is_close)
    }

    /// Records an opening or closing bracket, with its column if it starts a line.
    fn bracket(&mut self, kind: TokenKind, column: Option<usize>) {
        if kind == TokenKind::Opening {
            let bracket = self.inside.or(self.brackets.last().copied());
            let around = match (bracket, self.levels.last()) {
                (Some(bracket), _) => bracket,
                (None, Some(level)) if level.kind == BlockKind::List => level.column + STEP,
                (None, Some(level)) => level.column,
                (None, None) => 0,
            };
            self.brackets.push(column.unwrap_or(around));
        } else if kind == TokenKind::Closing {
            self.brackets.pop();
        }
    }

    fn put(&mut self, token: &Token) {
        let text = self.source.get(token.start..token.end).unwrap_or_default();
        if token.kind == TokenKind::Block {
            return self.block(text);
        }
        let mut lines = text.split('\n');
        let first = lines.next().unwrap_or_default();
        self.line(token.kind, first);
        let column = match (self.brackets.last(), self.levels.last()) {
            (Some(bracket), _) => bracket + STEP,
            (None, Some(level)) => level.column + STEP,
            (None, None) => STEP,
        };
        for line in lines {
            self.text.push('\n');
            self.column = 0;
            let line = line.trim_start_matches([' ', '\t']);
            if !line.is_empty() {
                self.text.extend(std::iter::repeat_n(' ', column));
                self.column = column;
                self.line(token.kind, line);
            }
        }
    }

    /// One line of a token. Trailing white space is significant in quotes.
    fn line(&mut self, kind: TokenKind, line: &str) {
        let line = if kind == TokenKind::Quoted {
            line
        } else {
            line.trim_end_matches([' ', '\t'])
        };
        self.text.push_str(line);
        self.column += line.chars().count();
    }

    /// The lines of a block scalar, shifted together.
    fn block(&mut self, lines: &'s str) {
        let level = self.levels.last();
        let (column, source_column) =
            level.map_or((0, 0), |level| (level.column, level.source_column));
        let header = self.text.rsplit('\n').next().unwrap_or_default();
        let header = header.rsplit(" #").last().unwrap_or_default();
        let indentation_indicator = header
            .trim_end()
            .chars()
            .rev()
            .take(2)
            .find_map(|c| c.to_digit(10));
        let first = lines.split('\n').find(|line| !line.trim().is_empty());
        // A line of white space is an empty line, whatever its length.
        let indent = first.map_or(usize::MAX, |line| {
            line.len() - line.trim_start_matches(' ').len()
        });
        let (column, indent) = match indentation_indicator {
            Some(digit) => (column + digit as usize, source_column + digit as usize),
            None => (column + STEP, indent),
        };
        for line in lines.split('\n') {
            self.text.push('\n');
            let rest = line.get(indent..).unwrap_or_default();
            if !rest.is_empty() {
                self.text.extend(std::iter::repeat_n(' ', column));
                self.text.push_str(rest);
            }
        }
        self.column = 0;
    }
}
