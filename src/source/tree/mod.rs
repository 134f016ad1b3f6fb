//! Texts as trees whose every node knows the bytes it was written in.

pub mod json;
pub mod yaml;
