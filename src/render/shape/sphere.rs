//! The sphere: one f64 test for nearly all rays, and double-double for those it can't decide.
//!
//! The test is that of Haines, Günther, Akenine-Möller, "Precision improvements for ray/sphere
//! intersection" (Ray Tracing Gems, 2019, ch. 7): the discriminant from the foot of the
//! perpendicular, the roots from the stable quadratic. Where its first-order error bound says that
//! the sign or the root reported is in doubt, it is computed again.

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, Vector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::four::Shape4;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, DoubleDouble, U, Vec3, acos, atan2};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A root is computed again when rounding may have been amplified by more than this.
pub(super) const AMPLIFIED: f64 = 48.0;

/// From a squared distance this many times the squared radius the first root is measured from the
/// foot.
pub(super) const FAR: f64 = 4.0;

/// A prepared sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius, above 0.
    pub radius: f64,
}

impl Sphere {
    /// The smallest root above 0, accurate to 64 u for all tested rays (`docs/proofs` states the
    /// proven part); a tangent ray hits.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let f = ray.origin - self.center;
        let d = ray.direction;
        let (f2, b) = (f.dot(f), -f.dot(d));

        // Leave spheres that lie beside the line or behind the origin: from outside, both roots
        // have the sign of b, and there is none where a·(f² − r²) > b². Rounding may move the two
        // sides by 27 u·a·f².
        let r2 = self.radius * self.radius;
        let outside = f2 * (1.0 - 64.0 * U) - r2;
        if outside > 0.0 && d.dot(d) * outside > b * b {
            return None;
        }

        // Rays that lead off the sphere itself start outside by more than the 7 u by which rounding
        // may move f² against r².
        if b < 0.0 && f2 * (1.0 - 8.0 * U) > r2 {
            return None;
        }
        self.first_root(ray, f, [f2, b])
    }

    /// As [`Self::intersect`], of a line that comes close; `f` leads from the centre to the origin,
    /// with its square and its product with the direction, negated.
    #[inline]
    fn first_root(&self, ray: &Ray, f: Vec3, [f2, b]: [f64; 2]) -> Option<f64> {
        let d = ray.direction;
        let r2 = self.radius * self.radius;
        let a = d.dot(d);

        // Compute the discriminant from the foot of the perpendicular.
        let nearest = b / a;
        let foot = f + d * nearest;
        let foot2 = foot.dot(foot);
        let discriminant = r2 - foot2;
        let extent = f.abs().element_sum();
        let error_bound =
            16.0 * U * (r2 + foot2 + self.radius * extent + 16.0 * U * extent * extent);
        if discriminant < -error_bound {
            return None;
        }
        if discriminant <= error_bound {
            return self.intersect_precisely(ray);
        }

        // Compute the roots without cancellation (from afar, as a step back from the foot), and
        // take the first positive root.
        let c = f2 - r2;
        let a_discriminant = a * discriminant;
        let root = a_discriminant.sqrt();
        let q = if b >= 0.0 { b + root } else { b - root };
        let from_afar = f2 > FAR * r2;
        let (t, is_quotient) = match (from_afar, b >= 0.0) {
            (true, _) => (nearest - (foot.dot(d) + root) / a, true),
            (false, true) if c / q > 0.0 => (c / q, true),
            (false, true) => (q / a, false),
            (false, false) if q / a > 0.0 => (q / a, false),
            (false, false) => (c / q, true),
        };
        if t.is_nan() || t <= 0.0 {
            return None;
        }

        // Recompute the root in double-double if the error of c or of the discriminant is
        // amplified.
        let cancelled = is_quotient && f2 + r2 > AMPLIFIED * c.abs();
        let amplified = r2 * (r2 + f2) * a * a > AMPLIFIED * AMPLIFIED * a_discriminant * q * q;
        if cancelled || amplified {
            self.intersect_precisely(ray)
        } else {
            Some(t)
        }
    }

    /// As [`Self::intersect`] in double-double, with an error of at most 1 u.
    #[cold]
    #[inline(never)]
    pub(super) fn intersect_precisely(&self, ray: &Ray) -> Option<f64> {
        let f = [0, 1, 2].map(|k| DoubleDouble::difference(ray.origin[k], self.center[k]));
        let d = [0, 1, 2].map(|k| DoubleDouble::from(ray.direction[k]));
        let dot =
            |u: [DoubleDouble; 3], v: [DoubleDouble; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        let zero = DoubleDouble::from(0.0);
        let radius = DoubleDouble::from(self.radius);
        let a = dot(d, d);
        let b = zero - dot(f, d);
        // Compute the discriminant from the foot of the perpendicular.
        let step = b / a;
        let foot = [0, 1, 2].map(|k| f[k] + d[k] * step);
        let discriminant = radius * radius - dot(foot, foot);
        if discriminant.to_f64().is_nan() || discriminant.to_f64() < 0.0 {
            return None;
        }

        // Compute the roots without cancellation, and take the first positive root.
        let c = dot(f, f) - radius * radius;
        let root = (a * discriminant).sqrt();
        let forward = b.to_f64() >= 0.0;
        let q = if forward { b + root } else { b - root };
        let quotient = (c / q).to_f64();
        let other = (q / a).to_f64();
        let (near, far) = if forward {
            (quotient, other)
        } else {
            (other, quotient)
        };
        let t = if near > 0.0 { near } else { far };
        (t > 0.0).then_some(t)
    }

    /// The interval of the ray inside, over the whole line. The end ahead is that of
    /// [`Self::intersect`]; the other end is as far from the foot of the perpendicular.
    #[must_use]
    pub(super) fn stretch(&self, ray: &Ray) -> Option<[f64; 2]> {
        let t = self.intersect(ray)?;
        let (f, d) = (ray.origin - self.center, ray.direction);
        let (b, a) = (-f.dot(d), d.dot(d));
        let other = 2.0 * (b / a) - t;
        let starts_outside = f.dot(f) > self.radius * self.radius;
        Some(if starts_outside && b > 0.0 {
            [t, other.max(t)]
        } else {
            [other.min(0.0), t]
        })
    }

    /// The point at `t`: along the ray or projected onto the sphere in its own frame, whichever
    /// rounds less.
    #[inline(always)]
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        let step = ray.direction * t;
        let local = (ray.origin - self.center) + step;
        let length = local.length();
        let normal = if length > 0.0 {
            local / length
        } else {
            ray.outward(local)
        };
        let along_ray = (ray.origin.abs() + step.abs()).element_sum();
        let along_radius = self.center.abs().element_sum() + self.radius;
        let point = if along_ray < along_radius {
            ray.origin + step
        } else {
            self.center + normal * self.radius
        };
        Interaction::new(ray, point, normal, self.center, self.radius)
    }
}

/// A sphere with a texture on it.
#[derive(Clone, Copy, Debug)]
pub struct TexturedSphere {
    /// The sphere.
    pub sphere: Sphere,
    /// The rows of the rotation to the directions of its texture.
    pub texture_from_world: [Vec3; 3],
}

impl Intersect for TexturedSphere {
    #[inline]
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.sphere.intersect(ray).map(|t| (t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        if let Some([enter, leave]) = self.sphere.stretch(ray) {
            SolidCrossing::visit_both((enter, 0), (leave, 0), visit);
        }
    }

    #[inline]
    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.sphere.interaction(ray, t)
    }

    fn has_uv(&self) -> bool {
        true
    }

    /// u = φ/2π and v = 1 − θ/π of the direction from the centre, turned by the rotation of the
    /// texture.
    fn shading_attributes(
        &self,
        _: &Ray,
        at: &Interaction,
        _: u32,
        _: AttributeRequest,
    ) -> ShadingAttributes {
        let [x, y, z] = self.texture_from_world;
        let direction = at.normal;
        let d = Vec3::new(x.dot(direction), y.dot(direction), z.dot(direction));
        let turns = atan2(d.y, d.x) / TAU;
        let u = if turns < 0.0 { turns + 1.0 } else { turns };
        let v = 1.0 - acos(d.z.clamp(-1.0, 1.0)) / PI;
        let tangent = (y * d.x - x * d.y).try_normalize();
        ShadingAttributes {
            uv: Some([u, v]),
            tangent,
            ..ShadingAttributes::default()
        }
    }

    #[inline(always)]
    fn shape4(&self) -> Option<Shape4<'_>> {
        Some(Shape4::Sphere(&self.sphere))
    }

    fn emitter(&self) -> Option<Emitter> {
        let Sphere { center, radius } = self.sphere;
        Some(Emitter::Sphere { center, radius })
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::around(self.sphere.center, self.sphere.radius))
    }

    fn ball(&self) -> Option<BoundingSphere> {
        let Sphere { center, radius } = self.sphere;
        Some(BoundingSphere { center, radius })
    }
}

impl HasBaseline for TexturedSphere {
    type Baseline<R: Real> = BaselineSphere<R>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(BaselineSphere {
            center: Vector::of(self.sphere.center),
            radius: R::of(self.sphere.radius),
        })
    }
}

/// The baseline, by b² − 4ac.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineSphere<R> {
    center: Vector<R>,
    radius: R,
}

impl<R: Real> Baseline<R> for BaselineSphere<R> {
    #[inline]
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let f = ray.origin - self.center;
        let b = R::of(2.0) * f.dot(ray.direction);
        let c = f.dot(f) - self.radius * self.radius;
        let roots = quadratic(ray.length2, b, c)?;
        roots.into_iter().find(|t| ray.counts(*t)).map(|t| (t, 0))
    }

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, _: u32) -> Vector<R> {
        (point - self.center).normalized()
    }
}
