//! Boxes, and a slab test that never misses what the shape inside would hit.

use super::ray::Ray;
use crate::math::{U, Vec3};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lowest corner.
    pub min: Vec3,
    /// The highest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box of some points.
    #[must_use]
    pub fn of(points: &[Vec3]) -> Self {
        points
            .iter()
            .fold(Self::EMPTY, |bounds, point| Self { min: bounds.min.min(*point), max: bounds.max.max(*point) })
    }

    /// The box around a sphere, rounded outward.
    #[must_use]
    pub fn around(center: Vec3, radius: f64) -> Self {
        let (low, high) = (center - Vec3::splat(radius), center + Vec3::splat(radius));
        Self {
            min: Vec3::new(low.x.next_down(), low.y.next_down(), low.z.next_down()),
            max: Vec3::new(high.x.next_up(), high.y.next_up(), high.z.next_up()),
        }
    }

    /// The box around a disc with a unit normal, rounded outward.
    #[must_use]
    pub fn around_disc(center: Vec3, normal: Vec3, radius: f64) -> Self {
        let reach = |n: f64| radius * (1.0 - n * n).max(0.0).sqrt() * (1.0 + 16.0 * U) + radius * 16.0 * U;
        let reach = Vec3::new(reach(normal.x), reach(normal.y), reach(normal.z));
        Self::around(center - reach, 0.0).union(Self::around(center + reach, 0.0))
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle.
    #[must_use]
    pub fn center(self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half the surface area; 0 for the empty box.
    #[must_use]
    pub fn half_area(self) -> f64 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// What of a ray the slab test needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs {
    origin: Vec3,
    inverse: Vec3,
}

impl Slabs {
    /// The slabs of a ray.
    #[must_use]
    pub(super) fn new(ray: &Ray) -> Self {
        Self { origin: ray.origin, inverse: ray.direction.recip() }
    }

    /// True for the axes along which the ray runs downwards.
    #[must_use]
    pub(super) fn runs_down(&self, axis: usize) -> bool {
        self.inverse[axis] < 0.0
    }

    /// Whether the ray may meet the box before `t_max`.
    ///
    /// Conservative as in Ize, "Robust BVH ray traversal" (JCGT 2, 2013): the far end grows by 2γ₃, and comparisons are
    /// written so that the NaN of a ray inside a slab's plane leaves the interval as it is.
    #[must_use]
    #[inline]
    pub(super) fn meet(&self, bounds: &Bounds, t_max: f64) -> bool {
        const GROWN: f64 = 1.0 + 2.0 * (3.0 * U / (1.0 - 3.0 * U));
        let (mut near, mut far) = (0.0, t_max);
        for axis in 0..3 {
            let first = (bounds.min[axis] - self.origin[axis]) * self.inverse[axis];
            let second = (bounds.max[axis] - self.origin[axis]) * self.inverse[axis];
            let (enter, leave) = if self.inverse[axis] < 0.0 { (second, first) } else { (first, second) };
            let leave = leave * GROWN;
            if enter > near {
                near = enter;
            }
            if leave < far {
                far = leave;
            }
        }
        near <= far
    }
}
