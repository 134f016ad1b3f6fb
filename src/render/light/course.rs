//! A light of the course: a point, or a sphere that is sampled as a disc.

use crate::math::{NonNegative, Vec3};
use crate::render::accel::bounds::Ball;

/// A light of equal intensity in all directions, without falloff.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct CourseLight {
    /// Its position.
    pub(in crate::render) position: Vec3,
    /// Its colour.
    pub(in crate::render) color: Vec3,
    /// Its radius; 0 for a point.
    pub(in crate::render) radius: NonNegative,
}

impl CourseLight {
    /// The ball it fills.
    #[inline]
    pub(in crate::render) fn ball(&self) -> Ball {
        Ball {
            center: self.position,
            radius: self.radius.get(),
        }
    }
}
