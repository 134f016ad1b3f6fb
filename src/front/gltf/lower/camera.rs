//! The camera: the first one that the scene shows, or else one that looks at all of it.

use super::super::camera::Projection;
use super::Lowering;
use crate::ir::{self, Camera, Field, Lens, Noun, Place, Shape};
use crate::math::{Vec3, cos, sin};
use glam::DAffine3;

/// The height of a picture in pixels, and its width over its height where the asset does not say.
const HEIGHT: u32 = 512;
const ASPECT: f64 = 1.0;
/// The opening of a camera that we choose, in radians.
const OPENING: f64 = 0.8;
/// Where it stands, from the middle of the scene: in front, a little to the right and above.
const FROM: [f64; 3] = [0.4, 0.3, 1.0];

impl Lowering<'_, '_, '_> {
    /// Puts the camera into the scene.
    pub(super) fn camera(&mut self) {
        let own = self.cameras.iter().find_map(|(camera, world)| {
            let camera = self.doc.cameras.get(*camera)?;
            Some((camera.at, through(camera.projection?, *world)?))
        });
        match own {
            Some((at, camera)) => {
                self.origins.record(Place::new(Noun::Camera, 0, Field::Whole), self.report.json.span(at));
                self.scene.camera = camera;
            }
            None => {
                let (center, radius) = bounds(&self.scene);
                self.scene.camera = looking_at(center, radius);
            }
        }
    }
}

/// The camera of a projection at a place; none if the place has no volume.
fn through(projection: Projection, world: DAffine3) -> Option<Camera> {
    // The directions of the axes count; scale does not.
    let z = world.z_axis.normalize_or_zero();
    let x = (world.x_axis - z * world.x_axis.dot(z)).normalize_or_zero();
    let y = z.cross(x) * world.y_axis.dot(z.cross(x)).signum();
    if z == Vec3::ZERO || x == Vec3::ZERO {
        return None;
    }
    let (half, kind) = match projection {
        Projection::Perspective { yfov, aspect } => {
            let tangent = sin(yfov / 2.0) / cos(yfov / 2.0);
            if yfov >= std::f64::consts::PI {
                return None;
            }
            ([tangent * aspect.unwrap_or(ASPECT), tangent], ir::Projection::Perspective)
        }
        Projection::Orthographic { xmag, ymag } => ([xmag, ymag], ir::Projection::Orthographic),
    };
    Some(camera(world.translation, [x, y, z], half, kind))
}

/// A camera at `eye` that sees so much to each side at distance 1.
fn camera(eye: Vec3, [x, y, z]: [Vec3; 3], half: [f64; 2], projection: ir::Projection) -> Camera {
    let ratio = (half[0] / half[1]).abs();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let width = (f64::from(HEIGHT) * ratio).round().clamp(1.0, 16384.0) as u32;
    Camera {
        eye: eye.to_array(),
        center: (eye - z).to_array(),
        right: (x * (2.0 * half[0] / f64::from(width))).to_array(),
        up: (y * (2.0 * half[1] / f64::from(HEIGHT))).to_array(),
        size: [width, HEIGHT],
        lens: Lens { radius: 0.0, samples: 1 },
        projection,
    }
}

/// A camera that sees the whole ball around `center`.
pub(super) fn looking_at(center: [f64; 3], radius: f64) -> Camera {
    let z = Vec3::from_array(FROM).normalize();
    let x = Vec3::Y.cross(z).normalize();
    let eye = Vec3::from_array(center) + z * (radius / sin(OPENING / 2.0));
    let tangent = sin(OPENING / 2.0) / cos(OPENING / 2.0);
    camera(eye, [x, z.cross(x), z], [tangent * ASPECT, tangent], ir::Projection::Perspective)
}

/// The middle of all that is placed, and how far it reaches from there.
fn bounds(scene: &ir::Scene) -> ([f64; 3], f64) {
    let corners = scene.meshes.iter().map(|mesh| {
        let positions = || mesh.positions.iter().map(Vec3::from_array);
        [positions().fold(Vec3::INFINITY, Vec3::min), positions().fold(Vec3::NEG_INFINITY, Vec3::max)]
    });
    let corners: Vec<[Vec3; 2]> = corners.collect();
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for surface in &scene.surfaces {
        let Shape::Instance(instance) = &surface.shape else { continue };
        let world = DAffine3::from_cols_array_2d(&instance.world_from_object);
        let Some(&[least, most]) = corners.get(instance.mesh.0 as usize) else { continue };
        for corner in 0..8 {
            let pick = |bit: u32, axis: usize| if corner >> bit & 1 == 0 { least[axis] } else { most[axis] };
            let point = world.transform_point3(Vec3::new(pick(0, 0), pick(1, 1), pick(2, 2)));
            (low, high) = (low.min(point), high.max(point));
        }
    }
    let (center, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    if center.is_finite() && radius > 0.0 { (center.to_array(), radius) } else { ([0.0; 3], 1.0) }
}
