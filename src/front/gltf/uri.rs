//! URIs: data URIs, and paths in the folder of the asset. Other URIs are rejected.

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

/// Base64 with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// The meaning of a URI.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Uri {
    /// Bytes and their media type, which may be empty.
    Data {
        /// As `image/png`.
        media: String,
        /// The URI as written.
        bytes: Vec<u8>,
    },
    /// A relative path without `..`, escapes resolved.
    Path(String),
    /// A relative path that climbs by `..`, escapes resolved.
    Above(String),
}

/// The reason why a URI is invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UriError {
    /// It is invalid, for this reason.
    Malformed(&'static str),
    /// It leads out of the folder, in this way.
    Outside(&'static str),
    /// It is one that importers repair, and was reported.
    Reported,
}

/// Reads a URI.
///
/// # Errors
/// If it is invalid, or leaves the folder of the asset.
pub(super) fn parse(uri: &str) -> Result<Uri, UriError> {
    if let Some(rest) = strip_scheme(uri, "data") {
        return data(rest);
    }
    if let Some((scheme, _)) = uri
        .split_once(':')
        .filter(|(scheme, _)| !scheme.contains(['/', '?', '#']))
    {
        return Err(match scheme.as_bytes() {
            [first, rest @ ..]
                if first.is_ascii_alphabetic() && rest.iter().all(|byte| in_scheme(*byte)) =>
            {
                UriError::Outside("it is an address or names a drive, and is no relative path")
            }
            _ => UriError::Malformed("the text before the colon is not a scheme"),
        });
    }
    let path = unescape(uri.split(['?', '#']).next().unwrap_or_default())?;
    if path.starts_with(['/', '\\']) {
        return Err(UriError::Outside("it is an absolute path"));
    }
    if path.contains(['\\', ':', '\0']) {
        return Err(UriError::Outside(
            "it contains a backslash, a colon or a NUL",
        ));
    }
    if path.is_empty() {
        Err(UriError::Malformed("it is empty"))
    } else if path.split('/').any(|part| part == "..") {
        Ok(Uri::Above(path))
    } else {
        Ok(Uri::Path(path))
    }
}

/// The repair of an invalid URI by importers: the error, and the repair. A repaired path gets no
/// access that a valid one lacks.
pub(super) fn repair(uri: &str) -> Option<(Uri, &'static str, &'static str)> {
    if strip_scheme(uri, "data").is_some() {
        let joined: String = uri.split_ascii_whitespace().collect();
        let is_broken = joined.len() < uri.len();
        let data = parse(&joined).ok().filter(|_| is_broken)?;
        return Some((data, "has white space in its data", "it is ignored"));
    }
    let turned = uri.replace('\\', "/");
    let path = parse(&turned).ok().filter(|_| turned != uri)?;
    let is_path = matches!(path, Uri::Path(_));
    is_path.then_some((path, "has backslashes", "they are read as slashes"))
}

fn in_scheme(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || b"+-.".contains(&byte)
}

fn strip_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let (head, rest) = uri.split_at_checked(scheme.len())?;
    rest.strip_prefix(':')
        .filter(|_| head.eq_ignore_ascii_case(scheme))
}

/// A data URI without its scheme (RFC 2397).
fn data(rest: &str) -> Result<Uri, UriError> {
    let (head, body) = rest.split_once(',').ok_or(UriError::Malformed(
        "a data URI needs a comma before its data",
    ))?;
    // The head is a media type with parameters.
    let mut parameters = head.split(';');
    let media = parameters
        .next()
        .unwrap_or_default()
        .trim()
        .to_ascii_lowercase();
    let is_media = media
        .split_once('/')
        .is_some_and(|(kind, name)| !kind.is_empty() && !name.is_empty());
    if !media.is_empty() && !is_media {
        return Err(UriError::Malformed("its media type has no slash"));
    }
    // The last parameter tells the encoding.
    let mut parameters: Vec<&str> = parameters.collect();
    let is_base64 = parameters
        .last()
        .is_some_and(|last| last.eq_ignore_ascii_case("base64"));
    parameters.truncate(parameters.len() - usize::from(is_base64));
    if !parameters.iter().all(|parameter| parameter.contains('=')) {
        return Err(UriError::Malformed(
            "a parameter of its media type has no value",
        ));
    }
    // The body is Base64 or percent-encoded.
    let bytes = if is_base64 {
        let escaped = body.contains('%');
        let text = if escaped {
            unescape(body)?
        } else {
            String::new()
        };
        let text = if escaped { text.as_str() } else { body };
        BASE64
            .decode(text)
            .map_err(|_| UriError::Malformed("its data is not Base64"))?
    } else {
        unescape_bytes(body)?
    };
    Ok(Uri::Data { media, bytes })
}

fn unescape(text: &str) -> Result<String, UriError> {
    String::from_utf8(unescape_bytes(text)?)
        .map_err(|_| UriError::Malformed("its escapes are not UTF-8"))
}

/// Resolves escapes such as `%41` (RFC 3986, section 2.1); an incomplete one is an error.
fn unescape_bytes(text: &str) -> Result<Vec<u8>, UriError> {
    let is_escape = |after: &[u8]| {
        let digits = after.get(..2);
        digits.is_some_and(|digits| digits.iter().all(u8::is_ascii_hexdigit))
    };
    if !text
        .as_bytes()
        .split(|byte| *byte == b'%')
        .skip(1)
        .all(is_escape)
    {
        return Err(UriError::Malformed(
            "a `%` must be followed by two hexadecimal digits",
        ));
    }
    Ok(percent_decode_str(text).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_below_the_folder_in_whatever_disguise() {
        assert_eq!(parse("a%20b/c.bin"), Ok(Uri::Path("a b/c.bin".to_owned())));
        for uri in ["../x", "a/../x", "%2e%2e/x", "..%2Fx"] {
            let climbs = |uri| matches!(uri, Ok(Uri::Above(path)) if path.ends_with("../x"));
            assert!(climbs(parse(uri)), "{uri}");
        }
        for uri in [
            "..\\x",
            "%2e%2e%5cx",
            "/etc/passwd",
            "//host/x",
            "%2Fetc/passwd",
            "file:///etc/passwd",
            "FILE:/etc/passwd",
            "http://host/x",
            "C:\\x",
            "C:/x",
            "a\\b",
            "a%00b",
            "a/b:c",
        ] {
            assert!(
                matches!(parse(uri), Err(UriError::Outside(_))),
                "{uri}: {:?}",
                parse(uri)
            );
        }
    }

    #[test]
    fn what_is_mended_stays_below_the_folder_too() {
        let path = |uri| repair(uri).map(|(uri, ..)| uri);
        assert_eq!(path("a\\b.bin"), Some(Uri::Path("a/b.bin".to_owned())));
        for uri in [
            "..\\x",
            "a\\..\\x",
            "\\x",
            "C:\\x",
            "\\\\host\\x",
            "%2e%2e%5cx",
            "x",
        ] {
            assert_eq!(repair(uri), None, "{uri}");
        }
        let bytes = vec![0, 1, 2];
        let media = String::new();
        assert_eq!(
            path("data:;base64,AA\nE C"),
            Some(Uri::Data { media, bytes })
        );
        assert_eq!(path("data:;base64,`\n"), None);
    }

    #[test]
    fn data_is_read_in_place() {
        let data = |media: &str, bytes: &[u8]| {
            Ok(Uri::Data {
                media: media.to_owned(),
                bytes: bytes.to_vec(),
            })
        };
        assert_eq!(
            parse("data:application/octet-stream;base64,AAEC"),
            data("application/octet-stream", &[0, 1, 2])
        );
        assert_eq!(
            parse("data:image/png;x=y;base64,AA=="),
            data("image/png", &[0])
        );
        assert_eq!(parse("data:,a%20b"), data("", b"a b"));
        for uri in [
            "data:",
            "data:x,",
            "data:a/b;;base64,AA==",
            "data:a/b;base64,`",
            ":",
            "1:x",
            "",
            "%zz",
            "%4",
        ] {
            assert!(
                matches!(parse(uri), Err(UriError::Malformed(_))),
                "{uri}: {:?}",
                parse(uri)
            );
        }
    }
}
