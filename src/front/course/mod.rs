//! The YAML of the course: text to spanned tree, tree to declaration, declaration to IR.
//!
//! Each record of the format is declared once, in the file of its noun; the declaration is its
//! type, its decoder and its schema. Every mistake is collected; none stops the pass.

pub mod assets;
mod camera;
mod cone;
mod cylinder;
mod decode;
mod disc;
mod environment;
mod form;
mod gltf;
mod light;
mod lower;
mod material;
mod mesh;
mod number;
mod object;
mod page;
mod plane;
mod quad;
mod reader;
mod record;
mod schema;
mod settings;
mod solid;
mod spelling;
mod sphere;
mod syntax;
mod texture;
mod torus;

mod triangle;
mod value;

pub use lower::{UnfinishedScene, lower};
pub use page::page;
pub use schema::schema;
