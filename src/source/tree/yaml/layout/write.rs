//! The pieces of a YAML text, written where they belong.

use super::pieces::{BlockKind, LayoutItem, Piece, PieceKind};

/// Spaces a level.
const STEP: usize = 2;

/// The text of the pieces, cut from `source`.
pub(super) fn write(source: &str, items: &[LayoutItem]) -> String {
    let mut writer = LayoutWriter {
        source,
        opened_after: opened_after(items),
        text: String::with_capacity(source.len()),
        column: 0,
        end: 0,
        last: None,
        shift: (0, 0),
        levels: Vec::new(),
        brackets: Vec::new(),
        inside: None,
    };
    for (index, item) in items.iter().enumerate() {
        match item {
            LayoutItem::Piece(piece) => writer.piece(index, piece),
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

/// Of each item the list or map that is opened by the next one that is no comment, and where that
/// starts.
fn opened_after(items: &[LayoutItem]) -> Vec<Option<(usize, BlockKind)>> {
    let mut next = None;
    let mut opened: Vec<_> = items
        .iter()
        .rev()
        .map(|item| {
            let after = next;
            match item {
                LayoutItem::Piece(piece) if piece.kind == PieceKind::Comment => {}
                LayoutItem::Piece(piece) => next = piece.opens.map(|kind| (piece.start, kind)),
                LayoutItem::End => next = None,
            }
            after
        })
        .collect();
    opened.reverse();
    opened
}

/// A list or map without brackets that is open.
struct Level {
    kind: BlockKind,
    /// Where its dashes or keys stand now, and where they stood.
    column: usize,
    stood: usize,
}

struct LayoutWriter<'s> {
    source: &'s str,
    /// Of each item the list or map that is opened by what comes after it and after its comments.
    opened_after: Vec<Option<(usize, BlockKind)>>,
    text: String,
    /// Where the text has come to in its line.
    column: usize,
    /// Where the last piece ended in the source.
    end: usize,
    last: Option<PieceKind>,
    /// Where the line starts now, and where it started.
    shift: (usize, usize),
    levels: Vec<Level>,
    /// Of each open bracket, where the line that closes it starts.
    brackets: Vec<usize>,
    /// Where the line starts, if that is inside a bracket.
    inside: Option<usize>,
}

impl<'s> LayoutWriter<'s> {
    fn piece(&mut self, index: usize, piece: &Piece) {
        let before = self.source.get(self.end..piece.start).unwrap_or_default();
        let breaks = before.matches('\n').count();
        let starts_line = self.last.is_none() || breaks > 0;
        let column = if piece.kind == PieceKind::Block {
            self.column
        } else if starts_line {
            let column = self.line_column(index, piece);
            self.shift = (column, self.stood(piece.start));
            if self.last.is_some() {
                self.text.push_str(if breaks > 1 { "\n\n" } else { "\n" });
            }
            self.column = 0;
            self.inside = self.brackets.last().map(|_| column);
            column
        } else {
            self.column_in_line(piece)
        };
        let missing = column.saturating_sub(self.column);
        self.text.extend(std::iter::repeat_n(' ', missing));
        self.column = column;
        if let Some(kind) = piece.opens {
            let stood = self.stood(piece.start);
            self.levels.push(Level {
                kind,
                column,
                stood,
            });
        }
        self.bracket(piece.kind, starts_line.then_some(column));
        self.put(piece);
        (self.end, self.last) = (piece.end, Some(piece.kind));
    }

    /// Where the source has a place in its line.
    fn stood(&self, at: usize) -> usize {
        let before = self.source.get(..at).unwrap_or_default();
        before.chars().rev().take_while(|c| *c != '\n').count()
    }

    /// Where a line starts that starts with a piece.
    fn line_column(&self, index: usize, piece: &Piece) -> usize {
        let bracket = self.brackets.last();
        let level = self.levels.last();
        match (piece.kind, bracket, level) {
            (PieceKind::Directive | PieceKind::Marker, ..) => 0,
            (PieceKind::Closing, Some(bracket), _) => *bracket,
            (_, Some(bracket), _) => bracket + STEP,
            (PieceKind::Comment, None, _) => self.comment_column(index, piece),
            (_, None, None) => 0,
            (kind, None, Some(level)) => match piece.opens {
                Some(opens) => self.opened(opens),
                None if piece.is_key => level.column,
                None => match kind {
                    PieceKind::Dash | PieceKind::Question | PieceKind::Colon => level.column,
                    PieceKind::Directive
                    | PieceKind::Marker
                    | PieceKind::Comma
                    | PieceKind::Opening
                    | PieceKind::Closing
                    | PieceKind::Property
                    | PieceKind::Alias
                    | PieceKind::Plain
                    | PieceKind::Quoted
                    | PieceKind::Header
                    | PieceKind::Block
                    | PieceKind::Comment => level.column + STEP,
                },
            },
        }
    }

    /// Where a list or map stands that starts with a line.
    fn opened(&self, kind: BlockKind) -> usize {
        match (kind, self.levels.last()) {
            (_, None) => 0,
            (BlockKind::List, Some(level)) if level.kind == BlockKind::Map => level.column,
            (BlockKind::List | BlockKind::Map, Some(level)) => level.column + STEP,
        }
    }

    /// Where a comment on a line of its own stands: with the list or map that it stood with, which may
    /// be the one that follows.
    fn comment_column(&self, index: usize, comment: &Piece) -> usize {
        let stood = self.stood(comment.start);
        if let Some((start, kind)) = self.opened_after[index]
            && self.stood(start) <= stood
        {
            return self.opened(kind);
        }
        let levels = || self.levels.iter();
        let own = levels().rev().find(|level| level.stood <= stood);
        own.or_else(|| levels().next())
            .map_or(0, |level| level.column)
    }

    /// Where a piece stands that does not start its line.
    fn column_in_line(&self, piece: &Piece) -> usize {
        if piece.kind == PieceKind::Comment {
            let (starts, started) = self.shift;
            let moved = (self.stood(piece.start) + starts).saturating_sub(started);
            return moved.max(self.column + 1);
        }
        let is_close = match (self.last, piece.kind) {
            // Together with a bracket or comma, these may be a word.
            (Some(PieceKind::Question | PieceKind::Dash), _) => false,
            (Some(PieceKind::Opening), _) | (_, PieceKind::Closing | PieceKind::Comma) => true,
            // After an alias, the colon would belong to its name.
            (Some(last), PieceKind::Colon) => matches!(
                last,
                PieceKind::Plain | PieceKind::Quoted | PieceKind::Closing
            ),
            _ => false,
        };
        self.column + usize::from(!is_close)
    }

    /// Notes a bracket that opens or closes; with the column if it starts its line.
    fn bracket(&mut self, kind: PieceKind, column: Option<usize>) {
        if kind == PieceKind::Opening {
            let bracket = self.inside.or(self.brackets.last().copied());
            let around = match (bracket, self.levels.last()) {
                (Some(bracket), _) => bracket,
                (None, Some(level)) if level.kind == BlockKind::List => level.column + STEP,
                (None, Some(level)) => level.column,
                (None, None) => 0,
            };
            self.brackets.push(column.unwrap_or(around));
        } else if kind == PieceKind::Closing {
            self.brackets.pop();
        }
    }

    fn put(&mut self, piece: &Piece) {
        let text = self.source.get(piece.start..piece.end).unwrap_or_default();
        if piece.kind == PieceKind::Block {
            return self.block(text);
        }
        let mut lines = text.split('\n');
        let first = lines.next().unwrap_or_default();
        self.line(piece.kind, first);
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
                self.line(piece.kind, line);
            }
        }
    }

    /// One line of a piece: blanks at its end may count in quotes.
    fn line(&mut self, kind: PieceKind, line: &str) {
        let line = if kind == PieceKind::Quoted {
            line
        } else {
            line.trim_end_matches([' ', '\t'])
        };
        self.text.push_str(line);
        self.column += line.chars().count();
    }

    /// The lines below a header, moved as one.
    fn block(&mut self, lines: &'s str) {
        let level = self.levels.last();
        let (column, stood) = level.map_or((0, 0), |level| (level.column, level.stood));
        let header = self.text.rsplit('\n').next().unwrap_or_default();
        let header = header.rsplit(" #").last().unwrap_or_default();
        let told = header
            .trim_end()
            .chars()
            .rev()
            .take(2)
            .find_map(|c| c.to_digit(10));
        let first = lines.split('\n').find(|line| !line.trim().is_empty());
        // Blanks alone are an empty line, wherever they end.
        let indent = first.map_or(usize::MAX, |line| {
            line.len() - line.trim_start_matches(' ').len()
        });
        let (column, indent) = match told {
            Some(digit) => (column + digit as usize, stood + digit as usize),
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
