//! The integrators: each is a way to find what a pixel shows.

pub(in crate::render) mod aov;
pub(in crate::render) mod path;
pub(in crate::render) mod shade;
pub(in crate::render) mod whitted;
