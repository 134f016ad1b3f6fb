//! Writes files atomically: a file appears complete or not at all, and so does a folder of files.
//!
//! A file is written next to its target under a temporary name, synced and renamed; unfinished
//! files are removed. A link at the end of the path is replaced, not followed, except that an
//! edited file may be a link within its folder.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::{NamedTempFile, TempDir};

/// A file to be written.
pub struct AtomicFile {
    /// The path, with a canonical folder.
    target: PathBuf,
    folder: FolderIdentity,
    /// The permissions of the file that it replaces.
    permissions: Option<Permissions>,
}

/// A folder, whatever has its name later.
pub struct FolderIdentity {
    folder: PathBuf,
    key: FolderKey,
}

/// Device and inode.
#[cfg(unix)]
type FolderKey = (u64, u64);

/// The canonical path.
#[cfg(not(unix))]
type FolderKey = PathBuf;

impl FolderIdentity {
    /// That of the folder of a file.
    ///
    /// # Errors
    /// An error of the system.
    pub fn of_file(file: &Path) -> io::Result<Self> {
        let folder = folder_of(file).to_owned();
        let key = Self::key(&folder)?;
        Ok(Self { folder, key })
    }

    /// Checks that its name still leads to it.
    ///
    /// # Errors
    /// If it does not, or an error of the system.
    pub fn check(&self) -> io::Result<()> {
        match Self::key(&self.folder)? == self.key {
            true => Ok(()),
            false => Err(io::Error::other("its folder was replaced in the meantime")),
        }
    }

    #[cfg(unix)]
    fn key(folder: &Path) -> io::Result<FolderKey> {
        use std::os::unix::fs::MetadataExt;
        fs::metadata(folder).map(|own| (own.dev(), own.ino()))
    }

    #[cfg(not(unix))]
    fn key(folder: &Path) -> io::Result<FolderKey> {
        folder.canonicalize()
    }
}

/// Observes the writing of a file.
pub trait WriteObserver {
    /// Whether to stop.
    fn is_stopped(&self) -> bool;

    /// Receives the path of the temporary file, which must be deleted if the process ends now;
    /// `None` if there is none.
    fn draft(&self, path: Option<&Path>);
}

/// Does nothing.
struct NoWriteObserver;

impl WriteObserver for NoWriteObserver {
    fn is_stopped(&self) -> bool {
        false
    }

    fn draft(&self, _: Option<&Path>) {}
}

impl AtomicFile {
    /// Writes a file with these bytes at `path`, without an observer.
    ///
    /// # Errors
    /// An error of the system, or if `path` is not a regular file.
    pub fn save(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let stream = || io::Error::other("it is no regular file");
        let file = Self::at(path)?.ok_or_else(stream)?;
        file.write(&|out| out.write_all(bytes), &NoWriteObserver)
    }

    /// Replaces the content of the file at `path`, without an observer.
    ///
    /// # Errors
    /// An error of the system, or if the file is a link that leaves its folder.
    pub fn edit(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let target = path.canonicalize()?;
        if !target.starts_with(folder_of(path).canonicalize()?) {
            let message = "it is a link that leaves its folder; name its target";
            return Err(io::Error::other(message));
        }
        Self::save(&target, bytes)
    }

    /// Checks that the file at `path` can be written. `None` for a device or a pipe, which can't be
    /// replaced.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn at(path: &Path) -> io::Result<Option<Self>> {
        if fs::metadata(path).is_ok_and(|meta| meta.is_dir()) {
            return Err(ErrorKind::IsADirectory.into());
        }
        let target = resolved_path(path)?;
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
        let folder = FolderIdentity::of_file(&target)?;
        // The errors name the temporary file, which the user does not know; their kind suffices.
        draft(&folder.folder).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Some(Self {
            target,
            folder,
            permissions,
        }))
    }

    /// Writes the file to a temporary file and renames it, unless the observer stops it.
    ///
    /// # Errors
    /// An error of the system, or if it was stopped.
    pub fn write(
        &self,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        self.write_incrementally(&mut |file| write(file), observer)
    }

    /// The same for a file that is written incrementally, with random access.
    ///
    /// # Errors
    /// An error of the system, or if it was stopped.
    pub fn write_incrementally(
        &self,
        write: &mut dyn FnMut(&mut File) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        self.folder.check()?;
        let draft = draft(&self.folder.folder).map_err(|error| io::Error::from(error.kind()))?;
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
        // The inner file: errors of its wrapper name the temporary file.
        write(draft.as_file_mut())?;
        draft.as_file().sync_all()?;
        if observer.is_stopped() {
            return Err(ErrorKind::Interrupted.into());
        }
        self.folder.check()?;
        let placed = draft.persist(&self.target);
        placed.map_err(|error| error.error).map(drop)
    }
}

/// A folder that appears complete with all its files, or not at all.
pub struct AtomicFolder {
    target: PathBuf,
    /// The temporary folder next to the target; deleted when dropped.
    draft: TempDir,
}

impl AtomicFolder {
    /// Checks that a folder can be created at `path`: nothing exists there, or an empty folder.
    ///
    /// # Errors
    /// If it can't be made.
    pub fn at(path: &Path) -> io::Result<Self> {
        match fs::read_dir(path).map(|mut entries| entries.next().is_some()) {
            Ok(true) => return Err(ErrorKind::DirectoryNotEmpty.into()),
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            Ok(false) | Err(_) => {}
        }
        if path.is_symlink() {
            return Err(io::Error::other("it is a link"));
        }
        let target = path.canonicalize().or_else(|_| resolved_path(path))?;
        let folder = folder_of(&target);
        let mut builder = tempfile::Builder::new();
        builder.prefix(".rtc-").suffix(".tmp");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
        let draft = builder.tempdir_in(folder);
        let draft = draft.map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self { target, draft })
    }

    /// Writes one of its files, unless the observer stops it.
    ///
    /// # Errors
    /// As [`AtomicFile::write`].
    pub fn put(
        &self,
        name: &str,
        write: &dyn Fn(&mut dyn Write) -> io::Result<()>,
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        let file = AtomicFile::at(&self.draft.path().join(name))?;
        file.ok_or(ErrorKind::AlreadyExists)?.write(write, observer)
    }

    /// Renames the temporary folder, unless the observer stops it.
    ///
    /// # Errors
    /// An error of the system, for example if the target exists by now, or if it was stopped.
    #[expect(clippy::disallowed_methods, reason = "this is the one writer")]
    pub fn place(self, observer: &dyn WriteObserver) -> io::Result<()> {
        if observer.is_stopped() {
            return Err(ErrorKind::Interrupted.into());
        }
        // Only an empty folder can be removed this way.
        if self.target.is_dir() {
            fs::remove_dir(&self.target)?;
        }
        fs::rename(self.draft.path(), &self.target)?;
        // The temporary folder no longer exists.
        let _ = self.draft.keep();
        Ok(())
    }
}

/// A path with a canonical folder, which must exist.
fn resolved_path(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or(ErrorKind::IsADirectory)?;
    Ok(folder_of(path).canonicalize()?.join(name))
}

/// Whether a link is a stream of the system, for example `/dev/stdout`.
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

/// An empty temporary file with the permissions of a new file; deleted when dropped.
fn draft(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rtc-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}
