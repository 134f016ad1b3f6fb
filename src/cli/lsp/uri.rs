//! URIs as editors write them (RFC 3986), by their parts.

use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A URI, or a reference to one, as it was written; two are the same if they are written the same.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String")]
pub(super) struct DocumentUri(String);

/// The parts before the path, the path, and the parts after it.
struct UriParts<'t> {
    scheme: Option<&'t str>,
    authority: &'t str,
    path: &'t str,
    query: &'t str,
    fragment: &'t str,
}

impl DocumentUri {
    /// As it was written.
    pub(super) fn as_str(&self) -> &str {
        &self.0
    }

    /// The scheme: the text before the first colon, if the URI is absolute.
    pub(super) fn scheme(&self) -> Option<&str> {
        UriParts::of(&self.0).scheme
    }

    /// The path, with its escapes.
    pub(super) fn path(&self) -> &str {
        UriParts::of(&self.0).path
    }
}

impl TryFrom<String> for DocumentUri {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        match UriParts::of(&text).are_sound() {
            true => Ok(Self(text)),
            false => Err(format!("`{text}` is no URI")),
        }
    }
}

impl FromStr for DocumentUri {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.to_owned().try_into()
    }
}

impl<'t> UriParts<'t> {
    /// The parts of any text (RFC 3986, appendix B).
    fn of(text: &'t str) -> Self {
        let (text, fragment) = text.split_once('#').unwrap_or((text, ""));
        let (text, query) = text.split_once('?').unwrap_or((text, ""));
        let (scheme, rest) = match text.split_once(':') {
            Some((scheme, rest)) if !scheme.contains('/') => (Some(scheme), rest),
            Some(_) | None => (None, text),
        };
        let (authority, path) = match rest.strip_prefix("//") {
            Some(own) => own.split_at(own.find('/').unwrap_or(own.len())),
            None => ("", rest),
        };
        Self {
            scheme,
            authority,
            path,
            query,
            fragment,
        }
    }

    /// Whether each part has only allowed characters; host names are not checked.
    fn are_sound(&self) -> bool {
        self.scheme.is_none_or(is_scheme)
            && is_escaped(self.authority, b"[]")
            && is_escaped(self.path, b"/")
            && is_escaped(self.query, b"/?")
            && is_escaped(self.fragment, b"/?")
    }
}

fn is_scheme(text: &str) -> bool {
    let is_of_scheme = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    text.starts_with(|first: char| first.is_ascii_alphabetic()) && text.bytes().all(is_of_scheme)
}

/// Whether a text has only characters allowed in every part, the given extra bytes, and complete
/// escapes.
fn is_escaped(text: &str, more: &[u8]) -> bool {
    let is_plain = |byte: u8| {
        byte.is_ascii_alphanumeric() || b"-._~!$&'()*+,;=:@".contains(&byte) || more.contains(&byte)
    };
    let mut pieces = text.split('%');
    let first = pieces.next().unwrap_or_default();
    let is_behind_escape = |piece: &str| match piece.as_bytes() {
        [high, low, rest @ ..] => {
            let is_escape = high.is_ascii_hexdigit() && low.is_ascii_hexdigit();
            is_escape && rest.iter().copied().all(is_plain)
        }
        _ => false,
    };
    first.bytes().all(is_plain) && pieces.all(is_behind_escape)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_told_apart() {
        for (text, scheme, path) in [
            ("file:///a%20b/c.yaml", Some("file"), "/a%20b/c.yaml"),
            ("file://host:1/a?b/c#d:e", Some("file"), "/a"),
            ("untitled:Untitled-1", Some("untitled"), "Untitled-1"),
            ("vscode-vfs://[::1]", Some("vscode-vfs"), ""),
            ("//host/a", None, "/a"),
            ("a/b:c", None, "a/b:c"),
            ("?a:b", None, ""),
            ("", None, ""),
        ] {
            let uri: DocumentUri = text.parse().unwrap();
            assert_eq!((uri.scheme(), uri.path()), (scheme, path), "{text}");
        }
    }

    #[test]
    fn what_is_no_uri_is_not_taken() {
        for text in [
            "file:///a b",
            "file:///é",
            "file:///%4",
            "file:///%zz",
            "file:///a[b]",
            "a#b#c",
            ":a",
            "1a:b",
            "a@b:c",
            "c:\\x",
            "file:///a?%",
        ] {
            assert!(text.parse::<DocumentUri>().is_err(), "{text}");
        }
    }
}
