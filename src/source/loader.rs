//! Reads files and standard input, up to a size limit. No other code opens files.
//!
//! A path that the user gives is opened as it is. A path from a scene is opened first and then
//! checked through the open file, because the path could point elsewhere when it is followed again.

use super::{FileId, FoundFile, MemoryFiles, SourceMap};
use std::fmt;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest file in bytes: offsets are 32 bits, and a larger scene text is a mistake.
const MAX_BYTES: u64 = 1 << 30;

/// Why a file could not be read; displays as a message.
#[derive(Debug)]
pub enum LoadError {
    /// An error of the operating system.
    Io(io::Error),
    /// The file is larger than the limit.
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// The path is a device, a pipe or a socket, where reading may block or never end.
    NotRegular,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::TooLarge { limit } => write!(f, "it is larger than {}", ByteLimit(*limit)),
            Self::NotRegular => f.write_str("it is no regular file; `-` reads standard input"),
        }
    }
}

/// A limit in bytes, displayed exactly, with the largest unit.
#[derive(Clone, Copy, Debug)]
pub struct ByteLimit(pub u64);

impl fmt::Display for ByteLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.trailing_zeros() {
            20.. => write!(f, "{} MiB", self.0 >> 20),
            10.. => write!(f, "{} KiB", self.0 >> 10),
            _ => write!(f, "{} bytes", self.0),
        }
    }
}

/// Reads files, usually into a [`SourceMap`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Loader;

impl Loader {
    /// Reads the file at `path` into the map; its name is the path as the user wrote it.
    ///
    /// # Errors
    /// If it can't be opened or is too large.
    pub fn file(&self, path: &Path, map: &mut SourceMap) -> Result<FileId, LoadError> {
        let bytes = self.bytes(path, MAX_BYTES, map)?;
        Ok(map.add_from(path, bytes))
    }

    /// Reads the file at `path` of files in memory into the map; a scene may refer to the others.
    ///
    /// # Errors
    /// If it does not exist or is too large.
    pub fn memory(
        &self,
        path: &str,
        files: &Arc<MemoryFiles>,
        map: &mut SourceMap,
    ) -> Result<FileId, LoadError> {
        let bytes = in_memory(files, Path::new(path), MAX_BYTES)?;
        Ok(map.add_memory(path, files, bytes))
    }

    /// Reads all of `reader`, for example standard input, into the map under a name.
    ///
    /// # Errors
    /// An error of the reader, or too many bytes.
    pub fn reader(
        &self,
        name: &str,
        reader: impl Read,
        map: &mut SourceMap,
    ) -> Result<FileId, LoadError> {
        Ok(map.add(name, read_to_limit(reader, 0, MAX_BYTES)?))
    }

    /// Reads a file that was found, of at most `limit` bytes: the file that was opened when it was
    /// found, or the text that replaces it. The map records only the path.
    ///
    /// # Errors
    /// If it can't be read or is too large.
    pub fn found(
        &self,
        found: &FoundFile,
        limit: u64,
        map: &SourceMap,
    ) -> Result<Vec<u8>, LoadError> {
        let opened = found.opened();
        let is_on_disk = opened.memory().is_none();
        if is_on_disk {
            map.note(&found.path);
        }
        let bytes = match map.edited(opened.path()).filter(|_| is_on_disk) {
            Some(text) => read_to_limit(text, text.len(), limit),
            None => opened.bytes(limit),
        }?;
        map.count(&found.path, bytes.len());
        if is_on_disk {
            map.note_content(&found.path, &bytes);
        }
        Ok(bytes)
    }

    /// Reads the file at `path`, given by the user, of at most `limit` bytes. The map records only
    /// the path.
    ///
    /// # Errors
    /// If it can't be opened or is too large.
    pub fn bytes(&self, path: &Path, limit: u64, map: &SourceMap) -> Result<Vec<u8>, LoadError> {
        map.note(path);
        // Opening a device can have side effects, so it is not tried.
        let metadata = fs::metadata(path).map_err(LoadError::Io)?;
        if !metadata.is_file() && !metadata.is_dir() {
            return Err(LoadError::NotRegular);
        }
        let bytes = read_all(&nonblocking().open(path).map_err(LoadError::Io)?, limit)?;
        map.count(path, bytes.len());
        map.note_content(path, &bytes);
        Ok(bytes)
    }

    /// Reads a regular file of at most `limit` bytes that the user did not name, and checks its
    /// owner.
    ///
    /// # Errors
    /// If there is no such regular file, or it is too large.
    pub fn owned(&self, path: &Path, limit: u64) -> Result<OwnedFile, LoadError> {
        let opened = OpenedFile::at(path).ok_or(LoadError::NotRegular)?;
        let bytes = opened.bytes(limit)?;
        let metadata = match &opened.content {
            OpenedContent::System(Ok(file)) => file.metadata().map_err(LoadError::Io)?,
            OpenedContent::System(Err(_)) | OpenedContent::Memory(_) => {
                return Err(LoadError::NotRegular);
            }
        };
        Ok(OwnedFile {
            path: opened.path,
            bytes,
            is_trusted: is_trusted(&metadata),
        })
    }
}

/// A file that the user did not name.
#[derive(Debug)]
pub struct OwnedFile {
    /// Its canonical path.
    pub path: PathBuf,
    /// Its content.
    pub bytes: Vec<u8>,
    /// Whether it belongs to the user or to root and is not writable by others; true on systems
    /// without file owners.
    pub is_trusted: bool,
}

/// Whether a folder belongs to the user or to root and is not writable by others; true on systems
/// without file owners.
///
/// # Errors
/// An error of the system.
pub fn is_own_folder(path: &Path) -> io::Result<bool> {
    fs::metadata(path).map(|folder| is_trusted(&folder))
}

#[cfg(unix)]
fn is_trusted(file: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    /// The write permission of others.
    const WRITABLE: u32 = 0o002;
    let user = rustix::process::geteuid().as_raw();
    [0, user].contains(&file.uid()) && file.mode() & WRITABLE == 0
}

#[cfg(not(unix))]
fn is_trusted(_: &Metadata) -> bool {
    true
}

/// The identity of a file, independent of its names and links.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileIdentity(IdentityKind);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum IdentityKind {
    OnDisk(FileKey),
    InMemory(PathBuf),
}

/// Device and inode.
#[cfg(unix)]
type FileKey = (u64, u64);

/// The canonical path.
#[cfg(not(unix))]
type FileKey = PathBuf;

/// An open regular file with its canonical path.
#[derive(Debug)]
pub(super) struct OpenedFile {
    path: PathBuf,
    content: OpenedContent,
}

#[derive(Debug)]
enum OpenedContent {
    /// The open file, or why it could not be opened.
    System(io::Result<File>),
    Memory(Arc<MemoryFiles>),
}

impl OpenedFile {
    /// Opens the file at `path`; `None` if it is not a regular file.
    pub(super) fn at(path: &Path) -> Option<Self> {
        // Opening a device can have side effects, so it is not tried.
        if !fs::metadata(path).ok()?.is_file() {
            return None;
        }
        let file = nonblocking().open(path);
        let path = fs::canonicalize(path).ok()?;
        if let Ok(file) = &file {
            let (opened, metadata) = (file.metadata().ok()?, fs::metadata(&path).ok()?);
            if !opened.is_file() || !is_same(&opened, &metadata) {
                return None;
            }
        }
        Some(Self {
            path,
            content: OpenedContent::System(file),
        })
    }

    /// A file in memory.
    pub(super) fn in_memory(files: &Arc<MemoryFiles>, path: &Path) -> Option<Self> {
        let (path, _) = files.get(path)?;
        Some(Self {
            path: path.to_owned(),
            content: OpenedContent::Memory(Arc::clone(files)),
        })
    }

    /// The files in memory to which it belongs.
    pub(super) fn memory(&self) -> Option<&Arc<MemoryFiles>> {
        match &self.content {
            OpenedContent::System(_) => None,
            OpenedContent::Memory(files) => Some(files),
        }
    }

    /// The canonical path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The identity; `None` if it can't be read.
    pub(super) fn identity(&self) -> Option<FileIdentity> {
        let OpenedContent::System(file) = &self.content else {
            return Some(FileIdentity(IdentityKind::InMemory(self.path.clone())));
        };
        let file = file.as_ref().ok()?;
        #[cfg(unix)]
        let key = key(&file.metadata().ok()?);
        #[cfg(not(unix))]
        let key = file.metadata().ok().map(|_| self.path.clone())?;
        Some(FileIdentity(IdentityKind::OnDisk(key)))
    }

    /// The first bytes, at most 64 KiB; empty if it can't be read.
    pub(super) fn head(&self) -> Vec<u8> {
        let mut head = Vec::new();
        if let OpenedContent::System(Ok(file)) = &self.content
            && file.take(1 << 16).read_to_end(&mut head).is_err()
        {
            head.clear();
        }
        head
    }

    fn bytes(&self, limit: u64) -> Result<Vec<u8>, LoadError> {
        match &self.content {
            OpenedContent::Memory(files) => in_memory(files, &self.path, limit),
            OpenedContent::System(Ok(file)) => {
                (&*file).rewind().map_err(LoadError::Io)?;
                read_all(file, limit)
            }
            OpenedContent::System(Err(error)) => Err(LoadError::Io(
                error
                    .raw_os_error()
                    .map_or(error.kind().into(), io::Error::from_raw_os_error),
            )),
        }
    }
}

/// Options that do not block if a pipe has replaced the file.
fn nonblocking() -> OpenOptions {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed();
        std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, flags);
    }
    options
}

#[cfg(unix)]
fn key(file: &Metadata) -> FileKey {
    use std::os::unix::fs::MetadataExt;
    (file.dev(), file.ino())
}

/// Whether both are the same file according to the system.
#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    key(a) == key(b)
}

#[cfg(not(unix))]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    (a.len(), a.modified().ok()) == (b.len(), b.modified().ok())
}

/// A copy of a file in memory.
fn in_memory(files: &MemoryFiles, path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let missing = || LoadError::Io(io::ErrorKind::NotFound.into());
    let (_, bytes) = files.get(path).ok_or_else(missing)?;
    read_to_limit(bytes, bytes.len(), limit)
}

/// Reads an open file.
fn read_all(file: &File, limit: u64) -> Result<Vec<u8>, LoadError> {
    let metadata = file.metadata().map_err(LoadError::Io)?;
    if metadata.is_dir() {
        return Err(LoadError::Io(io::ErrorKind::IsADirectory.into()));
    }
    if !metadata.is_file() {
        return Err(LoadError::NotRegular);
    }
    if metadata.len() > limit {
        return Err(LoadError::TooLarge { limit });
    }
    read_to_limit(file, usize::try_from(metadata.len()).unwrap_or(0), limit)
}

/// Reads to the end, at most `limit` bytes; `expected` bytes are allocated at once.
fn read_to_limit(reader: impl Read, expected: usize, limit: u64) -> Result<Vec<u8>, LoadError> {
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(expected)
        .map_err(|_| LoadError::Io(std::io::ErrorKind::OutOfMemory.into()))?;
    reader
        .take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(LoadError::Io)?;
    if bytes.len() as u64 > limit {
        return Err(LoadError::TooLarge { limit });
    }
    Ok(bytes)
}
