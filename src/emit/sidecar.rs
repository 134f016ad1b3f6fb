//! Names of sidecar files.
//!
//! A name contains the hash of the content: no file overwrites a different one, and equal files
//! have one name.

/// The maximum length in bytes of the readable part of a name.
const MAX_NAME: usize = 40;

/// The path of a sidecar file in a folder: the name of its source, or `fallback` if that has none,
/// the hash of its content, and the extension.
pub(super) fn path(
    folder: &str,
    source_name: &str,
    fallback: &str,
    hash: u64,
    extension: &str,
) -> String {
    let stem = sanitized_stem(source_name);
    let stem = if stem.is_empty() { fallback } else { &stem };
    format!("{folder}/{stem}-{hash:016x}.{extension}")
}

/// The last component of a path, without extension and special characters.
fn sanitized_stem(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = last.rsplit_once('.').map_or(last, |(stem, _)| stem);
    let allowed = |letter: &char| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_');
    stem.chars().filter(allowed).take(MAX_NAME).collect()
}
