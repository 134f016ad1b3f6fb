//! Tables that several stages read. A table is a macro that passes all its rows to the macro of a
//! stage.

mod shape;
mod standard;

pub use standard::{PhongFit, PhongTerms, camel_bytes, fit_phong};
