//! A record of everything that reading a scene depended on: for a cache that asks later whether any
//! of it has changed.

use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where paths led, and what the files held.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReadRecord {
    /// The paths that were opened, each with its canonical path; `None` if no file was used there.
    pub lookups: BTreeMap<PathBuf, Option<PathBuf>>,
    /// The SHA-256 of each file that was read, by canonical path.
    pub files: BTreeMap<PathBuf, [u8; 32]>,
    /// Whether a path or a file had changed when it was read again.
    pub has_changed: bool,
}

impl ReadRecord {
    /// Whether all lookups still lead where they led.
    #[must_use]
    pub fn leads_there(&self) -> bool {
        let leads = |(path, found): (&PathBuf, &Option<PathBuf>)| file_at(path) == *found;
        self.lookups.iter().all(leads)
    }
}

/// The canonical path of the regular file at a path.
fn file_at(path: &Path) -> Option<PathBuf> {
    let is_file = fs::metadata(path).is_ok_and(|there| there.is_file());
    is_file.then(|| fs::canonicalize(path).ok())?
}

/// A record that a source map shares with its folders.
#[derive(Clone, Debug, Default)]
pub(super) struct SharedRecord(Arc<Mutex<ReadRecord>>);

impl SharedRecord {
    /// The record so far.
    pub(super) fn so_far(&self) -> ReadRecord {
        self.locked().clone()
    }

    /// Notes where a path led.
    pub(super) fn note_lookup(&self, path: &Path, found: Option<&Path>) {
        let mut record = self.locked();
        let found = found.map(Path::to_owned);
        let before = record.lookups.insert(path.to_owned(), found.clone());
        record.has_changed |= before.is_some_and(|before| before != found);
    }

    /// Notes the content of the file at a path that the user gave, or at a canonical one.
    pub(super) fn note_file(&self, path: &Path, bytes: &[u8]) {
        let canonical = fs::canonicalize(path).ok();
        if let Ok(absolute) = std::path::absolute(path) {
            self.note_lookup(&absolute, canonical.as_deref());
        }
        let hash = Sha256::digest(bytes).into();
        let mut record = self.locked();
        let path = canonical.unwrap_or_else(|| path.to_owned());
        let before = record.files.insert(path, hash);
        record.has_changed |= before.is_some_and(|before| before != hash);
    }

    fn locked(&self) -> MutexGuard<'_, ReadRecord> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
