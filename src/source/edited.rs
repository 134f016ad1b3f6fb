//! Unsaved editor contents, which replace files on disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Texts by the canonical paths of the files that they replace.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EditedFiles(Arc<BTreeMap<PathBuf, Arc<String>>>);

impl EditedFiles {
    /// Texts by the paths of their files; a path that does not exist is ignored.
    #[must_use]
    pub fn new(texts: impl IntoIterator<Item = (PathBuf, Arc<String>)>) -> Self {
        let texts = texts.into_iter();
        let texts = texts.filter_map(|(path, text)| Some((fs::canonicalize(path).ok()?, text)));
        Self(Arc::new(texts.collect()))
    }

    /// The text that replaces the file at a canonical path.
    pub(super) fn get(&self, path: &Path) -> Option<&[u8]> {
        self.0.get(path).map(|text| text.as_bytes())
    }
}
