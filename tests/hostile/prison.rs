//! Runs rtc with little memory and time: 256 MiB of addresses, 10 CPU-seconds, two threads. Linux alone has both limits.

use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// The exit code; none if a signal ended it.
    pub(crate) code: Option<i32>,
    /// What it said.
    pub(crate) words: String,
}

impl Outcome {
    /// True if it ended by itself with a finding of this code.
    pub(crate) fn is_refused(&self, finding: &str) -> bool {
        self.code == Some(1) && self.words.contains(&format!("error[{finding}]"))
    }
}

/// A folder with these files in it.
pub(crate) fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// Runs `rtc` with these arguments in a folder, within the limits.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> Outcome {
    let program = env!("CARGO_BIN_EXE_rtc");
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 262144; ulimit -t 10; exec \"$@\"", "sh", program])
        .args(arguments)
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .unwrap();
    Outcome { code: output.status.code(), words: String::from_utf8_lossy(&output.stderr).into_owned() }
}
