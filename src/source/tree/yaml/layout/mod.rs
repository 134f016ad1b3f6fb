//! The layout of a YAML text: indentation, blanks and empty lines as the house writes them; words,
//! their order and comments as they are.
//!
//! What comes out is read again: it says the same, and all but blanks is the same, or there is none.

mod pieces;
#[cfg(test)]
mod tests;
mod write;

use super::{Mistake, parse};
use crate::FileId;

/// Why a text is left as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutFault {
    /// It is no YAML; the mistakes were told.
    Mistakes,
    /// It would say something else.
    Differs,
}

/// The text with the layout of the house: two spaces a level, the dashes of a list below the key that
/// has it, one space after `:`, `,` and `-`, none inside brackets, at most one empty line. Where a line
/// ends stays as it is.
///
/// # Errors
/// If it is no YAML, or holds what no layout of ours says so.
pub fn layout(
    file: FileId,
    bytes: &[u8],
    tell: &mut dyn FnMut(Mistake<'_>),
) -> Result<String, LayoutFault> {
    let tree = parse(file, bytes, tell).ok_or(LayoutFault::Mistakes)?;
    let source = tree.source.replace("\r\n", "\n").replace('\r', "\n");
    let text = settled(&source).ok_or(LayoutFault::Differs)?;
    let again = parse(file, text.as_bytes(), &mut |_| ()).ok_or(LayoutFault::Differs)?;
    let is_same = tree.says_the_same(&again) && words(&source).eq(words(&text));
    is_same.then_some(text).ok_or(LayoutFault::Differs)
}

/// How often a text is laid out at most; once is enough for all that people write.
const PASSES: usize = 4;

/// The layout that is its own layout; `None` if there is none near.
fn settled(source: &str) -> Option<String> {
    let mut text = source.to_owned();
    for _ in 0..PASSES {
        let next = write::write(&text, &pieces::items(&text)?);
        if next == text {
            return Some(text);
        }
        text = next;
    }
    None
}

/// All that is no blank.
fn words(text: &str) -> impl Iterator<Item = char> {
    text.chars().filter(|c| !matches!(c, ' ' | '\t' | '\n'))
}
