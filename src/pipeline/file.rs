//! The one writer of files: a file appears whole or not at all, and so does a folder of them.
//!
//! It is written beside its target under another name, synced and renamed. What is unfinished is
//! removed. A link that is the last part of its path is replaced, not followed; what is edited may
//! be one that stays in its folder.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, TempDir};

/// A file that is to appear, fit to be written.
pub struct NewFile {
    /// Where it is to be, free of links.
    target: PathBuf,
    /// Those of the file that is there already.
    permissions: Option<Permissions>,
}

/// Who looks on while a file is written.
pub trait WriteObserver {
    /// Whether to stop.
    fn is_stopped(&self) -> bool;

    /// The draft that is not to stay behind if the process ends now; `None` if there is none.
    fn draft(&self, path: Option<&Path>);
}

/// Nobody looks on.
struct Unobserved;

impl WriteObserver for Unobserved {
    fn is_stopped(&self) -> bool {
        false
    }

    fn draft(&self, _: Option<&Path>) {}
}

impl NewFile {
    /// Writes a file of these bytes at `path`, which nobody looks on.
    ///
    /// # Errors
    /// What the system says, or that there is no regular file at `path`.
    pub fn save(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let stream = || io::Error::other("it is no regular file");
        let file = Self::at(path)?.ok_or_else(stream)?;
        file.write(&|out| out.write_all(bytes), &Unobserved)
    }

    /// Writes these bytes in place of those of the file at `path`, which nobody looks on.
    ///
    /// # Errors
    /// What the system says, or that the file is a link that leaves its folder.
    pub fn edit(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let target = path.canonicalize()?;
        if !target.starts_with(folder_of(path).canonicalize()?) {
            let words = "it is a link that leaves its folder; name the file that it leads to";
            return Err(io::Error::other(words));
        }
        Self::save(&target, bytes)
    }

    /// Looks whether the file at `path` can be written. `None` if there is a device or a pipe, which
    /// cannot be replaced.
    ///
    /// # Errors
    /// If it can't.
    pub fn at(path: &Path) -> io::Result<Option<Self>> {
        if fs::metadata(path).is_ok_and(|meta| meta.is_dir()) {
            return Err(ErrorKind::IsADirectory.into());
        }
        let target = place_of(path)?;
        let present = fs::symlink_metadata(&target).ok();
        let permissions = match &present {
            Some(meta) if meta.is_symlink() && is_stream(&target) => return Ok(None),
            Some(meta) if meta.is_symlink() => None,
            Some(meta) if !meta.is_file() => return Ok(None),
            Some(meta) if meta.permissions().readonly() => {
                return Err(io::Error::other("the file is read-only"));
            }
            Some(meta) => Some(meta.permissions()),
            None => None,
        };
        let folder = folder_of(&target);
        // Its errors name the draft, which means nothing to the user: the kind says it.
        draft(folder).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Some(Self {
            target,
            permissions,
        }))
    }

    /// Writes a file beside its target and puts it in place, unless the observer says stop before.
    ///
    /// # Errors
    /// What the system says, or that someone said stop.
    pub fn write(
        &self,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        self.write_slowly(&mut |file| write(file), observer)
    }

    /// The same with a file that is written while work goes on, and not from its beginning to its end.
    ///
    /// # Errors
    /// What the system says, or that someone said stop.
    pub fn write_slowly(
        &self,
        write: &mut dyn FnMut(&mut File) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        let draft =
            draft(folder_of(&self.target)).map_err(|error| io::Error::from(error.kind()))?;
        observer.draft(Some(draft.path()));
        let written = self.finish(draft, write, observer);
        observer.draft(None);
        written
    }

    fn finish(
        &self,
        mut draft: NamedTempFile,
        write: &mut dyn FnMut(&mut File) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        if let Some(permissions) = &self.permissions {
            draft.as_file().set_permissions(permissions.clone())?;
        }
        // By the file itself: the errors of its wrapper name the draft.
        write(draft.as_file_mut())?;
        draft.as_file().sync_all()?;
        if observer.is_stopped() {
            return Err(ErrorKind::Interrupted.into());
        }
        let placed = draft.persist(&self.target);
        placed.map_err(|error| error.error).map(drop)
    }
}

/// A folder that is to appear whole, with all its files, or not at all.
pub struct NewFolder {
    target: PathBuf,
    /// Where it is until then, beside its target; gone when dropped.
    draft: TempDir,
}

impl NewFolder {
    /// Looks whether there can be a folder at `path`: there is nothing, or an empty one.
    ///
    /// # Errors
    /// If there can't.
    pub fn at(path: &Path) -> io::Result<Self> {
        match fs::read_dir(path).map(|mut entries| entries.next().is_some()) {
            Ok(true) => return Err(ErrorKind::DirectoryNotEmpty.into()),
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            Ok(false) | Err(_) => {}
        }
        if path.is_symlink() {
            return Err(io::Error::other("it is a link"));
        }
        let target = path.canonicalize().or_else(|_| place_of(path))?;
        let folder = folder_of(&target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(".rtc-").suffix(".tmp");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let draft = builder.tempdir_in(folder);
        let draft = draft.map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self { target, draft })
    }

    /// Writes one of its files, unless the observer says stop before.
    ///
    /// # Errors
    /// As [`NewFile::write`].
    pub fn put(
        &self,
        name: &str,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        let file = NewFile::at(&self.draft.path().join(name))?;
        file.ok_or(ErrorKind::AlreadyExists)?.write(write, observer)
    }

    /// Puts it in place, unless the observer says stop before.
    ///
    /// # Errors
    /// What the system says, as when there is something by now, or that someone said stop.
    #[expect(clippy::disallowed_methods, reason = "this is the one writer")]
    pub fn place(self, observer: &dyn WriteObserver) -> io::Result<()> {
        if observer.is_stopped() {
            return Err(ErrorKind::Interrupted.into());
        }
        // Only an empty folder goes so.
        if self.target.is_dir() {
            fs::remove_dir(&self.target)?;
        }
        fs::rename(self.draft.path(), &self.target)?;
        // There is nothing left of the draft.
        let _ = self.draft.keep();
        Ok(())
    }
}

/// A path whose folder, which must be there, is free of links.
fn place_of(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or(ErrorKind::IsADirectory)?;
    Ok(folder_of(path).canonicalize()?.join(name))
}

/// Whether a link is one that the system keeps for a stream, as `/dev/stdout`.
fn is_stream(link: &Path) -> bool {
    let folder = folder_of(link);
    folder == Path::new("/dev") || folder.starts_with("/proc")
}

fn folder_of(target: &Path) -> &Path {
    target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// An empty file with the permissions of any new one, gone when dropped.
fn draft(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rtc-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
