//! Rays, and what is known of the point where one meets a surface.

use crate::math::{U, Vec3};

/// How far from a surface rays start, in units of its rounding error: enough for the error of the point, of the
/// surface's own numbers, and of the sum that moves the point.
const OFFSET: f64 = 8.0;

/// A half-line; `t` counts in lengths of `direction`, which need not be a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub direction: Vec3,
}

/// A point of a surface, with a bound on how far rounding may have moved it.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// The point, on the surface to within `error` along `normal`.
    pub point: Vec3,
    /// The geometric unit normal: outward for closed shapes, else as declared.
    pub normal: Vec3,
    /// Rays start this far from the point along the normal.
    pub offset: f64,
}

impl Interaction {
    /// The interaction at `point` of a surface whose own numbers are about `anchor`, with the extra `extent` that its
    /// size adds: 8 u·(Σ|nᵢ|(|pᵢ| + |aᵢ|) + extent).
    #[must_use]
    pub fn new(point: Vec3, normal: Vec3, anchor: Vec3, extent: f64) -> Self {
        let size = normal.abs().dot(point.abs() + anchor.abs()) + extent;
        Self { point, normal, offset: OFFSET * U * size }
    }

    /// A start for rays along `direction`, on the side of the surface the direction points to.
    #[must_use]
    pub fn start(&self, direction: Vec3) -> Vec3 {
        let side = if direction.dot(self.normal) < 0.0 { -self.offset } else { self.offset };
        self.point + self.normal * side
    }

    /// The ray from this point along `direction`.
    #[must_use]
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray { origin: self.start(direction), direction }
    }
}
