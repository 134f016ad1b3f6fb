//! The tokens of a pbrt text with their spans.

use crate::exchange::SpannedText;
use rtc_source::{FileId, Span};
use std::ops::Range;
use std::sync::Arc;

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PbrtTokenKind {
    /// A string; its range excludes the quotes.
    Quoted,
    /// A name, a number, `true` or `false`.
    Word,
    Open,
    Close,
    /// A string that its line does not end.
    Unterminated,
}

/// A token and the range of its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PbrtToken {
    pub(super) kind: PbrtTokenKind,
    start: usize,
    end: usize,
}

impl PbrtToken {
    /// Its bytes, without quotes.
    pub(crate) fn range(self) -> Range<usize> {
        self.start..self.end
    }
}

/// The text of a file, and how far it was read.
#[derive(Clone, Debug)]
pub(super) struct TokenReader {
    file: FileId,
    /// Those of the source map.
    bytes: Arc<Vec<u8>>,
    at: usize,
    /// The tokens that were read.
    pub(super) count: u64,
}

impl TokenReader {
    pub(super) fn new(file: FileId, bytes: Arc<Vec<u8>>) -> Self {
        let mark: &[u8] = b"\xef\xbb\xbf";
        Self {
            file,
            at: if bytes.starts_with(mark) {
                mark.len()
            } else {
                0
            },
            bytes,
            count: 0,
        }
    }

    /// The same text from its start.
    pub(super) fn restarted(&self) -> Self {
        Self::new(self.file, Arc::clone(&self.bytes))
    }

    /// The bytes of the text.
    pub(super) fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether its text is this one.
    pub(super) fn has_text(&self, bytes: &[u8]) -> bool {
        *self.bytes == bytes
    }

    pub(super) fn file(&self) -> FileId {
        self.file
    }

    /// The next token, which stays unread.
    pub(super) fn peek(&self) -> Option<PbrtToken> {
        token(&self.bytes, self.at)
    }

    pub(super) fn next(&mut self) -> Option<PbrtToken> {
        let token = self.peek()?;
        self.at = match token.kind {
            // Behind the closing quote.
            PbrtTokenKind::Quoted => token.end + 1,
            _ => token.end,
        };
        self.count += 1;
        Some(token)
    }

    /// The next token, if it is of this kind.
    pub(super) fn next_if(&mut self, kind: PbrtTokenKind) -> Option<PbrtToken> {
        self.peek().filter(|token| token.kind == kind)?;
        self.next()
    }

    pub(super) fn bytes(&self, token: PbrtToken) -> &[u8] {
        self.bytes.get(token.start..token.end).unwrap_or_default()
    }

    /// The span of a token.
    pub(super) fn span(&self, token: PbrtToken) -> Span {
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Span::new(self.file, offset(token.start), offset(token.end))
    }

    /// A string with its escapes `\"` and `\\` replaced; invalid UTF-8 is replaced, too.
    pub(super) fn text(&self, token: PbrtToken) -> SpannedText {
        let text = String::from_utf8_lossy(self.bytes(token));
        let text = match text.contains('\\') {
            true => text.replace("\\\"", "\"").replace("\\\\", "\\"),
            false => text.into_owned(),
        };
        SpannedText {
            text,
            span: self.span(token),
        }
    }

    /// The number that a token is.
    pub(super) fn number(&self, token: PbrtToken) -> Option<f64> {
        if token.kind != PbrtTokenKind::Word {
            return None;
        }
        let text = std::str::from_utf8(self.bytes(token)).ok()?;
        text.parse().ok().filter(|number: &f64| number.is_finite())
    }
}

/// The token at or after an offset, behind white space and comments.
pub(crate) fn token(bytes: &[u8], mut at: usize) -> Option<PbrtToken> {
    loop {
        match bytes.get(at)? {
            b'#' => {
                let rest = bytes.get(at..)?;
                at += memchr::memchr2(b'\n', b'\r', rest)?;
            }
            byte if byte.is_ascii_whitespace() || *byte == b',' => at += 1,
            b'[' => return Some(single(PbrtTokenKind::Open, at)),
            b']' => return Some(single(PbrtTokenKind::Close, at)),
            b'"' => return Some(quoted(bytes, at + 1)),
            _ => {
                let is_end = |byte: &u8| byte.is_ascii_whitespace() || b"\"[]#,".contains(byte);
                let rest = bytes.get(at..)?;
                let length = rest.iter().position(is_end).unwrap_or(rest.len());
                return Some(PbrtToken {
                    kind: PbrtTokenKind::Word,
                    start: at,
                    end: at + length,
                });
            }
        }
    }
}

fn single(kind: PbrtTokenKind, at: usize) -> PbrtToken {
    PbrtToken {
        kind,
        start: at,
        end: at + 1,
    }
}

/// The string that starts here. It ends on its line.
fn quoted(bytes: &[u8], start: usize) -> PbrtToken {
    let mut end = start;
    let kind = loop {
        match bytes.get(end) {
            Some(b'"') => break PbrtTokenKind::Quoted,
            Some(b'\\') if bytes.get(end + 1).is_some_and(|byte| *byte != b'\n') => end += 2,
            Some(b'\n') | None => break PbrtTokenKind::Unterminated,
            Some(_) => end += 1,
        }
    };
    PbrtToken { kind, start, end }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::SourceMap;

    fn words(text: &str) -> Vec<(PbrtTokenKind, String)> {
        let file = SourceMap::default().add("text", Vec::new());
        let mut reader = TokenReader::new(file, Arc::new(text.into()));
        let mut words = Vec::new();
        while let Some(token) = reader.next() {
            words.push((token.kind, reader.text(token).text));
        }
        words
    }

    #[test]
    fn words_strings_brackets_and_comments_are_told_apart() {
        let word = |word: &str| (PbrtTokenKind::Word, word.to_owned());
        let quoted = |word: &str| (PbrtTokenKind::Quoted, word.to_owned());
        let (open, close) = (
            (PbrtTokenKind::Open, "[".into()),
            (PbrtTokenKind::Close, "]".into()),
        );
        assert_eq!(
            words("Shape \"a b\"[-1 .5e3]# [ \"\n\"x\\\"y\""),
            [
                word("Shape"),
                quoted("a b"),
                open,
                word("-1"),
                word(".5e3"),
                close,
                quoted("x\"y")
            ]
        );
        assert_eq!(words("# only\r# comments"), []);
        assert_eq!(
            words("\"open\nA"),
            [(PbrtTokenKind::Unterminated, "open".into()), word("A")]
        );
    }

    #[test]
    fn every_cut_of_a_text_ends() {
        let text = "\"a\\\" [ 1 2 ] \\ \" # x";
        for end in 0..=text.len() {
            assert!(words(text.get(..end).unwrap()).len() < 20);
        }
    }
}
