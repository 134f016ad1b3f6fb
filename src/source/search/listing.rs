//! Cached listings of folders: each folder is read once.

use super::Folder;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The maximum number of names that are read from a folder.
const MAX_NAMES: usize = 1 << 16;

/// The listings of the folders read so far.
#[derive(Clone, Debug, Default)]
pub(super) struct FolderListings(Arc<Mutex<BTreeMap<PathBuf, Arc<FolderListing>>>>);

/// The names in a folder.
#[derive(Debug)]
pub(super) struct FolderListing {
    /// The names, sorted.
    pub(super) names: Vec<String>,
    /// The names by their lower-case form.
    by_lower: BTreeMap<String, Vec<String>>,
}

impl FolderListings {
    /// The listing of a path in a folder.
    pub(super) fn of(&self, folder: &Folder, place: &Path) -> Arc<FolderListing> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(listing) = known.get(place) {
            return Arc::clone(listing);
        }
        let listing = Arc::new(FolderListing::new(
            folder.names(place).take(MAX_NAMES).collect(),
        ));
        known.insert(place.to_owned(), Arc::clone(&listing));
        listing
    }
}

impl FolderListing {
    fn new(mut names: Vec<String>) -> Self {
        names.sort_unstable();
        let mut by_lower: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for name in &names {
            let ignoring_case = by_lower.entry(name.to_lowercase()).or_default();
            ignoring_case.push(name.clone());
        }
        Self { names, by_lower }
    }

    /// The names that differ from `name` only in case, sorted.
    pub(super) fn ignoring_case(&self, name: &str) -> &[String] {
        let ignoring_case = self.by_lower.get(&name.to_lowercase());
        ignoring_case.map_or(&[], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Independent of the number of names searched and of files present.
    #[test]
    fn a_folder_is_read_once() {
        let files = |count: usize| {
            let named = (0..count).map(|at| (format!("a/Y{at}.png"), Vec::new()));
            Arc::new(crate::MemoryFiles::new(named))
        };
        for count in [100, 200, 400] {
            let folder = Folder::in_memory(&files(count), Path::new(""), None);
            let listings = FolderListings::default();
            let first = listings.of(&folder, Path::new("a"));
            for at in 0..count {
                let again = listings.of(&folder, Path::new("a"));
                assert!(Arc::ptr_eq(&first, &again));
                assert_eq!(
                    again.ignoring_case(&format!("y{at}.PNG")),
                    [format!("Y{at}.png")]
                );
                assert!(again.ignoring_case("z.png").is_empty());
            }
            assert_eq!(first.names.len(), count);
        }
    }
}
