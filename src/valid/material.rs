//! The proof of the materials.

use super::check::{Check, Counts, place};
use super::standard;
use crate::diag::codes;
use crate::ir::{self, Field, Noun, Place, TextureId};
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
    /// What is looked up by uv, if anything is.
    pub maps: Option<Box<Maps>>,
}

/// Textures of a material, as indices into [`super::Proof::textures`].
#[derive(Clone, Copy, Debug)]
pub struct Maps {
    /// The texture that gives the colour.
    pub color: Option<usize>,
    /// The texture whose red channel multiplies ks.
    pub specular: Option<usize>,
    /// The texture of the shading normal.
    pub normal: Option<usize>,
    /// The height field.
    pub bump: Option<Bump>,
}

/// A height field over a surface.
#[derive(Clone, Copy, Debug)]
pub struct Bump {
    /// The texture: an index into [`super::Proof::textures`].
    pub texture: usize,
    /// The height of white above black, as a share of the width of a texel.
    pub height: f64,
}

pub(super) fn material(
    material: &ir::Material,
    index: usize,
    counts: &Counts,
    check: &mut Check<'_>,
) -> Option<Phong> {
    let approximation;
    let phong = match material {
        ir::Material::Phong(phong) => phong,
        ir::Material::Standard(material) => {
            standard::standard(material, index, counts, check)?;
            approximation = standard::as_phong(material);
            &approximation
        }
    };
    let ir::Phong {
        color,
        ka,
        kd,
        ks,
        n,
        kt,
        eta,
        glossy_samples,
        ..
    } = phong;
    let at = |field| place(Noun::Material, index, field);
    let color = check.color(*color, at(Field::Color));
    let ka = check.non_negative(*ka, "ka", at(Field::Ka));
    let kd = check.non_negative(*kd, "kd", at(Field::Kd));
    let ks = check.non_negative(*ks, "ks", at(Field::Ks));
    let n = check.exponent(*n, at(Field::N));
    let kt = check.non_negative(*kt, "refract", at(Field::Kt));
    let eta = check.length(*eta, at(Field::Eta), &codes::ETA, "index of refraction");
    let glossy_samples = check.count(*glossy_samples, "glossySamples", at(Field::GlossySamples));
    let maps = maps(phong, counts, index, check);
    Some(Phong {
        color: color?,
        ka: ka?,
        kd: kd?,
        ks: ks?,
        n: n?,
        kt: kt?,
        eta: eta?,
        glossy_samples: glossy_samples?,
        maps: maps?,
    })
}

/// The material as the path integrator sees it.
pub(super) fn standard(
    material: &ir::Material,
    index: usize,
    counts: &Counts,
    check: &mut Check<'_>,
) -> Option<ir::Standard> {
    match material {
        ir::Material::Phong(phong) => Some(standard::from_phong(phong)),
        ir::Material::Standard(material) => standard::standard(material, index, counts, check),
    }
}

/// The maps that a material may have: the outer `None` is an error, the inner one absence.
#[expect(
    clippy::option_option,
    reason = "an error and an absence are two things"
)]
fn maps(
    phong: &ir::Phong,
    counts: &Counts,
    index: usize,
    check: &mut Check<'_>,
) -> Option<Option<Box<Maps>>> {
    let ir::Phong {
        color_map,
        specular_map,
        normal_map,
        bump,
        ..
    } = phong;
    if color_map.is_none() && specular_map.is_none() && normal_map.is_none() && bump.is_none() {
        return Some(None);
    }
    let at = |field| place(Noun::Material, index, field);
    let color = texture(color_map.as_ref(), counts, at(Field::ColorMap), check);
    let specular = texture(specular_map.as_ref(), counts, at(Field::SpecularMap), check);
    let normal = texture(normal_map.as_ref(), counts, at(Field::NormalMap), check);
    let bump = height_field(bump.as_ref(), counts, at(Field::Bump), check);
    Some(Some(Box::new(Maps {
        color: color?,
        specular: specular?,
        normal: normal?,
        bump: bump?,
    })))
}

/// A texture that may be absent: the outer `None` is an error, the inner one absence.
fn texture(
    id: Option<&TextureId>,
    counts: &Counts,
    place: Place,
    check: &mut Check<'_>,
) -> Option<Option<usize>> {
    match id {
        Some(id) => check
            .handle(id.0, counts.textures, "texture", place)
            .map(Some),
        None => Some(None),
    }
}

fn height_field(
    bump: Option<&ir::Bump>,
    counts: &Counts,
    place: Place,
    check: &mut Check<'_>,
) -> Option<Option<Bump>> {
    let Some(ir::Bump {
        texture: id,
        height,
    }) = bump
    else {
        return Some(None);
    };
    let texture = texture(Some(id), counts, place, check);
    let height = check.number(*height, place);
    texture?
        .zip(height)
        .map(|(texture, height)| Some(Bump { texture, height }))
}
