//! The material of glTF 2.0: metallic-roughness with the layers of its extensions.

use super::TextureId;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A texture, and the map from the coordinates of a surface to its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Map {
    /// The texture.
    pub texture: TextureId,
    /// Which set of texture coordinates, 0 or 1.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(max = 1))]
    pub set: u32,
    /// The rows of the affine map from the coordinates of the surface to those of the texture,
    /// `(a, b, c)` for `a·u + b·v + c`; none for the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_from_surface: Option<[[f64; 3]; 2]>,
}

/// The alpha mode: how much of the background a surface covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Alpha {
    /// All of it.
    #[default]
    Opaque,
    /// All where alpha is at least the cutoff, nothing elsewhere.
    Mask(f64),
    /// The fraction alpha.
    Blend,
}

/// The material of glTF 2.0, appendix B, and of the `KHR_materials_*` extensions, by whose names
/// the fields go; a map multiplies its factor, in the channels the specification gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields, default)]
#[expect(
    missing_docs,
    reason = "each is named and described in the specification of glTF"
)]
pub struct Standard {
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    pub base_color: [f64; 4],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_color_map: Option<Map>,
    pub metallic: f64,
    pub roughness: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metallic_roughness_map: Option<Map>,
    /// The reflectance at normal incidence and the glossiness (rgb, a) of
    /// `KHR_materials_pbrSpecularGlossiness`, in place of metallic, roughness and ior.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specular_glossiness: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specular_glossiness_map: Option<Map>,
    /// The radiance, strength included.
    #[serde(skip_serializing_if = "are_zero")]
    pub emissive: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emissive_map: Option<Map>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal_map: Option<Map>,
    #[serde(skip_serializing_if = "is_one")]
    pub normal_scale: f64,
    #[serde(skip_serializing_if = "is_default")]
    pub alpha: Alpha,
    /// Whether the camera sees the back where paths are traced. It sees that of what transmits,
    /// and all other rays meet it.
    #[serde(skip_serializing_if = "is_default")]
    pub double_sided: bool,
    #[serde(skip_serializing_if = "is_default")]
    pub unlit: bool,
    pub ior: f64,
    #[serde(skip_serializing_if = "is_zero")]
    pub dispersion: f64,
    #[serde(skip_serializing_if = "is_one")]
    pub specular: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specular_map: Option<Map>,
    pub specular_color: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub specular_color_map: Option<Map>,
    #[serde(skip_serializing_if = "is_zero")]
    pub transmission: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmission_map: Option<Map>,
    /// Above 0, the surface bounds a volume.
    #[serde(skip_serializing_if = "is_zero")]
    pub thickness: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness_map: Option<Map>,
    /// None for infinite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attenuation_distance: Option<f64>,
    pub attenuation_color: [f64; 3],
    #[serde(skip_serializing_if = "is_zero")]
    pub clearcoat: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearcoat_map: Option<Map>,
    #[serde(skip_serializing_if = "is_zero")]
    pub clearcoat_roughness: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearcoat_roughness_map: Option<Map>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearcoat_normal_map: Option<Map>,
    #[serde(skip_serializing_if = "is_one")]
    pub clearcoat_normal_scale: f64,
    #[serde(skip_serializing_if = "are_zero")]
    pub sheen_color: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheen_color_map: Option<Map>,
    #[serde(skip_serializing_if = "is_zero")]
    pub sheen_roughness: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheen_roughness_map: Option<Map>,
    #[serde(skip_serializing_if = "is_zero")]
    pub anisotropy: f64,
    /// In radians.
    #[serde(skip_serializing_if = "is_zero")]
    pub anisotropy_rotation: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anisotropy_map: Option<Map>,
    #[serde(skip_serializing_if = "is_zero")]
    pub iridescence: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iridescence_map: Option<Map>,
    pub iridescence_ior: f64,
    /// The minimum and the maximum, in nanometres.
    pub iridescence_thickness: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iridescence_thickness_map: Option<Map>,
}

impl Standard {
    /// Whether camera rays skip the back. The back of a transmitting material is never skipped: a
    /// ray may meet it from inside.
    #[must_use]
    pub fn is_seen_from_one_side(&self) -> bool {
        !self.double_sided && self.transmission == 0.0
    }

    /// Every map it has.
    pub fn maps(&self) -> impl Iterator<Item = &Map> {
        [
            &self.base_color_map,
            &self.metallic_roughness_map,
            &self.specular_glossiness_map,
            &self.emissive_map,
            &self.normal_map,
            &self.specular_map,
            &self.specular_color_map,
            &self.transmission_map,
            &self.thickness_map,
            &self.clearcoat_map,
            &self.clearcoat_roughness_map,
            &self.clearcoat_normal_map,
            &self.sheen_color_map,
            &self.sheen_roughness_map,
            &self.anisotropy_map,
            &self.iridescence_map,
            &self.iridescence_thickness_map,
        ]
        .into_iter()
        .flatten()
    }

    /// The same, to be changed.
    pub fn maps_mut(&mut self) -> impl Iterator<Item = &mut Map> {
        [
            &mut self.base_color_map,
            &mut self.metallic_roughness_map,
            &mut self.specular_glossiness_map,
            &mut self.emissive_map,
            &mut self.normal_map,
            &mut self.specular_map,
            &mut self.specular_color_map,
            &mut self.transmission_map,
            &mut self.thickness_map,
            &mut self.clearcoat_map,
            &mut self.clearcoat_roughness_map,
            &mut self.clearcoat_normal_map,
            &mut self.sheen_color_map,
            &mut self.sheen_roughness_map,
            &mut self.anisotropy_map,
            &mut self.iridescence_map,
            &mut self.iridescence_thickness_map,
        ]
        .into_iter()
        .flatten()
    }
}

impl Default for Standard {
    /// The default material of glTF: white, metallic and rough.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_map: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_map: None,
            specular_glossiness: None,
            specular_glossiness_map: None,
            emissive: [0.0; 3],
            emissive_map: None,
            normal_map: None,
            normal_scale: 1.0,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
            ior: 1.5,
            dispersion: 0.0,
            specular: 1.0,
            specular_map: None,
            specular_color: [1.0; 3],
            specular_color_map: None,
            transmission: 0.0,
            transmission_map: None,
            thickness: 0.0,
            thickness_map: None,
            attenuation_distance: None,
            attenuation_color: [1.0; 3],
            clearcoat: 0.0,
            clearcoat_map: None,
            clearcoat_roughness: 0.0,
            clearcoat_roughness_map: None,
            clearcoat_normal_map: None,
            clearcoat_normal_scale: 1.0,
            sheen_color: [0.0; 3],
            sheen_color_map: None,
            sheen_roughness: 0.0,
            sheen_roughness_map: None,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
            anisotropy_map: None,
            iridescence: 0.0,
            iridescence_map: None,
            iridescence_ior: 1.3,
            iridescence_thickness: [100.0, 400.0],
            iridescence_thickness_map: None,
        }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(value: &f64) -> bool {
    value.to_bits() == 0
}

fn are_zero(values: &[f64; 3]) -> bool {
    values.iter().all(is_zero)
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_one(value: &f64) -> bool {
    value.to_bits() == 1.0_f64.to_bits()
}
