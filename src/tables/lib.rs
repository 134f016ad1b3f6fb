//! Tables that several stages share: the shapes, and the parameters of the glTF material.
//!
//! # Overview
//!
//! - [`shapes!`] has one row per shape: its type, its key in the IR, and the rules for its values.
//! - [`parameters!`] and the other macros of the material have one row per parameter, layer and
//!   extension.
//! - [`METALS`] has the complex indices of refraction of conductors.
//! - [`fit_phong`] computes the parameters of the glTF material ([`PhongFit`]) closest to the terms
//!   of
//!   a Phong material ([`PhongTerms`]). Exporters and front ends use it.
//! - [`camel_bytes`] converts the name of a field to its key in JSON.
//!
//! # How a table is used
//!
//! A table is a macro that takes the name of another macro and passes it all its rows. Each stage
//! defines a macro that generates its own part from the rows:
//!
//! ```text
//! tables::shapes!(declare)   in ir:      enum Shape { Sphere(Sphere), … }
//! tables::shapes!(validate)  in valid:   checks the values of each shape
//! tables::shapes!(emit)      in emit:    writes the keys of each shape
//! tables::shapes!(facts)     in plan:    facts of each shape
//! tables::shapes!(prepare)   in render:  builds the shapes of a world
//! ```
//!
//! So a row that a stage ignores does not compile, and text search finds every stage of a shape.
//! This room is below all stages, because the renderer may not name the IR.
//!
//! # Guarantees
//!
//! - All stages list shapes and parameters in the order of the table.
//! - A table contains no code of a stage; it depends on no other room.

mod metal;
mod shape;
mod standard;

pub use metal::{METALS, Metal};
pub use standard::{
    ExtensionProperty, MATERIAL_EXTENSIONS, PhongFit, PhongTerms, PropertyKind, camel_bytes,
    fit_phong,
};
