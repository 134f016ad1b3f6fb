//! What new files beside a text are called.
//!
//! The name of a new file holds the hash of its content: no file is ever written over by another, and
//! what is the same is one file.

/// The longest part of a name that says what a file is of, in bytes.
const MAX_NAME: usize = 40;

/// The path of a new file in a folder: what it is of, or `word` where that has no name, the hash of
/// its content, and the extension.
pub(super) fn path(folder: &str, of: &str, word: &str, hash: u64, extension: &str) -> String {
    let stem = plain(of);
    let stem = if stem.is_empty() { word } else { &stem };
    format!("{folder}/{stem}-{hash:016x}.{extension}")
}

/// The end of a path, without an extension and without characters that mean something to a system.
fn plain(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
    let allowed = |letter: &char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_');
    stem.chars().filter(allowed).take(MAX_NAME).collect()
}
