//! An emissive shape that is not made of triangles.

use crate::shape::emitter::Emitter;
use crate::shape::geometry::Intersect;
use crate::world::SurfaceId;
use rtc_math::{Bounds, Vec3};
use std::f64::consts::PI;

/// A surface with an emissive material, sampled as its shape declares.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeLight {
    pub(super) surface: SurfaceId,
    pub(super) emitter: Emitter,
    pub(super) bounds: Bounds,
}

impl ShapeLight {
    /// The light of a surface; `None` if its shape is not sampled as a whole.
    pub(super) fn new<S: Intersect>(surface: SurfaceId, shape: &S) -> Option<Self> {
        Some(Self {
            surface,
            emitter: shape.emitter()?,
            bounds: shape.bounds()?,
        })
    }

    /// The approximate power of a mean radiance: a flat shape shines from both of its sides.
    pub(super) fn power(&self, radiance: Vec3) -> f64 {
        let sides = if self.emitter.flat_normal().is_some() {
            2.0
        } else {
            1.0
        };
        sides * PI * self.emitter.area() * radiance.max_element()
    }
}
