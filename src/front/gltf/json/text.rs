//! Texts of JSON: where one ends, and what it says with its escapes resolved.

use std::borrow::Cow;

/// The end of the text that starts with the quote at `start`, past its closing quote.
///
/// # Errors
/// Where the first byte is that can't be, with what is wrong.
pub(super) fn end(text: &[u8], start: usize) -> Result<usize, (usize, &'static str)> {
    let mut at = start + 1;
    loop {
        match text.get(at) {
            None => return Err((at, "a text is never closed")),
            Some(b'"') => return Ok(at + 1),
            Some(b'\\') => at = escape(text, at)?,
            Some(0..0x20) => return Err((at, "a control character stands in a text")),
            Some(_) => at += 1,
        }
    }
}

fn escape(text: &[u8], at: usize) -> Result<usize, (usize, &'static str)> {
    match text.get(at + 1) {
        Some(b'"' | b'\\' | b'/' | b'b' | b'f' | b'n' | b'r' | b't') => Ok(at + 2),
        Some(b'u') if text.get(at + 2..at + 6).is_some_and(|hex| hex.iter().all(u8::is_ascii_hexdigit)) => Ok(at + 6),
        Some(_) => Err((at, "an escape means nothing")),
        None => Err((text.len(), "a text is never closed")),
    }
}

/// What a text says; `written` has its quotes and is sound.
pub(super) fn value(written: &str) -> Cow<'_, str> {
    let inside = &written[1..written.len() - 1];
    if !inside.contains('\\') {
        return Cow::Borrowed(inside);
    }
    let mut said = String::with_capacity(inside.len());
    let mut rest = inside;
    while let Some(at) = rest.find('\\') {
        said.push_str(&rest[..at]);
        let (character, length) = unescape(&rest[at..]);
        said.push(character);
        rest = &rest[at + length..];
    }
    Cow::Owned(said + rest)
}

/// The character that `escape` starts with, and its length; half of a surrogate pair is the replacement character.
fn unescape(escape: &str) -> (char, usize) {
    let unit = |from: usize| escape.get(from..from + 4).and_then(|hex| u16::from_str_radix(hex, 16).ok());
    let second = || if escape.get(6..8) == Some("\\u") { unit(8) } else { None };
    match escape.as_bytes()[1] {
        b'u' => match (unit(2), second()) {
            (Some(high @ 0xd800..0xdc00), Some(low @ 0xdc00..0xe000)) => {
                let character = char::decode_utf16([high, low]).next().and_then(Result::ok);
                (character.unwrap_or(char::REPLACEMENT_CHARACTER), 12)
            }
            (Some(unit), _) => (char::from_u32(u32::from(unit)).unwrap_or(char::REPLACEMENT_CHARACTER), 6),
            (None, _) => unreachable!("`end` has seen four hexadecimal digits"),
        },
        b'b' => ('\u{8}', 2),
        b'f' => ('\u{c}', 2),
        b'n' => ('\n', 2),
        b'r' => ('\r', 2),
        b't' => ('\t', 2),
        other => (char::from(other), 2),
    }
}
