//! Finds the files to which a scene refers: only below the scene's folder, its parent, or a folder
//! that the user allows.
//!
//! A path that leads elsewhere (`C:\…\earth.png`, `/home/…`, `../..`) is never followed: its
//! longest suffix that exists below those folders is used, and last a name that differs only in
//! case. Only regular files are found, and they are checked once they are open. The parent folder
//! is searched only for visible files whose extension and magic bytes match; home and system
//! folders are never searched. Error messages don't reveal whether any other file exists.

mod folder;
mod listing;

pub use folder::Folder;

use super::loader::{FileIdentity, OpenedFile};
use listing::FolderListings;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The maximum number of components of a name that are tried, from its end.
const MAX_COMPONENTS: usize = 16;

/// The folders that are searched, in this order.
#[derive(Clone, Debug, Default)]
pub struct FileSearch {
    folders: Vec<Folder>,
    /// Whether the last folder is the parent of the scene's folder.
    has_parent: bool,
    /// The folder that the user allows, canonical.
    allowed: Option<PathBuf>,
    listings: FolderListings,
}

/// A kind of file that scenes refer to.
#[derive(Clone, Copy, Debug)]
pub struct FileKind {
    /// The extensions of its names, in lower case.
    pub extensions: &'static [&'static str],
    /// Whether a file that begins with these bytes, at most 64 KiB, is of this kind.
    pub begins: fn(&[u8]) -> bool,
}

/// A file that was found, and is open.
#[derive(Debug)]
pub struct FoundFile {
    /// Its canonical path.
    pub path: PathBuf,
    /// Its path as the user would write it.
    pub shown: PathBuf,
    /// Whether its name or folder differs from the requested path.
    pub elsewhere: bool,
    opened: OpenedFile,
}

/// Why a file was not found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MissingFile {
    /// There is no folder to search.
    NoFolder,
    /// The file is at none of these paths.
    Absent(Vec<PathBuf>),
    /// The path leads outside the folders, and no suffix of it exists at these paths.
    Outside(Vec<PathBuf>),
}

impl FoundFile {
    fn new(opened: OpenedFile, shown: PathBuf, elsewhere: bool) -> Self {
        Self {
            path: opened.path().to_owned(),
            shown,
            elsewhere,
            opened,
        }
    }

    /// The folder of the file.
    #[must_use]
    pub fn folder(&self) -> Option<Folder> {
        let shown = self.shown.parent().map(Path::to_owned);
        let resolved = self.path.parent()?;
        Some(match self.opened.memory() {
            Some(files) => Folder::in_memory(files, resolved, shown),
            None => Folder::named(resolved, shown),
        })
    }

    /// The identity of the file; `None` if it can't be read.
    #[must_use]
    pub fn identity(&self) -> Option<FileIdentity> {
        self.opened.identity()
    }

    pub(super) fn opened(&self) -> &OpenedFile {
        &self.opened
    }
}

/// A path in a scene, with the separators of any system.
struct ScenePath<'a> {
    components: Vec<&'a str>,
    /// The number of leading `..`.
    parents: usize,
    /// Whether it starts at a drive or at the root.
    is_absolute: bool,
    /// Whether white space was removed.
    trimmed: bool,
}

impl<'a> ScenePath<'a> {
    fn new(written: &'a str) -> Self {
        let text = written.trim();
        let mut name = Self {
            components: Vec::new(),
            parents: 0,
            is_absolute: text.starts_with(['/', '\\']),
            trimmed: text.len() != written.len(),
        };
        let is_drive = |part: &str| part.len() == 2 && part.ends_with(':');
        for part in text.split(['/', '\\']) {
            match part {
                "" | "." => {}
                ".." if name.components.pop().is_none() => name.parents += 1,
                ".." => {}
                part if is_drive(part) && name.components.is_empty() => name.is_absolute = true,
                part => name.components.push(part),
            }
        }
        name
    }

    fn escapes(&self) -> bool {
        self.is_absolute || self.parents > 0
    }

    /// Whether it leads outside all folders that are searched.
    fn leads_above(&self, has_parent: bool) -> bool {
        self.is_absolute || self.parents > usize::from(has_parent)
    }

    /// The suffixes of the path, from the longest to the last component.
    fn tails(&self) -> impl Iterator<Item = PathBuf> {
        let first = self.components.len().saturating_sub(MAX_COMPONENTS);
        (first..self.components.len()).map(|from| self.components[from..].iter().collect())
    }
}

/// The result of looking up a path in a folder.
enum PathLookup {
    File(OpenedFile),
    /// A link leads outside the folder, whether its target exists or not.
    Outside,
    Nothing,
}

impl FileSearch {
    /// Searches `folder`, that of the scene, and then `allowed`; for files in memory, all folders.
    #[must_use]
    pub fn new(folder: Option<&Folder>, allowed: Option<&Path>) -> Self {
        let given = match folder.and_then(Folder::memory) {
            Some(files) => Some(Folder::in_memory(files, Path::new(""), None)),
            None => allowed.and_then(Folder::new),
        };
        let allowed = given.as_ref().map(|folder| folder.resolved.clone());
        Self {
            folders: folder.cloned().into_iter().chain(given).collect(),
            has_parent: false,
            allowed,
            listings: FolderListings::default(),
        }
    }

    /// Also searches the parent of the scene's `folder`, last, unless it is `home` or excluded for
    /// another reason.
    #[must_use]
    pub fn with_parent(mut self, folder: Option<&Folder>, home: Option<&Path>) -> Self {
        let home = home.and_then(|home| fs::canonicalize(home).ok());
        let may_be_searched = |parent: &Folder| {
            parent.may_be_searched(home.as_deref()) || self.is_allowed(&parent.resolved)
        };
        let parent = folder.and_then(Folder::parent).filter(may_be_searched);
        self.has_parent = parent.is_some();
        self.folders.extend(parent);
        self
    }

    /// Finds a file of a kind that a scene calls `written`.
    ///
    /// # Errors
    /// If there is none: the reason, with the paths that were searched.
    pub fn find(&self, written: &str, kind: &FileKind) -> Result<FoundFile, MissingFile> {
        let Some(scene) = self.folders.first() else {
            return Err(MissingFile::NoFolder);
        };
        let name = ScenePath::new(written);
        let mut outside = name.leads_above(self.has_parent);
        // A path with `..` into the allowed folder.
        if let Some(opened) = self.open_above(scene, &name) {
            let shown = scene.shown.join(written.trim().replace('\\', "/"));
            return Ok(FoundFile::new(opened, shown, name.trimmed));
        }
        // Each suffix of the path, from the longest, in each folder.
        let mut searched: Vec<PathBuf> = Vec::new();
        for (index, tail) in name.tails().enumerate() {
            let elsewhere = index > 0 || name.escapes() || name.trimmed;
            for (place, folder) in self.folders.iter().enumerate() {
                let shown = folder.shown.join(&tail);
                match self.at(place, &tail, kind) {
                    PathLookup::File(opened) => {
                        return Ok(FoundFile::new(opened, shown, elsewhere));
                    }
                    PathLookup::Outside => outside = true,
                    PathLookup::Nothing => {}
                }
                searched.push(shown);
            }
        }
        // Last, names that differ only in case.
        let places = 0..self.folders.len();
        let other_case = name.tails().find_map(|tail| {
            places
                .clone()
                .find_map(|at| self.other_case(at, &tail, kind))
        });
        other_case.ok_or(if outside {
            MissingFile::Outside(searched)
        } else {
            MissingFile::Absent(searched)
        })
    }

    /// Finds the file at exactly the path `written`, relative and with `/` between components,
    /// below the folder of the scene or the folder that the user allows.
    ///
    /// # Errors
    /// If there is none: the reason, with the paths that were searched.
    pub fn below(&self, written: &str) -> Result<FoundFile, MissingFile> {
        let own = self.folders.len() - usize::from(self.has_parent);
        if own == 0 {
            return Err(MissingFile::NoFolder);
        }
        let name = ScenePath::new(written);
        if name.escapes() || written.contains('\\') {
            return Err(MissingFile::Outside(Vec::new()));
        }
        let (mut searched, mut outside) = (Vec::new(), false);
        for (folder, shown) in self.folders[..own]
            .iter()
            .map(|folder| (folder, folder.shown.join(written)))
        {
            match self.within(folder, Path::new(written)) {
                PathLookup::File(opened) => return Ok(FoundFile::new(opened, shown, false)),
                PathLookup::Outside => outside = true,
                PathLookup::Nothing => {}
            }
            searched.push(shown);
        }
        Err(if outside {
            MissingFile::Outside(searched)
        } else {
            MissingFile::Absent(searched)
        })
    }

    /// The same for a path with leading `..`: below the folder that the user allows, or, with one
    /// `..`, a file of a kind in the parent folder.
    ///
    /// # Errors
    /// As [`FileSearch::below`].
    pub fn above(&self, written: &str, kind: Option<&FileKind>) -> Result<FoundFile, MissingFile> {
        let Some(scene) = self.folders.first() else {
            return Err(MissingFile::NoFolder);
        };
        let name = ScenePath::new(written);
        let outside = Err(MissingFile::Outside(Vec::new()));
        if name.is_absolute || written.contains('\\') {
            return outside;
        }
        let path: PathBuf = name.components.iter().collect();
        if name.parents == 0 {
            return self.below(&path.to_string_lossy());
        }
        let shown = scene.shown.join(written);
        if let Some(opened) = self.open_above(scene, &name) {
            return Ok(FoundFile::new(opened, shown, false));
        }
        let parent = self.folders.len() - 1;
        let Some(kind) = kind.filter(|_| self.has_parent && name.parents == 1) else {
            return outside;
        };
        match self.at(parent, &path, kind) {
            PathLookup::File(opened) => Ok(FoundFile::new(opened, shown, false)),
            PathLookup::Outside => outside,
            PathLookup::Nothing => Err(MissingFile::Absent(vec![shown])),
        }
    }

    fn is_allowed(&self, path: &Path) -> bool {
        self.allowed
            .as_ref()
            .is_some_and(|allowed| path.starts_with(allowed))
    }

    /// The file at a path with leading `..`, which must be below the folder that the user allows.
    fn open_above(&self, scene: &Folder, name: &ScenePath) -> Option<OpenedFile> {
        self.allowed
            .as_ref()
            .filter(|_| name.parents > 0 && !name.is_absolute)?;
        let above = scene.resolved.ancestors().nth(name.parents)?;
        let path = above.join(name.components.iter().collect::<PathBuf>());
        let opened = scene.open(&path);
        let opened = opened.filter(|opened| self.is_allowed(opened.path()));
        scene.note_lookup(&path, opened.as_ref());
        opened
    }

    /// Looks up a path below folder `index`; in the parent folder only files that match the kind.
    fn at(&self, place: usize, tail: &Path, kind: &FileKind) -> PathLookup {
        let folder = &self.folders[place];
        let is_parent = self.has_parent && place + 1 == self.folders.len();
        let matches = |opened: &OpenedFile| {
            self.is_allowed(opened.path()) || kind.matches(opened, &folder.resolved)
        };
        match self.within(folder, tail) {
            PathLookup::File(opened) if !is_parent || matches(&opened) => PathLookup::File(opened),
            PathLookup::File(_) | PathLookup::Outside if is_parent => PathLookup::Nothing,
            at @ (PathLookup::File(_) | PathLookup::Outside | PathLookup::Nothing) => at,
        }
    }

    fn within(&self, folder: &Folder, tail: &Path) -> PathLookup {
        let is_inside = |opened: &OpenedFile| {
            opened.path().starts_with(&folder.resolved) || self.is_allowed(opened.path())
        };
        let path = folder.resolved.join(tail);
        let opened = folder.open(&path).filter(is_inside);
        // The first folder is that of the scene, which has the record.
        if let Some(scene) = self.folders.first() {
            scene.note_lookup(&path, opened.as_ref());
        }
        match opened {
            Some(opened) => PathLookup::File(opened),
            None if folder.escapes(tail) => PathLookup::Outside,
            None => PathLookup::Nothing,
        }
    }

    /// The file whose last component differs from that of `tail` only in case; the first by name if
    /// there are several.
    fn other_case(&self, place: usize, tail: &Path, kind: &FileKind) -> Option<FoundFile> {
        let folder = &self.folders[place];
        let expected = tail.file_name()?.to_str()?;
        let listing = self
            .listings
            .of(folder, folder.resolved.join(tail).parent()?);
        listing.ignoring_case(expected).iter().find_map(|name| {
            let tail = tail.with_file_name(name);
            match self.at(place, &tail, kind) {
                PathLookup::File(opened) => {
                    Some(FoundFile::new(opened, folder.shown.join(&tail), true))
                }
                PathLookup::Outside | PathLookup::Nothing => None,
            }
        })
    }
}

impl FileKind {
    /// Whether a file below a folder is of this kind, by extension and first bytes, and not hidden.
    fn matches(&self, opened: &OpenedFile, folder: &Path) -> bool {
        let extension = opened
            .path()
            .extension()
            .and_then(|extension| extension.to_str())
            .map(str::to_lowercase);
        let below = opened.path().strip_prefix(folder).unwrap_or(opened.path());
        let is_hidden = below
            .components()
            .any(|part| part.as_os_str().as_encoded_bytes().starts_with(b"."));
        !is_hidden
            && extension.is_some_and(|extension| self.extensions.contains(&extension.as_str()))
            && (self.begins)(&opened.head())
    }
}

/// The maximum number of files that are compared.
const MAX_NEIGHBOURS: usize = 4096;

impl FileSearch {
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
    pub fn path_to(&self, found: &FoundFile) -> Option<String> {
        let below = |folder: &Folder| found.path.strip_prefix(&folder.resolved).ok();
        let path = self.folders.iter().find_map(below)?;
        let parts = path
            .components()
            .map(|part| part.as_os_str().to_string_lossy());
        Some(parts.collect::<Vec<_>>().join("/"))
    }
}
