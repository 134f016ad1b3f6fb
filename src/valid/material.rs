//! Validates the materials.

use super::check::{Checker, EntityCounts};
use super::phong::{self, Phong};
use super::standard::{self, Standard};
use rtc_ir as ir;

/// A material of either model.
#[derive(Clone, Debug)]
pub enum Material {
    /// The Phong model with reflection and refraction.
    Phong(Phong),
    /// The material of glTF.
    Standard(Box<Standard>),
}

pub(super) fn material(
    material: &ir::Material,
    index: usize,
    counts: &EntityCounts,
    check: &mut Checker<'_>,
) -> Option<Material> {
    match material {
        ir::Material::Phong(phong) => {
            phong::phong(phong, index, counts, check).map(Material::Phong)
        }
        ir::Material::Standard(standard) => standard::standard(standard, index, counts, check)
            .map(|standard| Material::Standard(Box::new(standard))),
    }
}
