//! Motion blur: the moments of the shutter.
//!
//! A picture of a scene that moves is the mean over moments of the shutter, each of which is a
//! scene that stands still (Haeberli and Akeley, "The accumulation buffer", SIGGRAPH 1990): each
//! sample is taken at one of them. So everything that holds for a still scene holds at each moment.

use crate::effect::{Effect, EffectState, EffectStatus};
use crate::surface_bounds::{SurfaceBounds, surface_bounds};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{Vec3, cross};
use rtc_valid::{Camera, Material, Projection, Shape, Surface, ValidScene};

/// The least and the greatest number of moments of a scene that moves.
const MOMENTS: [u32; 2] = [16, 256];

/// The most surfaces, lights and materials of all moments together: there is a world for each
/// moment.
const MOST_ENTITIES: usize = 1 << 21;

/// The number of moments: 1 if nothing moves, else a power of two, so many that nothing moves
/// farther than about a pixel from one to the next, as far as [`MOMENTS`] and [`MOST_ENTITIES`]
/// allow.
pub(crate) fn moments(scene: &ValidScene) -> u32 {
    if !scene.moves() {
        return 1;
    }
    let bounds = surface_bounds(scene);
    let steps = scene.surfaces().iter().zip(&bounds);
    let farthest = steps.map(|(surface, bounds)| pixels(surface.sweep, bounds, scene.camera()));
    let farthest = farthest.fold(0.0, f64::max);
    let entities = scene
        .surfaces()
        .iter()
        .map(|surface| entities(surface, scene));
    let others = scene.materials().len() + scene.lights().len();
    let entities = entities.fold(others, usize::saturating_add);
    let [least, most] = MOMENTS;
    let mut moments = least;
    while f64::from(moments) < farthest && moments < most {
        moments *= 2;
    }
    while moments > 2 && entities.saturating_mul(moments as usize) > MOST_ENTITIES {
        moments /= 2;
    }
    moments
}

/// The number of pixels that a surface within some bounds moves by; infinite where it may pass the
/// eye.
fn pixels(sweep: Vec3, bounds: &SurfaceBounds, camera: &Camera) -> f64 {
    let length = sweep.length();
    if length == 0.0 {
        return 0.0;
    }
    let pixel = camera.right.length().min(camera.up.length());
    match camera.projection {
        Projection::Orthographic => length / pixel,
        Projection::Perspective | Projection::Stereo(_) => {
            let axis = cross(camera.right.normalize(), camera.up.normalize());
            let plane = axis.dot(camera.center - camera.eye).abs();
            let distance = bounds.aabb().map_or(0.0, |aabb| aabb.distance(camera.eye));
            length * plane / (pixel * distance)
        }
    }
}

/// The number of surfaces and lights that a surface takes in a world.
fn entities(surface: &Surface, scene: &ValidScene) -> usize {
    let is_light = match &scene.materials()[surface.material] {
        Material::Standard(material) => material.emissive != Vec3::ZERO,
        Material::Phong(_) => false,
    };
    let triangles = if let (Shape::Instance(instance), true) = (&surface.shape, is_light) {
        scene.meshes()[instance.mesh].triangles.len()
    } else {
        0
    };
    1 + triangles
}

/// The status of motion blur in a scene that moves.
pub(crate) fn status(scene: &ValidScene, moments: u32) -> Option<EffectStatus> {
    let moving = scene.surfaces().iter();
    let moving = moving.filter(|surface| surface.sweep != Vec3::ZERO);
    let path = |surface: &Surface| {
        ValuePath::new(EntityKind::Surface, surface.index, EntityField::Velocity)
    };
    (moments > 1).then(|| EffectStatus {
        effect: Effect::MotionBlur,
        of: None,
        state: EffectState::Needed,
        rule: None,
        reason: format!(
            "{} of {} surfaces move: {moments} moments of the shutter",
            moving.clone().count(),
            scene.surfaces().len()
        ),
        facts: moving.map(path).take(3).collect(),
    })
}
