//! The file watcher: polls length, modification time and system id of files, several times a
//! second.

use super::interrupt;
use super::preview_state::PreviewState;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

/// The polling interval.
const EVERY: Duration = Duration::from_millis(50);

/// The maximum number of files per poll; more files are polled in turn.
const AT_ONCE: usize = 100;

/// The state that identifies a version of a file; `None` if there is none.
type FileStamp = Option<(u64, Option<SystemTime>, u64)>;

/// The watched files, in the state in which they were read.
#[derive(Default)]
pub(super) struct WatchedFiles {
    stamps: Mutex<BTreeMap<PathBuf, FileStamp>>,
}

impl WatchedFiles {
    /// Watches these files from now on, relative to their state before they were read.
    pub(super) fn set(&self, known: &BTreeMap<PathBuf, FileStamp>, paths: Vec<PathBuf>) {
        let with_stamp = |path: PathBuf| {
            let stamp = known.get(&path).copied();
            (path.clone(), stamp.unwrap_or_else(|| stamp_of(&path)))
        };
        *self.stamps() = paths.into_iter().map(with_stamp).collect();
    }

    /// The watched files and this one, in their current state.
    pub(super) fn now(&self, first: &Path) -> BTreeMap<PathBuf, FileStamp> {
        let stamps = self.stamps();
        let paths = stamps.keys().cloned().chain([first.to_owned()]);
        let now = |path: PathBuf| {
            let stamp = stamp_of(&path);
            (path, stamp)
        };
        paths.collect::<Vec<_>>().into_iter().map(now).collect()
    }

    /// The files that are not as they were.
    fn changed(&self) -> Vec<(PathBuf, FileStamp)> {
        let known = self.stamps().clone();
        let now = known.into_iter().map(|(path, before)| {
            let now = stamp_of(&path);
            (path, before, now)
        });
        now.filter(|(_, before, now)| before != now)
            .map(|(path, _, now)| (path, now))
            .collect()
    }

    fn stamps(&self) -> MutexGuard<'_, BTreeMap<PathBuf, FileStamp>> {
        self.stamps.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Requests a new reading when a file has changed and then stays unchanged; returns when the
    /// program is stopped.
    pub(super) fn run(&self, preview_state: &PreviewState) {
        let (mut pending, mut reported) = (Vec::new(), Vec::new());
        let mut pause = 0;
        while !interrupt::is_heard() {
            thread::sleep(EVERY);
            // Many files take their time.
            pause += 1;
            if pause * AT_ONCE < self.stamps().len() {
                continue;
            }
            pause = 0;
            let changed = self.changed();
            // A writer gets time to finish, and each change is reported once.
            if !changed.is_empty() && changed == pending && changed != reported {
                reported.clone_from(&changed);
                preview_state.reload();
            } else if changed.is_empty() {
                reported.clear();
            }
            pending = changed;
        }
        preview_state.end();
    }
}

fn stamp_of(path: &Path) -> FileStamp {
    let found = fs::metadata(path).ok()?;
    #[cfg(unix)]
    let system = std::os::unix::fs::MetadataExt::ino(&found);
    #[cfg(not(unix))]
    let system = 0;
    Some((found.len(), found.modified().ok(), system))
}

#[cfg(test)]
mod tests {
    #![expect(clippy::disallowed_methods, reason = "a test makes the files it needs")]
    use super::*;

    #[test]
    fn a_file_that_is_written_replaced_or_gone_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["a", "b", "c", "d"] {
            fs::write(path(name), name).unwrap();
        }
        let watched = WatchedFiles::default();
        let known = watched.now(&path("a"));
        watched.set(&known, ["a", "b", "c", "d", "e"].map(path).to_vec());
        assert!(watched.changed().is_empty());
        fs::write(path("a"), "longer").unwrap();
        fs::write(path("new"), "b").unwrap();
        fs::rename(path("new"), path("b")).unwrap();
        fs::remove_file(path("c")).unwrap();
        fs::write(path("e"), "").unwrap();
        let changed: Vec<_> = watched.changed().into_iter().map(|(own, _)| own).collect();
        assert_eq!(changed, ["a", "b", "c", "e"].map(path));
    }

    /// A change between the reading of a file and the look at it is seen all the same.
    #[test]
    fn what_changes_while_it_is_read_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "before").unwrap();
        let watched = WatchedFiles::default();
        let known = watched.now(&path);
        fs::write(&path, "behind the back").unwrap();
        watched.set(&known, vec![path.clone()]);
        assert_eq!(watched.changed().len(), 1);
    }
}
