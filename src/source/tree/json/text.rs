//! JSON strings: finds their end and resolves their escapes.

/// The end of the string that starts with the quote at `start`, after its closing quote, and
/// whether it has escapes.
///
/// # Errors
/// The offset of the first invalid byte, with a message.
pub(super) fn end(text: &[u8], start: usize) -> Result<(usize, bool), (usize, &'static str)> {
    let (mut at, mut has_escapes) = (start + 1, false);
    loop {
        match text.get(at) {
            None => return Err((at, "a text is never closed")),
            Some(b'"') => return Ok((at + 1, has_escapes)),
            Some(b'\\') => (at, has_escapes) = (escape(text, at)?, true),
            Some(0..0x20) => return Err((at, "a string contains a control character")),
            Some(_) => at += 1,
        }
    }
}

fn escape(text: &[u8], at: usize) -> Result<usize, (usize, &'static str)> {
    match text.get(at + 1) {
        Some(b'"' | b'\\' | b'/' | b'b' | b'f' | b'n' | b'r' | b't') => Ok(at + 2),
        Some(b'u')
            if text
                .get(at + 2..at + 6)
                .is_some_and(|hex| hex.iter().all(u8::is_ascii_hexdigit)) =>
        {
            Ok(at + 6)
        }
        Some(_) => Err((at, "an escape is invalid")),
        None => Err((text.len(), "a text is never closed")),
    }
}

/// Appends the value of a valid string; `inside` is the text between its quotes.
pub(super) fn resolve(inside: &str, value: &mut String) {
    value.reserve(inside.len());
    let mut rest = inside;
    while let Some((before, escape)) = rest.split_once('\\') {
        value.push_str(before);
        let (character, after) = unescape(escape);
        value.push(character);
        rest = after;
    }
    value.push_str(rest);
}

/// The character of an escape and the text after it; `escape` starts after the backslash.
fn unescape(escape: &str) -> (char, &str) {
    let mut rest = escape.chars();
    let letter = rest
        .next()
        .expect("`end` has seen a letter after each backslash");
    let rest = rest.as_str();
    match letter {
        'u' => unicode(rest),
        'b' => ('\u{8}', rest),
        'f' => ('\u{c}', rest),
        'n' => ('\n', rest),
        'r' => ('\r', rest),
        't' => ('\t', rest),
        other => (other, rest),
    }
}

/// The character of the escape `\u`; half of a surrogate pair becomes the replacement character.
fn unicode(digits: &str) -> (char, &str) {
    let unit = |text| {
        let (hex, rest) = str::split_at_checked(text, 4)?;
        Some((u16::from_str_radix(hex, 16).ok()?, rest))
    };
    let (first, rest) = unit(digits).expect("`end` has seen four hexadecimal digits");
    match (first, rest.strip_prefix("\\u").and_then(unit)) {
        (high @ 0xd800..0xdc00, Some((low @ 0xdc00..0xe000, rest))) => {
            let character = char::decode_utf16([high, low]).next().and_then(Result::ok);
            (character.unwrap_or(char::REPLACEMENT_CHARACTER), rest)
        }
        (unit, _) => (
            char::from_u32(u32::from(unit)).unwrap_or(char::REPLACEMENT_CHARACTER),
            rest,
        ),
    }
}
