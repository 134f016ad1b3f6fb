//! Whether solids contain a point.

use super::csg::{Csg, Solid};
use super::shape::{Cone, Cylinder, Ellipsoid, Paraboloid, Plane, Shape, Torus};
use rtc_math::{MAX_SET_OPERANDS, Vec3, evaluate_set, unit};

impl Shape {
    /// Whether a solid given by one formula contains a point; false for other shapes.
    #[must_use]
    pub fn contains(&self, point: Vec3) -> bool {
        // Compare the distance from the centre or the axis with the radius there.
        match self {
            Shape::Sphere(sphere) => {
                point.distance(Vec3::from_array(sphere.center)) < sphere.radius
            }
            Shape::Cylinder(cylinder) => {
                let Cylinder {
                    base,
                    axis,
                    height,
                    radius,
                } = cylinder;
                let up = unit(Vec3::from_array(*axis)).map(|axis| axis * *height);
                let from_base = point - Vec3::from_array(*base);
                along(from_base, up).is_some_and(|(_, off)| off < *radius)
            }
            Shape::Cone(Cone { base, up, radius }) => {
                let from_base = point - Vec3::from_array(*base);
                let coordinates = along(from_base, Some(Vec3::from_array(*up)));
                coordinates.is_some_and(|(fraction, off)| off < radius * (1.0 - fraction))
            }
            Shape::Paraboloid(Paraboloid { base, up, radius }) => {
                let from_base = point - Vec3::from_array(*base);
                let coordinates = along(from_base, Some(Vec3::from_array(*up)));
                coordinates.is_some_and(|(fraction, off)| off < radius * (1.0 - fraction).sqrt())
            }
            Shape::Torus(torus) => {
                let Torus {
                    center,
                    axis,
                    major,
                    minor,
                } = torus;
                let Some(axis) = unit(Vec3::from_array(*axis)) else {
                    return false;
                };
                let from_center = point - Vec3::from_array(*center);
                let above = axis.dot(from_center);
                let off = (from_center - axis * above).length();
                Vec3::new(off - major, above, 0.0).length() < *minor
            }
            Shape::Ellipsoid(Ellipsoid { center, axes }) => {
                let [x, y, z] = axes.map(Vec3::from_array);
                let from_center = point - Vec3::from_array(*center);
                let rows = [y.cross(z), z.cross(x), x.cross(y)];
                let local = rows.map(|row| row.dot(from_center) / x.dot(rows[0]));
                Vec3::from_array(local).length() < 1.0
            }
            Shape::InfiniteCylinder(cylinder) => {
                let from_center = point - Vec3::from_array(cylinder.center);
                unit(Vec3::from_array(cylinder.axis))
                    .is_some_and(|axis| from_center.cross(axis).length() < cylinder.radius)
            }
            Shape::Csg(csg) => evaluate_set(&csg.steps, csg.operands_around(point)),
            Shape::Plane(_)
            | Shape::Triangle(_)
            | Shape::Quad(_)
            | Shape::Disc(_)
            | Shape::Instance(_) => false,
        }
    }
}

impl Solid {
    /// Whether a point is inside.
    #[must_use]
    pub fn contains(&self, point: Vec3) -> bool {
        if let Self::Plane(Plane { center, normal }) = self {
            let from_center = point - Vec3::from_array(*center);
            return from_center.dot(Vec3::from_array(*normal)) < 0.0;
        }
        self.shape().contains(point)
    }
}

impl Csg {
    /// The operands that contain a point, a bit for each.
    #[must_use]
    pub fn operands_around(&self, point: Vec3) -> u64 {
        let operands = self.operands.iter().take(MAX_SET_OPERANDS);
        (0..).zip(operands).fold(0, |bits, (index, operand)| {
            bits | u64::from(operand.contains(point)) << index
        })
    }
}

/// The position of a point along the axis of a solid: the fraction of the height above the base,
/// and the distance from the axis. `None` below the base or above the top.
fn along(from_base: Vec3, up: Option<Vec3>) -> Option<(f64, f64)> {
    let up = up?;
    let (axis, height) = (unit(up)?, up.length());
    let above = axis.dot(from_base);
    (above > 0.0 && above < height).then(|| (above / height, (from_base - axis * above).length()))
}
