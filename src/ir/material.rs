//! Materials.

use super::{Map, Standard, TextureId};
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a material in [`super::Scene::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct MaterialId(pub u32);

/// A material of either model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Material {
    /// The Phong model with reflection and refraction.
    Phong(Phong),
    /// The metallic-roughness material of glTF.
    Standard(Box<Standard>),
}

impl Material {
    /// The material, if it is a Phong material.
    #[must_use]
    pub fn phong(&self) -> Option<&Phong> {
        match self {
            Self::Phong(phong) => Some(phong),
            Self::Standard(_) => None,
        }
    }

    /// The texture maps, each with the name of its parameter.
    #[must_use]
    pub fn maps(&self) -> Vec<(&'static str, Map)> {
        match self {
            Self::Phong(phong) => {
                let bump = phong.bump.as_ref().map(|bump| bump.texture);
                let maps = [
                    ("colorMap", phong.color_map),
                    ("specularMap", phong.specular_map),
                    ("normalMap", phong.normal_map),
                    ("bumpMap", bump),
                ];
                let maps = maps.into_iter();
                maps.filter_map(|(name, texture)| Some((name, Map::from(texture?))))
                    .collect()
            }
            Self::Standard(standard) => {
                let named = |name: &&'static str| {
                    let map = standard.parameter(name)?.downcast_ref::<Option<Map>>()?;
                    Some((*name, map.clone()?))
                };
                Standard::PARAMETERS.iter().filter_map(named).collect()
            }
        }
    }

    /// The other material of a blend; `None` if it is no blend.
    #[must_use]
    pub fn blend_with(&self) -> Option<MaterialId> {
        match self {
            Self::Phong(_) => None,
            Self::Standard(standard) => standard.blend_with,
        }
    }

    /// Sets the colour of the surface: of a standard material the base colour, whose alpha stays.
    pub fn set_color(&mut self, [r, g, b]: [f64; 3]) {
        match self {
            Self::Phong(phong) => phong.color = [r, g, b],
            Self::Standard(standard) => {
                let [.., alpha] = standard.base_color;
                standard.base_color = [r, g, b, alpha];
            }
        }
    }

    /// The Phong material, mutably.
    pub fn phong_mut(&mut self) -> Option<&mut Phong> {
        match self {
            Self::Phong(phong) => Some(phong),
            Self::Standard(_) => None,
        }
    }
}

impl From<Phong> for Material {
    fn from(phong: Phong) -> Self {
        Self::Phong(phong)
    }
}

impl From<Standard> for Material {
    fn from(standard: Standard) -> Self {
        Self::Standard(Box::new(standard))
    }
}

/// The Phong model: `I = Σ_l c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)^n)] + kr·I(mirror)
/// + kt·I(refracted)`; with [`super::Ambient::Once`] the term ka·C stands before the sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Phong {
    /// C, the colour of the surface, linear RGB, each channel at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
    /// The weight of the ambient term, at least 0.
    #[schemars(range(min = 0.0))]
    pub ka: f64,
    /// The weight of the diffuse term, at least 0.
    #[schemars(range(min = 0.0))]
    pub kd: f64,
    /// The weight of the highlight, at least 0.
    #[schemars(range(min = 0.0))]
    pub ks: f64,
    /// The weight of the reflected ray, at least 0; by default ks, times its map.
    #[schemars(range(min = 0.0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kr: Option<f64>,
    /// The exponent of the highlight and of the glossy lobe, at least 0.
    #[schemars(range(min = 0.0))]
    pub n: f64,
    /// The weight of the refracted ray, at least 0; 0 is opaque.
    #[schemars(range(min = 0.0))]
    pub kt: f64,
    /// Whether kt is divided by Fresnel's equations in the approximation of Schlick ("An
    /// inexpensive BRDF model for physically-based rendering", Eurographics 1994, equation 15):
    /// kt·F(θ) is added to the weight of the reflected ray, and kt·(1 − F(θ)) is that of the
    /// refracted ray.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fresnel: bool,
    /// The relative index of refraction, inside over outside, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(rename = "eta")]
    pub ior: f64,
    /// The number of rays that sample the glossy lobe, at least 1; with 1 the reflection is a
    /// perfect mirror.
    #[schemars(range(min = 1))]
    pub glossy_samples: u32,
    /// The texture that replaces `color` as C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color_map: Option<TextureId>,
    /// The texture whose red channel multiplies ks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular_map: Option<TextureId>,
    /// The normal map, in the tangent space of the surface: (2·rgb − 1), blue along the normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_map: Option<TextureId>,
    /// The bump map: the brightness of a texture is the height of the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bump: Option<Bump>,
}

impl Phong {
    /// The weight of the reflected ray where no map scales it, without a part of kt.
    #[must_use]
    pub fn mirror_weight(&self) -> f64 {
        self.kr.unwrap_or(self.ks)
    }

    /// The largest weight of the reflected ray where no map scales it.
    #[must_use]
    pub fn most_mirror_weight(&self) -> f64 {
        let part = if self.fresnel { self.kt } else { 0.0 };
        self.mirror_weight() + part
    }

    /// Whether a texture is looked up at a point.
    #[must_use]
    pub fn has_texture(&self) -> bool {
        let maps = [self.color_map, self.specular_map, self.normal_map];
        maps.iter().any(Option::is_some) || self.bump.is_some()
    }

    /// A white, opaque, purely diffuse material.
    pub const MATT: Self = Self {
        color: [1.0; 3],
        ka: 0.0,
        kd: 1.0,
        ks: 0.0,
        kr: None,
        n: 1.0,
        kt: 0.0,
        fresnel: false,
        ior: 1.0,
        glossy_samples: 1,
        color_map: None,
        specular_map: None,
        normal_map: None,
        bump: None,
    };
}

impl Default for Phong {
    fn default() -> Self {
        Self::MATT
    }
}

/// Declares a setter for each field; of an optional one it takes the value.
macro_rules! setters {
    ($($field:ident: $type:ty $(=> $wrap:path)?;)*) => {
        /// Setters, one for each field.
        impl Phong {
            $(
                #[doc = concat!("Sets [`", stringify!($field), "`](Self#structfield.",
                    stringify!($field), ").")]
                #[must_use]
                pub fn $field(self, $field: $type) -> Self {
                    Self { $field: $($wrap)? ($field), ..self }
                }
            )*
        }
    };
}

setters! {
    color: [f64; 3];
    ka: f64;
    kd: f64;
    ks: f64;
    kr: f64 => Some;
    n: f64;
    kt: f64;
    fresnel: bool;
    ior: f64;
    glossy_samples: u32;
    color_map: TextureId => Some;
    specular_map: TextureId => Some;
    normal_map: TextureId => Some;
    bump: Bump => Some;
}

/// A height field (Blinn, "Simulation of wrinkled surfaces", SIGGRAPH 1978).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Bump {
    /// The texture; the mean of its channels is the height.
    pub texture: TextureId,
    /// The height of white above black, as a fraction of the width of a texel.
    pub height: f64,
}
