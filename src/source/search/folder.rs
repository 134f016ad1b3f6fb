//! A folder in which files are looked for, of the system or of files in memory.

use crate::loader::Opened;
use crate::memory::MemoryFiles;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Folders of the system, which lend nothing, nor does any folder below.
const OF_THE_SYSTEM: [&str; 5] = ["/proc", "/sys", "/dev", "/etc", "/private/etc"];

/// Folders of homes.
const OF_HOMES: [&str; 3] = ["/home", "/Users", "C:\\Users"];

/// The most parts of a path that are followed, those of links too.
const MOST_STEPS: usize = 400;

/// A folder.
#[derive(Clone, Debug)]
pub struct Folder {
    /// As the user would write it.
    pub(super) shown: PathBuf,
    /// Without links and `..`.
    pub(super) resolved: PathBuf,
    /// The files it is of, if they lie in memory.
    files: Option<Arc<MemoryFiles>>,
}

impl Folder {
    /// The folder that the user writes so; `None` if there is none. Nothing stands for the current
    /// one.
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
        })
    }

    /// A folder free of links, shown by the first of these names that leads there.
    pub(super) fn named(resolved: &Path, names: impl IntoIterator<Item = PathBuf>) -> Self {
        let leads_there = |folder: &Self| folder.resolved == resolved;
        let folder = names
            .into_iter()
            .find_map(|name| Self::new(&name).filter(leads_there));
        folder.unwrap_or_else(|| Self {
            shown: resolved.to_owned(),
            resolved: resolved.to_owned(),
            files: None,
        })
    }

    /// A folder of files in memory, shown by its own name if by no other.
    pub(crate) fn in_memory(
        files: &Arc<MemoryFiles>,
        resolved: &Path,
        shown: Option<PathBuf>,
    ) -> Self {
        Self {
            shown: shown.unwrap_or_else(|| resolved.to_owned()),
            resolved: resolved.to_owned(),
            files: Some(Arc::clone(files)),
        }
    }

    /// The files it is of, if they lie in memory.
    pub(super) fn memory(&self) -> Option<&Arc<MemoryFiles>> {
        self.files.as_ref()
    }

    /// The file at a path free of `..`, in this folder or above.
    pub(super) fn open(&self, path: &Path) -> Option<Opened> {
        match &self.files {
            Some(files) => Opened::in_memory(files, path),
            None => Opened::at(path),
        }
    }

    /// Whether a link on the way to a place in it leads out, whatever is there: only what lies in
    /// the folder is looked at.
    pub(super) fn leads_out(&self, place: &Path) -> bool {
        if self.files.is_some() {
            return false;
        }
        let mut way: Vec<PathBuf> = parts_from_last(place);
        let mut at = self.resolved.clone();
        for _ in 0..MOST_STEPS {
            let Some(part) = way.pop() else {
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
                // From the root it leads out even where it comes back; who follows it sees that.
                at.pop();
                if target.has_root() {
                    at = PathBuf::new();
                }
                way.extend(parts_from_last(&target));
            }
            if !at.starts_with(&self.resolved) {
                return true;
            }
        }
        false
    }

    /// A place in it, free of links.
    pub(super) fn resolve(&self, place: &Path) -> Option<PathBuf> {
        match &self.files {
            Some(_) => Some(place.to_owned()),
            None => fs::canonicalize(place).ok(),
        }
    }

    /// The names of what lies at a place, in no order.
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

    /// Whether it may lend files to scenes in a folder within; `home` is that of the user.
    pub(super) fn lends(&self, home: Option<&Path>) -> bool {
        let path = &self.resolved;
        let names = path
            .components()
            .filter(|part| matches!(part, Component::Normal(_)))
            .count();
        let of_system = OF_THE_SYSTEM.iter().any(|folder| path.starts_with(folder));
        let is_home = home == Some(path)
            || OF_HOMES
                .iter()
                .any(|homes| path.parent() == Some(Path::new(homes)));
        names >= 2 && !of_system && !is_home
    }
}

/// The names on the way to a place, and `..`, the first of them last.
fn parts_from_last(place: &Path) -> Vec<PathBuf> {
    let is_step =
        |part: &Component<'_>| matches!(part, Component::Normal(_) | Component::ParentDir);
    let parts = place.components().filter(is_step);
    let mut parts: Vec<PathBuf> = parts.map(|part| part.as_os_str().into()).collect();
    parts.reverse();
    parts
}
