//! Surfaces in the view that the clip planes of a sensor hide in Mitsuba; they are shown.

use super::xml::{PluginNode, Property, Value};
use crate::exchange::tessellate;
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, DiagnosticSink, codes};
use rtc_ir::{Camera, Mesh, Projection, Scene, Shape};
use rtc_math::{Vec3, unit};
use rtc_source::Span;

/// The most triangles that are looked at.
const MAX_TRIANGLES: usize = 1 << 22;

/// A clip plane of a sensor: its distance along the axis of the view.
#[derive(Clone, Copy)]
pub(super) struct ClipPlane {
    depth: f64,
    is_near: bool,
    span: Span,
}

impl ClipPlane {
    /// The clip planes that a sensor names.
    pub(super) fn of(sensor: &PluginNode) -> Vec<Self> {
        let plane = |Property { name, value }: &Property| {
            let is_near = name.text == "near_clip";
            match value {
                Value::Number(depth) if is_near || name.text == "far_clip" => Some(Self {
                    depth: *depth,
                    is_near,
                    span: name.span,
                }),
                _ => None,
            }
        };
        sensor.properties.iter().filter_map(plane).collect()
    }
}

/// A half-space: the points p with normal · p + offset ≥ 0.
struct HalfSpace {
    normal: Vec3,
    offset: f64,
}

impl HalfSpace {
    fn through(point: Vec3, normal: Vec3) -> Self {
        Self {
            normal,
            offset: -normal.dot(point),
        }
    }

    fn height(&self, point: Vec3) -> f64 {
        self.normal.dot(point) + self.offset
    }

    /// The part of a convex polygon that is inside (Sutherland and Hodgman).
    fn clipped(&self, polygon: &[Vec3]) -> Vec<Vec3> {
        let mut kept = Vec::new();
        for (index, &end) in polygon.iter().enumerate() {
            let start = polygon[(index + polygon.len() - 1) % polygon.len()];
            let (from, to) = (self.height(start), self.height(end));
            if (from < 0.0) != (to < 0.0) {
                kept.push(start + (end - start) * (from / (from - to)));
            }
            if to >= 0.0 {
                kept.push(end);
            }
        }
        kept
    }
}

/// Warns of the planes that hide a part of what the camera sees.
pub(super) fn report_clipped(scene: &Scene, planes: &[ClipPlane], sink: &mut DiagnosticSink) {
    for plane in planes {
        let Some(hidden) = hidden(&scene.camera, plane) else {
            continue;
        };
        if !reaches(scene, &hidden) {
            continue;
        }
        let message = match plane.is_near {
            true => "what is nearer than `near_clip` is hidden in Mitsuba, and shown here",
            false => "what is farther than `far_clip` is hidden in Mitsuba, and shown here",
        };
        let diagnostic = Diagnostic::new(&codes::MITSUBA_APPROXIMATE, message);
        sink.push(diagnostic.at(plane.span, ""));
    }
}

/// The part of the view that a plane hides.
fn hidden(camera: &Camera, plane: &ClipPlane) -> Option<Vec<HalfSpace>> {
    let [eye, center, right, up] =
        [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
    let toward = center - eye;
    let axis = unit(right.cross(up))?;
    let axis = if axis.dot(toward) < 0.0 { -axis } else { axis };
    let mut spaces = Vec::new();
    for (side, pixels) in [(right, camera.size[0]), (up, camera.size[1])] {
        let half = side * (f64::from(pixels) / 2.0);
        for half in [half, -half] {
            let inward = match camera.projection {
                Projection::Orthographic => -half,
                // Across the axis and to the edge of the picture.
                Projection::Perspective => {
                    let edge = toward + half;
                    axis * half.dot(edge) - half * axis.dot(edge)
                }
            };
            spaces.push(HalfSpace::through(center + half, inward));
        }
    }
    let at = eye + axis * plane.depth;
    let (start, beyond) = match plane.is_near {
        true => (eye, HalfSpace::through(at, -axis)),
        false => (at, HalfSpace::through(at, axis)),
    };
    spaces.extend([HalfSpace::through(start, axis), beyond]);
    Some(spaces)
}

/// Whether a surface is partly within all half-spaces.
fn reaches(scene: &Scene, spaces: &[HalfSpace]) -> bool {
    let cube = tessellate::cube();
    let mut left = MAX_TRIANGLES;
    scene.surfaces.iter().any(|surface| {
        let around = |center: [f64; 3], axes: [Vec3; 3]| {
            let [x, y, z] = axes;
            (&cube, AffineTransform([x, y, z, Vec3::from_array(center)]))
        };
        let (mesh, placed) = match &surface.shape {
            Shape::Sphere(sphere) => {
                around(sphere.center, Vec3::AXES.map(|axis| axis * sphere.radius))
            }
            Shape::Ellipsoid(solid) => around(solid.center, solid.axes.map(Vec3::from_array)),
            Shape::Disc(disc) => around(disc.center, Vec3::AXES.map(|axis| axis * disc.radius)),
            Shape::Instance(instance) => match scene.meshes.get(instance.mesh.0 as usize) {
                Some(mesh) => (
                    mesh,
                    AffineTransform(instance.world_from_object.map(Vec3::from_array)),
                ),
                None => return false,
            },
            _ => return false,
        };
        left = left.saturating_sub(mesh.triangles.len());
        left > 0 && mesh_reaches(mesh, &placed, spaces)
    })
}

fn mesh_reaches(mesh: &Mesh, placed: &AffineTransform, spaces: &[HalfSpace]) -> bool {
    let corner = |index: u32| placed.point(Vec3::from_array(mesh.positions.at(index as usize)));
    let has_vertices = |triangle: &&[u32; 3]| {
        triangle
            .iter()
            .all(|index| (*index as usize) < mesh.positions.len())
    };
    mesh.triangles.iter().filter(has_vertices).any(|triangle| {
        let mut polygon = triangle.map(corner).to_vec();
        for space in spaces {
            polygon = space.clipped(&polygon);
        }
        polygon.len() > 2
    })
}
