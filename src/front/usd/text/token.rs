//! The tokens and values of a text, and its mistakes.

use super::super::layer::Value;
use super::{MAX_BRACKETS, MAX_MISTAKES, NUMBER, PRIM, STEP, TextReader, WORD};
use crate::exchange::SpannedText;
use rtc_diag::clip;
use rtc_source::{Resource, Span};

pub(super) fn is_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b':' | b'.' | b'!' | b'-' | b'+' | 128..)
}

/// The type of an attribute, of which values are one or a list.
#[derive(Clone, Copy)]
pub(super) struct ValueType<'a> {
    name: &'a str,
    pub(super) is_array: bool,
    item: ItemType,
}

#[derive(Clone, Copy)]
enum ItemType {
    /// So many numbers.
    Numbers(usize),
    Text,
    /// A type without a name here.
    Any,
}

impl<'a> ValueType<'a> {
    /// The type of a name (`SdfValueTypeNames`), of single values.
    pub(super) fn of(name: &'a str) -> Self {
        /// Types of one number.
        const SINGLE: [&str; 10] = [
            "bool", "uchar", "int", "uint", "int64", "uint64", "half", "float", "double",
            "timecode",
        ];
        /// What stands before the count of numbers, and the letter of their precision.
        const VECTORS: [&str; 10] = [
            "int", "half", "float", "double", "point", "normal", "vector", "color", "texCoord",
            "quat",
        ];
        let stem = name.trim_end_matches(['h', 'f', 'd']);
        let (stem, count) = match stem.strip_suffix(['2', '3', '4']) {
            Some(before) => (before, usize::from(stem.as_bytes()[stem.len() - 1] - b'0')),
            None => (stem, 4),
        };
        let item = match name {
            "string" | "token" | "asset" | "pathExpression" => ItemType::Text,
            name if SINGLE.contains(&name) => ItemType::Numbers(1),
            _ if matches!(stem, "matrix" | "frame") => ItemType::Numbers(count * count),
            _ if VECTORS.contains(&stem) => ItemType::Numbers(count),
            _ => ItemType::Any,
        };
        Self {
            name,
            is_array: false,
            item,
        }
    }
}

impl<'a> TextReader<'a> {
    pub(super) fn span(&self, start: usize) -> Span {
        let at = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Span::new(self.file, at(start), at(self.at.max(start)))
    }

    /// Reports a mistake at the place that is read.
    pub(super) fn mistake<T>(&mut self, message: impl Into<String>) -> Option<T> {
        let start = self.at.min(self.bytes.len());
        self.mistake_at(start, message);
        None
    }

    /// Records a mistake at this place; what follows is read on from where the reader stands.
    pub(super) fn mistake_at(&mut self, start: usize, message: impl Into<String>) {
        let at = std::mem::replace(&mut self.at, (start + 1).min(self.bytes.len()));
        let span = self.span(start);
        self.at = at;
        self.mistakes.push((span, message.into()));
        if self.mistakes.len() >= MAX_MISTAKES {
            self.at = self.bytes.len();
        }
    }

    /// Charges memory in steps; the text ends where there is no more.
    pub(super) fn spend(&mut self, bytes: u64) {
        self.owed += bytes;
        if self.owed >= STEP {
            let charged = self.budget.charge(Resource::Memory, self.owed);
            let nodes = self.owed / PRIM;
            let charged = charged.and_then(|()| self.budget.charge(Resource::Nodes, nodes));
            self.owed = 0;
            if let Err(exceeded) = charged {
                self.exceeded = Some(exceeded);
                self.at = self.bytes.len();
            }
        }
    }

    /// What is not read so far; empty past the end, where a mistake too many leaves the reader.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// The next byte that is no white space and no comment.
    pub(super) fn peek(&mut self) -> Option<u8> {
        loop {
            let rest = self.rest();
            let byte = *rest.first()?;
            if byte.is_ascii_whitespace() || matches!(byte, b';' | 0xef | 0xbb | 0xbf) {
                self.at += 1;
            } else if byte == b'#' || rest.starts_with(b"//") {
                self.skip_line();
            } else if rest.starts_with(b"/*") {
                let end = memchr::memmem::find(rest, b"*/").map_or(rest.len(), |end| end + 2);
                self.at += end;
            } else {
                return Some(byte);
            }
        }
    }

    pub(super) fn skip_line(&mut self) {
        let rest = self.rest();
        self.at += memchr::memchr2(b'\n', b'\r', rest).map_or(rest.len(), |end| end + 1);
    }

    pub(super) fn eat(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    pub(super) fn expect(&mut self, byte: u8) -> Option<()> {
        if self.eat(byte) {
            return Some(());
        }
        self.mistake(format!("a `{}` is expected here", char::from(byte)))
    }

    /// A name, a keyword or a number; empty if there is none.
    pub(super) fn word(&mut self) -> &'a str {
        self.word_of(is_name)
    }

    /// A word of some bytes; empty if there is none.
    pub(super) fn word_of(&mut self, is_part: impl Fn(u8) -> bool) -> &'a str {
        self.peek();
        let rest = self.rest();
        let length = rest.iter().position(|byte| !is_part(*byte));
        let length = length.unwrap_or(rest.len());
        self.at += length;
        std::str::from_utf8(&rest[..length]).unwrap_or("")
    }

    pub(super) fn string(&mut self) -> Option<String> {
        // One or three quotes delimit the string.
        let quote = self.peek().filter(|byte| matches!(byte, b'"' | b'\''));
        let Some(quote) = quote else {
            return self.mistake("a string is expected here");
        };
        let start = self.at;
        let is_long = self.rest().starts_with(&[quote; 3]);
        let mark = if is_long { 3 } else { 1 };
        // Read to the same delimiter, with escapes.
        let mut bytes = Vec::new();
        self.at += mark;
        loop {
            let rest = self.rest();
            match rest.first() {
                Some(b'\\') => {
                    bytes.push(match rest.get(1) {
                        Some(b'n') => b'\n',
                        Some(b't') => b'\t',
                        Some(other) => *other,
                        None => b'\\',
                    });
                    self.at += 2;
                }
                Some(byte) if *byte == quote && (!is_long || rest.starts_with(&[quote; 3])) => {
                    self.at += mark;
                    self.spend(WORD + bytes.len() as u64);
                    return Some(String::from_utf8_lossy(&bytes).into_owned());
                }
                Some(byte) if is_long || !matches!(byte, b'\n' | b'\r') => {
                    bytes.push(*byte);
                    self.at += 1;
                }
                _ => {
                    self.at = start;
                    self.mistake::<()>("the string has no closing quote");
                    self.at = if is_long {
                        self.bytes.len()
                    } else {
                        self.at + 1
                    };
                    return None;
                }
            }
        }
    }

    /// What stands between two marks, as `@file@` and `<path>`.
    pub(super) fn between(&mut self, open: u8, close: u8) -> Option<SpannedText> {
        self.expect(open)?;
        let mut start = self.at;
        let is_long = open == b'@' && self.rest().starts_with(b"@@");
        let mark: &[u8] = if is_long { b"@@@" } else { &[close] };
        start += if is_long { 2 } else { 0 };
        let rest = self.bytes.get(start..)?;
        let end = memchr::memmem::find(rest, mark);
        let end = end.filter(|end| is_long || !rest[..*end].contains(&b'\n'));
        let Some(end) = end else {
            self.mistake_at(
                start - mark.len(),
                format!(
                    "`{}` has no closing `{}`",
                    char::from(open),
                    char::from(close)
                ),
            );
            return None;
        };
        let text = String::from_utf8_lossy(&rest[..end]).into_owned();
        self.at = start + end;
        let span = self.span(start);
        self.at += mark.len();
        self.spend(WORD + text.len() as u64);
        Some(SpannedText { text, span })
    }

    /// A path, absolute within the layer, without selections of variants.
    pub(super) fn path(&mut self) -> Option<SpannedText> {
        let SpannedText { text, span } = self.between(b'<', b'>')?;
        let mut plain = String::new();
        let mut depth = 0_u32;
        for character in text.chars() {
            match character {
                '{' => depth += 1,
                '}' => depth = depth.saturating_sub(1),
                _ if depth == 0 => plain.push(character),
                _ => {}
            }
        }
        if plain.starts_with('/') || plain.is_empty() {
            return Some(SpannedText { text: plain, span });
        }
        let mut names: Vec<&str> = self.paths.iter().map(String::as_str).collect();
        let mut rest = plain.as_str();
        while let Some(after) = rest.strip_prefix("..") {
            names.pop();
            rest = after.strip_prefix('/').unwrap_or(after);
        }
        let is_joined = !(rest.is_empty() || rest.starts_with('.'));
        let joint = if is_joined { "/" } else { "" };
        let mut parts: Vec<&str> = names.into_iter().flat_map(|name| ["/", name]).collect();
        parts.extend([joint, rest.strip_prefix("./").unwrap_or(rest)]);
        let text = parts.concat();
        // A short relative path may stand in prims of long names.
        self.spend(2 * text.len() as u64);
        Some(SpannedText { text, span })
    }

    /// Items in brackets, one alone, or `None`.
    pub(super) fn list<T>(
        &mut self,
        mut item: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Vec<T>> {
        let mut items = Vec::new();
        match self.peek() {
            Some(b'[') => {
                self.at += 1;
                while !self.eat(b']') {
                    items.push(item(self)?);
                    if !self.eat(b',') {
                        self.expect(b']')?;
                        break;
                    }
                }
            }
            Some(b'N') => drop(self.word()),
            _ => items.push(item(self)?),
        }
        Some(items)
    }

    /// A number, `true` as 1, or a word as text.
    pub(super) fn atom(&mut self, numbers: &mut Vec<f64>, texts: &mut Vec<String>) -> Option<()> {
        match self.peek() {
            Some(b'"' | b'\'') => texts.push(self.string()?),
            Some(b'@') => texts.push(self.between(b'@', b'@')?.text),
            Some(b'<') => texts.push(self.path()?.text),
            _ => {
                let start = self.at;
                let word = self.word();
                match word {
                    "" => return self.mistake("a value is expected here"),
                    "true" | "True" | "yes" => numbers.push(1.0),
                    "false" | "False" | "no" => numbers.push(0.0),
                    // `None` in a list, as in a list of targets.
                    "None" => {}
                    _ => match word.parse::<f64>() {
                        Ok(number) => {
                            numbers.push(number);
                            self.spend(NUMBER);
                        }
                        Err(_) if word.starts_with(|c: char| c.is_ascii_digit()) => {
                            self.at = start;
                            let message = format!("`{}` is no number", clip(word));
                            return self.mistake(message);
                        }
                        Err(_) => {
                            self.spend(WORD);
                            texts.push(word.to_owned());
                        }
                    },
                }
            }
        }
        Some(())
    }

    /// A value; lists and tuples of any depth become one list.
    pub(super) fn value(&mut self) -> Option<Value> {
        let (mut numbers, mut texts) = (Vec::new(), Vec::new());
        let mut depth = 0;
        // Dictionaries and `None` have no value here.
        if self.peek() == Some(b'{') {
            self.skip_value()?;
            return Some(Value::Blocked);
        }
        if self.rest().starts_with(b"None") {
            self.word();
            return Some(Value::Blocked);
        }
        // Read numbers and texts through nested brackets.
        loop {
            match self.peek() {
                Some(b'[' | b'(') if depth < MAX_BRACKETS => {
                    self.at += 1;
                    depth += 1;
                }
                Some(b']' | b')') if depth > 0 => {
                    self.at += 1;
                    depth -= 1;
                    if depth > 0 {
                        self.eat(b',');
                    }
                }
                Some(b'[' | b'(') => {
                    return self
                        .mistake(format!("brackets are nested more than {MAX_BRACKETS} deep"));
                }
                _ => {
                    self.atom(&mut numbers, &mut texts)?;
                    if depth > 0 && !self.eat(b',') && !matches!(self.peek(), Some(b']' | b')')) {
                        return self.mistake("a `,` or the end of the list is expected here");
                    }
                }
            }
            if depth == 0 {
                break;
            }
        }
        Some(match texts.is_empty() {
            true => Value::Numbers(numbers),
            false => Value::Texts(texts),
        })
    }

    /// The value of an attribute of a type. As in OpenUSD, one of another type is a mistake.
    pub(super) fn value_of(&mut self, kind: ValueType<'_>) -> Option<Value> {
        self.peek();
        let start = self.at;
        let is_list = self.rest().starts_with(b"[");
        let mut value = self.value()?;
        // Flags may be in quotes.
        if let (Value::Texts(texts), "bool") = (&value, kind.name)
            && let [text] = texts.as_slice()
            && matches!(text.as_str(), "true" | "yes" | "false" | "no")
        {
            let is_set = matches!(text.as_str(), "true" | "yes");
            value = Value::Numbers(vec![f64::from(u8::from(is_set))]);
        }
        let fits = match (&value, kind.item) {
            (Value::Blocked, _) | (_, ItemType::Any) => true,
            _ if kind.is_array != is_list => false,
            (Value::Numbers(numbers), ItemType::Numbers(width)) => {
                numbers.len() % width == 0 && (is_list || numbers.len() == width)
            }
            (Value::Texts(texts), ItemType::Text) => is_list || texts.len() == 1,
            // A list without items could be one of numbers.
            (Value::Numbers(numbers), ItemType::Text) => numbers.is_empty(),
            (Value::Texts(_), ItemType::Numbers(_)) => false,
        };
        if !fits {
            let brackets = if kind.is_array { "[]" } else { "" };
            let message = format!(
                "a value of the type `{}{brackets}` is expected here",
                kind.name
            );
            self.mistake_at(start, message);
        }
        Some(value)
    }

    /// Skips a value of any kind.
    pub(super) fn skip_value(&mut self) -> Option<()> {
        let (start, mut depth) = (self.at, 0_usize);
        loop {
            match self.peek() {
                None => {
                    self.mistake_at(start, "a bracket of the value is never closed");
                    return None;
                }
                Some(b'{' | b'[' | b'(') => {
                    self.at += 1;
                    depth += 1;
                }
                Some(b'}' | b']' | b')') => {
                    self.at += 1;
                    depth = depth.saturating_sub(1);
                }
                Some(b'"' | b'\'') => drop(self.string()?),
                Some(b'@') => drop(self.between(b'@', b'@')?),
                Some(b'<') => drop(self.between(b'<', b'>')?),
                Some(byte) if is_name(byte) => drop(self.word()),
                Some(_) => self.at += 1,
            }
            if depth == 0 {
                return Some(());
            }
        }
    }
}
