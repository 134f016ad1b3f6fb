//! The IR back to what people and other tools read. One folder a language.

mod beside;
pub mod course;
mod flat;
pub mod gltf;
pub mod mitsuba;
mod nearest;
mod ply;
pub mod pov;
mod told;
mod twin;

pub use twin::ExportedScene;
