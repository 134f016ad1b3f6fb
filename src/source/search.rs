//! Where a file lies that a scene names: only below the scene's folder, its parent, or a folder the user allows.
//!
//! A name that leads elsewhere (`C:\…\earth.png`, `/home/…`, `../..`) is never followed: the longest tail of it that
//! exists below those folders is taken instead. So is, last, a name that differs in case only. Links are resolved
//! before they are judged, and only regular files are found.

use std::fs;
use std::path::{Path, PathBuf};

/// The most components of a name that are looked at, from its end.
const MAX_COMPONENTS: usize = 16;

/// The folders in which files are looked for, in this order.
#[derive(Clone, Debug, Default)]
pub struct Search {
    folders: Vec<Folder>,
    /// The folder the user allows, resolved.
    allowed: Option<PathBuf>,
}

#[derive(Clone, Debug)]
struct Folder {
    /// As the user would write it.
    shown: PathBuf,
    /// Without links and `..`.
    resolved: PathBuf,
}

/// A file that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// Its path, free of links.
    pub path: PathBuf,
    /// Its path as the user would write it.
    pub shown: PathBuf,
    /// It has not the name, or lies not where the name says.
    pub elsewhere: bool,
}

/// What tells a file from others, by whatever names and links it is reached.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity(Key);

#[cfg(unix)]
type Key = (u64, u64);

#[cfg(not(unix))]
type Key = PathBuf;

impl Found {
    /// What tells it from other files; `None` if it has gone.
    #[must_use]
    pub fn identity(&self) -> Option<Identity> {
        #[cfg(unix)]
        let key = {
            use std::os::unix::fs::MetadataExt;
            fs::metadata(&self.path).ok().map(|metadata| (metadata.dev(), metadata.ino()))
        };
        #[cfg(not(unix))]
        let key = Some(self.path.clone());
        key.map(Identity)
    }
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

    /// The name's tails, from the longest to its last component.
    fn tails(&self) -> impl Iterator<Item = PathBuf> {
        let first = self.components.len().saturating_sub(MAX_COMPONENTS);
        (first..self.components.len()).map(|from| self.components[from..].iter().collect())
    }
}

/// What is at a place.
enum At {
    File(PathBuf),
    LinkOut,
    Nothing,
}

impl Search {
    /// Looks in `folder`, that of the scene, in `allowed`, and in the parent of `folder`.
    #[must_use]
    pub fn new(folder: Option<&Path>, allowed: Option<&Path>) -> Self {
        let open = |shown: &Path| {
            let path = if shown.as_os_str().is_empty() { Path::new(".") } else { shown };
            Some(Folder { shown: shown.to_owned(), resolved: fs::canonicalize(path).ok()? })
        };
        let scene = folder.and_then(open);
        let parent = scene.as_ref().and_then(|scene| {
            let above = scene.shown.join("..");
            let shown = scene.shown.parent().filter(|_| !scene.shown.ends_with("..")).unwrap_or(&above);
            Some(Folder { shown: shown.to_owned(), resolved: scene.resolved.parent()?.to_owned() })
        });
        let given = allowed.and_then(open);
        let allowed = given.as_ref().map(|folder| folder.resolved.clone());
        Self { folders: [scene, given, parent].into_iter().flatten().collect(), allowed }
    }

    /// The file that a scene names `written`.
    ///
    /// # Errors
    /// Why there is none, with the places that were looked at.
    pub fn find(&self, written: &str) -> Result<Found, Missing> {
        let Some(scene) = self.folders.first() else { return Err(Missing::NoFolder) };
        let name = Name::new(written);
        let mut outside = name.leads_out();
        if let Some(path) = self.climb(scene, &name) {
            let shown = scene.shown.join(written.trim().replace('\\', "/"));
            return Ok(Found { path, shown, elsewhere: name.trimmed });
        }
        let mut looked: Vec<PathBuf> = Vec::new();
        for (index, tail) in name.tails().enumerate() {
            let elsewhere = index > 0 || name.leads_out() || name.trimmed;
            for folder in &self.folders {
                let shown = folder.shown.join(&tail);
                match self.at(folder, &tail) {
                    At::File(path) => return Ok(Found { path, shown, elsewhere }),
                    At::LinkOut => outside = true,
                    At::Nothing => {}
                }
                looked.push(shown);
            }
        }
        let other_case =
            name.tails().find_map(|tail| self.folders.iter().find_map(|folder| self.other_case(folder, &tail)));
        other_case.ok_or(if outside { Missing::Outside(looked) } else { Missing::Absent(looked) })
    }

    /// The file at exactly the path `written`, relative and with `/` between components, below the folder of the scene
    /// or the one the user allows.
    ///
    /// # Errors
    /// Why there is none, with the places that were looked at.
    pub fn below(&self, written: &str) -> Result<Found, Missing> {
        let Some(scene) = self.folders.first() else { return Err(Missing::NoFolder) };
        let name = Name::new(written);
        if name.leads_out() || written.contains('\\') {
            return Err(Missing::Outside(Vec::new()));
        }
        let allowed = self.folders.iter().skip(1).find(|folder| Some(&folder.resolved) == self.allowed.as_ref());
        let (mut looked, mut outside) = (Vec::new(), false);
        for folder in std::iter::once(scene).chain(allowed) {
            let shown = folder.shown.join(written);
            match self.at(folder, Path::new(written)) {
                At::File(path) => return Ok(Found { path, shown, elsewhere: false }),
                At::LinkOut => outside = true,
                At::Nothing => {}
            }
            looked.push(shown);
        }
        Err(if outside { Missing::Outside(looked) } else { Missing::Absent(looked) })
    }

    /// The file at a name with `..` in front, which only the folder the user allows can hold.
    fn climb(&self, scene: &Folder, name: &Name) -> Option<PathBuf> {
        let allowed = self.allowed.as_ref().filter(|_| name.climbs > 0 && !name.is_absolute)?;
        let above = scene.resolved.ancestors().nth(name.climbs)?;
        let path = fs::canonicalize(above.join(name.components.iter().collect::<PathBuf>())).ok()?;
        (path.starts_with(allowed) && path.is_file()).then_some(path)
    }

    fn at(&self, folder: &Folder, tail: &Path) -> At {
        let Some(path) = fs::canonicalize(folder.resolved.join(tail)).ok().filter(|path| path.is_file()) else {
            return At::Nothing;
        };
        let inside = |root: &PathBuf| path.starts_with(root);
        if inside(&folder.resolved) || self.allowed.as_ref().is_some_and(inside) { At::File(path) } else { At::LinkOut }
    }

    /// The file whose last component differs from that of `tail` in case only; the first by name, if there are more.
    fn other_case(&self, folder: &Folder, tail: &Path) -> Option<Found> {
        let wanted = tail.file_name()?.to_str()?.to_lowercase();
        let entries = fs::read_dir(folder.resolved.join(tail).parent()?).ok()?;
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut alike: Vec<String> = names.filter(|name| name.to_lowercase() == wanted).collect();
        alike.sort();
        alike.into_iter().find_map(|name| {
            let tail = tail.with_file_name(name);
            match self.at(folder, &tail) {
                At::File(path) => Some(Found { path, shown: folder.shown.join(&tail), elsewhere: true }),
                At::LinkOut | At::Nothing => None,
            }
        })
    }
}
