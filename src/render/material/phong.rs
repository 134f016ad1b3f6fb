//! The prepared Phong material: each map contains its image.

use crate::texture::Texture;
use crate::texture::bilinear::Bump;
use rtc_math::{NonNegative, Positive, Vec3};
use std::num::NonZeroU32;

/// A material, prepared.
#[derive(Clone, Debug)]
pub(crate) struct PhongMaterial {
    /// The colour of the surface.
    pub(crate) color: Vec3,
    /// The weight of the ambient term.
    pub(crate) ka: NonNegative,
    /// The weight of the diffuse term.
    pub(crate) kd: NonNegative,
    /// The weight of the highlight.
    pub(crate) ks: NonNegative,
    /// The weight of the reflected ray; by default `ks`, times its map.
    pub(crate) kr: Option<NonNegative>,
    /// The exponent of the highlight and of the glossy lobe.
    pub(crate) n: NonNegative,
    /// The weight of the refracted ray.
    pub(crate) kt: NonNegative,
    /// Whether Fresnel's equations divide kt between the reflected and the refracted ray.
    pub(crate) fresnel: bool,
    /// The index of refraction of the inside over that of the outside.
    pub(crate) eta: Positive,
    /// Rays of the glossy lobe.
    pub(crate) glossy_samples: NonZeroU32,
    /// The textures, if there are any.
    pub(crate) maps: Option<Box<PhongMaps>>,
}

/// The textures of a material.
#[derive(Clone, Debug)]
pub(crate) struct PhongMaps {
    /// The texture that gives the colour.
    pub(crate) color: Option<Texture>,
    /// The texture whose red channel multiplies ks.
    pub(crate) specular: Option<Texture>,
    /// The texture of the shading normal.
    pub(crate) normal: Option<Texture>,
    /// The height field.
    pub(crate) bump: Option<Bump>,
}
