//! A text file that is changed: shown as a unified diff, or written.

use super::{Failure, output};
use rtc_diag::clean;
use rtc_pipeline::AtomicFile;
use rtc_source::{Loader, SourceMap};
use similar::TextDiff;
use std::io::{self, IsTerminal};
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

/// Prints such changes; a terminal is shown no characters of the text that command it.
pub(super) fn print(diff: &str) -> Result<(), Failure> {
    match io::stdout().is_terminal() {
        true => output::print(&diff.replace("\r\n", "\n")),
        false => output::to_stdout(diff.as_bytes()),
    }
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
