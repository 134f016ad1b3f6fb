//! The intermediate representation: a scene with names gone, defaults filled and units resolved.
//!
//! It holds numbers as stored, in or out of range: the room `valid` proves them. It knows neither
//! YAML nor glTF, nor the renderer. Lengths are in scene units, colours are linear display values
//! per channel (red, green, blue), where 1 is the full byte. Surfaces refer to materials by index;
//! where each value was written is kept beside the scene, in [`SourceSpans`], and is not part of it.

mod bounds;
mod camera;
mod display;
mod environment;
mod image;
mod light;
mod material;
mod mesh;
mod origin;
mod settings;
mod shape;
mod standard;
mod texture;

pub use bounds::BoundingSphere;
pub use camera::{Camera, Lens, Projection};
pub use display::Display;
pub use environment::Environment;
pub use image::{Image, ImageId, Pixels};
pub use light::{Emitter, Light, Photometry, PointLight, Punctual, Spelling};
pub use material::{Bump, Material, MaterialId, Phong};
pub use mesh::{Mesh, MeshId};
pub use origin::{EntityKind, Field, SourceSpans, ValuePath};
pub use rtc_math::{Column, Shared};
pub use settings::{Ambient, Gooch, Mode, PathSettings, Pattern, Settings};
pub use shape::*;
pub use standard::{Alpha, Map, Standard};
pub use texture::{Filter, Sampled, Texture, TextureId, Wrap};

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The version of the representation that this build writes. It reads this one and every older one.
///
/// A closed version is never changed: what is added is a new one (`schema/ir.md`).
pub const VERSION: u32 = 5;

/// One scene: what the camera sees, by which rules, and all there is to see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Scene {
    /// Where rays start and which way they go.
    pub camera: Camera,
    /// By which rules the picture is made.
    pub settings: Settings,
    /// The lights, in the order in which their terms are summed.
    pub lights: Vec<Light>,
    /// The images, referred to by index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub images: Vec<Image>,
    /// The textures, referred to by index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub textures: Vec<Texture>,
    /// The meshes, referred to by index.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub meshes: Vec<Mesh>,
    /// The materials, referred to by index.
    pub materials: Vec<Material>,
    /// The surfaces; at equal distance the earlier one is seen.
    pub surfaces: Vec<Surface>,
    /// The name of each surface, empty where it has none; no list if none has one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<String>,
    /// What surrounds it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// How its values are shown.
    #[serde(default, skip_serializing_if = "Display::is_plain")]
    pub display: Display,
}

impl Scene {
    /// A scene of nothing.
    #[must_use]
    pub fn new(camera: Camera, settings: Settings) -> Self {
        Self {
            camera,
            settings,
            lights: Vec::new(),
            images: Vec::new(),
            textures: Vec::new(),
            meshes: Vec::new(),
            materials: Vec::new(),
            surfaces: Vec::new(),
            names: Vec::new(),
            environment: None,
            display: Display::default(),
        }
    }

    /// Whether no light changes what its surfaces show: all are unlit, and there are some.
    #[must_use]
    pub fn is_unlit(&self) -> bool {
        let material = |surface: &Surface| self.materials.get(surface.material.0 as usize);
        let is_unlit = |surface: &Surface| matches!(material(surface), Some(Material::Standard(standard)) if standard.unlit);
        !self.surfaces.is_empty() && self.surfaces.iter().all(is_unlit)
    }
}

/// A scene as a front end or a decoder leaves it: not yet proven, with the places of its values
/// beside it.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// The scene; entities that failed are left out, and the sink has an error for each.
    pub scene: Scene,
    /// Where its values were written.
    pub source_spans: SourceSpans,
}
