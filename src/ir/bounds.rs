//! Where a scene is: a ball around all of it that has an end. Its middle is what cameras without a
//! target look at.

use super::{Column, Scene, Shape};
use rtc_math::Vec3;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// The middle.
    pub center: Vec3,
    /// The radius, above 0.
    pub radius: f64,
}

impl Scene {
    /// A ball around all shapes but planes: its middle is that of the box around them. `None` if
    /// there is nothing that has an end, and an extent.
    #[must_use]
    pub fn ball(&self) -> Option<BoundingSphere> {
        let boxes = self.mesh_boxes();
        let each = |visit: &mut dyn FnMut(Vec3)| {
            for surface in &self.surfaces {
                surface.shape.corners_around(&boxes, visit);
            }
        };
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        each(&mut |corner| (low, high) = (low.min(corner), high.max(corner)));
        let center = low + (high - low) / 2.0;
        let mut square = 0.0_f64;
        each(&mut |corner| square = square.max(corner.distance_squared(center)));
        let ball = BoundingSphere {
            center,
            radius: square.sqrt(),
        };
        (center.is_finite() && ball.radius.is_finite() && ball.radius > 0.0).then_some(ball)
    }
}

impl Scene {
    /// The boxes around the meshes, each by its least and greatest corner.
    #[must_use]
    pub fn mesh_boxes(&self) -> Vec<[Vec3; 2]> {
        let meshes = self.meshes.iter();
        meshes.map(|mesh| around(&mesh.positions)).collect()
    }
}

impl Shape {
    /// Visits the corners of boxes around the shape; none if it has no end. `meshes` are the boxes
    /// around the meshes of the scene.
    pub fn corners_around(&self, meshes: &[[Vec3; 2]], visit: &mut dyn FnMut(Vec3)) {
        self.bounded().cubes(meshes, &mut |center, half| {
            let corners = box_corners([center - half, center + half]);
            corners.into_iter().for_each(&mut *visit);
        });
    }
}

/// The box around some points, empty if there are none.
fn around(points: &Column<3>) -> [Vec3; 2] {
    let points = || points.iter().map(Vec3::from_array);
    [
        points().fold(Vec3::INFINITY, Vec3::min),
        points().fold(Vec3::NEG_INFINITY, Vec3::max),
    ]
}

/// The corners of a box.
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
