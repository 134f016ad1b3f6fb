//! The materials.

use super::{Standard, TextureId};
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The index of a material in [`super::Scene::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(transparent)]
pub struct MaterialId(pub u32);

/// A material of any family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Material {
    /// Phong's model with mirror and refraction.
    Phong(Phong),
    /// The material of glTF.
    Standard(Box<Standard>),
}

impl Material {
    /// The material, if it is Phong's.
    #[must_use]
    pub fn phong(&self) -> Option<&Phong> {
        match self {
            Self::Phong(phong) => Some(phong),
            Self::Standard(_) => None,
        }
    }

    /// The material to change, if it is Phong's.
    pub fn phong_mut(&mut self) -> Option<&mut Phong> {
        match self {
            Self::Phong(phong) => Some(phong),
            Self::Standard(_) => None,
        }
    }
}

/// Phong's model: `I = Σ_l c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)^n)] + ks·I(mirror) +
/// kt·I(refracted)`; with [`super::Ambient::Once`] the term ka·C stands before the sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Phong {
    /// C, the colour of the surface, each channel at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
    /// The weight of the ambient term, at least 0.
    #[schemars(range(min = 0.0))]
    pub ka: f64,
    /// The weight of the diffuse term, at least 0.
    #[schemars(range(min = 0.0))]
    pub kd: f64,
    /// The weight of the highlight and of the mirror ray, at least 0.
    #[schemars(range(min = 0.0))]
    pub ks: f64,
    /// The exponent of the highlight and of the glossy lobe, at least 0.
    #[schemars(range(min = 0.0))]
    pub n: f64,
    /// The weight of the refracted ray, at least 0; 0 is opaque.
    #[schemars(range(min = 0.0))]
    pub kt: f64,
    /// The index of refraction of the inside over that of the outside, above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub eta: f64,
    /// How many rays sample the glossy lobe, at least 1; 1 is the mirror.
    #[schemars(range(min = 1))]
    pub glossy_samples: u32,
    /// The texture that gives C in place of `color`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color_map: Option<TextureId>,
    /// The texture whose red channel multiplies ks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular_map: Option<TextureId>,
    /// The texture that gives the shading normal in the frame of the surface: (2·rgb − 1), blue
    /// along the normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_map: Option<TextureId>,
    /// The texture whose brightness is the height of the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bump: Option<Bump>,
}

impl Phong {
    /// White, matt and opaque, without ambient light.
    pub const MATT: Self = Self {
        color: [1.0; 3],
        ka: 0.0,
        kd: 1.0,
        ks: 0.0,
        n: 1.0,
        kt: 0.0,
        eta: 1.0,
        glossy_samples: 1,
        color_map: None,
        specular_map: None,
        normal_map: None,
        bump: None,
    };
}

/// A height field (Blinn, "Simulation of wrinkled surfaces", SIGGRAPH 1978).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Bump {
    /// The texture; the mean of its channels is the height.
    pub texture: TextureId,
    /// The height of white above black, as a share of the width of a texel.
    pub height: f64,
}
