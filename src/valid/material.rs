//! Validates the materials.

use super::check::{Checker, EntityCounts};
use super::phong::{self, Phong};
use super::standard::{self, Standard};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::Id;

/// The id of a material of a [`ValidScene`](crate::ValidScene).
pub type MaterialId = Id<Material>;

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

/// The most materials of a blend.
const MOST_BLENDED: usize = 16;

/// Checks that no blend has too many materials. Blends are with earlier materials, or invalid.
pub(super) fn blends(materials: &[ir::Material], check: &mut Checker<'_>) {
    let mut counts: Vec<usize> = Vec::with_capacity(materials.len());
    for (index, material) in materials.iter().enumerate() {
        let other = match material {
            ir::Material::Phong(_) => None,
            ir::Material::Standard(standard) => standard.blend_with,
        };
        let others = other.and_then(|other| counts.get(other.0 as usize));
        let count = 1 + others.copied().unwrap_or(0);
        counts.push(count);
        if count == MOST_BLENDED + 1 {
            let message = format!("a blend has more than {MOST_BLENDED} materials");
            let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
            check.report(path, "", Diagnostic::new(&codes::BAD_FACTOR, message));
        }
    }
}
