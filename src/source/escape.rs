//! Paths as URIs write them.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use std::fmt::Display;

/// What is escaped in the path of a URI: all but the unreserved characters (RFC 3986, section 2.3)
/// and the slash.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/');

/// A path with `/` between its components, with escapes for what a URI can't hold.
pub fn uri_path(path: &str) -> impl Display {
    utf8_percent_encode(path, ESCAPED)
}
