//! Tables that several stages share: the parameters of the glTF material, and metals.
//!
//! # Overview
//!
//! - [`parameters!`] has one row per parameter of the glTF material, [`MATERIAL_EXTENSIONS`] the
//!   properties of extensions that are parameters.
//! - [`METALS`] has the complex indices of refraction of conductors.
//! - [`fit_phong`] computes the parameters of the glTF material ([`PhongFit`]) closest to the terms
//!   of a Phong material ([`PhongTerms`]). Exporters and front ends use it.
//! - [`camel_bytes`] converts the name of a field to its key in JSON.
//!
//! # How a table is used
//!
//! [`parameters!`] takes the name of another macro and passes it all its rows. Each stage defines a
//! macro that generates its own part from them: the fields of the IR, their validation, the keys of
//! the scene format. So a row that a stage ignores does not compile. Other tables are constants.
//!
//! # Guarantees
//!
//! - All stages list parameters in the order of the table.
//! - A table contains no code of a stage; it depends on no other room.

mod metal;
mod standard;

pub use metal::{METALS, Metal};
pub use standard::{
    ExtensionProperty, MATERIAL_EXTENSIONS, PhongFit, PhongTerms, PropertyKind, camel_bytes,
    fit_phong,
};
