//! Phong's material, prepared: each map holds its image.

use crate::math::{NonNegative, Positive, Vec3};
use crate::render::texture::Texture;
use crate::render::texture::bilinear::Bump;
use std::num::NonZeroU32;

/// A material, prepared.
#[derive(Clone, Debug)]
pub(in crate::render) struct PhongMaterial {
    /// The colour of the surface.
    pub(in crate::render) color: Vec3,
    /// The weight of the ambient term.
    pub(in crate::render) ka: NonNegative,
    /// The weight of the diffuse term.
    pub(in crate::render) kd: NonNegative,
    /// The weight of the highlight and of the mirror ray.
    pub(in crate::render) ks: NonNegative,
    /// The exponent of the highlight and of the glossy lobe.
    pub(in crate::render) n: NonNegative,
    /// The weight of the refracted ray.
    pub(in crate::render) kt: NonNegative,
    /// The index of refraction of the inside over that of the outside.
    pub(in crate::render) eta: Positive,
    /// Rays of the glossy lobe.
    pub(in crate::render) glossy_samples: NonZeroU32,
    /// The textures, if there are any.
    pub(in crate::render) maps: Option<Box<PhongMaps>>,
}

/// The textures of a material.
#[derive(Clone, Debug)]
pub(in crate::render) struct PhongMaps {
    /// The texture that gives the colour.
    pub(in crate::render) color: Option<Texture>,
    /// The texture whose red channel multiplies ks.
    pub(in crate::render) specular: Option<Texture>,
    /// The texture of the shading normal.
    pub(in crate::render) normal: Option<Texture>,
    /// The height field.
    pub(in crate::render) bump: Option<Bump>,
}
