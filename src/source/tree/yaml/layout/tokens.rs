//! Tokens of a YAML text with comments, for the formatter.
//!
//! Between the tokens of the scanner there are only white space, comments, and the indicators of
//! block lists and maps. So a `#` there starts a comment, and nowhere else.

use granit_parser::{ScalarStyle, Scanner, StrInput, TokenType};

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A line that starts with `%`.
    Directive,
    /// `---` or `...`.
    Marker,
    /// The dash of a list item.
    Dash,
    /// The question mark of an explicit key.
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
    /// `|` or `>`, with its indicators.
    Header,
    /// The lines of a block scalar.
    Block,
    Comment,
}

/// A block list or block map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockKind {
    List,
    Map,
}

/// A token.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) start: usize,
    pub(super) end: usize,
    /// The block list or map that starts with it.
    pub(super) opens: Option<BlockKind>,
    /// Whether it starts a key.
    pub(super) is_key: bool,
}

/// An item of the token stream.
#[derive(Clone, Copy, Debug)]
pub(super) enum LayoutItem {
    Token(Token),
    /// The innermost block list or map ends.
    End,
}

/// All tokens of a valid text; `None` if one is not understood.
pub(super) fn items(source: &str) -> Option<Vec<LayoutItem>> {
    let mut tokenizer = Tokenizer {
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
        tokenizer.token(range.start, range.end, &kind)?;
    }
    tokenizer.between(source.len())?;
    Some(tokenizer.items)
}

/// An open block list or map.
#[derive(Clone, Copy, PartialEq, Eq)]
enum OpenBlock {
    Explicit,
    Map,
    /// A list that is not indented more than its key: the scanner reports neither its start nor its
    /// end.
    Implicit,
}

struct Tokenizer<'s> {
    source: &'s str,
    /// The end of the last token.
    at: usize,
    items: Vec<LayoutItem>,
    open: Vec<OpenBlock>,
    brackets: usize,
    /// For the next token.
    opens: Option<BlockKind>,
    is_key: bool,
    /// The start of the lines after a block scalar header, and whether it keeps empty lines at its
    /// end.
    block: Option<(usize, bool)>,
}

impl Tokenizer<'_> {
    fn token(&mut self, start: usize, end: usize, kind: &TokenType<'_>) -> Option<()> {
        let is_block = matches!(
            kind,
            TokenType::Scalar(ScalarStyle::Literal | ScalarStyle::Folded, _)
        );
        // A block scalar without lines may start before its header.
        self.between(if is_block { end } else { start })?;
        // Blocks open and end; other tokens are emitted.
        match kind {
            TokenType::BlockSequenceStart => self.open(OpenBlock::Explicit, BlockKind::List),
            TokenType::BlockMappingStart => self.open(OpenBlock::Map, BlockKind::Map),
            TokenType::BlockEnd => {
                self.end_implicit();
                self.end();
            }
            TokenType::Key | TokenType::Value => {
                self.end_implicit();
                self.is_key |= matches!(kind, TokenType::Key);
            }
            TokenType::FlowSequenceStart | TokenType::FlowMappingStart => {
                self.brackets += 1;
                self.put(TokenKind::Opening, start, end);
            }
            TokenType::FlowSequenceEnd | TokenType::FlowMappingEnd => {
                self.brackets = self.brackets.checked_sub(1)?;
                self.put(TokenKind::Closing, start, end);
            }
            TokenType::FlowEntry => self.put(TokenKind::Comma, start, end),
            TokenType::DocumentStart | TokenType::DocumentEnd => {
                self.put(TokenKind::Marker, start, end);
            }
            TokenType::Alias(_) => self.put(TokenKind::Alias, start, end),
            TokenType::Anchor(_) | TokenType::Tag(..) => {
                self.put(TokenKind::Property, start, end);
            }
            TokenType::Scalar(ScalarStyle::Plain, _) => self.put(TokenKind::Plain, start, end),
            TokenType::Scalar(ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted, _) => {
                self.put(TokenKind::Quoted, start, end);
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

    fn end_implicit(&mut self) {
        if self.brackets == 0 && self.open.last() == Some(&OpenBlock::Implicit) {
            self.end();
        }
    }

    fn put(&mut self, kind: TokenKind, start: usize, end: usize) {
        // An empty scalar, for example of a key without a value.
        if start == end {
            return;
        }
        let is_comment = kind == TokenKind::Comment;
        self.items.push(LayoutItem::Token(Token {
            kind,
            start,
            end,
            opens: if is_comment { None } else { self.opens.take() },
            is_key: !is_comment && std::mem::take(&mut self.is_key),
        }));
        self.at = end;
    }

    /// Reads the indicators and comments before a token.
    fn between(&mut self, end: usize) -> Option<()> {
        while self.at < end && self.block.is_none() {
            let rest = self.source.get(self.at..end)?;
            let visible_characters = rest.trim_start_matches([' ', '\t', '\n']);
            self.at = end - visible_characters.len();
            let start = self.at;
            let line = visible_characters.split('\n').next().unwrap_or_default();
            match visible_characters.chars().next() {
                None => {}
                Some('#') => self.put(TokenKind::Comment, start, start + line.trim_end().len()),
                Some('%') => self.put(TokenKind::Directive, start, start + line.trim_end().len()),
                Some('-') => self.dash(start),
                Some('?') => self.put(TokenKind::Question, start, start + 1),
                Some(':') => self.put(TokenKind::Colon, start, start + 1),
                Some('|' | '>') => self.header(start, line),
                Some(_) => return None,
            }
        }
        Some(())
    }

    fn dash(&mut self, start: usize) {
        if self.opens.is_none() && self.open.last() == Some(&OpenBlock::Map) {
            self.open(OpenBlock::Implicit, BlockKind::List);
        }
        self.put(TokenKind::Dash, start, start + 1);
    }

    /// The header of a block scalar, and the comment that may follow it.
    fn header(&mut self, start: usize, line: &str) {
        let header = line.split([' ', '\t']).next().unwrap_or_default();
        self.put(TokenKind::Header, start, start + header.len());
        if let Some(at) = line.find('#') {
            self.put(
                TokenKind::Comment,
                start + at,
                start + line.trim_end().len(),
            );
        }
        self.block = Some((start + line.len() + 1, header.contains('+')));
    }

    /// The lines of a block scalar, without empty ones at the end unless it keeps them.
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
        self.put(TokenKind::Block, start, start + length);
        Some(())
    }
}
