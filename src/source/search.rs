//! Search for the files that a scene names: only below the scene's folder, its parent, or a folder
//! that the user allows.
//!
//! A name that leads elsewhere (`C:\…\earth.png`, `/home/…`, `../..`) is never followed: the
//! longest tail of it that exists below those folders is taken, last a name that differs in case
//! only. Only regular files are found, and judged once they are open. The parent lends what is by name
//! and first bytes what the scene asks for; a home, a system folder or a hidden file lends nothing.
//! Whether anything else is there is not told.

mod folder;
mod listing;
mod neighbours;

pub use folder::Folder;

use super::loader::{Identity, Opened};
use listing::Listings;
use std::fs;
use std::path::{Path, PathBuf};

/// The maximum number of components of a name that are tried, from its end.
const MAX_COMPONENTS: usize = 16;

/// The folders in which files are looked for, in this order.
#[derive(Clone, Debug, Default)]
pub struct Search {
    folders: Vec<Folder>,
    /// The last of them is the parent of the scene's folder.
    has_parent: bool,
    /// The folder the user allows, resolved.
    allowed: Option<PathBuf>,
    listings: Listings,
}

/// A kind of file that scenes name.
#[derive(Clone, Copy, Debug)]
pub struct FileKind {
    /// What its names end in, in lower case.
    pub extensions: &'static [&'static str],
    /// Whether a file that begins with these bytes, at most 64 KiB, is one.
    pub begins: fn(&[u8]) -> bool,
}

/// A file that was found, and is open.
#[derive(Debug)]
pub struct Found {
    /// Its path, free of links.
    pub path: PathBuf,
    /// Its path as the user would write it.
    pub shown: PathBuf,
    /// It has not the name, or lies not where the name says.
    pub elsewhere: bool,
    opened: Opened,
}

/// Why there is no such file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// There is no folder to look in.
    NoFolder,
    /// It was at none of these places.
    Absent(Vec<PathBuf>),
    /// The name leads out of the folders, and nothing like it is at these places.
    Outside(Vec<PathBuf>),
}

impl Found {
    fn new(opened: Opened, shown: PathBuf, elsewhere: bool) -> Self {
        Self {
            path: opened.path().to_owned(),
            shown,
            elsewhere,
            opened,
        }
    }

    /// The folder it lies in.
    #[must_use]
    pub fn folder(&self) -> Option<Folder> {
        let shown = self.shown.parent().map(Path::to_owned);
        let resolved = self.path.parent()?;
        Some(match self.opened.memory() {
            Some(files) => Folder::in_memory(files, resolved, shown),
            None => Folder::named(resolved, shown),
        })
    }

    /// What tells it from other files; `None` if it can't be read.
    #[must_use]
    pub fn identity(&self) -> Option<Identity> {
        self.opened.identity()
    }

    pub(super) fn opened(&self) -> &Opened {
        &self.opened
    }
}

/// A name as a scene writes it, on any system.
struct Name<'a> {
    components: Vec<&'a str>,
    /// How many `..` are left over in front.
    climbs: usize,
    /// It starts at a drive or at the root.
    is_absolute: bool,
    /// White space was cut off.
    trimmed: bool,
}

impl<'a> Name<'a> {
    fn new(written: &'a str) -> Self {
        let text = written.trim();
        let mut name = Self {
            components: Vec::new(),
            climbs: 0,
            is_absolute: text.starts_with(['/', '\\']),
            trimmed: text.len() != written.len(),
        };
        let is_drive = |part: &str| part.len() == 2 && part.ends_with(':');
        for part in text.split(['/', '\\']) {
            match part {
                "" | "." => {}
                ".." if name.components.pop().is_none() => name.climbs += 1,
                ".." => {}
                part if is_drive(part) && name.components.is_empty() => name.is_absolute = true,
                part => name.components.push(part),
            }
        }
        name
    }

    fn leads_out(&self) -> bool {
        self.is_absolute || self.climbs > 0
    }

    /// Whether it leads where nothing is looked for; the parent is looked in if it lends.
    fn leads_above(&self, has_parent: bool) -> bool {
        self.is_absolute || self.climbs > usize::from(has_parent)
    }

    /// The name's tails, from the longest to its last component.
    fn tails(&self) -> impl Iterator<Item = PathBuf> {
        let first = self.components.len().saturating_sub(MAX_COMPONENTS);
        (first..self.components.len()).map(|from| self.components[from..].iter().collect())
    }
}

/// The entry at a place.
enum At {
    File(Opened),
    /// A link that leads out, whether there is anything or not.
    Withheld,
    Nothing,
}

impl Search {
    /// Looks in `folder`, that of the scene, and in `allowed`; of files in memory in all.
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
            listings: Listings::default(),
        }
    }

    /// Looks last in the parent of the scene's `folder` too, unless that is `home` or lends nothing
    /// for another reason.
    #[must_use]
    pub fn with_parent(mut self, folder: Option<&Folder>, home: Option<&Path>) -> Self {
        let home = home.and_then(|home| fs::canonicalize(home).ok());
        let lends =
            |parent: &Folder| parent.lends(home.as_deref()) || self.is_allowed(&parent.resolved);
        let parent = folder.and_then(Folder::parent).filter(lends);
        self.has_parent = parent.is_some();
        self.folders.extend(parent);
        self
    }

    /// The file of a kind that a scene names `written`.
    ///
    /// # Errors
    /// If there is none: the reason, with the places that were searched.
    pub fn find(&self, written: &str, kind: &FileKind) -> Result<Found, Missing> {
        let Some(scene) = self.folders.first() else {
            return Err(Missing::NoFolder);
        };
        let name = Name::new(written);
        let mut outside = name.leads_above(self.has_parent);
        if let Some(opened) = self.climb(scene, &name) {
            let shown = scene.shown.join(written.trim().replace('\\', "/"));
            return Ok(Found::new(opened, shown, name.trimmed));
        }
        let mut looked: Vec<PathBuf> = Vec::new();
        for (index, tail) in name.tails().enumerate() {
            let elsewhere = index > 0 || name.leads_out() || name.trimmed;
            for (place, folder) in self.folders.iter().enumerate() {
                let shown = folder.shown.join(&tail);
                match self.at(place, &tail, kind) {
                    At::File(opened) => return Ok(Found::new(opened, shown, elsewhere)),
                    At::Withheld => outside = true,
                    At::Nothing => {}
                }
                looked.push(shown);
            }
        }
        let places = 0..self.folders.len();
        let other_case = name.tails().find_map(|tail| {
            places
                .clone()
                .find_map(|at| self.other_case(at, &tail, kind))
        });
        other_case.ok_or(if outside {
            Missing::Outside(looked)
        } else {
            Missing::Absent(looked)
        })
    }

    /// The file at exactly the path `written`, relative and with `/` between components, below the
    /// folder of the scene or the one the user allows.
    ///
    /// # Errors
    /// If there is none: the reason, with the places that were searched.
    pub fn below(&self, written: &str) -> Result<Found, Missing> {
        let own = self.folders.len() - usize::from(self.has_parent);
        if own == 0 {
            return Err(Missing::NoFolder);
        }
        let name = Name::new(written);
        if name.leads_out() || written.contains('\\') {
            return Err(Missing::Outside(Vec::new()));
        }
        let (mut looked, mut outside) = (Vec::new(), false);
        for (folder, shown) in self.folders[..own]
            .iter()
            .map(|folder| (folder, folder.shown.join(written)))
        {
            match self.within(folder, Path::new(written)) {
                At::File(opened) => return Ok(Found::new(opened, shown, false)),
                At::Withheld => outside = true,
                At::Nothing => {}
            }
            looked.push(shown);
        }
        Err(if outside {
            Missing::Outside(looked)
        } else {
            Missing::Absent(looked)
        })
    }

    /// The same of a path that climbs by `..`: below the folder the user allows; or, one step up,
    /// what the folder above lends of a kind.
    ///
    /// # Errors
    /// As [`Search::below`].
    pub fn above(&self, written: &str, kind: Option<&FileKind>) -> Result<Found, Missing> {
        let Some(scene) = self.folders.first() else {
            return Err(Missing::NoFolder);
        };
        let name = Name::new(written);
        let outside = Err(Missing::Outside(Vec::new()));
        if name.is_absolute || written.contains('\\') {
            return outside;
        }
        let path: PathBuf = name.components.iter().collect();
        if name.climbs == 0 {
            return self.below(&path.to_string_lossy());
        }
        let shown = scene.shown.join(written);
        if let Some(opened) = self.climb(scene, &name) {
            return Ok(Found::new(opened, shown, false));
        }
        let parent = self.folders.len() - 1;
        let Some(kind) = kind.filter(|_| self.has_parent && name.climbs == 1) else {
            return outside;
        };
        match self.at(parent, &path, kind) {
            At::File(opened) => Ok(Found::new(opened, shown, false)),
            At::Withheld => outside,
            At::Nothing => Err(Missing::Absent(vec![shown])),
        }
    }

    fn is_allowed(&self, path: &Path) -> bool {
        self.allowed
            .as_ref()
            .is_some_and(|allowed| path.starts_with(allowed))
    }

    /// The file at a name with `..` in front, which only the folder the user allows can hold.
    fn climb(&self, scene: &Folder, name: &Name) -> Option<Opened> {
        self.allowed
            .as_ref()
            .filter(|_| name.climbs > 0 && !name.is_absolute)?;
        let above = scene.resolved.ancestors().nth(name.climbs)?;
        let opened = scene.open(&above.join(name.components.iter().collect::<PathBuf>()))?;
        self.is_allowed(opened.path()).then_some(opened)
    }

    /// What is below the folder at `place`; of the parent only what it lends.
    fn at(&self, place: usize, tail: &Path, kind: &FileKind) -> At {
        let folder = &self.folders[place];
        let is_parent = self.has_parent && place + 1 == self.folders.len();
        let is_lent = |opened: &Opened| {
            self.is_allowed(opened.path()) || kind.is_lent(opened, &folder.resolved)
        };
        match self.within(folder, tail) {
            At::File(opened) if !is_parent || is_lent(&opened) => At::File(opened),
            At::File(_) | At::Withheld if is_parent => At::Nothing,
            at @ (At::File(_) | At::Withheld | At::Nothing) => at,
        }
    }

    fn within(&self, folder: &Folder, tail: &Path) -> At {
        let is_inside = |opened: &Opened| {
            opened.path().starts_with(&folder.resolved) || self.is_allowed(opened.path())
        };
        let opened = folder.open(&folder.resolved.join(tail));
        match opened.filter(is_inside) {
            Some(opened) => At::File(opened),
            None if folder.leads_out(tail) => At::Withheld,
            None => At::Nothing,
        }
    }

    /// The file whose last component differs from that of `tail` in case only; the first by name,
    /// if there are more.
    fn other_case(&self, place: usize, tail: &Path, kind: &FileKind) -> Option<Found> {
        let folder = &self.folders[place];
        let wanted = tail.file_name()?.to_str()?;
        let listing = self
            .listings
            .of(folder, folder.resolved.join(tail).parent()?);
        listing.alike(wanted).iter().find_map(|name| {
            let tail = tail.with_file_name(name);
            match self.at(place, &tail, kind) {
                At::File(opened) => Some(Found::new(opened, folder.shown.join(&tail), true)),
                At::Withheld | At::Nothing => None,
            }
        })
    }
}

impl FileKind {
    /// Whether a file below a folder is of this kind, by its name and its first bytes, and not
    /// hidden there.
    fn is_lent(&self, opened: &Opened, folder: &Path) -> bool {
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
