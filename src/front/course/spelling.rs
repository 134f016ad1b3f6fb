//! Helpers for messages: lists of names, and the comparison of spellings.

/// Names in backticks, joined by commas and `and`.
pub(super) fn quoted_list<'w>(names: impl IntoIterator<Item = &'w str>) -> String {
    let quoted: Vec<_> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Whether two strings have the same letters and digits, ignoring case and all other characters.
pub(super) fn same_letters(written: &str, suggestion: &str) -> bool {
    let letters = |text: &str| -> Vec<char> {
        let letters = text.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    letters(written) == letters(suggestion)
}
