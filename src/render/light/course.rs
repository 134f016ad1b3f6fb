//! A light of the course: a point, or a sphere that is sampled as a disc.

use crate::math::{NonNegative, Vec3};

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
