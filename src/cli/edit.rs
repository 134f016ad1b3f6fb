//! A text file that is changed: shown as a unified diff, or written.

use super::Failure;
use rtc_diag::clean;
use rtc_pipeline::AtomicFile;
use rtc_source::{Loader, SourceMap};
use similar::TextDiff;
use std::io;
use std::path::Path;

/// Lines shown around each change.
const AROUND: usize = 3;

/// The changes as a unified diff.
pub(super) fn diff(name: &str, before: &str, after: &str) -> String {
    let name = clean(name);
    TextDiff::from_lines(before, after)
        .unified_diff()
        .context_radius(AROUND)
        .header(&name, &name)
        .to_string()
}

/// Puts the text into the file, unless someone else has changed it since it was read.
pub(super) fn write(path: &Path, before: &str, after: &str) -> Result<(), Failure> {
    let written = put(path, before, after);
    let name = path.display();
    written.map_err(|error| Failure::Failed(format!("can't write `{name}`: {error}")))
}

fn put(path: &Path, before: &str, after: &str) -> io::Result<()> {
    let limit = before.len() as u64;
    let now = Loader.bytes(path, limit, &SourceMap::default());
    if !now.is_ok_and(|now| now == before.as_bytes()) {
        return Err(io::Error::other("it has changed since it was read"));
    }
    AtomicFile::edit(path, after.as_bytes())
}
