//! The URIs of editors as paths, and back.

use super::uri::DocumentUri;
use percent_encoding::percent_decode_str;
use rtc_source::uri_path;
use std::path::{Path, PathBuf};

/// The path of a file; for an unsaved document its last component in the current folder.
pub(super) fn path(uri: &DocumentUri) -> PathBuf {
    let decoded = percent_decode_str(uri.path()).decode_utf8_lossy();
    if uri.scheme() == Some("file") {
        return PathBuf::from(without_drive_slash(&decoded));
    }
    let name = decoded.rsplit('/').next().unwrap_or_default();
    PathBuf::from(name)
}

/// `/C:/x` is how URIs spell `C:/x`.
fn without_drive_slash(path: &str) -> &str {
    let mut letters = path.chars();
    let is_drive = letters.next() == Some('/')
        && letters
            .next()
            .is_some_and(|letter| letter.is_ascii_alphabetic())
        && letters.next() == Some(':');
    match is_drive {
        true => path.strip_prefix('/').unwrap_or(path),
        false => path,
    }
}

/// The URI of a file.
pub(super) fn uri(path: &Path) -> Option<DocumentUri> {
    let path = std::path::absolute(path).ok()?;
    let path = path.to_string_lossy().replace('\\', "/");
    let slash = if path.starts_with('/') { "" } else { "/" };
    format!("file://{slash}{}", uri_path(&path)).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_go_to_uris_and_back() {
        let path_of = |text: &str| path(&text.parse().unwrap());
        assert_eq!(
            path_of("file:///a%20b/%C3%A9.yaml"),
            Path::new("/a b/é.yaml")
        );
        assert_eq!(path_of("file:///c%3A/x.yaml"), Path::new("c:/x.yaml"));
        assert_eq!(path_of("untitled:Untitled-1"), Path::new("Untitled-1"));
        #[cfg(unix)]
        for text in ["/a b/é#?.yaml", "/x/y.gltf"] {
            assert_eq!(path(&uri(Path::new(text)).unwrap()), Path::new(text));
        }
    }
}
