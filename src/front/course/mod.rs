//! The YAML of the course: text to spanned tree, tree to declaration, declaration to IR.
//!
//! Each record of the format is declared once, in the file of its noun; the declaration is its
//! type, its decoder and its schema. Every mistake is collected; none stops the pass.

mod ambient;
pub mod assets;
mod camera;
mod core_schema;
mod decode;
mod display;
mod environment;
mod expression;
mod glass;
mod keyword;
mod layout;
mod light;
mod lower;
mod material;
mod number;
mod object;
mod page;
mod path_settings;
mod reader;
mod record;
mod rotation;
mod sampling;
mod schema;
mod settings;
mod spelling;
mod standard;
mod suggestion;
mod synonym;
mod syntax;
mod texture;
mod value;
mod variant;
mod view_size;

pub use layout::lay_out;
pub use lower::{UnfinishedScene, lower};
pub use page::page;
pub use schema::schema;
pub use value::FILE;
