//! Files, their bytes, spans into them, and trees of their texts: every byte a person wrote has a
//! place.

pub mod budget;
mod edited;
mod escape;
mod loader;
mod map;
mod memory;
mod search;
pub mod tree;

pub use budget::{Budget, Exceeded, Limits, Resource};
pub use edited::EditedFiles;
pub use escape::uri_path;
pub use loader::{Identity, LoadError, Loader, OwnedFile};
pub use map::{FileId, LineColumn, SourceMap, Span};
pub use memory::MemoryFiles;
pub use search::{FileKind, Folder, Found, Missing, Search};
