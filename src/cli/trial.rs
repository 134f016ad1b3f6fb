//! Arguments nobody vouches for: what the fuzz target calls, and the suite with what it found.

use super::args::Cli;
use clap::Parser;
use std::ffi::OsString;

/// Parses arguments, one a line, the program's name left out. No command is carried out; of the
/// files that are named only a folder of assets is asked whether it is there.
///
/// # Panics
/// If arguments are refused without a reason, or with the exit code of something else.
pub fn arguments(bytes: &[u8]) {
    let lines = bytes.split(|byte| *byte == b'\n').map(argument);
    let Err(error) = Cli::try_parse_from(std::iter::once(OsString::from("rtc")).chain(lines))
    else {
        return;
    };
    assert!(!error.to_string().trim().is_empty(), "a refusal says why");
    // Help and version are not refused.
    assert_eq!(
        error.exit_code(),
        if error.use_stderr() { 2 } else { 0 },
        "{error}"
    );
}

#[cfg(unix)]
fn argument(bytes: &[u8]) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes.to_vec())
}

#[cfg(not(unix))]
fn argument(bytes: &[u8]) -> OsString {
    String::from_utf8_lossy(bytes).into_owned().into()
}
