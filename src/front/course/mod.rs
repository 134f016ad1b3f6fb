//! The YAML of the course: text to spanned tree, tree to declaration, declaration to IR.
//!
//! Each record of the format is declared once, in the file of its noun; the declaration is its
//! type, its decoder and its schema. Every mistake is collected; none stops the pass.

mod ambient;
pub mod assets;
mod calculation;
mod camera;
mod decode;
mod display;
mod environment;
mod form;
mod glass;
mod layout;
mod light;
mod lower;
mod material;
mod meant;
mod number;
mod object;
mod page;
mod paths;
mod picture;
mod reader;
mod reading;
mod record;
mod sampling;
mod schema;
mod settings;
mod spelling;
mod standard;
mod synonym;
mod syntax;
mod texture;
mod turn;
mod value;
mod word;

pub use layout::lay_out;
pub use lower::{UnfinishedScene, lower};
pub use page::page;
pub use schema::schema;
pub use value::FILE;
