//! Replaces planes by squares and flat quadrilaterals by triangles.

use rtc_ir::{BoundingSphere, Cylinder, InfiniteCylinder, Plane, Scene};
use rtc_math::{OrthonormalBasis, Vec3, cross, unit};

/// The half side of the square of a plane, in radii of the scene.
const PLANE: f64 = 4.0;

/// Half the side of the square of a plane.
pub(super) fn side(around: BoundingSphere) -> f64 {
    PLANE * around.radius
}

/// A sphere around all finite shapes and the eye, which determines the squares of planes.
pub(super) fn around(scene: &Scene) -> BoundingSphere {
    let eye = Vec3::from_array(scene.camera.eye);
    let view_direction = Vec3::from_array(scene.camera.center) - eye;
    let sphere = scene.bounding_sphere().unwrap_or(BoundingSphere {
        center: eye,
        radius: view_direction.length(),
    });
    BoundingSphere {
        radius: sphere.radius.max(sphere.center.distance(eye)),
        ..sphere
    }
}

/// A square around the point of a plane that is closest to the centre of the scene.
pub(super) fn square(plane: &Plane, around: BoundingSphere) -> [Vec3; 4] {
    let Plane { center, normal } = plane;
    let basis = OrthonormalBasis::around(unit(Vec3::from_array(*normal)).unwrap_or(Vec3::Z));
    let above = (around.center - Vec3::from_array(*center)).dot(basis.normal);
    let middle = around.center - basis.normal * above;
    let (x, y) = (basis.tangent * side(around), basis.bitangent * side(around));
    [
        middle - x - y,
        middle + x - y,
        middle + x + y,
        middle - x + y,
    ]
}

/// A cylinder without ends, as long on either side as the square of a plane is from the point of
/// its axis that is closest to the centre of the scene.
pub(super) fn finite(cylinder: &InfiniteCylinder, around: BoundingSphere) -> Cylinder {
    let InfiniteCylinder {
        center,
        axis,
        radius,
    } = cylinder;
    let direction = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z);
    let center = Vec3::from_array(*center);
    let middle = center + direction * (around.center - center).dot(direction);
    Cylinder {
        base: (middle - direction * side(around)).to_array(),
        axis: *axis,
        height: 2.0 * side(around),
        radius: *radius,
    }
}

/// The two triangles of a flat quadrilateral, along the diagonal inside it.
pub(super) fn split(corners: [Vec3; 4]) -> Vec<[u32; 3]> {
    let normal = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
        cross(b - a, c - a)
    };
    let splits = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let inside = |split: &[[u32; 3]; 2]| normal(split[0]).dot(normal(split[1])) >= 0.0;
    let split = splits.into_iter().find(inside).unwrap_or(splits[0]);
    split.to_vec()
}
