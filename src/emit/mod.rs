//! The IR back to text that people and other tools read. One folder a language.

pub mod course;
