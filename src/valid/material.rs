//! The proof of the materials.

use super::check::{Check, place};
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use crate::math::{NonNegative, Positive, Vec3};
use std::num::NonZeroU32;

/// Phong's model with mirror and refraction; see [`ir::Phong`] for the formula.
#[derive(Clone, Debug)]
pub struct Phong {
    /// The colour of the surface.
    pub color: Vec3,
    /// The weight of the ambient term.
    pub ka: NonNegative,
    /// The weight of the diffuse term.
    pub kd: NonNegative,
    /// The weight of the highlight and of the mirror ray.
    pub ks: NonNegative,
    /// The exponent of the highlight and of the glossy lobe.
    pub n: NonNegative,
    /// The weight of the refracted ray.
    pub kt: NonNegative,
    /// The index of refraction of the inside over that of the outside.
    pub eta: Positive,
    /// Rays of the glossy lobe.
    pub glossy_samples: NonZeroU32,
}

pub(super) fn material(material: &ir::Material, index: usize, check: &mut Check<'_>) -> Option<Phong> {
    let ir::Material::Phong(ir::Phong { color, ka, kd, ks, n, kt, eta, glossy_samples }) = material;
    let at = |field| place(Noun::Material, index, field);
    let color = check.color(*color, at(Field::Color));
    let ka = check.non_negative(*ka, "ka", at(Field::Ka));
    let kd = check.non_negative(*kd, "kd", at(Field::Kd));
    let ks = check.non_negative(*ks, "ks", at(Field::Ks));
    let n = check.exponent(*n, at(Field::N));
    let kt = check.non_negative(*kt, "refract", at(Field::Kt));
    let eta = check.length(*eta, at(Field::Eta), &codes::ETA, "index of refraction");
    let glossy_samples = check.count(*glossy_samples, "glossySamples", at(Field::GlossySamples));
    Some(Phong { color: color?, ka: ka?, kd: kd?, ks: ks?, n: n?, kt: kt?, eta: eta?, glossy_samples: glossy_samples? })
}
