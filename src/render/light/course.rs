//! A light of the course: a point, or with a radius a sphere that shows a disc.

use crate::math::{NonNegative, Vec3};

/// It shines equally in all directions, without falloff.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct CourseLight {
    /// Where it stands.
    pub(in crate::render) position: Vec3,
    /// Its colour.
    pub(in crate::render) color: Vec3,
    /// Its radius; 0 for a point.
    pub(in crate::render) radius: NonNegative,
}
