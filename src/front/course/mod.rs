//! The YAML of the course: text to spanned tree, tree to declaration, declaration to IR, and the IR back to text.
//!
//! Each record of the format is declared once, in the file of its noun; the declaration is its type, its decoder and
//! its schema. Every mistake is collected; none stops the pass.

mod camera;
mod decode;
mod emit;
mod light;
mod lower;
mod material;
mod number;
mod object;
mod record;
mod schema;
mod settings;
mod spelling;
mod tree;
mod value;

pub use emit::emit;
pub use lower::lower;
pub use schema::schema;
