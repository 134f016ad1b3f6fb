//! What suites of discovered tests share: a trial for each file, one of which runs by its name
//! (`cargo test --test files render/light/sun`), and trials that need files which not everybody
//! has. Where those are missing, they are counted as ignored, with the reason.
#![allow(dead_code, reason = "no suite needs all of it")]

pub(crate) use crate::repo::{files, root};
use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A test that passes unless it panics.
pub(crate) fn trial(name: impl Into<String>, test: impl FnOnce() + Send + 'static) -> Trial {
    Trial::test(name, move || {
        test();
        Ok(())
    })
}

/// A test that may find that there is nothing to test, and then says why; it counts as ignored.
pub(crate) fn trial_if(
    name: impl Into<String>,
    test: impl FnOnce() -> Result<(), &'static str> + Send + 'static,
) -> Trial {
    Trial::ignorable_test(name, move || {
        Ok(match test() {
            Ok(()) => Completion::Completed,
            Err(why) => Completion::ignored_with(why),
        })
    })
}

/// A test of a file or folder of `../shared`; ignored where that is not at hand.
pub(crate) fn needs(
    name: impl Into<String>,
    path: &str,
    test: impl FnOnce(&Path) + Send + 'static,
) -> Trial {
    match shared(path) {
        Some(path) => trial(name, move || test(&path)),
        None => absent(name, path),
    }
}

/// The place of a test that cannot run without a file of `../shared`.
pub(crate) fn absent(name: impl Into<String>, path: &str) -> Trial {
    let why = format!("there is no ../shared/{path}");
    Trial::ignorable_test(name, move || -> Result<Completion, Failed> {
        Ok(Completion::ignored_with(why))
    })
}

/// A file or folder of `../shared`, or of the folder that `RTC_SHARED` names; none if it is not
/// there.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RTC_SHARED").map_or_else(|| root("../shared"), PathBuf::from);
    Some(folder.join(path)).filter(|path| path.exists())
}

/// Whether expectations are to be written anew.
pub(crate) fn updates() -> bool {
    std::env::var_os("RTC_UPDATE").is_some()
}

/// The path of a file below a folder without its extension, parted by `/` on every system.
pub(crate) fn name(path: &Path, folder: &Path) -> String {
    let path = path.strip_prefix(folder).unwrap().with_extension("");
    path.to_string_lossy().replace('\\', "/")
}

/// Runs a suite as `cargo test` runs any other.
pub(crate) fn run(trials: Vec<Trial>) -> ExitCode {
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}
