//! Texts that stand in place of files: what an editor has open, which may differ from what is on disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Texts by the paths of their files, free of links: what is read where a scene names these files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EditedFiles(Arc<BTreeMap<PathBuf, Arc<String>>>);

impl EditedFiles {
    /// These texts by the paths of their files; what is no file is left out.
    #[must_use]
    pub fn new(texts: impl IntoIterator<Item = (PathBuf, Arc<String>)>) -> Self {
        let texts = texts.into_iter();
        let texts = texts.filter_map(|(path, text)| Some((fs::canonicalize(path).ok()?, text)));
        Self(Arc::new(texts.collect()))
    }

    /// The text in place of the file at a path that is free of links.
    pub(super) fn get(&self, path: &Path) -> Option<&[u8]> {
        self.0.get(path).map(|text| text.as_bytes())
    }
}
