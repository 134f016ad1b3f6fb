//! An emissive triangle.

use crate::shape::emitter::EmitterPoint;
use crate::world::SurfaceId;
use rtc_math::Vec3;

/// A triangle of a surface with an emissive material.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleLight {
    pub(super) surface: SurfaceId,
    pub(super) prim_id: u32,
    pub(super) corners: [Vec3; 3],
    /// The cross product of two edges, 2·A·n.
    cross: Vec3,
}

impl TriangleLight {
    /// A triangle of a surface.
    pub(super) fn new(surface: SurfaceId, prim_id: u32, corners: [Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            surface,
            prim_id,
            corners,
            cross: (b - a).cross(c - a),
        }
    }

    pub(super) fn area(&self) -> f64 {
        0.5 * self.cross.length()
    }

    /// Its unit normal.
    pub(super) fn normal(&self) -> Vec3 {
        self.cross.normalize_or(Vec3::Z)
    }

    /// A point of it.
    pub(super) fn at(&self, point: Vec3) -> EmitterPoint {
        EmitterPoint {
            point,
            normal: self.normal(),
            prim_id: self.prim_id,
        }
    }

    /// The density per solid angle of [`Self::point`], in the direction `wi` at a squared distance:
    /// `r²/(A·|cos θ|)`.
    pub(super) fn pdf(&self, wi: Vec3, distance_squared: f64) -> f64 {
        // Convert from area to solid angle.
        let projected = 0.5 * self.cross.dot(wi).abs();
        if projected > 0.0 {
            distance_squared / projected
        } else {
            0.0
        }
    }

    /// Samples a point uniformly by area (Heitz, "A low-distortion map between triangle and
    /// square", 2019).
    pub(super) fn point(&self, [u, v]: [f64; 2]) -> Vec3 {
        let [a, b, c] = self.corners;
        // Fold the unit square onto barycentric coordinates.
        let (u, v) = if v > u {
            (u * 0.5, v - u * 0.5)
        } else {
            (u - v * 0.5, v * 0.5)
        };
        a * u + b * v + c * (1.0 - u - v)
    }
}
