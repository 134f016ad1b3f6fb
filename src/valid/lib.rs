//! The proof: only [`validate`] makes a [`ValidScene`], and every number in a proof is in its range.
//!
//! All checks on the IR are here, so a faulty IR file is refused like a faulty text. This room does
//! not know the source of a scene: it looks up spans in the origins it is given, and every finding
//! has a JSON pointer.

mod camera;
mod check;
mod environment;
mod image;
mod inside;
mod light;
mod material;
mod mesh;
mod phong;
mod settings;
mod shape;
mod standard;
mod suspicion;
mod texture;

pub use camera::{Camera, Lens, Projection};
pub use check::LARGEST;
pub use environment::Environment;
pub use image::Image;
pub use light::{CourseLight, DirectionalLight, Falloff, Light, PointLight, Punctual};
pub use material::Material;
pub use mesh::{MOST_TRIANGLES, Mesh};
pub use phong::{Bump, Maps, Phong};
pub use settings::{Ambient, Gooch, Mode, PathSettings, Pattern, Settings};
pub use shape::*;
pub use standard::{Alpha, Standard};
pub use texture::{Filter, Map, Sampled, Texture, UvSet, Wrap};

use check::{Check, EntityCounts};
use rtc_diag::Sink;
use rtc_ir::{self as ir, SourceSpans};
use rtc_source::Limits;
use std::sync::Arc;

/// What the proof accepts.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProofOptions {
    /// The limits on the pixels of the picture and on its rays.
    pub limits: Limits,
}

/// A proven scene: handles in range, numbers finite and in range, bases at right angles, triangles
/// with an area.
#[derive(Clone, Debug)]
pub struct ValidScene {
    camera: Camera,
    settings: Settings,
    lights: Vec<Light>,
    environment: Environment,
    images: Vec<Image>,
    textures: Vec<Texture>,
    meshes: Vec<Arc<Mesh>>,
    materials: Vec<Material>,
    surfaces: Vec<Surface>,
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

    /// The lights, of any kind, in the order of the scene.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// The environment.
    #[must_use]
    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// The images.
    #[must_use]
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// The textures.
    #[must_use]
    pub fn textures(&self) -> &[Texture] {
        &self.textures
    }

    /// The meshes.
    #[must_use]
    pub fn meshes(&self) -> &[Arc<Mesh>] {
        &self.meshes
    }

    /// The materials, of any family.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The surfaces, without triangles that have no area.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }
}

impl ValidScene {
    /// The same scene with another camera, for a picture of the same size; `None` if that camera is
    /// not valid.
    #[must_use]
    pub fn seen_by(&self, camera: &ir::Camera) -> Option<Self> {
        let (source_spans, mut sink) = (SourceSpans::default(), Sink::default());
        let mut check = Check::new(&source_spans, &mut sink);
        let camera = camera::camera(camera, &mut check)?;
        let is_as_large = (camera.width, camera.height) == (self.camera.width, self.camera.height);
        (check.is_clean() && is_as_large).then(|| Self {
            camera,
            ..self.clone()
        })
    }
}

/// The proof of a scene that was already proven with another camera or in other settings.
///
/// # Panics
/// If what was changed is out of range.
#[must_use]
pub fn revalidate(scene: &ir::Scene) -> ValidScene {
    let options = ProofOptions {
        limits: Limits::NONE,
    };
    let proof = validate(
        scene,
        &SourceSpans::default(),
        &options,
        &mut Sink::default(),
    );
    proof.expect("the scene was proven before, and what was changed is in range")
}

/// Proves the scene, or reports in the sink all faults of it, not only the first.
///
/// Returns `None` if and only if this call reported an error.
pub fn validate(
    scene: &ir::Scene,
    source_spans: &SourceSpans,
    options: &ProofOptions,
    sink: &mut Sink,
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
        display,
    } = scene;
    let mut check = Check::new(source_spans, sink);
    let valid_camera = camera::camera(camera, &mut check);
    let valid_settings = settings::settings(settings, &mut check);
    settings::display(display, &mut check);
    let valid_lights = check.all(lights, light::light);
    let valid_environment =
        environment::environment(environment.as_ref(), images.len(), &mut check);
    let valid_images = check.all(images, image::image);
    let valid_textures = check.all(textures, |texture, index, check| {
        texture::texture(texture, index, images.len(), check)
    });
    let valid_meshes = check.all(meshes, mesh::mesh);
    let counts = EntityCounts {
        textures: textures.len(),
        meshes: meshes.len(),
        materials: materials.len(),
    };
    let valid_materials = check.all(materials, |material, index, check| {
        material::material(material, index, &counts, check)
    });
    let valid_surfaces = check.all(surfaces, |surface, index, check| {
        shape::surface(surface, index, &counts, check)
    });
    settings::budget(scene, options, &mut check);
    let valid = ValidScene {
        camera: valid_camera?,
        settings: valid_settings?,
        lights: valid_lights?,
        environment: valid_environment?,
        images: valid_images?,
        textures: valid_textures?,
        meshes: valid_meshes?.into_iter().map(Arc::new).collect(),
        materials: valid_materials?,
        surfaces: valid_surfaces?.into_iter().flatten().collect(),
    };
    inside::lights(scene, &mut check);
    suspicion::suspicions(scene, &mut check);
    check.is_clean().then_some(valid)
}
