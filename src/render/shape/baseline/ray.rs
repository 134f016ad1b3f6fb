//! The ray of the baseline formulas, and the selection of valid roots.

use super::real::{Real, RealVector};
use crate::ray::Ray;
use rtc_math::Vector;
use rtc_plan::MIN_HIT_DISTANCE;

/// A ray in the numbers of the baseline formulas.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineRay<R> {
    pub(in crate::shape) origin: Vector<R>,
    pub(in crate::shape) direction: Vector<R>,
    /// The square of the direction's length in the world.
    pub(in crate::shape) length2: R,
}

impl<R: Real> BaselineRay<R> {
    #[inline]
    pub(in crate::shape) fn of(ray: &Ray) -> Self {
        let direction = Vector::of(ray.direction);
        Self {
            origin: Vector::of(ray.origin),
            direction,
            length2: direction.dot(direction),
        }
    }

    #[inline]
    pub(in crate::shape) fn at(&self, t: R) -> Vector<R> {
        self.origin + self.direction * t
    }

    /// Whether a root is a number and beyond [`MIN_HIT_DISTANCE`].
    #[inline]
    pub(in crate::shape) fn counts(&self, t: R) -> bool {
        let zero = R::of(0.0);
        t > zero
            && t * t * self.length2 > R::of(MIN_HIT_DISTANCE * MIN_HIT_DISTANCE)
            && t < R::of(f64::INFINITY)
    }

    /// The first of some roots that counts, each with the part it is on.
    #[inline]
    pub(in crate::shape) fn first(
        &self,
        roots: impl IntoIterator<Item = (R, u32)>,
    ) -> Option<(R, u32)> {
        let nearer = |best: Option<(R, u32)>, root: (R, u32)| match best {
            Some(best) if best.0 <= root.0 => Some(best),
            _ => Some(root),
        };
        roots
            .into_iter()
            .filter(|(t, _)| self.counts(*t))
            .fold(None, nearer)
    }
}
