//! The front end of the course's scene format: YAML (or JSON) to IR.
//!
//! ```text
//! text ──▶ spanned tree ──▶ declarations ──▶ UnfinishedScene ──▶ LoweredScene
//!   yaml::parse      Decode::decode     Lowering        assets::load
//! ```
//!
//! 1. The parser of `rtc_source::tree::yaml` makes a tree in which every node has a span. `syntax`
//!    turns its errors into diagnostics.
//! 2. Maps are decoded to *records*. The macro `record!` (in `record`) declares a record once, in
//!    the file that is named after it: `camera`, `light`, `material`, `object::sphere` and so on.
//!    The declaration is the Rust type, its decoder and its schema. A field may have several
//!    spellings; `synonym` has those that many records share. A record may have *variants*: sets
//!    of keys of which exactly one must be present (`variant`). The types of values are in
//!    `number`, `value`, `keyword` and `rotation`; each implements `decode::Decode`.
//! 3. `lower` turns each record into entities of the IR as soon as it is decoded, and records the
//!    span of every value. Decisions that need the entire scene follow at the end: soft lights,
//!    ambiguous tori, path tracing, the ambient term, glass. The result is an
//!    [`UnfinishedScene`]: its images and meshes are placeholders.
//! 4. [`assets::load`] reads the files that the scene names and completes the scene.
//!
//! [`schema()`] (JSON Schema), [`page()`] (Markdown) and the decoder come from the same
//! declarations, so they cannot disagree. [`format_text`] formats a text without decoding it.
//!
//! What callers may rely on:
//!
//! * All errors are reported in one run. None stops it, except a text without a tree. `None` always
//!   means that a diagnostic was reported.
//! * An invalid object, light or material is omitted and an invalid camera is replaced, so that
//!   the validator can check the rest.
//! * Ranges are checked by the validator and not here, unless the IR cannot represent the value.
//! * With `strict` unknown keys are errors; with `lenient` mistakes that have one sensible repair
//!   are repaired with a warning.
//! * Work is bounded: aliases and merge keys that repeat parts of the tree are counted against the
//!   budget (`decode::DecodeContext::step`).

mod ambient;
mod area_light;
pub mod assets;
mod camera;
mod core_schema;
mod decode;
mod display;
mod environment;
mod filter;
mod glass;
mod ineffective;
mod keyword;
mod layout;
mod light;
mod lower;
mod material;
mod medium;
mod number;
mod object;
mod page;
mod path_settings;
mod pattern;
mod reader;
mod recognize;
mod record;
mod rotation;
mod sampling;
mod schema;
mod settings;
mod snippet;
mod spelling;
mod standard;
mod suggestion;
mod synonym;
mod syntax;
mod texture;
mod value;
mod variant;
mod view_size;

pub use layout::format_text;
pub use lower::{UnfinishedScene, lower};
pub use page::page;
pub use recognize::is_scene_text;
pub use schema::schema;
pub use value::FILE;
