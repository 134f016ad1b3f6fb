//! Untrusted arguments and messages: entry points of the fuzz targets, and of the tests with their
//! findings.

use super::args::{Cli, Command};
use super::lsp;
use clap::Parser;
use std::ffi::OsString;

/// Parses arguments, one per line, without the program's name. No command runs; only the existence
/// of an asset folder is checked.
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

/// Hears the messages of an editor, one JSON object a line, the greeting left out.
///
/// # Panics
/// If a message causes an internal error.
pub fn messages(bytes: &[u8]) {
    let cli = Cli::try_parse_from(["rtc", "lsp"]);
    if let Ok(Cli {
        command: Command::Lsp(args),
    }) = cli
    {
        lsp::hear_all(args, bytes);
    }
}

#[cfg(unix)]
fn argument(bytes: &[u8]) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes.to_vec())
}

#[cfg(not(unix))]
fn argument(bytes: &[u8]) -> OsString {
    String::from_utf8_lossy(bytes).into_owned().into()
}
