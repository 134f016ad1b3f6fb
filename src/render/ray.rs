//! Rays, and interactions of rays with surfaces.

use rtc_math::{U, Vec3, ldexp, unit_scale};

/// How far from a surface rays start, in units of its rounding error: enough for the error of the
/// point, of the surface's own numbers, and of the sum that moves the point.
pub(crate) const OFFSET: f64 = 8.0;

/// A half-line; `t` counts in lengths of `direction`, which need not be a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The origin.
    pub origin: Vec3,
    /// The direction.
    pub direction: Vec3,
}

impl Ray {
    /// The ray with its direction rescaled so that its square does not overflow, and the factor
    /// from its `t` to the `t` of `self`.
    ///
    /// Lengths from about 2^−64 to 2^64 stay as they are; others are scaled to about 1 by a power
    /// of two, which is exact.
    #[must_use]
    #[inline]
    pub fn rescaled(self) -> (Self, f64) {
        if self.is_scaled() {
            return (self, 1.0);
        }
        match unit_scale(self.direction) {
            Some((direction, exponent)) => (Self { direction, ..self }, ldexp(1.0, -exponent)),
            None => (self, 1.0),
        }
    }

    /// Whether [`Self::rescaled`] leaves it as it is.
    #[must_use]
    #[inline]
    pub(crate) fn is_scaled(&self) -> bool {
        const MOST: f64 = 18_446_744_073_709_551_616.0;
        let size = self.direction.abs().max_element();
        (1.0 / MOST..=MOST).contains(&size)
    }

    /// The unit normal of the hit surface, on the outside. Where the eye is 10¹⁶ times as far away
    /// as the surface is large, it may round to zero: then the surface faces the ray.
    #[must_use]
    pub(crate) fn outward(&self, out: Vec3) -> Vec3 {
        out.normalize_or(-self.direction.normalize())
    }
}

/// A point of a surface, with a bound on how far rounding may have moved it.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// The point, on the surface to within the rounding error that `offset` covers, along `normal`.
    pub point: Vec3,
    /// The geometric unit normal: outward for closed shapes, else as declared.
    pub normal: Vec3,
    /// Rays start this far from the point along the normal.
    pub offset: f64,
    /// The way back along the ray that hit, of length 1 or a little less.
    pub back: Vec3,
}

impl Interaction {
    /// The interaction at `point`, where `ray` meets a surface whose own numbers are about
    /// `anchor`, with the extra `extent` that its size adds: the offset is 8 u·(Σ|nᵢ|(|pᵢ| +
    /// |aᵢ|) + extent).
    #[must_use]
    pub fn new(ray: &Ray, point: Vec3, normal: Vec3, anchor: Vec3, extent: f64) -> Self {
        let size = normal.abs().dot(point.abs() + anchor.abs()) + extent;
        let back = -ray.direction / ray.direction.abs().element_sum();
        Self {
            point,
            normal,
            offset: OFFSET * U * size,
            back,
        }
    }

    /// A start for rays along `direction`, on the side of the surface the direction points to.
    ///
    /// On the side that the ray came from, the start also moves back along that ray, where nothing
    /// is hit: so a ray from the very edge of two mirrors starts on the inner side of both.
    #[must_use]
    pub fn start(&self, direction: Vec3) -> Vec3 {
        let side = if direction.dot(self.normal) < 0.0 {
            -self.offset
        } else {
            self.offset
        };
        let returns = (self.back.dot(self.normal) < 0.0) == (side < 0.0);
        let step = self.normal * side;
        self.point
            + if returns {
                step + self.back * self.offset
            } else {
                step
            }
    }

    /// The ray from this point along `direction`.
    #[must_use]
    pub fn ray(&self, direction: Vec3) -> Ray {
        Ray {
            origin: self.start(direction),
            direction,
        }
    }
}
