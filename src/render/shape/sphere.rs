//! The sphere: one f64 test for nearly all rays, and double-double for those it can't decide.
//!
//! The test is that of Haines, Günther, Akenine-Möller, "Precision improvements for ray/sphere
//! intersection" (Ray Tracing Gems, 2019, ch. 7): the discriminant from the foot of the
//! perpendicular, the roots from the stable quadratic. Where its first-order error bound says that
//! the sign or the root reported is in doubt, it is computed again.

use crate::math::{DoubleDouble, U, Vec3};
use crate::render::ray::{Interaction, Ray};

/// A root is computed again when rounding may have been amplified by more than this.
const AMPLIFIED: f64 = 48.0;

/// From a squared distance this many times the squared radius the first root is measured from the
/// foot.
const FAR: f64 = 4.0;

/// A prepared sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius, above 0.
    pub radius: f64,
}

impl Sphere {
    /// The smallest root above 0, right to within 64 u for any ray; a tangent ray hits.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let f = ray.origin - self.center;
        let d = ray.direction;
        let r2 = self.radius * self.radius;
        let f2 = f.dot(f);
        let a = d.dot(d);
        let b = -f.dot(d);

        // Leave spheres behind the origin: both roots have the sign of `b` where `c` is surely
        // above 0.
        if b < 0.0 && f2 > r2 * (1.0 + 32.0 * U) {
            return None;
        }

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
        let (quotient, other) = (c / q, q / a);
        let (near, far) = if b >= 0.0 {
            (quotient, other)
        } else {
            (other, quotient)
        };
        let from_afar = f2 > FAR * r2;
        let t = match (from_afar, near > 0.0) {
            (true, _) => nearest - (foot.dot(d) + root) / a,
            (false, true) => near,
            (false, false) => far,
        };
        if t.is_nan() || t <= 0.0 {
            return None;
        }

        // Recompute the root in double-double if the error of c or of the discriminant is
        // amplified.
        let is_quotient = (near > 0.0) == (b >= 0.0);
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
    fn intersect_precisely(&self, ray: &Ray) -> Option<f64> {
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

    /// The point at `t`: along the ray or moved onto the sphere in its own frame, whichever rounds
    /// less.
    #[inline]
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
