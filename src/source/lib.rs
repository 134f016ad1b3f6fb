//! Files, their bytes, spans into them, and spanned trees of YAML and JSON.
//!
//! # Overview
//! - [`Loader`] reads files, standard input and [`MemoryFiles`]. It is the only code that opens
//!   files.
//! - [`SourceMap`] owns the bytes of all files of a run. A [`FileId`] names one; a [`Span`] is a
//!   byte range in it. The map converts offsets to [`LineColumn`]s.
//! - [`FileSearch`] finds the files to which a scene refers: below its folder, its parent folder,
//!   or a folder that the user allows.
//! - [`Budget`] and [`Limits`] bound the memory and work of a run, per [`Resource`].
//! - [`tree`] parses YAML and JSON to a [`tree::SyntaxTree`] of nodes with spans, and formats YAML.
//! - [`ReadRecord`] is everything that reading a scene depended on, for caches.
//! - [`EditedFiles`] are texts that an editor has open; they replace files on disk.
//!
//! # Guarantees
//! - Every value of a text has a span.
//! - Parsing is bounded in depth and memory and reports the position of each error.
//! - A scene can't read files outside the folders that are searched, and only regular files are
//!   read.
//! - Nothing is printed.

pub mod budget;
mod edited;
mod escape;
mod loader;
mod map;
mod memory;
mod record;
mod search;
mod span;
pub mod tree;

pub use budget::{Budget, LimitExceeded, Limits, Resource};
pub use edited::EditedFiles;
pub use escape::uri_path;
pub use loader::{ByteLimit, FileIdentity, LoadError, Loader, OwnedFile, is_own_folder};
pub use map::SourceMap;
pub use memory::MemoryFiles;
pub use record::ReadRecord;
pub use search::{FileKind, FileSearch, Folder, FoundFile, MissingFile};
pub use span::{FileId, LineColumn, Span};
