//! The plane: t from compensated dot products with the raw normal, accurate at any slope and
//! distance.

use crate::math::{Vec3, cross, dot, two_difference, unit_scale};
use crate::render::ray::{Interaction, Ray};

/// How a plane stands.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Normal {
    /// The normal as given, times a power of two.
    raw: Vec3,
    /// Its square.
    square: f64,
    unit: Vec3,
}

/// A prepared plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    anchor: Vec3,
    normal: Normal,
}

impl Normal {
    /// That of a vector, which must not be zero.
    #[must_use]
    pub(in crate::render) fn new(vector: Vec3) -> Self {
        let raw = unit_scale(vector).map_or(vector, |(scaled, _)| scaled);
        let square = dot(raw, raw);
        Self {
            raw,
            square,
            unit: raw / square.sqrt(),
        }
    }

    /// That of a triangle, or `None` if its corners are in line.
    #[must_use]
    pub(in crate::render) fn of([a, b, c]: [Vec3; 3]) -> Option<Self> {
        let (first, _) = unit_scale(b - a)?;
        let (second, _) = unit_scale(c - a)?;
        let normal = cross(first, second);
        (normal != Vec3::ZERO).then(|| Self::new(normal))
    }

    /// The unit vector.
    #[must_use]
    #[inline]
    pub(in crate::render) fn unit(&self) -> Vec3 {
        self.unit
    }

    /// The plane through a point.
    #[must_use]
    #[inline]
    pub(in crate::render) fn through(self, anchor: Vec3) -> Plane {
        Plane {
            anchor,
            normal: self,
        }
    }
}

impl Plane {
    /// The plane through `anchor` at a right angle to `normal`, which must not be zero.
    #[must_use]
    pub fn new(anchor: Vec3, normal: Vec3) -> Self {
        Normal::new(normal).through(anchor)
    }

    /// The unit normal.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal.unit
    }

    /// The t of the plane along the ray, of any sign, with an error of at most 10 u; `None` for a
    /// parallel ray.
    #[must_use]
    #[inline]
    pub fn parameter(&self, ray: &Ray) -> Option<f64> {
        let slope = dot(self.normal.raw, ray.direction);
        if slope == 0.0 {
            return None;
        }
        Some(self.distance(ray.origin) / slope)
    }

    /// N·(anchor − p), as if in twice the precision.
    #[inline]
    fn distance(&self, p: Vec3) -> f64 {
        let (x, x_error) = two_difference(self.anchor.x, p.x);
        let (y, y_error) = two_difference(self.anchor.y, p.y);
        let (z, z_error) = two_difference(self.anchor.z, p.z);
        let raw = self.normal.raw;
        dot(raw, Vec3::new(x, y, z)) + raw.dot(Vec3::new(x_error, y_error, z_error))
    }

    /// The root above 0.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        self.parameter(ray).filter(|t| *t > 0.0)
    }

    /// The point at `t`, moved onto the plane.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        let near = ray.origin + ray.direction * t;
        let Normal { raw, square, unit } = self.normal;
        let point = near + raw * (self.distance(near) / square);
        Interaction::new(ray, point, unit, self.anchor, 0.0)
    }
}
