//! Formats YAML text: normalises indentation, spaces and empty lines; keeps scalars, their order
//! and comments.
//!
//! The result is parsed again: it must be equal to the input in content and in all characters
//! except white space, or formatting fails.

#[cfg(test)]
mod tests;
mod tokens;
mod write;

use super::{YamlError, parse};
use crate::FileId;

/// Why a text is not formatted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormatTextFault {
    /// It is not valid YAML; the mistakes were reported.
    Mistakes,
    /// The result would differ.
    Differs,
}

/// Formats a text: two spaces per level, the dashes of a list in the column of its key, one space
/// after `:`, `,` and `-`, none inside brackets, at most one empty line in a row. Line breaks stay.
///
/// # Errors
/// If the text is not valid YAML, or the result would differ from it.
pub fn layout(
    file: FileId,
    bytes: &[u8],
    report: &mut dyn FnMut(YamlError<'_>),
) -> Result<String, FormatTextFault> {
    let tree = parse(file, bytes, report).ok_or(FormatTextFault::Mistakes)?;
    let source = tree.source.replace("\r\n", "\n").replace('\r', "\n");
    let text = fixed_point(&source).ok_or(FormatTextFault::Differs)?;
    let again = parse(file, text.as_bytes(), &mut |_| ()).ok_or(FormatTextFault::Differs)?;
    let is_same =
        tree.is_equivalent(&again) && visible_characters(&source).eq(visible_characters(&text));
    is_same.then_some(text).ok_or(FormatTextFault::Differs)
}

/// The maximum number of passes; one suffices in practice.
const PASSES: usize = 4;

/// Formats until nothing changes; `None` if that takes too many passes.
fn fixed_point(source: &str) -> Option<String> {
    let mut text = source.to_owned();
    for _ in 0..PASSES {
        let next = write::write(&text, &tokens::items(&text)?);
        if next == text {
            return Some(text);
        }
        text = next;
    }
    None
}

/// All characters except white space.
fn visible_characters(text: &str) -> impl Iterator<Item = char> {
    text.chars().filter(|c| !matches!(c, ' ' | '\t' | '\n'))
}
