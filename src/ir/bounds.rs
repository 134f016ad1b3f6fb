//! Bounds of a scene: a sphere around every finite shape. Cameras without a target look at its
//! centre.

use super::{Scene, Shape, VertexColumn};
use rtc_math::Vec3;

/// A bounding sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// The centre, in world coordinates.
    pub center: Vec3,
    /// The radius, above 0.
    pub radius: f64,
}

impl Scene {
    /// A sphere around all shapes except planes, centred in their bounding box. `None` if there is
    /// no finite shape, or if all of them are one point.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<BoundingSphere> {
        let boxes = self.mesh_boxes();
        let for_each_corner = |visit: &mut dyn FnMut(Vec3)| {
            for surface in &self.surfaces {
                surface.shape.corners_around(&boxes, visit);
            }
        };
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for_each_corner(&mut |corner| (low, high) = (low.min(corner), high.max(corner)));
        let center = low + (high - low) / 2.0;
        let mut square = 0.0_f64;
        for_each_corner(&mut |corner| square = square.max(corner.distance_squared(center)));
        let sphere = BoundingSphere {
            center,
            radius: square.sqrt(),
        };
        (center.is_finite() && sphere.radius.is_finite() && sphere.radius > 0.0).then_some(sphere)
    }
}

impl Scene {
    /// The bounding box of each mesh in object coordinates, as its minimum and maximum corner.
    #[must_use]
    pub fn mesh_boxes(&self) -> Vec<[Vec3; 2]> {
        let meshes = self.meshes.iter();
        meshes.map(|mesh| bounding_box(&mesh.positions)).collect()
    }
}

impl Shape {
    /// Visits the corners of boxes that contain the shape; visits none if the shape is infinite.
    /// `meshes` holds the bounding box of each mesh of the scene.
    pub fn corners_around(&self, meshes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3)) {
        self.bounded().visit_bounds(meshes, &mut |center, half| {
            let corners = box_corners([center - half, center + half]);
            corners.into_iter().for_each(&mut *visit);
        });
    }
}

/// The bounding box of points; empty (minimum above maximum) if there are none.
fn bounding_box(points: &VertexColumn<3>) -> [Vec3; 2] {
    let points = || points.iter().map(Vec3::from_array);
    [
        points().fold(Vec3::INFINITY, Vec3::min),
        points().fold(Vec3::NEG_INFINITY, Vec3::max),
    ]
}

/// The eight corners of a box.
pub(super) fn box_corners([low, high]: [Vec3; 2]) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        let pick = |bit: usize| {
            if corner >> bit & 1 == 0 {
                low[bit]
            } else {
                high[bit]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}
