//! A folder that is searched, on disk or in memory.

use crate::loader::OpenedFile;
use crate::memory::MemoryFiles;
use crate::record::SharedRecord;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// System folders; they and all folders below are excluded from the search of the parent folder.
const SYSTEM_FOLDERS: [&str; 5] = ["/proc", "/sys", "/dev", "/etc", "/private/etc"];

/// The folders of home folders.
const HOME_FOLDERS: [&str; 3] = ["/home", "/Users", "C:\\Users"];

/// The maximum number of path components that are followed, including those of links.
const MAX_STEPS: usize = 400;

/// A folder.
#[derive(Clone, Debug)]
pub struct Folder {
    /// The path as the user would write it.
    pub(super) shown: PathBuf,
    /// The canonical path.
    pub(super) resolved: PathBuf,
    /// The files in memory, for a folder in memory.
    files: Option<Arc<MemoryFiles>>,
    /// The record of a scene in this folder, if it is kept.
    record: Option<SharedRecord>,
}

impl Folder {
    /// The folder at a path of the user; `None` if it does not exist. An empty path is the current
    /// folder.
    #[must_use]
    pub fn new(shown: &Path) -> Option<Self> {
        let path = if shown.as_os_str().is_empty() {
            Path::new(".")
        } else {
            shown
        };
        Some(Self {
            shown: shown.to_owned(),
            resolved: fs::canonicalize(path).ok()?,
            files: None,
            record: None,
        })
    }

    /// The canonical path.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.resolved.clone()
    }

    /// A folder by its canonical path, displayed by the first of these names that leads to it.
    pub(super) fn named(resolved: &Path, names: impl IntoIterator<Item = PathBuf>) -> Self {
        let leads_there = |folder: &Self| folder.resolved == resolved;
        let folder = names
            .into_iter()
            .find_map(|name| Self::new(&name).filter(leads_there));
        folder.unwrap_or_else(|| Self {
            shown: resolved.to_owned(),
            resolved: resolved.to_owned(),
            files: None,
            record: None,
        })
    }

    /// A folder in memory, displayed by its own path if no other is given.
    pub(crate) fn in_memory(
        files: &Arc<MemoryFiles>,
        resolved: &Path,
        shown: Option<PathBuf>,
    ) -> Self {
        Self {
            shown: shown.unwrap_or_else(|| resolved.to_owned()),
            resolved: resolved.to_owned(),
            files: Some(Arc::clone(files)),
            record: None,
        }
    }

    /// The same folder, with the record of its scene.
    pub(crate) fn recorded(self, record: Option<SharedRecord>) -> Self {
        Self { record, ..self }
    }

    /// Notes in the record where a path led.
    pub(super) fn note_lookup(&self, path: &Path, opened: Option<&OpenedFile>) {
        if let Some(record) = &self.record {
            record.note_lookup(path, opened.map(OpenedFile::path));
        }
    }

    /// The files in memory, for a folder in memory.
    pub(super) fn memory(&self) -> Option<&Arc<MemoryFiles>> {
        self.files.as_ref()
    }

    /// Opens the file at a path without `..`, in this folder or above.
    pub(super) fn open(&self, path: &Path) -> Option<OpenedFile> {
        match &self.files {
            Some(files) => OpenedFile::in_memory(files, path),
            None => OpenedFile::at(path),
        }
    }

    /// Whether a link on the path leads outside the folder, whether or not its target exists.
    pub(super) fn escapes(&self, place: &Path) -> bool {
        if self.files.is_some() {
            return false;
        }
        let mut pending: Vec<PathBuf> = parts_from_last(place);
        let mut at = self.resolved.clone();
        for _ in 0..MAX_STEPS {
            let Some(part) = pending.pop() else {
                return false;
            };
            match part.as_os_str() == ".." {
                true => drop(at.pop()),
                false => at.push(part),
            }
            let Ok(there) = fs::symlink_metadata(&at) else {
                return !at.starts_with(&self.resolved);
            };
            if there.is_symlink()
                && let Ok(target) = fs::read_link(&at)
            {
                // A link to an absolute path counts as leading outside, even if it returns;
                // following it decides.
                at.pop();
                if target.has_root() {
                    at = PathBuf::new();
                }
                pending.extend(parts_from_last(&target));
            }
            if !at.starts_with(&self.resolved) {
                return true;
            }
        }
        false
    }

    /// The canonical path of a path in this folder.
    pub(super) fn resolve(&self, place: &Path) -> Option<PathBuf> {
        match &self.files {
            Some(_) => Some(place.to_owned()),
            None => fs::canonicalize(place).ok(),
        }
    }

    /// The names of the entries at a path, in no order.
    pub(super) fn names(&self, place: &Path) -> Box<dyn Iterator<Item = String>> {
        if let Some(files) = &self.files {
            return Box::new(files.names(place).into_iter());
        }
        let entries = fs::read_dir(place).into_iter().flatten().flatten();
        Box::new(entries.filter_map(|entry| entry.file_name().into_string().ok()))
    }

    pub(super) fn parent(&self) -> Option<Self> {
        if self.files.is_some() {
            return None;
        }
        let lexical = self
            .shown
            .parent()
            .filter(|_| !self.shown.ends_with(".."))
            .map(Path::to_owned);
        Some(Self::named(
            self.resolved.parent()?,
            lexical.into_iter().chain([self.shown.join("..")]),
        ))
    }

    /// Whether it may be searched as the parent folder of a scene; `home` is the user's home
    /// folder.
    pub(super) fn may_be_searched(&self, home: Option<&Path>) -> bool {
        let path = &self.resolved;
        let names = path
            .components()
            .filter(|part| matches!(part, Component::Normal(_)))
            .count();
        let of_system = SYSTEM_FOLDERS.iter().any(|folder| path.starts_with(folder));
        let is_home = home == Some(path)
            || HOME_FOLDERS
                .iter()
                .any(|homes| path.parent() == Some(Path::new(homes)));
        names >= 2 && !of_system && !is_home
    }
}

/// The components of a path, `..` included, in reverse order.
fn parts_from_last(place: &Path) -> Vec<PathBuf> {
    let is_step =
        |part: &Component<'_>| matches!(part, Component::Normal(_) | Component::ParentDir);
    let parts = place.components().filter(is_step);
    let mut parts: Vec<PathBuf> = parts.map(|part| part.as_os_str().into()).collect();
    parts.reverse();
    parts
}
