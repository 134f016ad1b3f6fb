//! A shining triangle.

use crate::math::Vec3;

/// A triangle of a surface whose material shines.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct TriangleLight {
    pub(super) surface: usize,
    pub(super) prim_id: u32,
    pub(super) corners: [Vec3; 3],
}

impl TriangleLight {
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).cross(c - a).length()
    }

    /// The density per solid angle, seen in a direction at the square of a distance, of points all
    /// equally likely: `r²/(A·|cos θ|)`.
    pub(super) fn pdf(&self, wi: Vec3, distance_squared: f64) -> f64 {
        let [a, b, c] = self.corners;
        // The cross product is twice the area times the normal.
        let projected = 0.5 * (b - a).cross(c - a).dot(wi).abs();
        if projected > 0.0 {
            distance_squared / projected
        } else {
            0.0
        }
    }

    /// A point, all equally likely (Heitz, "A low-distortion map between triangle and square",
    /// 2019).
    pub(super) fn point(&self, [u, v]: [f64; 2]) -> Vec3 {
        let [a, b, c] = self.corners;
        let (u, v) = if v > u {
            (u * 0.5, v - u * 0.5)
        } else {
            (u - v * 0.5, v * 0.5)
        };
        a * u + b * v + c * (1.0 - u - v)
    }
}
