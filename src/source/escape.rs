//! Percent-encoding of paths in URIs.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use std::fmt::Display;

/// The characters that are escaped in a URI path: all except unreserved characters (RFC 3986,
/// section 2.3) and the slash.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/');

/// A path with `/` between components, percent-encoded.
pub fn uri_path(path: &str) -> impl Display {
    utf8_percent_encode(path, ESCAPED)
}
