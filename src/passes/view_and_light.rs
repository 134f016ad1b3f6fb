//! View and light of one run: they replace the camera, the lights and the environment of a scene
//! before it is validated. Nothing else of the scene changes.

use super::framing::{Framing, OrbitAngles};
use super::studio::{self, StudioSet};
use super::{emission, framing, ground};
use rtc_ir::{
    BoundingSphere, Camera, EntityKind, Environment, Image, Light, LoweredScene, Mode,
    PathSettings, PointLight, Projection, Punctual, PunctualKind, Scene,
};
use rtc_math::{CameraBasisError, Vec3, camera_basis, fallback_up, length, unit};
use std::f64::consts::PI;

/// View and light; a value that is not given stays as in the scene.
#[derive(Clone, Debug, Default)]
pub struct ViewAndLight {
    /// The view.
    pub view: View,
    /// The integrator.
    pub integrator: Option<IntegratorChoice>,
    /// What surrounds it.
    pub environment: Option<EnvironmentOverride>,
    /// Directional lights to add.
    pub suns: Vec<SunLight>,
    /// Whether the lights of the scene are removed.
    pub without_lights: bool,
    /// Whether the scene is rendered as a turntable, so its view is not framed.
    pub all_around: bool,
    /// Whether the scene is placed in the studio.
    pub studio: StudioChoice,
    /// Whether a ground is added; by default, for an asset without a camera in the studio.
    pub ground: Option<bool>,
}

/// The kind of source of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneKind {
    /// A scene text, with view and light.
    Text,
    /// An asset with a camera.
    Asset,
    /// An asset without a camera.
    BareAsset,
}

/// Whether a path-traced scene is placed in the studio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StudioChoice {
    /// If the scene has no light; as a dimmed fill light if its own light illuminates little of it.
    #[default]
    Auto,
    /// Yes, in this set, whatever its environment is.
    On(StudioSet),
    /// No.
    Off,
    /// As a dimmed fill light, if it has no other environment.
    Fill,
}

/// Whether the studio is added as a dimmed fill light to the light of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillLight {
    /// No.
    #[default]
    Never,
    /// If the light of the scene shows little of it.
    IfDim,
    /// Yes.
    Always,
}

/// A view; a value that is not given is that of the scene's camera. The picture keeps its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// The position of the camera.
    pub eye: Option<[f64; 3]>,
    /// The point in the centre of the picture; by default, with a given eye, the centre of the
    /// scene.
    pub center: Option<[f64; 3]>,
    /// The upward direction; by default, the world axis nearest to that of the camera.
    pub up: Option<[f64; 3]>,
    /// The vertical field of view in radians, above 0 and below π.
    pub yfov: Option<f64>,
    /// The viewing direction from which the whole scene is framed.
    pub orbit: Option<OrbitAngles>,
}

/// The integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorChoice {
    /// Whitted ray tracing: direct light, perfect reflection and refraction.
    Whitted,
    /// Path tracing.
    Path,
}

/// The environment light.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentOverride {
    /// A constant radiance in all directions.
    Color([f64; 3]),
    /// An environment map with linear float pixels.
    Picture(Image),
}

/// A directional light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunLight {
    /// The direction from the scene to the light, not of length 0.
    pub direction: [f64; 3],
    /// The irradiance on a surface that faces the light.
    pub irradiance: [f64; 3],
}

/// The result of [`ViewAndLight::apply`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedViewAndLight {
    /// Whether it had no light and was placed in the studio.
    pub lacks_light: bool,
    /// Whether the studio is still to be added as a fill light.
    pub fill: FillLight,
    /// The framing of its view, if it was framed.
    pub framing: Option<Framing>,
}

/// The distance of a directional light, in scene radii, for integrators that need a position.
const SUN_DISTANCE: f64 = 1e4;

impl ViewAndLight {
    /// Applies view and light to a scene.
    ///
    /// # Errors
    /// If the view has no direction, or no upward direction.
    pub fn apply(
        &self,
        lowered: &mut LoweredScene,
        kind: SceneKind,
    ) -> Result<AppliedViewAndLight, CameraBasisError> {
        let LoweredScene {
            scene,
            source_spans,
        } = lowered;
        let is_bare = kind == SceneKind::BareAsset;
        let mut framing = self
            .view
            .framing(&scene.camera, !is_bare || self.all_around);
        if let Some(framing) = &framing {
            framing.apply(scene, source_spans);
            source_spans.forget(EntityKind::Camera);
        } else if self.view != View::default() {
            self.view.apply(scene)?;
            source_spans.forget(EntityKind::Camera);
        }
        if self.without_lights {
            scene.lights.clear();
            source_spans.forget(EntityKind::Light);
        }
        scene.lights.extend(self.suns.iter().map(SunLight::light));
        if let Some(environment) = &self.environment {
            scene.environment = Some(environment.environment(scene));
            source_spans.forget(EntityKind::Environment);
        }
        let adds_light = !self.suns.is_empty() || self.environment.is_some();
        match self.integrator {
            Some(IntegratorChoice::Path) => use_path_integrator(scene),
            Some(IntegratorChoice::Whitted) => use_whitted_integrator(scene),
            // As for a scene text: a directional light or an environment needs path tracing.
            None if adds_light && scene.settings.mode == Mode::Phong => use_path_integrator(scene),
            None => {}
        }
        if !matches!(scene.settings.mode, Mode::Path(_)) {
            replace_physical_lights(scene);
        }
        let (lacks_light, set, fill) = self.apply_studio(scene, kind);
        let gets_ground = set.is_some() && is_bare && !scene.is_unlit();
        if self.ground.unwrap_or(gets_ground)
            && let Some(bounds) =
                framing::standing_bounds(source_spans.swept.as_deref().unwrap_or(scene))
        {
            let ground =
                ground::add_ground(scene, bounds, set.unwrap_or_default().ground_reflectance());
            if let Some(framing) = &mut framing {
                framing.ground = ground;
            }
        }
        Ok(AppliedViewAndLight {
            lacks_light,
            fill,
            framing,
        })
    }

    /// Places a path-traced scene in the studio, if requested; returns whether it had no light, the
    /// set that it is in, and whether the studio is still to be added as a fill light.
    fn apply_studio(
        &self,
        scene: &mut Scene,
        kind: SceneKind,
    ) -> (bool, Option<StudioSet>, FillLight) {
        if !matches!(scene.settings.mode, Mode::Path(_)) {
            return (false, None, FillLight::Never);
        }
        let lacks_light = self.studio == StudioChoice::Auto && !emission::has_light(scene, kind);
        let set = match self.studio {
            StudioChoice::On(set) => Some(set),
            StudioChoice::Auto if lacks_light => Some(StudioSet::default()),
            StudioChoice::Auto | StudioChoice::Off | StudioChoice::Fill => None,
        };
        if let Some(set) = set {
            studio::install(scene, set, 1.0);
        }
        let fill = match self.studio {
            _ if scene.environment.is_some() => FillLight::Never,
            StudioChoice::Auto => FillLight::IfDim,
            StudioChoice::Fill => FillLight::Always,
            StudioChoice::On(_) | StudioChoice::Off => FillLight::Never,
        };
        (lacks_light, set, fill)
    }
}

impl View {
    /// The framing of the view, for a scene without a camera or a given viewing direction.
    fn framing(&self, camera: &Camera, has_camera: bool) -> Option<Framing> {
        let has_position = self.eye.is_some() || self.center.is_some() || self.up.is_some();
        if has_position || (has_camera && self.orbit.is_none()) {
            return None;
        }
        let scene_yfov = has_camera.then(|| camera.yfov()).flatten();
        Some(Framing {
            orbit: self.orbit.unwrap_or_default(),
            yfov: self.yfov.or(scene_yfov),
            size: Some(camera.size),
            ground: None,
        })
    }

    fn apply(&self, scene: &mut Scene) -> Result<(), CameraBasisError> {
        if self.eye.is_some() || self.center.is_some() || self.up.is_some() {
            self.look_at(scene)?;
        }
        if let Some(yfov) = self.yfov {
            scene.camera.open(yfov);
        }
        Ok(())
    }

    fn look_at(&self, scene: &mut Scene) -> Result<(), CameraBasisError> {
        let middle = self
            .eye
            .and_then(|_| scene.bounding_sphere())
            .map_or(scene.camera.center, |sphere| sphere.center.to_array());
        let camera = &mut scene.camera;
        let eye = Vec3::from_array(self.eye.unwrap_or(camera.eye));
        let center = Vec3::from_array(self.center.unwrap_or(middle));
        // A perspective picture of the same angle scales with its distance; an orthographic one
        // does not.
        let scale = match camera.projection {
            Projection::Perspective => eye.distance(center) / camera.distance(),
            Projection::Orthographic => 1.0,
        };
        // A given field of view determines the picture size.
        let pixel = if self.yfov.is_some() {
            1.0
        } else {
            length(Vec3::from_array(camera.up)) * scale
        };
        let up = self.up.map_or_else(
            || camera.upright(),
            |up| unit(Vec3::from_array(up)).unwrap_or(Vec3::ZERO),
        );
        let basis = match (camera_basis(eye, center, up * pixel), self.up) {
            (Err(CameraBasisError::Parallel), None) => {
                camera_basis(eye, center, fallback_up(center - eye, up * pixel))
            }
            (basis, _) => basis,
        };
        let (right, up) = basis?;
        (camera.eye, camera.center) = (eye.to_array(), center.to_array());
        (camera.right, camera.up) = (right.to_array(), up.to_array());
        Ok(())
    }
}

impl SunLight {
    fn light(&self) -> Light {
        let Self {
            direction,
            irradiance,
        } = *self;
        Light::Punctual(Punctual::new(PunctualKind::Sun { direction }, irradiance))
    }
}

impl EnvironmentOverride {
    fn environment(&self, scene: &mut Scene) -> Environment {
        let (radiance, image) = match self {
            Self::Color(radiance) => (*radiance, None),
            Self::Picture(image) => ([1.0; 3], Some(scene.add_image(image.clone()))),
        };
        Environment {
            radiance,
            image,
            image_from_world: None,
        }
    }
}

/// Switches to path tracing with the default number of paths and bounces, unless it is used.
pub fn use_path_integrator(scene: &mut Scene) {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        scene.settings.mode = Mode::Path(PathSettings::default());
        scene.settings.max_depth = PathSettings::DEPTH;
        scene.settings.supersampling = 1;
    }
}

/// Switches from path tracing to the Whitted integrator; adds a light from the upper left if there
/// is none.
fn use_whitted_integrator(scene: &mut Scene) {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        return;
    }
    scene.settings.mode = Mode::Phong;
    if scene.lights.is_empty() {
        let key_light_direction = SunLight {
            direction: studio::key_light_direction().to_array(),
            irradiance: [PI; 3],
        };
        scene.lights.push(key_light_direction.light());
    }
}

/// Adds a light. As for a scene text, a physical light needs path tracing.
pub fn add_light(scene: &mut Scene, light: Light) {
    if light.point().is_none() && scene.settings.mode == Mode::Phong {
        use_path_integrator(scene);
    }
    scene.lights.push(light);
}

/// Removes the lights and their source spans.
pub fn remove_lights(lowered: &mut LoweredScene) {
    lowered.scene.lights.clear();
    lowered.source_spans.forget(EntityKind::Light);
}

/// Replaces physical lights, which the Whitted integrator does not support, by course lights.
fn replace_physical_lights(scene: &mut Scene) {
    if scene.lights.iter().all(|light| light.point().is_some()) {
        return;
    }
    let sphere = scene.bounding_sphere().unwrap_or(BoundingSphere {
        center: Vec3::ZERO,
        radius: 1.0,
    });
    for light in &mut scene.lights {
        if let Light::Punctual(punctual) = light {
            *light = Light::Point(equivalent_point_light(punctual, sphere));
        }
    }
}

/// The point light without falloff that gives the centre of the scene the same irradiance as a
/// physical light.
fn equivalent_point_light(light: &Punctual, sphere: BoundingSphere) -> PointLight {
    let (position, irradiance) = if let Some(position) = light.emitter.position() {
        let square = Vec3::from_array(position).distance_squared(sphere.center);
        (position, 1.0 / square.max(sphere.radius * sphere.radius))
    } else {
        let direction = light.emitter.direction().map(Vec3::from_array);
        let direction = direction.and_then(unit).unwrap_or(Vec3::Y);
        let position = sphere.center + direction * (SUN_DISTANCE * sphere.radius);
        (position.to_array(), 1.0)
    };
    // A white surface that faces the light has the light's colour with a course light, and
    // irradiance over π with a physical one.
    PointLight {
        position,
        color: light.intensity.map(|channel| channel * irradiance / PI),
        radius: 0.0,
    }
}
