//! The one file that reads: it brings a file or standard input into the source map, within a limit of size.

use super::{FileId, SourceMap};
use std::io::Read;
use std::path::Path;

/// The largest file read, in bytes: offsets are 32 bits, and a larger scene text is a mistake.
const MAX_BYTES: u64 = 1 << 30;

/// Why a file could not be read.
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

/// Reads files into a [`SourceMap`].
#[derive(Default)]
pub struct Loader;

impl Loader {
    /// Reads the file at `path`; its name in the map is the path as the user wrote it.
    ///
    /// # Errors
    /// What the system says, or that the file is too large.
    #[expect(clippy::disallowed_methods, reason = "this is the one place that reads")]
    pub fn file(&self, path: &Path, map: &mut SourceMap) -> Result<FileId, LoadError> {
        let file = std::fs::File::open(path).map_err(LoadError::Io)?;
        let metadata = file.metadata().map_err(LoadError::Io)?;
        if metadata.is_dir() {
            return Err(LoadError::Io(std::io::ErrorKind::IsADirectory.into()));
        }
        if metadata.len() > MAX_BYTES {
            return Err(LoadError::TooLarge { limit: MAX_BYTES });
        }
        self.reader(&path.display().to_string(), file, map)
    }

    /// Reads all of `reader`, for instance standard input, under the name given.
    ///
    /// # Errors
    /// What the reader says, or that there is too much of it.
    pub fn reader(&self, name: &str, reader: impl Read, map: &mut SourceMap) -> Result<FileId, LoadError> {
        let mut bytes = Vec::new();
        reader.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(LoadError::Io)?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(LoadError::TooLarge { limit: MAX_BYTES });
        }
        Ok(map.add(name, bytes))
    }
}
