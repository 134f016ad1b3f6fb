//! The material of glTF as a world holds it: no default is asked for at a hit, and each map leads
//! straight to its image.

use crate::math::Vec3;
use crate::render::shape::instance::Asked;
use crate::render::texture::sampled::{Map, UvSets};

/// A material, prepared: what is the same everywhere is a number, what is not has a map.
#[derive(Clone, Debug)]
pub(in crate::render) struct StandardMaterial {
    /// What it needs to know of a surface.
    pub(in crate::render) asked: Asked,
    /// Whether a map that is not of normals says how it scatters light.
    pub(in crate::render) has_shading_map: bool,
    pub(in crate::render) alpha: Alpha,
    /// Whether a ray of the camera goes through the back.
    pub(in crate::render) is_seen_from_one_side: bool,
    pub(in crate::render) is_unlit: bool,
    /// Red, green, blue and alpha.
    pub(in crate::render) base_color: Rgba,
    pub(in crate::render) emission: Tint,
    pub(in crate::render) reflection: Reflection,
    pub(in crate::render) transmission: Number,
    /// The index of refraction, and that of each colour where they differ.
    pub(in crate::render) ior: f64,
    pub(in crate::render) dispersed: Option<[f64; 3]>,
    /// Whether there is a medium behind the surface.
    pub(in crate::render) bounds_a_volume: bool,
    /// The coefficient of absorption of that medium, per unit of length.
    pub(in crate::render) absorption: Vec3,
    pub(in crate::render) normal: Option<NormalMap>,
    pub(in crate::render) clearcoat: Option<ClearcoatLayer>,
    pub(in crate::render) sheen: Option<SheenLayer>,
    pub(in crate::render) anisotropy: Option<AnisotropyLayer>,
    pub(in crate::render) iridescence: Option<IridescenceLayer>,
}

/// How a surface covers what is behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::render) enum Alpha {
    /// All of it.
    Opaque,
    /// Where alpha is at least the number given.
    Mask(f64),
    /// To the fraction alpha.
    Blend,
}

/// A colour and a fourth number times the channels of a map.
#[derive(Clone, Debug)]
pub(in crate::render) struct Rgba {
    pub(in crate::render) factor: [f64; 4],
    pub(in crate::render) map: Option<Map>,
}

/// A number times one channel of a map.
#[derive(Clone, Debug)]
pub(in crate::render) struct Number {
    pub(in crate::render) factor: f64,
    pub(in crate::render) map: Option<(Map, usize)>,
}

/// A colour times that of a map.
#[derive(Clone, Debug)]
pub(in crate::render) struct Tint {
    pub(in crate::render) factor: Vec3,
    pub(in crate::render) map: Option<Map>,
}

/// What of the light is reflected where no layer is in between.
#[derive(Clone, Debug)]
pub(in crate::render) enum Reflection {
    /// That of a metal or a dielectric.
    Metallic {
        /// Roughness and metalness, in the green and the blue channel of their map.
        roughness: f64,
        metallic: f64,
        map: Option<Map>,
        specular: Number,
        specular_color: Tint,
    },
    /// What is given for normal incidence: red, green, blue and glossiness.
    Specular(Rgba),
}

/// What a map shows: the same everywhere, or to be looked up.
#[derive(Clone, Debug)]
pub(in crate::render) enum Source {
    Value([f64; 4]),
    Map(Map),
}

impl Source {
    /// What it shows; `None` on a surface without coordinates.
    pub(in crate::render) fn look_up(&self, uvs: &UvSets) -> Option<[f64; 4]> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Map(map) => map.look_up(uvs),
        }
    }
}

/// A map of shading normals, and by how much they lean.
#[derive(Clone, Debug)]
pub(in crate::render) struct NormalMap {
    pub(in crate::render) map: Source,
    pub(in crate::render) scale: f64,
}

/// A coat.
#[derive(Clone, Debug)]
pub(in crate::render) struct ClearcoatLayer {
    pub(in crate::render) factor: Number,
    pub(in crate::render) roughness: Number,
    pub(in crate::render) normal: Option<NormalMap>,
}

/// A sheen.
#[derive(Clone, Debug)]
pub(in crate::render) struct SheenLayer {
    pub(in crate::render) color: Tint,
    pub(in crate::render) roughness: Number,
}

/// A stretch of highlights.
#[derive(Clone, Debug)]
pub(in crate::render) struct AnisotropyLayer {
    pub(in crate::render) strength: f64,
    /// The cosine and the sine by which the direction is turned.
    pub(in crate::render) turn: [f64; 2],
    /// The direction in red and green, the strength in blue.
    pub(in crate::render) map: Option<Source>,
}

/// A thin film.
#[derive(Clone, Debug)]
pub(in crate::render) struct IridescenceLayer {
    pub(in crate::render) factor: Number,
    pub(in crate::render) ior: f64,
    /// The thickness where the map shows 0, and how much more it is where that shows 1.
    pub(in crate::render) min: f64,
    pub(in crate::render) spread: Number,
}

impl Number {
    /// The number at a point.
    #[inline]
    pub(in crate::render) fn at(&self, uvs: &UvSets) -> f64 {
        match &self.map {
            Some((map, channel)) => self.factor * shown(map, uvs)[*channel],
            None => self.factor,
        }
    }
}

impl Tint {
    /// The colour at a point.
    #[inline]
    pub(in crate::render) fn at(&self, uvs: &UvSets) -> Vec3 {
        match &self.map {
            Some(map) => {
                let [r, g, b, _] = shown(map, uvs);
                self.factor * Vec3::new(r, g, b)
            }
            None => self.factor,
        }
    }
}

impl Rgba {
    /// All four at a point.
    #[inline]
    pub(in crate::render) fn at(&self, uvs: &UvSets) -> [f64; 4] {
        match &self.map {
            Some(map) => {
                let shown = shown(map, uvs);
                [0, 1, 2, 3].map(|channel| self.factor[channel] * shown[channel])
            }
            None => self.factor,
        }
    }
}

/// What a map shows; ones on a surface without coordinates.
#[inline]
pub(in crate::render) fn shown(map: &Map, uvs: &UvSets) -> [f64; 4] {
    map.look_up(uvs).unwrap_or([1.0; 4])
}
