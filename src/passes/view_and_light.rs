//! What is said about view and light on one occasion: it replaces the camera, the lights and the
//! surroundings of a scene before it is proven. Nothing else of the scene changes.

use super::framing::{Framing, Orbit};
use super::{emission, framing, ground, studio};
use rtc_ir::{
    BoundingSphere, Camera, Emitter, EntityKind, Environment, Image, Light, Lowered, Mode,
    PathSettings, PointLight, Projection, Punctual, Scene,
};
use rtc_math::{BasisFault, Vec3, camera_basis, fallback_up, length, unit};
use std::f64::consts::PI;

/// The view and the light; what is not given stays as it is in the scene.
#[derive(Clone, Debug, Default)]
pub struct ViewAndLight {
    /// From where the scene is seen.
    pub view: View,
    /// By which integrator.
    pub integrator: Option<IntegratorChoice>,
    /// What surrounds it.
    pub environment: Option<EnvironmentOverride>,
    /// The suns that are added.
    pub suns: Vec<Sun>,
    /// The lights of the scene are left out.
    pub without_lights: bool,
    /// It is turned around, so its view is not framed.
    pub all_around: bool,
    /// Whether it stands in the studio.
    pub studio: StudioChoice,
    /// Whether a ground is laid under it; if not said, under an asset without a camera of its own
    /// that stands in the studio.
    pub ground: Option<bool>,
}

/// What a scene was read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneKind {
    /// A text that says how it is seen and lit.
    Text,
    /// An asset with a camera.
    Asset,
    /// An asset without one.
    BareAsset,
}

/// Whether a scene whose paths are traced stands in the studio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StudioChoice {
    /// If it brings no light; dimmed if what it brings shows little of it.
    #[default]
    Auto,
    /// Yes, whatever surrounds it otherwise.
    On,
    /// No.
    Off,
    /// Yes, dimmed, if nothing else surrounds it.
    Fill,
}

/// Whether the studio is to fill in, dimmed, beside the light of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FillLight {
    /// No.
    #[default]
    Never,
    /// If its own light shows little of it.
    IfDim,
    /// Yes.
    Always,
}

/// A view; what is not given is that of the camera of the scene, whose picture keeps its size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Where the camera stands.
    pub eye: Option<[f64; 3]>,
    /// What is in the middle of the picture; beside a given eye, the middle of the scene.
    pub center: Option<[f64; 3]>,
    /// The upward direction; the axis of the world that is nearest to that of the camera.
    pub up: Option<[f64; 3]>,
    /// The angle that the picture spans from bottom to top, in radians, above 0 and below π.
    pub yfov: Option<f64>,
    /// From where all of the scene is seen, as large as it fits.
    pub orbit: Option<Orbit>,
}

/// By which rules light is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegratorChoice {
    /// Whitted's: direct light of lights without extent, mirrors and refraction.
    Whitted,
    /// All paths.
    Path,
}

/// What surrounds the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentOverride {
    /// The same radiance from every direction.
    Color([f64; 3]),
    /// A picture of all directions, of linear floats.
    Picture(Image),
}

/// A light from infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// The direction from the scene to it, of any length but 0.
    pub direction: [f64; 3],
    /// The irradiance on a surface that faces it.
    pub irradiance: [f64; 3],
}

/// What became of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedViewAndLight {
    /// It had no light, and was put into the studio.
    pub lacks_light: bool,
    /// Whether the studio is still to fill in.
    pub fill: FillLight,
    /// How its view was found, if it was.
    pub framing: Option<Framing>,
}

/// Distance of a sun, in scene radii, for integrators that need a position.
const SUN_DISTANCE: f64 = 1e4;

impl ViewAndLight {
    /// Puts view and light into a scene.
    ///
    /// # Errors
    /// If the view has no direction, or no upward one.
    pub fn apply(
        &self,
        lowered: &mut Lowered,
        kind: SceneKind,
    ) -> Result<AppliedViewAndLight, BasisFault> {
        let Lowered {
            scene,
            source_spans,
        } = lowered;
        let is_bare = kind == SceneKind::BareAsset;
        let mut framing = self
            .view
            .framing(&scene.camera, !is_bare || self.all_around);
        if let Some(framing) = &framing {
            framing.apply(scene);
            source_spans.forget(EntityKind::Camera);
        } else if self.view != View::default() {
            self.view.apply(scene)?;
            source_spans.forget(EntityKind::Camera);
        }
        if self.without_lights {
            scene.lights.clear();
            source_spans.forget(EntityKind::Light);
        }
        scene.lights.extend(self.suns.iter().map(Sun::light));
        if let Some(environment) = &self.environment {
            scene.environment = Some(environment.environment(scene));
            source_spans.forget(EntityKind::Environment);
        }
        let adds_light = !self.suns.is_empty() || self.environment.is_some();
        match self.integrator {
            Some(IntegratorChoice::Path) => use_path_integrator(scene),
            Some(IntegratorChoice::Whitted) => use_whitted_integrator(scene),
            // As of a scene text: what has a sun or a sky is shown by its paths.
            None if adds_light && scene.settings.mode == Mode::Phong => use_path_integrator(scene),
            None => {}
        }
        if !matches!(scene.settings.mode, Mode::Path(_)) {
            replace_physical_lights(scene);
        }
        let (lacks_light, fill) = self.apply_studio(scene, kind);
        let gets_ground =
            (lacks_light || self.studio == StudioChoice::On) && is_bare && !scene.is_unlit();
        if self.ground.unwrap_or(gets_ground)
            && let Some(bounds) = framing::standing_bounds(scene)
        {
            let ground = ground::add_ground(scene, bounds);
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

    /// Puts a scene whose paths are traced into the studio, if it is to stand there; whether it was
    /// dark, and whether the studio is still to fill in.
    fn apply_studio(&self, scene: &mut Scene, kind: SceneKind) -> (bool, FillLight) {
        if !matches!(scene.settings.mode, Mode::Path(_)) {
            return (false, FillLight::Never);
        }
        let lacks_light = self.studio == StudioChoice::Auto && !emission::has_light(scene, kind);
        if lacks_light || self.studio == StudioChoice::On {
            studio::install(scene, 1.0);
        }
        let fill = match self.studio {
            _ if scene.environment.is_some() => FillLight::Never,
            StudioChoice::Auto => FillLight::IfDim,
            StudioChoice::Fill => FillLight::Always,
            StudioChoice::On | StudioChoice::Off => FillLight::Never,
        };
        (lacks_light, fill)
    }
}

impl View {
    /// How a view is found: of a scene without a camera, or from where one is asked for.
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

    fn apply(&self, scene: &mut Scene) -> Result<(), BasisFault> {
        if self.eye.is_some() || self.center.is_some() || self.up.is_some() {
            self.look_at(scene)?;
        }
        if let Some(yfov) = self.yfov {
            scene.camera.open(yfov);
        }
        Ok(())
    }

    fn look_at(&self, scene: &mut Scene) -> Result<(), BasisFault> {
        let middle = self
            .eye
            .and_then(|_| scene.bounding_sphere())
            .map_or(scene.camera.center, |ball| ball.center.to_array());
        let camera = &mut scene.camera;
        let eye = Vec3::from_array(self.eye.unwrap_or(camera.eye));
        let center = Vec3::from_array(self.center.unwrap_or(middle));
        // A picture of the same angle is larger the farther it is; side by side, rays make it as
        // large everywhere.
        let scale = match camera.projection {
            Projection::Perspective => eye.distance(center) / camera.distance(),
            Projection::Orthographic => 1.0,
        };
        // A lens that is asked for makes the picture of its own size.
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
            (Err(BasisFault::Parallel), None) => {
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

impl Sun {
    fn light(&self) -> Light {
        let Self {
            direction,
            irradiance,
        } = *self;
        Light::Punctual(Punctual {
            emitter: Emitter::Sun { direction },
            intensity: irradiance,
        })
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

/// Has all paths traced, if they are not.
fn use_path_integrator(scene: &mut Scene) {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        scene.settings.mode = Mode::Path(PathSettings::default());
        scene.settings.max_depth = PathSettings::DEPTH;
        scene.settings.supersampling = 1;
    }
}

/// Has Whitted's integrator draw what was made for paths; with a light from the left and above if
/// there is none.
fn use_whitted_integrator(scene: &mut Scene) {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        return;
    }
    scene.settings.mode = Mode::Phong;
    if scene.lights.is_empty() {
        let key_light_direction = Sun {
            direction: studio::key_light_direction().to_array(),
            irradiance: [PI; 3],
        };
        scene.lights.push(key_light_direction.light());
    }
}

/// Adds a light. As of a scene text: what has a physical light is shown by its paths.
pub fn add_light(scene: &mut Scene, light: Light) {
    if light.point().is_none() && scene.settings.mode == Mode::Phong {
        use_path_integrator(scene);
    }
    scene.lights.push(light);
}

/// Takes the lights away, and where they were written.
pub fn remove_lights(lowered: &mut Lowered) {
    lowered.scene.lights.clear();
    lowered.source_spans.forget(EntityKind::Light);
}

/// Puts lights of the course in place of physical ones, which Whitted's integrator does not see.
fn replace_physical_lights(scene: &mut Scene) {
    if scene.lights.iter().all(|light| light.point().is_some()) {
        return;
    }
    let ball = scene.bounding_sphere().unwrap_or(BoundingSphere {
        center: Vec3::ZERO,
        radius: 1.0,
    });
    for light in &mut scene.lights {
        if let Light::Punctual(punctual) = light {
            *light = Light::Point(as_point(punctual, ball));
        }
    }
}

/// The light without falloff that gives the middle of the scene as much as a physical one.
fn as_point(light: &Punctual, ball: BoundingSphere) -> PointLight {
    let (position, irradiance) = if let Some(position) = light.emitter.position() {
        let square = Vec3::from_array(position).distance_squared(ball.center);
        (position, 1.0 / square.max(ball.radius * ball.radius))
    } else {
        let direction = light.emitter.direction().map(Vec3::from_array);
        let direction = direction.and_then(unit).unwrap_or(Vec3::Y);
        let position = ball.center + direction * (SUN_DISTANCE * ball.radius);
        (position.to_array(), 1.0)
    };
    // A white surface that faces the light shows its colour here, its irradiance over π there.
    PointLight {
        position,
        color: light.intensity.map(|channel| channel * irradiance / PI),
        radius: 0.0,
    }
}
