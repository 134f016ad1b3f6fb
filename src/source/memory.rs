//! Files in memory, instead of a folder.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Files by their paths from a virtual root.
#[derive(Debug, Default)]
pub struct MemoryFiles(BTreeMap<PathBuf, Vec<u8>>);

impl MemoryFiles {
    /// Files with their paths, `/` between components; of two files at one path the last is kept.
    #[must_use]
    pub fn new(files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Self {
        let files = files.into_iter();
        Self(
            files
                .map(|(path, bytes)| (resolved(Path::new(&path)), bytes))
                .collect(),
        )
    }

    /// The normalised path and the bytes of a file.
    pub(super) fn get(&self, path: &Path) -> Option<(&Path, &[u8])> {
        let (path, bytes) = self.0.get_key_value(&resolved(path))?;
        Some((path, bytes))
    }

    /// The names of the files in a folder.
    pub(super) fn names(&self, folder: &Path) -> Vec<String> {
        let folder = resolved(folder);
        let within = self.0.keys().filter(|path| path.parent() == Some(&folder));
        let names = within.filter_map(|path| path.file_name()?.to_str());
        names.map(str::to_owned).collect()
    }
}

/// A path from the root, without `.` and `..`.
pub(super) fn resolved(path: &Path) -> PathBuf {
    let mut resolved = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => resolved.push(name),
            Component::ParentDir => drop(resolved.pop()),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    resolved
}
