//! The disc: a plane intersection, and a test of the distance from the centre in the disc's frame.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::geometry::Intersect;
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::plane::{BaselinePlane, Plane};
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3, Vector};
use std::sync::Arc;

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
    pub(crate) fn bounds(&self) -> Bounds {
        Bounds::around_disc(self.center, self.plane.normal(), self.radius)
    }
}

impl Intersect for Disc {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersect(ray).map(|t| (t, 0))
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.interaction(ray, t)
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Flat)
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Frustum {
            base: self.center,
            axis: self.plane.normal(),
            height: 0.0,
            radii: [self.radius, 0.0],
            is_capped: false,
        })
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds())
    }
}

impl HasBaseline for Disc {
    type Baseline<R: Real> = BaselineDisc<R>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(BaselineDisc::new(
            self.center,
            self.plane.normal(),
            self.radius,
        ))
    }
}

/// The baseline: the plane, and the distance from the centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineDisc<R> {
    plane: BaselinePlane<R>,
    center: Vector<R>,
    radius: R,
}

impl<R: Real> BaselineDisc<R> {
    pub(in crate::shape) fn new(center: Vec3, unit_normal: Vec3, radius: f64) -> Self {
        Self {
            plane: BaselinePlane::new(center, unit_normal),
            center: Vector::of(center),
            radius: R::of(radius),
        }
    }

    /// The intersection of the line with the disc, at any t; NaN for a miss.
    #[inline]
    pub(in crate::shape) fn parameter(&self, ray: &BaselineRay<R>) -> R {
        let t = self.plane.parameter(ray);
        let local = ray.at(t) - self.center;
        if local.dot(local) <= self.radius * self.radius {
            t
        } else {
            R::of(f64::NAN)
        }
    }

    /// The unit normal.
    #[inline]
    pub(in crate::shape) fn normal(&self) -> Vector<R> {
        self.plane.unit()
    }
}

impl<R: Real> Baseline<R> for BaselineDisc<R> {
    #[inline]
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let t = self.parameter(ray);
        ray.counts(t).then_some((t, 0))
    }

    fn normal(&self, _: &BaselineRay<R>, _: Vector<R>, _: u32) -> Vector<R> {
        self.normal()
    }
}
