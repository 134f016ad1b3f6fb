//! Quotes of the input in a message: short, and without control characters.

use super::print::is_unsafe;
use std::borrow::Cow;

/// A key or value, cut to 40 characters.
#[must_use]
pub fn clip(word: &str) -> Cow<'_, str> {
    clipped(word, 40)
}

/// A path, cut to 160 characters.
#[must_use]
pub fn clip_path(path: &str) -> Cow<'_, str> {
    clipped(path, 160)
}

/// The message of a library, which may quote a value, cut to 400 characters.
#[must_use]
pub fn clip_words(words: &str) -> Cow<'_, str> {
    clipped(words, 400)
}

/// At most `limit` characters, and `…` if there are more.
fn clipped(text: &str, limit: usize) -> Cow<'_, str> {
    match text.char_indices().nth(limit) {
        Some((end, _)) => Cow::Owned(format!("{}…", visible(text.split_at(end).0))),
        None => visible(text),
    }
}

/// The text without characters that command a terminal or turn a line round.
fn visible(text: &str) -> Cow<'_, str> {
    let visible = |c: char| match is_unsafe(c) {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    match text.contains(is_unsafe) {
        true => Cow::Owned(text.chars().map(visible).collect()),
        false => Cow::Borrowed(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_clipped_between_characters() {
        assert_eq!(clip("a\u{1b}é\u{202e}"), "a\\u{1b}é\\u{202e}");
        assert_eq!(clip(&"é".repeat(41)), format!("{}…", "é".repeat(40)));
        assert_eq!(clip(&"é".repeat(40)), "é".repeat(40));
    }
}
