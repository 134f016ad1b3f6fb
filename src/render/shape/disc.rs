//! The disc: a plane, and a test of the distance from its centre in the disc's own frame.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::plane::Plane;

/// A prepared disc, rim included.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    plane: Plane,
    center: Vec3,
    radius: f64,
}

impl Disc {
    /// The disc around `center` at a right angle to `normal`, which must not be zero.
    #[must_use]
    pub fn new(center: Vec3, normal: Vec3, radius: f64) -> Self {
        Self {
            plane: Plane::new(center, normal),
            center,
            radius,
        }
    }

    /// The root above 0.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let t = self.plane.intersect(ray)?;
        let local = (ray.origin - self.center) + ray.direction * t;
        (local.dot(local) <= self.radius * self.radius).then_some(t)
    }

    /// The point at `t`, moved onto the plane of the disc.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        self.plane.interaction(ray, t)
    }

    /// A box around the disc.
    #[must_use]
    pub(in crate::render) fn bounds(&self) -> Bounds {
        Bounds::around_disc(self.center, self.plane.normal(), self.radius)
    }
}
