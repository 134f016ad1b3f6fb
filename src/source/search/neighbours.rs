//! Names of files near a missing one, to suggest a correction, and paths of found files relative to
//! the folders that are searched.

use super::{FileKind, Folder, Found, Search};
use std::path::{Component, Path};

/// The maximum number of files that are compared.
const MAX_NEIGHBOURS: usize = 4096;

impl Search {
    /// The names of the visible files of a kind in the folder, below the scene's folder, to which a
    /// path leads; sorted.
    #[must_use]
    pub fn neighbours(&self, name: &str, kind: &FileKind) -> Vec<String> {
        let path = Path::new(name);
        let is_below = path
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        let (Some(folder), true) = (self.folders.first(), is_below) else {
            return Vec::new();
        };
        let place = folder.resolved.join(path.parent().unwrap_or(Path::new("")));
        // A link may lead outside the scene's folder.
        let place = folder.resolve(&place);
        let place = place.filter(|place| place.starts_with(&folder.resolved));
        let listing = place.map(|place| self.listings.of(folder, &place));
        let is_of_kind = |name: &String| {
            let extension = Path::new(name).extension().unwrap_or_default();
            let extension = extension.to_string_lossy().to_lowercase();
            !name.starts_with('.') && kind.extensions.contains(&&*extension)
        };
        let names = listing.iter().flat_map(|own| &own.names);
        let names = names.take(MAX_NEIGHBOURS).cloned();
        names.filter(is_of_kind).collect()
    }

    /// The path of a found file relative to the first searched folder that contains it, with `/`
    /// between components.
    #[must_use]
    pub fn path_to(&self, found: &Found) -> Option<String> {
        let below = |folder: &Folder| found.path.strip_prefix(&folder.resolved).ok();
        let path = self.folders.iter().find_map(below)?;
        let parts = path
            .components()
            .map(|part| part.as_os_str().to_string_lossy());
        Some(parts.collect::<Vec<_>>().join("/"))
    }
}
