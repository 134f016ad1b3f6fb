//! The intermediate representation (IR): a scene whose names, defaults and units are resolved.
//!
//! Every front end lowers its format to a [`Scene`]; passes change it, `valid` checks it, and
//! `plan` and `render` read it. A scene is data only: it knows neither YAML nor glTF, nor the
//! renderer.
//!
//! # Types
//! - [`Scene`] holds one [`Camera`], [`Settings`], a [`Display`], at most one [`Environment`] and
//!   [`Medium`], and lists of [`Light`], [`Image`], [`Texture`], [`Mesh`], [`Material`] and [`Surface`].
//! - A [`Surface`] is a [`Shape`] with a [`MaterialId`]. A [`Material`] refers to textures by
//!   [`TextureId`], a [`Texture`] to its image by [`ImageId`], an [`Instance`] to its mesh by
//!   [`MeshId`].
//! - A [`ValuePath`] addresses one value of a scene: [`EntityKind`], index, [`EntityField`].
//! - [`SourceSpans`] maps value paths to the source spans of the values. It is stored beside the
//!   scene, is never serialised, and is empty for a scene that was not read from text.
//! - [`LoweredScene`] is a scene together with its source spans: what front ends and decoders
//!   return.
//!
//! # Guarantees
//! A scene by itself guarantees nothing: an index may be out of range and a number may be infinite
//! or negative. `valid::validate` checks all of that and returns a `ValidScene`.
//!
//! # Units
//! Lengths are in scene units and angles in radians, except the angles of [`Photometry`], which are
//! in degrees. Colours are linear RGB where 1 is the largest value of a display. The lights and
//! materials of the course use display values; [`Punctual`], [`Environment`] and [`Standard`] use
//! physical units and Rec. 709 primaries.
//!
//! # Serialisation
//! All types derive `Serialize` and `Deserialize`; field names are the keys of the IR document
//! (`schema/ir.md`). `codec` adds the [`VERSION`] and the two encodings.

mod bounds;
mod camera;
mod contains;
mod csg;
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
pub use csg::{Csg, Solid};
pub use display::Display;
pub use environment::Environment;
pub use image::{Image, ImageId, Pixels};
pub use light::{
    EmitterSpelling, Light, Photometry, PointLight, ProjectedTexture, Punctual, PunctualKind,
};
pub use material::{Bump, Material, MaterialId, Phong};
pub use mesh::{Mesh, MeshId};
pub use origin::{EntityField, EntityKind, SourceSpans, ValuePath};
pub use rtc_math::{Medium, SetStep, SharedList, StoredTree, VertexColumn};
pub use settings::{Ambient, Gooch, Mode, PathSettings, Pattern, Settings, StereoView};
pub use shape::*;
pub use standard::{Alpha, Conductor, Map, Standard};
pub use texture::{Filter, Procedural, Sampled, Texture, TextureId, Wrap};

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The version of the IR that this build writes. It reads this version and all older ones.
///
/// A published version never changes; an addition makes a new version (`schema/ir.md`).
pub const VERSION: u32 = 5;

/// One scene: camera, settings, lights, and everything that can be hit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Scene {
    /// The camera.
    pub camera: Camera,
    /// The integrator and its sampling parameters.
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
    /// The surfaces; of two hits at equal distance the earlier surface wins.
    pub surfaces: Vec<Surface>,
    /// The name of each surface, empty if it has none; the list is absent if no surface has a name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub names: Vec<String>,
    /// The environment light, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// The participating medium around the camera, if any. A path is in it until it crosses a
    /// surface whose material names media.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub medium: Option<Medium>,
    /// How values are displayed.
    #[serde(default, skip_serializing_if = "Display::is_plain")]
    pub display: Display,
    /// Hierarchies that were built before. They change no picture, and are neither in the JSON
    /// encoding nor hashed.
    #[serde(skip)]
    #[arbitrary(default)]
    pub trees: Vec<StoredTree>,
}

impl Scene {
    /// An empty scene.
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
            medium: None,
            display: Display::default(),
            trees: Vec::new(),
        }
    }

    /// Whether every material is unlit, so that no light matters; false for an empty scene.
    #[must_use]
    pub fn is_unlit(&self) -> bool {
        let material = |surface: &Surface| self.materials.get(surface.material.0 as usize);
        let is_unlit = |surface: &Surface| match material(surface) {
            Some(Material::Standard(standard)) => standard.unlit,
            _ => false,
        };
        !self.surfaces.is_empty() && self.surfaces.iter().all(is_unlit)
    }
}

/// A scene that a front end or a decoder produced: not yet validated, with its source spans.
#[derive(Clone, Debug)]
pub struct LoweredScene {
    /// The scene. Entities that failed are left out, and the sink has an error for each.
    pub scene: Scene,
    /// The source spans of its values.
    pub source_spans: SourceSpans,
}
