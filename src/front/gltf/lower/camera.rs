//! The camera: the requested one, or the first one of the scene, or a default camera that frames
//! the scene.

use super::super::camera::{Projection, projection};
use super::super::field::ObjectFields;
use super::Lowering;
use glam::DAffine3;
use rtc_ir::{self as ir, BoundingSphere, Camera, EntityField, EntityKind, Lens, ValuePath};
use rtc_math::{Vec3, cos, sin, unit};
use rtc_source::tree::NodeId;

/// The height of a picture in pixels, and its width over its height where the asset does not say.
const HEIGHT: u32 = 512;
const ASPECT: f64 = 1.0;
/// The opening of a camera that we choose, in degrees from bottom to top.
const OPENING: f64 = 35.0;
/// The position relative to the centre of the scene: a three-quarter view, 34° to the right of the
/// front and 23° above.
const FROM: [f64; 3] = [2.0, 1.5, 3.0];

/// A camera that the scene shows, by its index and that of its node.
pub(super) struct CameraUse {
    pub(super) camera: usize,
    pub(super) node: usize,
    pub(super) world: DAffine3,
}

impl Lowering<'_, '_, '_> {
    /// Adds the camera to the scene: the requested one, by its name, that of its node, or its
    /// index. False if it is our own.
    pub(super) fn camera(&mut self, wanted: Option<&str>) -> bool {
        // Find the requested camera, or the first one that shows anything.
        let chosen = match wanted {
            Some(name) => self.find_camera(name).and_then(|seen| self.camera_of(seen)),
            None => self.cameras.iter().find_map(|seen| self.camera_of(seen)),
        };
        // Without one, look at the bounding sphere of the scene.
        match chosen {
            Some((at, camera)) => {
                self.source_spans.record(
                    ValuePath::new(EntityKind::Camera, 0, EntityField::Whole),
                    self.report.json.span(at),
                );
                self.scene.camera = camera;
                true
            }
            None => {
                if let Some(name) = wanted {
                    let names: Vec<String> = self
                        .cameras
                        .iter()
                        .map(|seen| self.camera_names(seen).join("/"))
                        .collect();
                    super::missing(
                        "camera that shows anything called",
                        name,
                        &names,
                        self.report,
                    );
                }
                let ball = self.scene.bounding_sphere().unwrap_or(BoundingSphere {
                    center: Vec3::ZERO,
                    radius: 1.0,
                });
                self.scene.camera = looking_at(ball);
                false
            }
        }
    }

    fn camera_of(&self, seen: &CameraUse) -> Option<(NodeId, Camera)> {
        let at = *self.doc.cameras.get(seen.camera)?;
        let fields = ObjectFields::new(self.report.json, at).animated(&self.materials.animated);
        let (mut camera, ahead) = through(projection(fields)?, seen.world)?;
        if let Some(extras) = fields.rtc_extras() {
            refine(&mut camera, ahead, extras);
        }
        Some((at, camera))
    }

    fn find_camera(&self, name: &str) -> Option<&CameraUse> {
        (0..3).find_map(|kind| {
            self.cameras
                .iter()
                .find(|seen| self.camera_names(seen)[kind] == name)
        })
    }

    /// The identifiers of a camera: its name, that of its node, its index.
    fn camera_names(&self, seen: &CameraUse) -> [String; 3] {
        let name = self
            .doc
            .cameras
            .get(seen.camera)
            .map(|camera| ObjectFields::new(self.report.json, *camera).name());
        [
            name.unwrap_or_default(),
            self.doc.nodes[seen.node].name.clone(),
            seen.camera.to_string(),
        ]
    }
}

/// The camera of a projection with a transform, and its view direction; `None` if the transform is
/// singular.
fn through(projection: Projection, world: DAffine3) -> Option<(Camera, Vec3)> {
    // The directions of the axes count; scale does not.
    let z = unit(world.z_axis)?;
    let x = unit(world.x_axis - z * world.x_axis.dot(z))?;
    let y = z.cross(x) * world.y_axis.dot(z.cross(x)).signum();
    let (half, kind) = match projection {
        Projection::Perspective { yfov, aspect } => {
            let tangent = sin(yfov / 2.0) / cos(yfov / 2.0);
            if yfov >= std::f64::consts::PI {
                return None;
            }
            (
                [tangent * aspect.unwrap_or(ASPECT), tangent],
                ir::Projection::Perspective,
            )
        }
        Projection::Orthographic { xmag, ymag } => ([xmag, ymag], ir::Projection::Orthographic),
    };
    Some((camera(world.translation, [x, y, z], half, kind), -z))
}

/// Sets the properties that glTF lacks: the size of the picture, the plane of focus, the offset of
/// the centre in half sizes, and the lens.
fn refine(camera: &mut Camera, ahead: Vec3, extras: ObjectFields<'_, '_>) {
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let [width, height] = camera.size;
    let size = [
        extras.count_or("width", width),
        extras.count_or("height", height),
    ];
    let distance = extras.number_or("focusDistance", 1.0);
    // Halves of the picture in the plane of focus; those of parallel rays are the same in all.
    let reach = reach(eye);
    let far = match camera.projection {
        ir::Projection::Perspective => distance / reach,
        ir::Projection::Orthographic => 1.0,
    };
    // Far from the camera, the difference of two positions has a poor direction.
    let ahead = if reach > 1.0 { ahead } else { center - eye };
    let half = [
        right * (far * f64::from(width) / 2.0),
        up * (far * f64::from(height) / 2.0),
    ];
    let [across, upward] = extras.vector_or("shift", [0.0; 2]);
    let middle = eye + ahead * distance + half[0] * across + half[1] * upward;
    camera.center = middle.to_array();
    camera.right = (half[0] * (2.0 / f64::from(size[0]))).to_array();
    camera.up = (half[1] * (2.0 / f64::from(size[1]))).to_array();
    camera.size = size;
    camera.lens = Lens {
        radius: extras.number_or("lensRadius", 0.0),
        samples: extras.count_or("lensSamples", 1),
    };
}

/// The default distance of the plane of focus: 1, or more where 1 is too small relative to the
/// coordinates; a power of two.
fn reach(eye: Vec3) -> f64 {
    const NEAR: f64 = 1_048_576.0;
    let far = (eye.abs().max_element() / NEAR).clamp(1.0, f64::MAX);
    // The bits of the exponent.
    f64::from_bits(far.to_bits() & (0x7ff << 52))
}

/// A camera at `eye` with the given half extents at distance 1.
fn camera(eye: Vec3, [x, y, z]: [Vec3; 3], half: [f64; 2], projection: ir::Projection) -> Camera {
    let ratio = (half[0] / half[1]).abs();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let width = (f64::from(HEIGHT) * ratio).round().clamp(1.0, 16384.0) as u32;
    let reach = reach(eye);
    let half = match projection {
        ir::Projection::Perspective => half.map(|half| half * reach),
        ir::Projection::Orthographic => half,
    };
    Camera {
        eye: eye.to_array(),
        center: (eye - z * reach).to_array(),
        right: (x * (2.0 * half[0] / f64::from(width))).to_array(),
        up: (y * (2.0 * half[1] / f64::from(HEIGHT))).to_array(),
        size: [width, HEIGHT],
        lens: Lens::PINHOLE,
        projection,
    }
}

/// The size that a pixel in the picture of the camera that we choose has at the middle of the ball;
/// 0 if that is too far away for it.
pub(crate) fn pixel(ball: BoundingSphere) -> f64 {
    let camera = looking_at(ball);
    let eye = Vec3::from_array(camera.eye);
    let pixel = Vec3::from_array(camera.up).length() / reach(eye) * eye.distance(ball.center);
    if pixel.is_finite() { pixel } else { 0.0 }
}

/// A camera that sees the whole ball.
pub(crate) fn looking_at(BoundingSphere { center, radius }: BoundingSphere) -> Camera {
    let half = OPENING.to_radians() / 2.0;
    let z = Vec3::from_array(FROM).normalize();
    let x = Vec3::Y.cross(z).normalize();
    let eye = center + z * (radius / sin(half));
    let tangent = sin(half) / cos(half);
    camera(
        eye,
        [x, z.cross(x), z],
        [tangent * ASPECT, tangent],
        ir::Projection::Perspective,
    )
}
