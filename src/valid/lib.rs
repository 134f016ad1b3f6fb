//! Validates a scene: [`validate`] is the only way to make a [`ValidScene`], in which every number
//! is in range.
//!
//! # Overview
//! - [`validate`] takes an `ir::Scene` and its source spans, reports every error to the sink, and
//!   returns a [`ValidScene`] if there is none.
//! - [`ValidScene`] has its own types for each kind of entity, with the same names as in the IR:
//!   [`Camera`], [`Settings`], [`Light`], [`Image`], [`Texture`], [`Mesh`], [`Material`],
//!   [`Surface`]. Their fields have types that state the range, such as `Positive` and
//!   `UnitInterval`.
//! - Each kind of entity has a file, which destructures the IR type completely: a new field does
//!   not compile until it is checked.
//! - Lints (`lint`, `inside`) warn about values that are valid but probably unintended.
//!
//! # Guarantees
//! - Indices are in range, numbers finite and in range, directions nonzero, camera axes
//!   perpendicular, and faces have an area (those without are dropped with a warning).
//! - Code that receives a [`ValidScene`] needs no further checks and can't fail.
//! - All checks of the IR are here, so an invalid IR file is rejected like an invalid text. This
//!   package does not know where a scene came from: it looks up spans in [`SourceSpans`], and every
//!   diagnostic has a JSON pointer into the IR.

mod camera;
mod check;
mod environment;
mod image;
mod inside;
mod light;
mod lint;
mod material;
mod medium;
mod mesh;
mod phong;
mod settings;
mod shape;
mod standard;
mod texture;

pub use camera::{Camera, Lens, Projection, Stereo};
pub use check::{LARGEST, ValidationOptions};
pub use environment::Environment;
pub use image::{Image, ImageId};
pub use light::{
    CourseLight, CourseLightId, DirectionalLight, Falloff, Light, PointLight, ProjectedTexture,
    Punctual, PunctualId,
};
pub use material::{Material, MaterialId};
pub use mesh::{MAX_MESH_TRIANGLES, Mesh, MeshId};
pub use phong::{Bump, Maps, Phong};
pub use settings::{Ambient, Gooch, Mode, PathSettings, Pattern, Settings};
pub use shape::*;
pub use standard::{Alpha, Standard};
pub use texture::{Filter, Map, Sampled, Texture, TextureId, UvSet, Wrap};

use check::{Checker, EntityCounts};
use inside::Solids;
use rtc_diag::DiagnosticSink;
use rtc_ir::{self as ir, EntityField, EntityKind, SourceSpans, ValuePath};
use rtc_math::{IdTable, Medium, StoredTree, UnitInterval, Vec3};
use std::sync::Arc;

/// A valid scene: indices in range, numbers finite and in range, camera axes perpendicular,
/// triangles with an area.
#[derive(Clone, Debug)]
pub struct ValidScene {
    camera: Camera,
    settings: Settings,
    lights: Vec<Light>,
    environment: Environment,
    medium: Option<Medium>,
    images: IdTable<Image>,
    textures: IdTable<Texture>,
    meshes: IdTable<Mesh, Arc<Mesh>>,
    materials: IdTable<Material>,
    surfaces: Vec<Surface>,
    trees: Vec<StoredTree>,
}

impl ValidScene {
    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The lights, in the order of the scene.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The environment.
    #[must_use]
    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// The medium around the camera.
    #[must_use]
    pub fn medium(&self) -> Option<Medium> {
        self.medium
    }

    /// The images.
    #[must_use]
    pub fn images(&self) -> &IdTable<Image> {
        &self.images
    }

    /// The textures.
    #[must_use]
    pub fn textures(&self) -> &IdTable<Texture> {
        &self.textures
    }

    /// The meshes.
    #[must_use]
    pub fn meshes(&self) -> &IdTable<Mesh, Arc<Mesh>> {
        &self.meshes
    }

    /// A material, and those that light meets in its place where it is a blend.
    pub fn blended(&self, material: MaterialId) -> impl Iterator<Item = MaterialId> {
        std::iter::successors(Some(material), |part| match &self.materials[*part] {
            Material::Standard(part) if part.blend_weight > UnitInterval::ZERO => part.blend_with,
            Material::Standard(_) | Material::Phong(_) => None,
        })
    }

    /// The materials.
    #[must_use]
    pub fn materials(&self) -> &IdTable<Material> {
        &self.materials
    }

    /// The surfaces, without faces that have no area.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Hierarchies that were built before, of which nothing is checked.
    #[must_use]
    pub fn trees(&self) -> &[StoredTree] {
        &self.trees
    }
}

impl ValidScene {
    /// Whether a surface moves while the shutter is open.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.surfaces
            .iter()
            .any(|surface| surface.sweep != Vec3::ZERO)
    }

    /// The scene at a moment, from 0, when the shutter opens, to 1, when it closes.
    #[must_use]
    pub fn at(&self, moment: f64) -> Self {
        let surfaces = self.surfaces.iter().map(|surface| Surface {
            shape: surface.shape.clone().moved(surface.sweep * moment),
            ..surface.clone()
        });
        Self {
            surfaces: surfaces.collect(),
            ..self.clone()
        }
    }
}

impl ValidScene {
    /// The same scene with another camera of the same image size; `None` if that camera is invalid.
    #[must_use]
    pub fn seen_by(&self, camera: &ir::Camera) -> Option<Self> {
        let (source_spans, mut sink) = (SourceSpans::default(), DiagnosticSink::default());
        let mut check = Checker::new(&source_spans, &mut sink);
        let stereo = match self.camera.projection {
            Projection::Stereo(stereo) => stereo,
            Projection::Perspective | Projection::Orthographic => Stereo {
                distance: 0.0,
                is_anaglyph: false,
            },
        };
        let camera = camera::camera(camera, stereo, &mut check)?;
        let is_as_large = (camera.width, camera.height) == (self.camera.width, self.camera.height);
        (check.is_clean() && is_as_large).then(|| Self {
            camera,
            ..self.clone()
        })
    }
}

/// Validates a scene that was valid before and whose camera or settings were changed to valid
/// values.
///
/// # Panics
/// If the scene is invalid.
#[must_use]
pub fn revalidate(scene: &ir::Scene) -> ValidScene {
    let options = ValidationOptions {
        limits: rtc_source::Limits::NONE,
    };
    let valid_scene = validate(
        scene,
        &SourceSpans::default(),
        &options,
        &mut DiagnosticSink::default(),
    );
    valid_scene.expect("the scene was valid before, and the changes are valid")
}

/// Validates the scene and reports all errors to the sink, not only the first.
///
/// Returns `None` if and only if this call reported an error.
pub fn validate(
    scene: &ir::Scene,
    source_spans: &SourceSpans,
    options: &ValidationOptions,
    sink: &mut DiagnosticSink,
) -> Option<ValidScene> {
    let ir::Scene {
        camera,
        settings,
        lights,
        images,
        textures,
        meshes,
        materials,
        surfaces,
        names: _,
        environment,
        medium,
        display,
        trees,
    } = scene;
    // Validate each kind of entity; all errors are reported.
    let mut check = Checker::new(source_spans, sink);
    let valid_camera = camera::camera(camera, Stereo::of(settings), &mut check);
    let valid_settings = settings::settings(settings, &mut check);
    settings::display(display, &mut check);
    let valid_environment =
        environment::environment(environment.as_ref(), images.len(), &mut check);
    let valid_medium = check.optional(medium.as_ref(), |check, medium| {
        let at = ValuePath::new(EntityKind::Medium, 0, EntityField::Whole);
        medium::medium(medium, at, check)
    });
    let valid_images = check.all(images, image::image);
    let valid_textures = check.all(textures, |texture, index, check| {
        texture::texture(texture, index, images.len(), check)
    });
    let valid_meshes = check.all(meshes, mesh::mesh);
    let counts = EntityCounts {
        textures: textures.len(),
        meshes: meshes.len(),
        materials: materials.len(),
        shutter: settings.shutter,
    };
    let valid_lights = check.all(lights, |light, index, check| {
        light::light(light, index, &counts, check)
    });
    let valid_materials = check.all(materials, |material, index, check| {
        material::material(material, index, &counts, check)
    });
    material::blends(materials, &mut check);
    let valid_surfaces = check.all(surfaces, |surface, index, check| {
        shape::surface(surface, index, &counts, check)
    });
    // Check the limits.
    settings::budget(scene, options, &mut check);
    // Assemble the scene if nothing is missing.
    let valid = ValidScene {
        camera: valid_camera?,
        settings: valid_settings?,
        lights: valid_lights?,
        environment: valid_environment?,
        medium: valid_medium?,
        images: valid_images?.into(),
        textures: valid_textures?.into(),
        meshes: valid_meshes?.into_iter().map(Arc::new).collect(),
        materials: valid_materials?.into(),
        surfaces: valid_surfaces?.into_iter().flatten().collect(),
        trees: trees.clone(),
    };
    // Run the lints.
    let solids = Solids::new(scene, &check);
    inside::lights(&solids, &mut check);
    lint::lints(scene, &solids, &mut check);
    check.is_clean().then_some(valid)
}
