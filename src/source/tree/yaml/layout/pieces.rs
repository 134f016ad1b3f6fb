//! A YAML text in pieces: what the scanner says is a word or a bracket, and what stands between.
//!
//! Between its tokens there are only blanks, comments, and the signs of block lists and maps. So a
//! `#` there starts a comment, and nowhere else.

use granit_parser::{ScalarStyle, Scanner, StrInput, TokenType};

/// What a piece of the text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PieceKind {
    /// A line that starts with `%`.
    Directive,
    /// `---` or `...`.
    Marker,
    /// The dash of an item.
    Dash,
    /// The question mark of a long key.
    Question,
    Colon,
    Comma,
    /// `[` or `{`.
    Opening,
    /// `]` or `}`.
    Closing,
    /// An anchor or a tag.
    Property,
    Alias,
    Plain,
    Quoted,
    /// `|` or `>`, with what belongs to it.
    Header,
    /// The lines below a header.
    Block,
    Comment,
}

/// A list or map without brackets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockKind {
    List,
    Map,
}

/// A piece of the text that stands in one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) kind: PieceKind,
    pub(super) start: usize,
    pub(super) end: usize,
    /// The list or map that starts with it.
    pub(super) opens: Option<BlockKind>,
    /// It starts a key.
    pub(super) is_key: bool,
}

/// What comes one after the other.
#[derive(Clone, Copy, Debug)]
pub(super) enum LayoutItem {
    Piece(Piece),
    /// The innermost list or map without brackets ends.
    End,
}

/// All pieces of a text that the parser takes; `None` if one is not understood.
pub(super) fn items(source: &str) -> Option<Vec<LayoutItem>> {
    let mut cut = Cutter {
        source,
        at: 0,
        items: Vec::new(),
        open: Vec::new(),
        brackets: 0,
        opens: None,
        is_key: false,
        block: None,
    };
    for token in Scanner::new(StrInput::new(source)) {
        let (span, kind) = token.ok()?.into_parts();
        let range = span.byte_range()?;
        cut.token(range.start, range.end, &kind)?;
    }
    cut.between(source.len())?;
    Some(cut.items)
}

/// A list or map that is open, without brackets.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OpenBlock {
    Told,
    Map,
    /// A list that is indented no further than the key that has it: the scanner tells neither its
    /// start nor its end.
    Untold,
}

struct Cutter<'s> {
    source: &'s str,
    /// All before is cut.
    at: usize,
    items: Vec<LayoutItem>,
    open: Vec<OpenBlock>,
    brackets: usize,
    /// For the next piece.
    opens: Option<BlockKind>,
    is_key: bool,
    /// Where the lines below a header start, and whether it keeps empty ones at its end.
    block: Option<(usize, bool)>,
}

impl Cutter<'_> {
    fn token(&mut self, start: usize, end: usize, kind: &TokenType<'_>) -> Option<()> {
        let is_block = matches!(
            kind,
            TokenType::Scalar(ScalarStyle::Literal | ScalarStyle::Folded, _)
        );
        // One without lines may start before its header.
        self.between(if is_block { end } else { start })?;
        match kind {
            TokenType::BlockSequenceStart => self.open(OpenBlock::Told, BlockKind::List),
            TokenType::BlockMappingStart => self.open(OpenBlock::Map, BlockKind::Map),
            TokenType::BlockEnd => {
                self.end_untold();
                self.end();
            }
            TokenType::Key | TokenType::Value => {
                self.end_untold();
                self.is_key |= matches!(kind, TokenType::Key);
            }
            TokenType::FlowSequenceStart | TokenType::FlowMappingStart => {
                self.brackets += 1;
                self.put(PieceKind::Opening, start, end);
            }
            TokenType::FlowSequenceEnd | TokenType::FlowMappingEnd => {
                self.brackets = self.brackets.checked_sub(1)?;
                self.put(PieceKind::Closing, start, end);
            }
            TokenType::FlowEntry => self.put(PieceKind::Comma, start, end),
            TokenType::DocumentStart | TokenType::DocumentEnd => {
                self.put(PieceKind::Marker, start, end);
            }
            TokenType::Alias(_) => self.put(PieceKind::Alias, start, end),
            TokenType::Anchor(_) | TokenType::Tag(..) => {
                self.put(PieceKind::Property, start, end);
            }
            TokenType::Scalar(ScalarStyle::Plain, _) => self.put(PieceKind::Plain, start, end),
            TokenType::Scalar(ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted, _) => {
                self.put(PieceKind::Quoted, start, end);
            }
            TokenType::Scalar(..) => self.block(end)?,
            TokenType::StreamStart
            | TokenType::StreamEnd
            | TokenType::BlockEntry
            | TokenType::VersionDirective(..)
            | TokenType::TagDirective(..)
            | TokenType::ReservedDirective(..)
            | _ => {}
        }
        Some(())
    }

    fn open(&mut self, open: OpenBlock, kind: BlockKind) {
        self.open.push(open);
        self.opens = Some(kind);
    }

    fn end(&mut self) {
        self.open.pop();
        self.items.push(LayoutItem::End);
    }

    fn end_untold(&mut self) {
        if self.brackets == 0 && self.open.last() == Some(&OpenBlock::Untold) {
            self.end();
        }
    }

    fn put(&mut self, kind: PieceKind, start: usize, end: usize) {
        // A word without text, as of a key without a value.
        if start == end {
            return;
        }
        let is_comment = kind == PieceKind::Comment;
        self.items.push(LayoutItem::Piece(Piece {
            kind,
            start,
            end,
            opens: if is_comment { None } else { self.opens.take() },
            is_key: !is_comment && std::mem::take(&mut self.is_key),
        }));
        self.at = end;
    }

    /// Cuts what stands before a token.
    fn between(&mut self, end: usize) -> Option<()> {
        while self.at < end && self.block.is_none() {
            let rest = self.source.get(self.at..end)?;
            let words = rest.trim_start_matches([' ', '\t', '\n']);
            self.at = end - words.len();
            let start = self.at;
            let line = words.split('\n').next().unwrap_or_default();
            match words.chars().next() {
                None => {}
                Some('#') => self.put(PieceKind::Comment, start, start + line.trim_end().len()),
                Some('%') => self.put(PieceKind::Directive, start, start + line.trim_end().len()),
                Some('-') => self.dash(start),
                Some('?') => self.put(PieceKind::Question, start, start + 1),
                Some(':') => self.put(PieceKind::Colon, start, start + 1),
                Some('|' | '>') => self.header(start, line),
                Some(_) => return None,
            }
        }
        Some(())
    }

    fn dash(&mut self, start: usize) {
        if self.opens.is_none() && self.open.last() == Some(&OpenBlock::Map) {
            self.open(OpenBlock::Untold, BlockKind::List);
        }
        self.put(PieceKind::Dash, start, start + 1);
    }

    /// The header of a block of lines, and the comment that may follow it.
    fn header(&mut self, start: usize, line: &str) {
        let header = line.split([' ', '\t']).next().unwrap_or_default();
        self.put(PieceKind::Header, start, start + header.len());
        if let Some(at) = line.find('#') {
            self.put(
                PieceKind::Comment,
                start + at,
                start + line.trim_end().len(),
            );
        }
        self.block = Some((start + line.len() + 1, header.contains('+')));
    }

    /// The lines below the header: without empty ones at the end, unless it keeps them.
    fn block(&mut self, end: usize) -> Option<()> {
        let (start, keeps) = self.block.take()?;
        let lines = self.source.get(start..end).unwrap_or_default();
        let length = match keeps {
            true => lines.rfind('\n').unwrap_or(lines.len()),
            false => {
                let last = lines.trim_end_matches([' ', '\t', '\n']).len();
                let rest = lines.get(last..)?;
                last + rest.find('\n').filter(|_| last > 0).unwrap_or(0)
            }
        };
        self.at = self.at.max(start.min(end));
        self.put(PieceKind::Block, start, start + length);
        Some(())
    }
}
