//! The glTF material, prepared: defaults are resolved, and each map holds its image.

use crate::math::{Vec3, Weight};
use crate::render::bsdf::standard::*;
use crate::render::shape::geometry::Asked;
use crate::render::texture::sampled::{Map, UvSets};

/// A prepared material: constants are numbers, everything else has a map.
#[derive(Clone, Debug)]
pub(in crate::render) struct StandardMaterial {
    /// The surface details that it needs.
    pub(in crate::render) asked: Asked,
    /// Whether a map other than a normal map changes the BSDF.
    pub(in crate::render) has_shading_map: bool,
    pub(in crate::render) alpha: Alpha,
    /// Whether camera rays skip back faces.
    pub(in crate::render) is_seen_from_one_side: bool,
    pub(in crate::render) is_unlit: bool,
    /// Red, green, blue and alpha.
    pub(in crate::render) base_color: Rgba,
    pub(in crate::render) emission: Tint,
    pub(in crate::render) reflection: Reflection,
    pub(in crate::render) transmission: Number,
    /// The index of refraction, and those of red, green and blue if they differ.
    pub(in crate::render) ior: f64,
    pub(in crate::render) dispersed: Option<[f64; 3]>,
    /// Whether the surface bounds a medium.
    pub(in crate::render) bounds_a_volume: bool,
    /// The absorption coefficient of that medium, per unit of length.
    pub(in crate::render) absorption: Vec3,
    pub(in crate::render) normal: Option<NormalMap>,
    pub(in crate::render) plain: PlainLayers,
    pub(in crate::render) clearcoat: Option<ClearcoatLayer>,
    pub(in crate::render) anisotropy: Option<AnisotropyLayer>,
    pub(in crate::render) iridescence: Option<IridescenceLayer>,
}

/// The opacity of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::render) enum Alpha {
    /// Opaque.
    Opaque,
    /// Opaque where alpha is at least this cutoff.
    Mask(f64),
    /// Opaque with the probability alpha.
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

/// The reflectance below all layers.
#[derive(Clone, Debug)]
pub(in crate::render) enum Reflection {
    /// Of a metal or a dielectric.
    Metallic {
        /// Roughness and metalness, in the green and the blue channel of their map.
        roughness: f64,
        metallic: f64,
        map: Option<Map>,
        specular: Number,
        specular_color: Tint,
    },
    /// Given for normal incidence: red, green, blue and glossiness.
    Specular(Rgba),
}

/// The values of a map: a constant, or an image.
#[derive(Clone, Debug)]
pub(in crate::render) enum MapSource {
    Value([f64; 4]),
    Map(Map),
}

impl MapSource {
    /// Looks the map up; `None` on a surface without texture coordinates.
    pub(in crate::render) fn look_up(&self, uvs: &UvSets) -> Option<[f64; 4]> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Map(map) => map.look_up(uvs),
        }
    }
}

/// A normal map, and the scale of its slopes.
#[derive(Clone, Debug)]
pub(in crate::render) struct NormalMap {
    pub(in crate::render) map: MapSource,
    pub(in crate::render) scale: f64,
}

/// The clearcoat layer.
#[derive(Clone, Debug)]
pub(in crate::render) struct ClearcoatLayer {
    pub(in crate::render) factor: Number,
    pub(in crate::render) roughness: Number,
    pub(in crate::render) normal: Option<NormalMap>,
}

/// The prepared part of a layer, of a kind of the table.
macro_rules! prepared {
    (number) => {
        Number
    };
    (tint) => {
        Tint
    };
}

/// The layers of the table that are made of numbers and colours alone.
macro_rules! plain_layers {
    ($($layer:ident: $prepared:ident => $parameters:ident {
        $weight:ident: $weight_kind:ident($($of_weight:tt)*);
        $($part:ident: $kind:ident($($of:tt)*);)*
    })*) => {
        /// The layers whose parts are numbers and colours times maps.
        #[derive(Clone, Debug)]
        pub(in crate::render) struct PlainLayers {
            $(pub(in crate::render) $layer: Option<$prepared>,)*
        }

        impl PlainLayers {
            /// Adds them to the parameters at a point.
            #[inline]
            pub(in crate::render) fn add(&self, standard: &mut StandardParameters, uvs: &UvSets) {
                $(standard.$layer = self.$layer.as_ref().and_then(|layer| layer.at(uvs));)*
            }
        }

        $(
            #[derive(Clone, Debug)]
            pub(in crate::render) struct $prepared {
                pub(in crate::render) $weight: prepared!($weight_kind),
                $(pub(in crate::render) $part: prepared!($kind),)*
            }

            impl $prepared {
                /// The layer at a point; `None` where its map is 0.
                #[inline]
                fn at(&self, uvs: &UvSets) -> Option<$parameters> {
                    let layer = $parameters {
                        $weight: self.$weight.at(uvs),
                        $($part: self.$part.at(uvs),)*
                    };
                    layer.$weight.weighs().then_some(layer)
                }
            }
        )*
    };
}

crate::standard::plain_layers!(plain_layers);

/// The anisotropy of the highlights.
#[derive(Clone, Debug)]
pub(in crate::render) struct AnisotropyLayer {
    pub(in crate::render) strength: f64,
    /// Cosine and sine of the rotation of the direction.
    pub(in crate::render) turn: [f64; 2],
    /// The direction in red and green, the strength in blue.
    pub(in crate::render) map: Option<MapSource>,
}

/// The thin film.
#[derive(Clone, Debug)]
pub(in crate::render) struct IridescenceLayer {
    pub(in crate::render) factor: Number,
    pub(in crate::render) ior: f64,
    /// The thickness where the map is 0, and the increase to where the map is 1.
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

/// Looks a map up; ones on a surface without texture coordinates.
#[inline]
pub(in crate::render) fn shown(map: &Map, uvs: &UvSets) -> [f64; 4] {
    map.look_up(uvs).unwrap_or([1.0; 4])
}
