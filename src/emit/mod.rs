//! The IR back to what people and other tools read. One folder a language.

mod beside;
pub mod course;
pub mod gltf;
