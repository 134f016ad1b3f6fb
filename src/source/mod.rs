//! Files, their bytes, and spans into them: every byte a person wrote has a place.

mod loader;
mod map;
mod search;

pub use loader::{LoadError, Loader};
pub use map::{FileId, LineColumn, SourceMap, Span};
pub use search::{Found, Missing, Search};
