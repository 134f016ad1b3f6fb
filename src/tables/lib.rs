//! Tables shared by several stages. A table is a macro that passes all its rows to a macro of the
//! stage.

mod shape;
mod standard;

pub use standard::{PhongFit, PhongTerms, camel_bytes, fit_phong};
