//! Splits text files of meshes and profiles into lines of words with their spans: bytes in any
//! encoding, without comments, and with lines joined by `\`.

use rtc_source::{FileId, LimitExceeded, Span};
use std::ops::Range;

/// A word of a file: bytes without white space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) bytes: &'a [u8],
    /// Its offset in the file.
    start: usize,
}

/// The range of bytes of words in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WordSpan {
    start: usize,
    end: usize,
}

/// An error in such a file.
#[derive(Debug)]
pub struct WordError {
    at: WordSpan,
    /// The message.
    pub message: String,
    /// The label.
    pub label: String,
    /// What other readers do about it, and we with `--lenient`.
    pub repair: Option<&'static str>,
}

/// Why such a file could not be parsed.
#[derive(Debug)]
pub enum TextParseError {
    /// The errors in the order of the file, at least one.
    Faults(Vec<WordError>),
    /// The file exceeds the budget.
    Limit(LimitExceeded),
}

impl From<LimitExceeded> for TextParseError {
    fn from(fault: LimitExceeded) -> Self {
        Self::Limit(fault)
    }
}

impl WordSpan {
    /// The span in the source map.
    #[must_use]
    pub fn span(self, file: FileId) -> Span {
        let offset =
            |at: usize| u32::try_from(at).expect("the loader refuses files of 4 GiB and more");
        Span::new(file, offset(self.start), offset(self.end))
    }
}

impl WordError {
    /// An error in some bytes of a file.
    pub(super) fn new(
        bytes: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Self {
        let Range { start, end } = bytes;
        Self {
            at: WordSpan { start, end },
            message: message.into(),
            label: label.into(),
            repair: None,
        }
    }

    /// An error that `--lenient` repairs.
    pub(super) fn repaired(self, repair: &'static str) -> Self {
        Self {
            repair: Some(repair),
            ..self
        }
    }

    /// Its range in the file.
    #[must_use]
    pub fn span(&self, file: FileId) -> Span {
        self.at.span(file)
    }
}

impl<'a> Word<'a> {
    /// The empty word at the start of a file.
    pub(super) const START: Self = Self {
        bytes: &[],
        start: 0,
    };

    /// The parts between separators, including empty ones.
    pub(super) fn split(self, separator: u8) -> impl Iterator<Item = Word<'a>> {
        let mut start = self.start;
        self.bytes
            .split(move |byte| *byte == separator)
            .map(move |bytes| {
                let part = Word { bytes, start };
                start += bytes.len() + 1;
                part
            })
    }

    /// An error at this word.
    pub(super) fn fault(&self, message: impl Into<String>, label: impl Into<String>) -> WordError {
        WordError::new(self.range(), message, label)
    }

    /// Its range in the file.
    pub(super) fn place(&self) -> WordSpan {
        let Range { start, end } = self.range();
        WordSpan { start, end }
    }

    /// Its range of bytes in the file.
    pub(super) fn range(&self) -> Range<usize> {
        self.start..self.start + self.bytes.len()
    }

    /// The bytes from this word to `last` on the same line, as a name with spaces.
    pub(super) fn through(self, last: &Self, file: &'a [u8]) -> Self {
        let end = last.range().end;
        Self {
            bytes: &file[self.start..end],
            ..self
        }
    }

    /// The word, short enough for a message.
    pub(super) fn text(&self) -> String {
        const SHOWN: usize = 24;
        let text =
            String::from_utf8_lossy(&self.bytes[..self.bytes.len().min(4 * SHOWN)]).into_owned();
        let mut shown: String = text.chars().take(SHOWN).collect();
        if shown.len() < self.bytes.len() {
            shown.push('…');
        }
        shown.escape_debug().to_string()
    }

    /// The word as a finite number.
    pub(super) fn number(&self) -> Result<f64, WordError> {
        let number: Option<f64> = std::str::from_utf8(self.bytes)
            .ok()
            .and_then(|text| text.parse().ok());
        let fault =
            |what: &str| self.fault(format!("`{}` is {what}", self.text()), "expected a number");
        match number {
            Some(number) if number.is_finite() => Ok(number),
            Some(_) => Err(fault("not a finite number")),
            None => Err(fault("not a number")),
        }
    }

    /// The word as an integer.
    pub(super) fn integer(&self) -> Result<i64, WordError> {
        let integer = std::str::from_utf8(self.bytes)
            .ok()
            .and_then(|text| text.parse().ok());
        integer.ok_or_else(|| {
            self.fault(
                format!("`{}` is not a whole number", self.text()),
                "expected a whole number",
            )
        })
    }
}

/// The first `N` of `words` as numbers; `line` is where a missing one is reported.
pub(super) fn numbers<const N: usize>(
    line: &Word<'_>,
    words: &[Word<'_>],
) -> Result<[f64; N], WordError> {
    let mut values = [0.0; N];
    for (at, value) in values.iter_mut().enumerate() {
        let missing = || {
            line.fault(
                format!("{at} numbers where there should be {N}"),
                "on this line",
            )
        };
        *value = words.get(at).ok_or_else(missing)?.number()?;
    }
    Ok(values)
}

/// The lines of a file that have words.
#[derive(Clone)]
pub(super) struct WordLines<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> WordLines<'a> {
    pub(super) fn new(file: &'a [u8]) -> Self {
        let at = if file.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        };
        Self { file, at }
    }

    /// The lines from a byte on.
    pub(super) fn from(file: &'a [u8], at: usize) -> Self {
        Self { file, at }
    }

    /// Whether the file is at its end.
    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.file.len()
    }

    /// Reads the words of the next line that is not empty into `words`; returns false at the end of
    /// the file.
    pub(super) fn next(&mut self, words: &mut Vec<Word<'a>>) -> bool {
        words.clear();
        while self.at < self.file.len() {
            match self.file[self.at] {
                b'\n' | b'\r' if !words.is_empty() => return true,
                b'\\' if self.joins() => {
                    self.at += self.file[self.at..]
                        .iter()
                        .position(|byte| *byte == b'\n')
                        .map_or(1, |skip| skip + 1);
                }
                b'#' => self.skip_while(|byte| !matches!(byte, b'\n' | b'\r')),
                byte if byte.is_ascii_whitespace() || byte == 0x0b => self.at += 1,
                _ => words.push(self.word()),
            }
        }
        !words.is_empty()
    }

    /// Whether only white space is between the backslash here and the end of the line.
    fn joins(&self) -> bool {
        let mut rest = self.file[self.at + 1..]
            .iter()
            .skip_while(|byte| matches!(byte, b' ' | b'\t' | b'\r'));
        rest.next().is_none_or(|byte| *byte == b'\n')
    }

    fn skip_while(&mut self, should_continue: impl Fn(u8) -> bool) {
        let rest = &self.file[self.at..];
        self.at += rest
            .iter()
            .position(|byte| !should_continue(*byte))
            .unwrap_or(rest.len());
    }

    fn word(&mut self) -> Word<'a> {
        let start = self.at;
        self.at += 1;
        self.skip_while(|byte| !byte.is_ascii_whitespace() && byte != 0x0b && byte != b'\\');
        Word {
            bytes: &self.file[start..self.at],
            start,
        }
    }
}
