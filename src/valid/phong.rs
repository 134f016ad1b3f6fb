//! Validates the Phong model.

use super::check::{Checker, EntityCounts};
use super::texture::TextureId;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{NonNegative, Positive, Vec3};
use std::num::NonZeroU32;

/// The Phong model with reflection and refraction; see [`ir::Phong`] for the formula.
#[derive(Clone, Debug)]
pub struct Phong {
    /// The colour of the surface.
    pub color: Vec3,
    /// The weight of the ambient term.
    pub ka: NonNegative,
    /// The weight of the diffuse term.
    pub kd: NonNegative,
    /// The weight of the highlight.
    pub ks: NonNegative,
    /// The weight of the reflected ray; by default `ks`, times its map.
    pub kr: Option<NonNegative>,
    /// The exponent of the highlight and of the glossy lobe.
    pub n: NonNegative,
    /// The weight of the refracted ray.
    pub kt: NonNegative,
    /// Whether Fresnel's equations divide kt between the reflected and the refracted ray.
    pub fresnel: bool,
    /// The relative index of refraction, inside over outside.
    pub ior: Positive,
    /// The number of rays that sample the glossy lobe.
    pub glossy_samples: NonZeroU32,
    /// The textures, if there are any.
    pub maps: Option<Box<Maps>>,
}

/// Textures of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maps {
    /// The texture of the colour.
    pub color: Option<TextureId>,
    /// The texture whose red channel multiplies ks.
    pub specular: Option<TextureId>,
    /// The normal map.
    pub normal: Option<TextureId>,
    /// The bump map.
    pub bump: Option<Bump>,
}

/// A height field over a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    /// The texture.
    pub texture: TextureId,
    /// The height of white above black, as a fraction of the width of a texel.
    pub height: f64,
}

pub(super) fn phong(
    phong: &ir::Phong,
    index: usize,
    counts: &EntityCounts,
    check: &mut Checker<'_>,
) -> Option<Phong> {
    let ir::Phong {
        color,
        ka,
        kd,
        ks,
        kr,
        n,
        kt,
        fresnel,
        ior,
        glossy_samples,
        color_map,
        specular_map,
        normal_map,
        bump,
    } = phong;
    let at = |field| ValuePath::new(EntityKind::Material, index, field);
    // Coefficients.
    let color = check.color(*color, at(EntityField::Color));
    let ka = check.non_negative(*ka, "ka", at(EntityField::Ka));
    let kd = check.non_negative(*kd, "kd", at(EntityField::Kd));
    let ks = check.non_negative(*ks, "ks", at(EntityField::Ks));
    let kr = check.optional(kr.as_ref(), |check, kr| {
        check.non_negative(*kr, "kr", at(EntityField::Kr))
    });
    let n = check.exponent(*n, at(EntityField::N));
    let kt = check.non_negative(*kt, "refract", at(EntityField::Kt));
    let ior = check.length(
        *ior,
        at(EntityField::Ior),
        &codes::ETA,
        "index of refraction",
    );
    let glossy_samples = check.count(
        *glossy_samples,
        "glossySamples",
        at(EntityField::GlossySamples),
    );
    // Texture maps.
    let mut texture = |id: &Option<ir::TextureId>, field| {
        check.optional(id.as_ref(), |check, id| {
            check.handle(id.0, counts.textures, "texture", at(field))
        })
    };
    let color_map = texture(color_map, EntityField::ColorMap);
    let specular_map = texture(specular_map, EntityField::SpecularMap);
    let normal_map = texture(normal_map, EntityField::NormalMap);
    let bump = check.optional(bump.as_ref(), |check, bump| {
        height_field(bump, counts, at(EntityField::Bump), check)
    });
    let maps = Maps {
        color: color_map?,
        specular: specular_map?,
        normal: normal_map?,
        bump: bump?,
    };
    // All values must be valid.
    Some(Phong {
        color: color?,
        ka: ka?,
        kd: kd?,
        ks: ks?,
        kr: kr?,
        n: n?,
        kt: kt?,
        fresnel: *fresnel,
        ior: ior?,
        glossy_samples: glossy_samples?,
        maps: maps.has_some().then(|| Box::new(maps)),
    })
}

impl Phong {
    /// The weight of the reflected ray where no map scales it, without a part of kt.
    #[must_use]
    pub fn mirror_weight(&self) -> f64 {
        self.kr.unwrap_or(self.ks).get()
    }

    /// The largest weight of the reflected ray where no map scales it.
    #[must_use]
    pub fn most_mirror_weight(&self) -> f64 {
        let part = if self.fresnel { self.kt.get() } else { 0.0 };
        self.mirror_weight() + part
    }
}

fn height_field(
    bump: &ir::Bump,
    counts: &EntityCounts,
    path: ValuePath,
    check: &mut Checker<'_>,
) -> Option<Bump> {
    let ir::Bump { texture, height } = bump;
    let texture = check.handle(texture.0, counts.textures, "texture", path);
    let height = check.number(*height, path);
    Some(Bump {
        texture: texture?,
        height: height?,
    })
}

impl Maps {
    /// Whether there is any texture.
    #[must_use]
    pub fn has_some(&self) -> bool {
        let Self {
            color,
            specular,
            normal,
            bump,
        } = self;
        color.is_some() || specular.is_some() || normal.is_some() || bump.is_some()
    }
}
