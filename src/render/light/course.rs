//! A light of a course scene: a point, or a sphere that is sampled as a disc.

use crate::accel::bounds::BoundingSphere;
use rtc_math::{NonNegative, Vec3};

/// A light of equal intensity in all directions, without falloff.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CourseLight {
    /// Its position.
    pub(crate) position: Vec3,
    /// Its colour.
    pub(crate) color: Vec3,
    /// Its radius; 0 for a point.
    pub(crate) radius: NonNegative,
}

impl CourseLight {
    /// The ball it fills.
    #[inline]
    pub(crate) fn ball(&self) -> BoundingSphere {
        BoundingSphere {
            center: self.position,
            radius: self.radius.get(),
        }
    }
}
