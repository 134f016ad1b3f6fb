//! Scenes that are built in code, and changes of scenes.

use super::camera::placeholder;
use super::{
    Camera, Diagnostic, Environment, Light, Material, MaterialId, Mesh, MeshId, Phong, Scene,
    Shape, Standard, Texture, TextureId, Tone,
};
use rtc_diag::{Diagnostic as Finding, codes};
use rtc_ir::{self as ir, EntityKind, LoweredScene, Medium, Mode, SourceSpans, Surface};
use rtc_math::to_u32;
use rtc_passes::{self as passes, Overrides};
use rtc_pipeline::{Input, LoadedScene, Options};

/// A scene that is built in code, or a scene that [`Scene::edit`] changes.
///
/// Without [`SceneBuilder::set`] and the other settings a scene is rendered as a scene text without
/// them: by path tracing if it has a [`Standard`] material, an environment or a physical light, and
/// else by Phong shading without shadows and mirrors.
///
/// ```
/// use rtc::{Camera, Light, Options, Phong, SceneBuilder, Shape};
///
/// let camera = Camera::look_at([0.0, 1.0, 6.0], [0.0; 3]).fov(30.0).size(32, 24);
/// let mut builder = SceneBuilder::new(camera);
/// builder.light(Light::plain([5.0, 5.0, 9.0], [1.0; 3], 0.0));
/// let ball = builder.add(
///     Shape::sphere([0.0; 3], 1.0),
///     Phong::default().color([1.0, 0.2, 0.1]).ka(0.2).kd(0.8),
/// );
/// builder.name(ball, "ball");
/// let scene = builder.build().unwrap();
/// let picture = scene.render(&Options::new().supersampling(2))?;
/// assert_eq!((picture.width(), picture.height()), (32, 24));
///
/// // What is wrong has the code that a file gets, and a path in place of a line.
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default().kt(0.5).ior(-1.0));
/// let wrong = builder.build().unwrap_err();
/// assert_eq!(wrong[0].path.as_deref(), Some("objects[0].material.ior"));
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "a builder is no scene before it is built"]
pub struct SceneBuilder {
    lowered: LoweredScene,
    /// A new camera, lowered at the end.
    camera: Option<Camera>,
    overrides: Overrides,
    /// The errors in single values.
    faults: Vec<Finding>,
}

/// An object of a scene: its index in the order in which objects were added.
///
/// ```
/// use rtc::{Camera, ObjectId, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// let ball = builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// assert_eq!(ball, ObjectId(0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ObjectId(pub usize);

/// The material of an object: one of its own, or one of the scene, which others may have too.
///
/// ```
/// use rtc::{Camera, Phong, SceneBuilder, Shape, Standard};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// let glass = builder.material(Standard::default().metallic(0.0).transmission(1.0));
/// builder.add(Shape::sphere([0.0; 3], 1.0), glass);
/// builder.add(Shape::sphere([2.0, 0.0, 0.0], 1.0), glass);
/// builder.add(Shape::sphere([4.0, 0.0, 0.0], 1.0), Phong::default());
/// assert_eq!(builder.build().unwrap().tree().unwrap().materials().len(), 2);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MaterialRef {
    /// A material for this object.
    Own(Material),
    /// A material of the scene.
    Shared(MaterialId),
}

impl From<Phong> for MaterialRef {
    fn from(phong: Phong) -> Self {
        Self::Own(phong.into())
    }
}

impl From<Standard> for MaterialRef {
    fn from(standard: Standard) -> Self {
        Self::Own(standard.into())
    }
}

impl From<Material> for MaterialRef {
    fn from(material: Material) -> Self {
        Self::Own(material)
    }
}

impl From<MaterialId> for MaterialRef {
    fn from(id: MaterialId) -> Self {
        Self::Shared(id)
    }
}

impl SceneBuilder {
    /// A scene without objects and lights.
    pub fn new(camera: Camera) -> Self {
        Self {
            camera: Some(camera),
            ..Self::of(LoweredScene {
                scene: ir::Scene::new(placeholder(), ir::Settings::default()),
                source_spans: SourceSpans::default(),
            })
        }
    }

    /// A scene to change.
    pub(super) fn of(lowered: LoweredScene) -> Self {
        Self {
            lowered,
            camera: None,
            overrides: Overrides::default(),
            faults: Vec::new(),
        }
    }

    /// Validates the scene.
    ///
    /// # Errors
    /// All errors, warnings and notes, if any is an error. Their locations are paths such as
    /// `objects[3].material.ior`.
    pub fn build(self) -> Result<Scene, Vec<Diagnostic>> {
        let input = Input::built("scene".to_owned(), Options::default());
        let empty = LoadedScene::built(ir::Scene::new(placeholder(), ir::Settings::default()));
        Scene::of_builder(input.into(), empty, self)
    }

    /// The scene, the errors in its single values, and whether it has a new camera.
    pub(super) fn finish(self) -> (LoweredScene, Vec<Finding>, bool) {
        let Self {
            mut lowered,
            camera,
            overrides,
            mut faults,
        } = self;
        let has_camera = camera.is_some();
        match camera.as_ref().map(Camera::lower) {
            Some(Ok(camera)) => lowered.scene.camera = camera,
            Some(Err(fault)) => faults.push(*fault),
            None => {}
        }
        overrides.apply(&mut lowered.scene);
        (lowered, faults, has_camera)
    }

    fn scene(&mut self) -> &mut ir::Scene {
        &mut self.lowered.scene
    }
}

/// Camera, lights and settings.
impl SceneBuilder {
    /// The camera.
    pub fn camera(&self) -> Camera {
        let own = || Camera::of(&self.lowered.scene.camera);
        self.camera.clone().unwrap_or_else(own)
    }

    /// Replaces the camera.
    pub fn set_camera(&mut self, camera: Camera) {
        self.lowered.source_spans.forget(EntityKind::Camera);
        self.camera = Some(camera);
    }

    /// Adds a light. Its index is the number of lights before it.
    pub fn light(&mut self, light: Light) -> usize {
        passes::add_light(self.scene(), light.0);
        self.lowered.scene.lights.len() - 1
    }

    /// Replaces a light; does nothing if there is none with this index.
    pub fn set_light(&mut self, index: usize, light: Light) {
        self.lowered
            .source_spans
            .forget_one(EntityKind::Light, index);
        let is_physical = light.0.point().is_none();
        if let Some(own) = self.scene().lights.get_mut(index) {
            *own = light.0;
            self.trace_physical(is_physical);
        }
    }

    /// Removes all lights except the environment and emissive surfaces.
    pub fn remove_lights(&mut self) {
        passes::remove_lights(&mut self.lowered);
    }

    /// Sets the environment.
    pub fn environment(&mut self, environment: Environment) {
        self.lowered.source_spans.forget(EntityKind::Environment);
        let environment = environment.lower(self.scene());
        self.scene().environment = Some(environment);
        self.trace_physical(true);
    }

    /// Sets the participating medium around the camera.
    pub fn medium(&mut self, medium: Medium) {
        self.lowered.source_spans.forget(EntityKind::Medium);
        self.scene().medium = Some(medium);
        self.trace_physical(true);
    }

    /// Whether surfaces cast shadows; in traced paths they always do.
    pub fn shadows(&mut self, shadows: bool) {
        self.scene().settings.shadows = shadows;
    }

    /// The maximum number of bounces after the first hit.
    pub fn depth(&mut self, bounces: u32) {
        self.overrides.depth = Some(bounces);
    }

    /// Sub-samples along each side of a pixel, at least 1; for all integrators but path tracing.
    pub fn supersampling(&mut self, side: u32) {
        self.overrides.supersampling = Some(side);
    }

    /// Renders by path tracing, with this many paths per pixel, at least 1.
    pub fn trace_paths(&mut self, paths: u32) {
        passes::use_path_integrator(self.scene());
        self.overrides.spp = Some(paths);
    }

    /// Sets any setting by its name in the IR and a value in JSON, for example `("toon", "true")`
    /// or `("mode", "normal")`; `schema/ir.md` lists them. An unknown name or a value of another
    /// type is an error of [`SceneBuilder::build`].
    pub fn set(&mut self, name: &str, value: &str) {
        if let Err(message) = passes::set(&mut self.scene().settings, name, value) {
            let pointer = format!("/settings/{name}");
            let fault = Finding::new(&codes::OUT_OF_RANGE, message).pointer(pointer);
            self.faults.push(fault);
        }
    }

    /// The exposure of a PNG in stops, from -64 to 64, and its tone map; `None` is that of the
    /// integrator.
    pub fn display(&mut self, stops: f64, tone: Option<Tone>) {
        self.scene().display = ir::Display {
            exposure: stops,
            tone,
        };
    }

    /// Only path tracing renders physical lights and materials.
    fn trace_physical(&mut self, is_physical: bool) {
        if is_physical && self.lowered.scene.settings.mode == Mode::Phong {
            passes::use_path_integrator(self.scene());
        }
    }
}

/// Meshes, textures and materials.
impl SceneBuilder {
    /// Adds a mesh. [`Shape::instance`] places it in the scene.
    pub fn mesh(&mut self, mesh: Mesh) -> MeshId {
        let meshes = &mut self.scene().meshes;
        meshes.push(mesh.0);
        MeshId(to_u32(meshes.len() - 1))
    }

    /// Replaces a mesh in all its instances; does nothing if there is none with this index.
    pub fn set_mesh(&mut self, id: MeshId, mesh: Mesh) {
        let index = id.0 as usize;
        self.lowered
            .source_spans
            .forget_one(EntityKind::Mesh, index);
        if let Some(own) = self.scene().meshes.get_mut(index) {
            *own = mesh.0;
        }
    }

    /// Adds a texture for maps of materials.
    pub fn texture(&mut self, texture: Texture) -> TextureId {
        let texture = texture.lower(self.scene());
        let textures = &mut self.scene().textures;
        textures.push(texture);
        TextureId(to_u32(textures.len() - 1))
    }

    /// Adds a material, for several objects.
    pub fn material(&mut self, material: impl Into<Material>) -> MaterialId {
        let material = material.into();
        self.trace_physical(material.phong().is_none());
        let materials = &mut self.scene().materials;
        materials.push(material);
        MaterialId(to_u32(materials.len() - 1))
    }

    /// A material, to be changed for all objects that have it.
    pub fn material_mut(&mut self, id: MaterialId) -> Option<&mut Material> {
        let index = id.0 as usize;
        let spans = &mut self.lowered.source_spans;
        spans.forget_one(EntityKind::Material, index);
        self.lowered.scene.materials.get_mut(index)
    }
}

/// Objects.
impl SceneBuilder {
    /// Adds an object.
    pub fn add(&mut self, shape: Shape, material: impl Into<MaterialRef>) -> ObjectId {
        let material = match material.into() {
            MaterialRef::Own(material) => self.material(material),
            MaterialRef::Shared(id) => id,
        };
        let scene = self.scene();
        scene.surfaces.push(Surface::new(shape.0, material));
        if !scene.names.is_empty() {
            scene.names.push(String::new());
        }
        ObjectId(scene.surfaces.len() - 1)
    }

    /// Names an object. This and the other functions do nothing if there is no such object.
    pub fn name(&mut self, object: ObjectId, name: impl Into<String>) {
        let scene = self.scene();
        scene.names.resize(scene.surfaces.len(), String::new());
        if let Some(own) = scene.names.get_mut(object.0) {
            *own = name.into();
        }
    }

    /// The first object of this name.
    pub fn find(&self, name: &str) -> Option<ObjectId> {
        let mut names = self.lowered.scene.names.iter();
        names.position(|own| own == name).map(ObjectId)
    }

    /// The material of an object.
    pub fn material_of(&self, object: ObjectId) -> Option<MaterialId> {
        let surface = self.lowered.scene.surfaces.get(object.0);
        surface.map(|surface| surface.material)
    }

    /// Replaces the shape of an object.
    pub fn set_shape(&mut self, object: ObjectId, shape: Shape) {
        self.change(object, |surface| surface.shape = shape.0);
    }

    /// Replaces the material of an object.
    pub fn set_material(&mut self, object: ObjectId, material: impl Into<MaterialRef>) {
        let Some(before) = self.material_of(object) else {
            return;
        };
        let surfaces = self.lowered.scene.surfaces.iter();
        let is_own = surfaces
            .filter(|surface| surface.material == before)
            .count()
            == 1;
        let id = match (material.into(), is_own) {
            (MaterialRef::Shared(id), _) => id,
            (MaterialRef::Own(material), false) => self.material(material),
            (MaterialRef::Own(material), true) => {
                self.trace_physical(material.phong().is_none());
                if let Some(own) = self.material_mut(before) {
                    *own = material;
                }
                before
            }
        };
        self.change(object, |surface| surface.material = id);
    }

    /// Whether an object casts shadows; in traced paths all do.
    pub fn set_shadow(&mut self, object: ObjectId, casts: bool) {
        self.change(object, |surface| surface.casts_no_shadow = !casts);
    }

    /// How far an object moves per second along each axis, while the shutter is open: from 0 to 1
    /// second, unless the setting `shutter` says otherwise.
    pub fn set_velocity(&mut self, object: ObjectId, velocity: [f64; 3]) {
        self.change(object, |surface| surface.velocity = velocity.into());
    }

    /// Removes an object. The indices of those after it fall by one.
    pub fn remove(&mut self, object: ObjectId) {
        let LoweredScene {
            scene,
            source_spans,
        } = &mut self.lowered;
        if object.0 < scene.surfaces.len() {
            scene.surfaces.remove(object.0);
            source_spans.forget(EntityKind::Surface);
        }
        if object.0 < scene.names.len() {
            scene.names.remove(object.0);
        }
    }

    fn change(&mut self, object: ObjectId, change: impl FnOnce(&mut Surface)) {
        let spans = &mut self.lowered.source_spans;
        spans.forget_one(EntityKind::Surface, object.0);
        if let Some(surface) = self.scene().surfaces.get_mut(object.0) {
            change(surface);
        }
    }
}
