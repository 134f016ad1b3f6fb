//! The one file that reads: a file or standard input, within a limit of size, most often into the
//! source map.
//!
//! What the user names is opened as it is. What a scene names is opened first, and judged by what
//! was opened: a path can lead elsewhere the next time it is followed.

use super::{FileId, Found, MemoryFiles, SourceMap};
use std::fmt;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest file read, in bytes: offsets are 32 bits, and a larger scene text is a mistake.
const MAX_BYTES: u64 = 1 << 30;

/// Why a file could not be read; prints as the reason.
#[derive(Debug)]
pub enum LoadError {
    /// The system said no.
    Io(io::Error),
    /// The file is larger than the limit, given in bytes.
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// There is a device, a pipe or a socket, where reading may wait for ever or never end.
    NotRegular,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::TooLarge { limit } => write!(f, "it is larger than {} MiB", limit >> 20),
            Self::NotRegular => f.write_str("it is no regular file; `-` reads standard input"),
        }
    }
}

/// Reads files, most often into a [`SourceMap`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Loader;

impl Loader {
    /// Reads the file at `path`; its name in the map is the path as the user wrote it.
    ///
    /// # Errors
    /// What the system says, or that the file is too large.
    pub fn file(&self, path: &Path, map: &mut SourceMap) -> Result<FileId, LoadError> {
        let bytes = self.bytes(path, MAX_BYTES, map)?;
        Ok(map.add_from(path, bytes))
    }

    /// Reads the file at `path` of files in memory, as a scene that may name the others.
    ///
    /// # Errors
    /// If there is none, or that it is too large.
    pub fn memory(
        &self,
        path: &str,
        files: &Arc<MemoryFiles>,
        map: &mut SourceMap,
    ) -> Result<FileId, LoadError> {
        let bytes = in_memory(files, Path::new(path), MAX_BYTES)?;
        Ok(map.add_memory(path, files, bytes))
    }

    /// Reads all of `reader`, for instance standard input, under the name given.
    ///
    /// # Errors
    /// What the reader says, or that there is too much of it.
    pub fn reader(
        &self,
        name: &str,
        reader: impl Read,
        map: &mut SourceMap,
    ) -> Result<FileId, LoadError> {
        Ok(map.add(name, all(reader, 0, MAX_BYTES)?))
    }

    /// Reads a file that was found, of at most `limit` bytes: what was opened when it was found, or the
    /// text that the map has in its place. The map only notes it.
    ///
    /// # Errors
    /// What the system says, or that the file is too large.
    pub fn found(&self, found: &Found, limit: u64, map: &SourceMap) -> Result<Vec<u8>, LoadError> {
        let opened = found.opened();
        if opened.memory().is_some() {
            return opened.bytes(limit);
        }
        map.note(&found.path);
        match map.edited(opened.path()) {
            Some(text) => all(text, text.len(), limit),
            None => opened.bytes(limit),
        }
    }

    /// Reads the file at `path`, which the user names, of at most `limit` bytes. The map only notes
    /// it.
    ///
    /// # Errors
    /// What the system says, or that the file is too large.
    pub fn bytes(&self, path: &Path, limit: u64, map: &SourceMap) -> Result<Vec<u8>, LoadError> {
        map.note(path);
        // To open a device may already do something, so it is not even tried.
        let there = fs::metadata(path).map_err(LoadError::Io)?;
        if !there.is_file() && !there.is_dir() {
            return Err(LoadError::NotRegular);
        }
        whole(&without_waiting().open(path).map_err(LoadError::Io)?, limit)
    }

    /// Reads a regular file of at most `limit` bytes that nobody named, and tells whose it is.
    ///
    /// # Errors
    /// What the system says, or that there is no such file or it is too large.
    pub fn owned(&self, path: &Path, limit: u64) -> Result<OwnedFile, LoadError> {
        let opened = Opened::at(path).ok_or(LoadError::NotRegular)?;
        let bytes = opened.bytes(limit)?;
        let metadata = match &opened.content {
            Content::System(Ok(file)) => file.metadata().map_err(LoadError::Io)?,
            Content::System(Err(_)) | Content::Memory(_) => return Err(LoadError::NotRegular),
        };
        Ok(OwnedFile {
            path: opened.path,
            bytes,
            is_own: is_own(&metadata),
        })
    }
}

/// A file that nobody named.
#[derive(Debug)]
pub struct OwnedFile {
    /// Where it lies, free of links.
    pub path: PathBuf,
    /// What is in it.
    pub bytes: Vec<u8>,
    /// Whether it belongs to the user or to the system's administrator, and nobody else may write
    /// it; true where the system does not tell.
    pub is_own: bool,
}

#[cfg(unix)]
fn is_own(file: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    /// The right of all others to write.
    const WRITABLE: u32 = 0o002;
    let user = rustix::process::geteuid().as_raw();
    [0, user].contains(&file.uid()) && file.mode() & WRITABLE == 0
}

#[cfg(not(unix))]
fn is_own(_: &Metadata) -> bool {
    true
}

/// What tells a file from others, by whatever names and links it is reached.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity(Known);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    ToSystem(FileIdentity),
    InMemory(PathBuf),
}

/// Device and inode.
#[cfg(unix)]
type FileIdentity = (u64, u64);

/// The path, free of links.
#[cfg(not(unix))]
type FileIdentity = PathBuf;

/// A regular file that was opened, and where it lies.
#[derive(Debug)]
pub(super) struct Opened {
    path: PathBuf,
    content: Content,
}

#[derive(Debug)]
enum Content {
    /// Or why the system did not open it.
    System(io::Result<File>),
    Memory(Arc<MemoryFiles>),
}

impl Opened {
    /// Opens the file at `path`; `None` if there is none, or what is there is no regular file.
    pub(super) fn at(path: &Path) -> Option<Self> {
        // To open a device may already do something, so it is not even tried.
        if !fs::metadata(path).ok()?.is_file() {
            return None;
        }
        let file = without_waiting().open(path);
        let path = fs::canonicalize(path).ok()?;
        if let Ok(file) = &file {
            let (opened, there) = (file.metadata().ok()?, fs::metadata(&path).ok()?);
            if !opened.is_file() || !is_same(&opened, &there) {
                return None;
            }
        }
        Some(Self {
            path,
            content: Content::System(file),
        })
    }

    /// The file at a path of files in memory.
    pub(super) fn in_memory(files: &Arc<MemoryFiles>, path: &Path) -> Option<Self> {
        let (path, _) = files.get(path)?;
        Some(Self {
            path: path.to_owned(),
            content: Content::Memory(Arc::clone(files)),
        })
    }

    /// The files in memory that it is of.
    pub(super) fn memory(&self) -> Option<&Arc<MemoryFiles>> {
        match &self.content {
            Content::System(_) => None,
            Content::Memory(files) => Some(files),
        }
    }

    /// Where it lies, free of links.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What tells it from other files; `None` if it can't be read.
    pub(super) fn identity(&self) -> Option<Identity> {
        let Content::System(file) = &self.content else {
            return Some(Identity(Known::InMemory(self.path.clone())));
        };
        let file = file.as_ref().ok()?;
        #[cfg(unix)]
        let key = key(&file.metadata().ok()?);
        #[cfg(not(unix))]
        let key = file.metadata().ok().map(|_| self.path.clone())?;
        Some(Identity(Known::ToSystem(key)))
    }

    /// The first bytes, of at most 64 KiB; none if it can't be read.
    pub(super) fn head(&self) -> Vec<u8> {
        let mut head = Vec::new();
        if let Content::System(Ok(file)) = &self.content
            && file.take(1 << 16).read_to_end(&mut head).is_err()
        {
            head.clear();
        }
        head
    }

    fn bytes(&self, limit: u64) -> Result<Vec<u8>, LoadError> {
        match &self.content {
            Content::Memory(files) => in_memory(files, &self.path, limit),
            Content::System(Ok(file)) => {
                (&*file).rewind().map_err(LoadError::Io)?;
                whole(file, limit)
            }
            Content::System(Err(error)) => Err(LoadError::Io(
                error
                    .raw_os_error()
                    .map_or(error.kind().into(), io::Error::from_raw_os_error),
            )),
        }
    }
}

/// Reads without waiting for a writer, should a pipe have come to where a file was.
fn without_waiting() -> OpenOptions {
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
fn key(file: &Metadata) -> FileIdentity {
    use std::os::unix::fs::MetadataExt;
    (file.dev(), file.ino())
}

/// True if both are of one file, as far as the system tells.
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
    all(bytes, bytes.len(), limit)
}

/// All of an open file.
fn whole(file: &File, limit: u64) -> Result<Vec<u8>, LoadError> {
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
    all(file, usize::try_from(metadata.len()).unwrap_or(0), limit)
}

/// All there is to read, most likely `expected` bytes.
fn all(reader: impl Read, expected: usize, limit: u64) -> Result<Vec<u8>, LoadError> {
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
