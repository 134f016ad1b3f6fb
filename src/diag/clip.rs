//! The user's words within a message: short, and without what would command a terminal.

use std::borrow::Cow;

/// A word, or its beginning if it would fill the message.
#[must_use]
pub fn clip(word: &str) -> Cow<'_, str> {
    clipped(word, 40)
}

/// A path, or its beginning.
#[must_use]
pub fn clip_path(path: &str) -> Cow<'_, str> {
    clipped(path, 160)
}

/// What a library says, which may repeat a value, or the beginning of it.
#[must_use]
pub fn clip_words(words: &str) -> Cow<'_, str> {
    clipped(words, 400)
}

/// At most `shown` characters, and `…` if there are more.
fn clipped(text: &str, shown: usize) -> Cow<'_, str> {
    match text.char_indices().nth(shown) {
        Some((end, _)) => Cow::Owned(format!("{}…", visible(text.split_at(end).0))),
        None => visible(text),
    }
}

fn visible(text: &str) -> Cow<'_, str> {
    let visible = |c: char| {
        if c.is_control() {
            c.escape_default().to_string()
        } else {
            c.to_string()
        }
    };
    if text.contains(char::is_control) {
        Cow::Owned(text.chars().map(visible).collect())
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_clipped_between_characters() {
        assert_eq!(clip("a\u{1b}é"), "a\\u{1b}é");
        assert_eq!(clip(&"é".repeat(41)), format!("{}…", "é".repeat(40)));
        assert_eq!(clip(&"é".repeat(40)), "é".repeat(40));
    }
}
