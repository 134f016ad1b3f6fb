//! Textures: values looked up at texture coordinates, by the rules of the course and of glTF.

pub(in crate::render) mod bilinear;
pub(in crate::render) mod sampled;
