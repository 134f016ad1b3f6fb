//! Arguments and messages nobody vouches for: what the fuzz targets call, and the suite with what
//! they found.

use super::args::{Cli, Command};
use super::lsp;
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

/// Hears the messages of an editor, one JSON object a line, the greeting left out.
///
/// # Panics
/// If a fault of ours is told of.
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
