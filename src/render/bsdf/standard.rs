//! The parameters of the glTF material at one point, after all texture lookups.

use super::fresnel::normal_reflectance;
use super::plastic::PlasticBoundary;
use rtc_math::{ComplexIndex, Microfacets, Vec3};
use rtc_plan::Layer;

/// The material of glTF 2.0 and its KHR extensions at one point, but for emission, alpha and the
/// volume inside.
///
/// Colours are linear, fractions and roughnesses in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardParameters<'world> {
    /// Albedo of the diffuse, reflectance of the metallic, tint of the transmitting part.
    pub base_color: Vec3,
    /// The metallic fraction.
    pub metallic: f64,
    /// Perceptual roughness; α is its square.
    pub roughness: f64,
    /// The index of refraction inside, at least 1, or 0 for an infinite one (`KHR_materials_ior`).
    pub ior: f64,
    /// The index of the metallic part, whose base colour then is a factor.
    pub conductor: Option<ComplexIndex>,
    /// The distribution of the facets.
    pub facets: Microfacets,
    /// The boundary above the diffuse base, of a plastic.
    pub plastic: Option<&'world PlasticBoundary>,
    /// The strength of the dielectric reflection (`KHR_materials_specular`).
    pub specular: f64,
    /// The colour of the dielectric reflection at normal incidence, each channel at least 0.
    pub specular_color: Vec3,
    /// The fraction of the dielectric base that lets light through instead of scattering it
    /// (`KHR_materials_transmission`).
    pub transmission: f64,
    /// Whether the surface is a thin wall without an inside: light crosses it without refraction.
    pub thin_walled: bool,
    /// Whether a smooth thin wall is a pane that reflects light inside it.
    pub has_two_faces: bool,
    /// A direction in which the reflection is stretched.
    pub anisotropy: Option<Anisotropy>,
    /// A clear layer on top.
    pub clearcoat: Option<Clearcoat>,
    /// The sheen of cloth.
    pub sheen: Option<Sheen>,
    /// A thin film on top.
    pub iridescence: Option<Iridescence>,
    /// The part of the diffuse light that leaves on the other side.
    pub diffuse_transmission: Option<DiffuseTransmission>,
    /// Whether multiple bounces between microfacets are added; glTF's appendix B omits them.
    pub multiple_scattering: bool,
}

/// `KHR_materials_anisotropy`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anisotropy {
    /// The growth of the roughness along the direction towards 1.
    pub strength: f64,
    /// The unit vector of the direction in x and y.
    pub direction: [f64; 2],
}

/// `KHR_materials_clearcoat`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearcoat {
    /// How much of the surface it covers.
    pub factor: f64,
    /// Its roughness.
    pub roughness: f64,
    /// Its own unit normal.
    pub normal: Vec3,
}

/// `KHR_materials_sheen`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheen {
    /// Its colour.
    pub color: Vec3,
    /// Its roughness.
    pub roughness: f64,
}

/// `KHR_materials_iridescence`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// How much of the surface the film covers.
    pub factor: f64,
    /// The index of refraction of the film, at least 1.
    pub ior: f64,
    /// The thickness of the film in nanometres.
    pub thickness: f64,
}

/// `KHR_materials_diffuse_transmission`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// The fraction of the diffuse light that is transmitted instead of reflected.
    pub factor: f64,
    /// The albedo of the transmitted part.
    pub color: Vec3,
}

impl Default for StandardParameters<'_> {
    /// The defaults of glTF, but for the metal: white and rough, of glass's index.
    fn default() -> Self {
        Self {
            base_color: Vec3::ONE,
            metallic: 0.0,
            roughness: 1.0,
            ior: 1.5,
            conductor: None,
            facets: Microfacets::Ggx,
            plastic: None,
            specular: 1.0,
            specular_color: Vec3::ONE,
            transmission: 0.0,
            thin_walled: true,
            has_two_faces: false,
            anisotropy: None,
            clearcoat: None,
            sheen: None,
            iridescence: None,
            diffuse_transmission: None,
            multiple_scattering: true,
        }
    }
}

impl StandardParameters<'_> {
    /// The fraction of the surface that is dielectric and transmits.
    #[must_use]
    #[inline]
    pub(super) fn transmitting(&self) -> f64 {
        (1.0 - self.metallic) * self.transmission
    }

    /// The reflectance of the dielectric part at normal incidence.
    #[must_use]
    pub(super) fn dielectric_f0(&self) -> Vec3 {
        (self.specular_color * normal_reflectance(self.ior)).min(Vec3::ONE) * self.specular
    }

    /// Each layer, and whether the material has it here.
    #[inline]
    pub(crate) fn layers(&self) -> [(Layer, bool); Layer::ALL.len()] {
        [
            (Layer::Clearcoat, self.clearcoat.is_some()),
            (Layer::Sheen, self.sheen.is_some()),
            (Layer::Anisotropy, self.anisotropy.is_some()),
            (Layer::Iridescence, self.iridescence.is_some()),
            (
                Layer::DiffuseTransmission,
                self.diffuse_transmission.is_some(),
            ),
        ]
    }
}
