//! Escapes characters of the input that could send commands to a terminal or change the direction
//! of a line.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Whether a character is a control character or changes the direction of text.
pub(crate) fn is_unsafe(c: char) -> bool {
    let is_bidi = matches!(c, '\u{200e}' | '\u{200f}' | '\u{061c}')
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || is_bidi || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}')
}

/// The text on one line, as a name is printed: characters that command a terminal or change the
/// direction of a line are escaped, as in `\u{1b}`.
#[must_use]
pub fn clean(text: &str) -> Cow<'_, str> {
    clean_except(text, &[])
}

/// The same for a text of lines, which may have tabs.
#[must_use]
pub fn clean_lines(text: &str) -> Cow<'_, str> {
    clean_except(text, &['\n', '\t'])
}

/// The text with every unsafe character escaped except those in `kept`.
pub(super) fn clean_except<'a>(text: &'a str, kept: &[char]) -> Cow<'a, str> {
    if !text.contains(|c| is_unsafe(c) && !kept.contains(&c)) {
        return Cow::Borrowed(text);
    }
    let mut cleaned = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_unsafe(c) && !kept.contains(&c) {
            cleaned.extend(c.escape_unicode());
        } else {
            cleaned.push(c);
        }
    }
    Cow::Owned(cleaned)
}

/// A visible character of the same width instead of `c`, so that columns stay; tabs stay tabs.
pub(super) fn picture(c: char) -> char {
    match c {
        '\t' => '\t',
        '\0'..='\u{1f}' => {
            char::from_u32(0x2400 + u32::from(c)).unwrap_or(char::REPLACEMENT_CHARACTER)
        }
        '\u{7f}' => '␡',
        _ if is_unsafe(c) => char::REPLACEMENT_CHARACTER,
        _ => c,
    }
}

/// JSON with a `\u` escape for every unsafe character except line ends; such characters occur only
/// in strings.
#[must_use]
pub fn clean_json(json: &str) -> String {
    let mut cleaned = String::with_capacity(json.len());
    for c in json.chars() {
        if is_unsafe(c) && c != '\n' {
            // All unsafe characters are in the basic multilingual plane: one UTF-16 unit.
            let _ = write!(cleaned, "\\u{:04x}", u32::from(c));
        } else {
            cleaned.push(c);
        }
    }
    cleaned
}

/// `1 error`, `2 errors`.
#[must_use]
pub fn plural(count: usize, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_spelled_out() {
        assert_eq!(
            clean("a\u{1b}[2Jb\u{9b}c\nd\u{202e}ü"),
            "a\\u{1b}[2Jb\\u{9b}c\\u{a}d\\u{202e}ü"
        );
        assert_eq!(clean_except("a\tb\u{7}", &['\t']), "a\tb\\u{7}");
        assert_eq!(
            "a\t\u{1b}\u{9b}".chars().map(picture).collect::<String>(),
            "a\t␛\u{fffd}"
        );
        assert_eq!(clean_json("\"\u{9b}ü\u{7f}\"\n"), "\"\\u009bü\\u007f\"\n");
    }
}
