//! The prepared glTF material: defaults are resolved, and each map contains its image.

use crate::bsdf::PlasticBoundary;
use crate::bsdf::standard::*;
use crate::shape::geometry::AttributeRequest;
use crate::texture::sampled::{Map, UvSets};
use crate::world::{MaterialId, MediumId};
use rtc_math::{ComplexIndex, Microfacets, Vec3, Weight};

/// A prepared material: constants are numbers, everything else has a map.
#[derive(Clone, Debug)]
pub(crate) struct StandardMaterial {
    /// The surface details that it needs.
    pub(crate) request: AttributeRequest,
    /// Whether a map other than a normal map changes the BSDF.
    pub(crate) has_shading_map: bool,
    pub(crate) alpha: Alpha,
    /// The factor of the alpha.
    pub(crate) opacity: MappedNumber,
    /// The other material, if it is a blend.
    pub(crate) blend: Option<BlendPart>,
    /// Whether camera rays skip back faces.
    pub(crate) is_seen_from_one_side: bool,
    pub(crate) is_unlit: bool,
    /// Red, green, blue and alpha.
    pub(crate) base_color: Rgba,
    pub(crate) emission: MappedColor,
    pub(crate) reflection: BaseReflectance,
    pub(crate) transmission: MappedNumber,
    /// Whether the factor of the transmission is not 0.
    pub(crate) refracts: bool,
    /// The index of the metal, if it has one.
    pub(crate) conductor: Option<ComplexIndex>,
    /// The distribution of the facets.
    pub(crate) facets: Microfacets,
    /// The boundary of a plastic.
    pub(crate) plastic: Option<PlasticBoundary>,
    /// Whether its back reflects nothing.
    pub(crate) is_black_behind: bool,
    /// The index of refraction, and those of red, green and blue if they differ.
    pub(crate) ior: f64,
    pub(crate) dispersed: Option<[f64; 3]>,
    /// Whether a smooth pane reflects light inside it.
    pub(crate) is_thin_dielectric: bool,
    /// Whether light crosses the surface without a bounce, where a scene names media.
    pub(crate) is_pane: bool,
    /// Whether the surface bounds a medium.
    pub(crate) bounds_a_volume: bool,
    /// The absorption coefficient of that medium, per unit of length.
    pub(crate) absorption: Vec3,
    /// The participating media on both sides of the surface, if it bounds any.
    pub(crate) media: Option<MediumInterface>,
    pub(crate) normal: Option<NormalMap>,
    pub(crate) bump: Option<BumpMap>,
    pub(crate) sheen: Option<SheenLayer>,
    pub(crate) diffuse_transmission: Option<DiffuseTransmissionLayer>,
    pub(crate) clearcoat: Option<ClearcoatLayer>,
    pub(crate) anisotropy: Option<AnisotropyLayer>,
    pub(crate) iridescence: Option<IridescenceLayer>,
}

impl StandardMaterial {
    /// The index of refraction, at a wavelength that a dispersed path picked; 0 for an infinite
    /// one.
    pub(crate) fn ior_at(&self, channel: Option<usize>) -> f64 {
        match (&self.reflection, channel, self.dispersed) {
            (BaseReflectance::Specular(_), ..) => 0.0,
            (_, Some(channel), Some(dispersed)) => dispersed[channel],
            (_, Some(_), None) | (_, None, _) => self.ior,
        }
    }

    /// The index by which light that crosses the surface is refracted; 1 if it is not.
    pub(crate) fn refractive_index(&self, channel: Option<usize>) -> f64 {
        let ior = self.ior_at(channel);
        if self.refracts && ior > 0.0 { ior } else { 1.0 }
    }
}

/// The other material of a blend.
#[derive(Clone, Debug)]
pub(crate) struct BlendPart {
    /// Its index, below that of the blend.
    pub(crate) other: MaterialId,
    /// The probability that it takes the place of the first one.
    pub(crate) weight: MappedNumber,
}

/// The participating media that a surface separates; `None` is a vacuum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MediumInterface {
    pub(crate) interior: Option<MediumId>,
    /// On the side of the geometric normal.
    pub(crate) exterior: Option<MediumId>,
}

/// The opacity of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Alpha {
    /// Opaque.
    Opaque,
    /// Opaque where alpha is at least this cutoff.
    Mask(f64),
    /// Opaque with the probability alpha.
    Blend,
}

/// A colour and a fourth number times the channels of a map.
#[derive(Clone, Debug)]
pub(crate) struct Rgba {
    pub(crate) factor: [f64; 4],
    pub(crate) map: Option<Map>,
}

/// A number times one channel of a map.
#[derive(Clone, Debug)]
pub(crate) struct MappedNumber {
    pub(crate) factor: f64,
    pub(crate) map: Option<(Map, usize)>,
}

/// A colour times that of a map.
#[derive(Clone, Debug)]
pub(crate) struct MappedColor {
    pub(crate) factor: Vec3,
    pub(crate) map: Option<Map>,
}

/// The reflectance below all layers.
#[derive(Clone, Debug)]
pub(crate) enum BaseReflectance {
    /// Of a metal or a dielectric.
    Metallic {
        /// Roughness and metalness, in the green and the blue channel of their map.
        roughness: f64,
        metallic: f64,
        map: Option<Map>,
        specular: MappedNumber,
        specular_color: MappedColor,
    },
    /// Given for normal incidence: red, green, blue and glossiness.
    Specular(Rgba),
}

/// The values of a map: a constant, or an image.
#[derive(Clone, Debug)]
pub(crate) enum MapSource {
    Value([f64; 4]),
    Map(Map),
}

impl MapSource {
    /// Looks the map up; `None` on a surface without texture coordinates.
    pub(crate) fn look_up(&self, uvs: &UvSets) -> Option<[f64; 4]> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Map(map) => map.look_up(uvs),
        }
    }
}

/// A normal map, and the scale of its slopes.
#[derive(Clone, Debug)]
pub(crate) struct NormalMap {
    pub(crate) map: MapSource,
    pub(crate) scale: f64,
}

/// A height field: the red of a map times a scale, in scene units.
#[derive(Clone, Debug)]
pub(crate) struct BumpMap {
    pub(crate) map: Map,
    pub(crate) scale: f64,
}

/// The clearcoat layer.
#[derive(Clone, Debug)]
pub(crate) struct ClearcoatLayer {
    pub(crate) factor: MappedNumber,
    pub(crate) roughness: MappedNumber,
    pub(crate) normal: Option<NormalMap>,
}

/// The sheen.
#[derive(Clone, Debug)]
pub(crate) struct SheenLayer {
    pub(crate) color: MappedColor,
    pub(crate) roughness: MappedNumber,
}

impl SheenLayer {
    /// The layer at a point; `None` where its map is 0.
    #[inline]
    pub(crate) fn at(&self, uvs: &UvSets) -> Option<Sheen> {
        let sheen = Sheen {
            color: self.color.at(uvs),
            roughness: self.roughness.at(uvs),
        };
        sheen.color.is_nonzero().then_some(sheen)
    }
}

/// The diffuse transmission.
#[derive(Clone, Debug)]
pub(crate) struct DiffuseTransmissionLayer {
    pub(crate) factor: MappedNumber,
    pub(crate) color: MappedColor,
}

impl DiffuseTransmissionLayer {
    /// The layer at a point; `None` where its map is 0.
    #[inline]
    pub(crate) fn at(&self, uvs: &UvSets) -> Option<DiffuseTransmission> {
        let transmission = DiffuseTransmission {
            factor: self.factor.at(uvs),
            color: self.color.at(uvs),
        };
        transmission.factor.is_nonzero().then_some(transmission)
    }
}

/// The anisotropy of the highlights.
#[derive(Clone, Debug)]
pub(crate) struct AnisotropyLayer {
    pub(crate) strength: f64,
    /// Cosine and sine of the rotation of the direction.
    pub(crate) turn: [f64; 2],
    /// The direction in red and green, the strength in blue.
    pub(crate) map: Option<MapSource>,
}

/// The thin film.
#[derive(Clone, Debug)]
pub(crate) struct IridescenceLayer {
    pub(crate) factor: MappedNumber,
    pub(crate) ior: f64,
    /// The thickness where the map is 0, and the increase to where the map is 1.
    pub(crate) min: f64,
    pub(crate) spread: MappedNumber,
}

impl MappedNumber {
    /// The number at a point.
    #[inline]
    pub(crate) fn at(&self, uvs: &UvSets) -> f64 {
        match &self.map {
            Some((map, channel)) => self.factor * shown(map, uvs)[*channel],
            None => self.factor,
        }
    }
}

impl MappedColor {
    /// The colour at a point.
    #[inline]
    pub(crate) fn at(&self, uvs: &UvSets) -> Vec3 {
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
    pub(crate) fn at(&self, uvs: &UvSets) -> [f64; 4] {
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
pub(crate) fn shown(map: &Map, uvs: &UvSets) -> [f64; 4] {
    map.look_up(uvs).unwrap_or([1.0; 4])
}
