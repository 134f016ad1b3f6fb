//! The one file that reads: a file or standard input, within a limit of size, most often into the source map.

use super::{FileId, SourceMap};
use std::fmt;
use std::io::Read;
use std::path::Path;

/// The largest file read, in bytes: offsets are 32 bits, and a larger scene text is a mistake.
const MAX_BYTES: u64 = 1 << 30;

/// Why a file could not be read; prints as the reason.
#[derive(Debug)]
pub enum LoadError {
    /// The system said no.
    Io(std::io::Error),
    /// The file is larger than the limit, given in bytes.
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::TooLarge { limit } => write!(f, "it is larger than {} MiB", limit >> 20),
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
        Ok(map.add_from(path, self.bytes(path, MAX_BYTES)?))
    }

    /// Reads all of `reader`, for instance standard input, under the name given.
    ///
    /// # Errors
    /// What the reader says, or that there is too much of it.
    pub fn reader(&self, name: &str, reader: impl Read, map: &mut SourceMap) -> Result<FileId, LoadError> {
        Ok(map.add(name, all(reader, 0, MAX_BYTES)?))
    }

    /// Reads the file at `path`, of at most `limit` bytes.
    ///
    /// # Errors
    /// What the system says, or that the file is too large.
    #[expect(clippy::disallowed_methods, reason = "this is the one place that reads")]
    pub fn bytes(&self, path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
        let file = std::fs::File::open(path).map_err(LoadError::Io)?;
        let metadata = file.metadata().map_err(LoadError::Io)?;
        if metadata.is_dir() {
            return Err(LoadError::Io(std::io::ErrorKind::IsADirectory.into()));
        }
        if metadata.len() > limit {
            return Err(LoadError::TooLarge { limit });
        }
        all(file, usize::try_from(metadata.len()).unwrap_or(0), limit)
    }
}

/// All there is to read, most likely `expected` bytes.
fn all(reader: impl Read, expected: usize, limit: u64) -> Result<Vec<u8>, LoadError> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(expected).map_err(|_| LoadError::Io(std::io::ErrorKind::OutOfMemory.into()))?;
    reader.take(limit + 1).read_to_end(&mut bytes).map_err(LoadError::Io)?;
    if bytes.len() as u64 > limit {
        return Err(LoadError::TooLarge { limit });
    }
    Ok(bytes)
}
