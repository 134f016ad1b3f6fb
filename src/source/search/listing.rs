//! The names in folders, each folder read once for all names that are not found there.

use super::Folder;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The most names of a folder that are looked at.
const MOST: usize = 1 << 16;

/// The names in the folders that were looked into.
#[derive(Clone, Debug, Default)]
pub(super) struct Listings(Arc<Mutex<BTreeMap<PathBuf, Arc<Listing>>>>);

/// The names in a folder.
#[derive(Debug)]
pub(super) struct Listing {
    /// In order.
    pub(super) names: Vec<String>,
    /// The same by what they are in lower case.
    by_lower: BTreeMap<String, Vec<String>>,
}

impl Listings {
    /// The names at a place in a folder.
    pub(super) fn of(&self, folder: &Folder, place: &Path) -> Arc<Listing> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(listing) = known.get(place) {
            return Arc::clone(listing);
        }
        let listing = Arc::new(Listing::new(folder.names(place).take(MOST).collect()));
        known.insert(place.to_owned(), Arc::clone(&listing));
        listing
    }
}

impl Listing {
    fn new(mut names: Vec<String>) -> Self {
        names.sort_unstable();
        let mut by_lower: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for name in &names {
            let alike = by_lower.entry(name.to_lowercase()).or_default();
            alike.push(name.clone());
        }
        Self { names, by_lower }
    }

    /// The names that differ from one in case only, in order.
    pub(super) fn alike(&self, name: &str) -> &[String] {
        let alike = self.by_lower.get(&name.to_lowercase());
        alike.map_or(&[], Vec::as_slice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However many names are not there, and however many are.
    #[test]
    fn a_folder_is_read_once() {
        let files = |count: usize| {
            let named = (0..count).map(|at| (format!("a/Y{at}.png"), Vec::new()));
            Arc::new(crate::MemoryFiles::new(named))
        };
        for count in [100, 200, 400] {
            let folder = Folder::in_memory(&files(count), Path::new(""), None);
            let listings = Listings::default();
            let first = listings.of(&folder, Path::new("a"));
            for at in 0..count {
                let again = listings.of(&folder, Path::new("a"));
                assert!(Arc::ptr_eq(&first, &again));
                assert_eq!(again.alike(&format!("y{at}.PNG")), [format!("Y{at}.png")]);
                assert!(again.alike("z.png").is_empty());
            }
            assert_eq!(first.names.len(), count);
        }
    }
}
