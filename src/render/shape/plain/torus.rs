//! The torus: its quartic in t, solved in closed form where the ray starts.

use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::roots::quartic;

#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Torus<R> {
    pub(in crate::render) center: Vector<R>,
    /// A unit vector.
    pub(in crate::render) axis: Vector<R>,
    pub(in crate::render) major: R,
    pub(in crate::render) minor: R,
}

impl<R: Real> Torus<R> {
    /// The first root of (|p|² + R² − r²)² = 4R²ρ² along the line that counts.
    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        let (two, four) = (R::of(2.0), R::of(4.0));
        let f = ray.origin - self.center;
        let d = ray.direction;
        let (above, rise) = (f.dot(self.axis), d.dot(self.axis));
        let (a, b, f2) = (d.dot(d), f.dot(d), f.dot(f));
        let (major2, minor2) = (self.major * self.major, self.minor * self.minor);
        let k = f2 + major2 - minor2;

        // Compute the coefficients, divided by that of t⁴.
        let c4 = a * a;
        let c3 = four * a * b / c4;
        let c2 = (two * a * k + four * b * b - four * major2 * (a - rise * rise)) / c4;
        let c1 = (four * b * k - R::of(8.0) * major2 * (b - above * rise)) / c4;
        let c0 = (k * k - four * major2 * (f2 - above * above)) / c4;
        ray.first(quartic(c3, c2, c1, c0).map(|t| (t, 0)))
    }

    pub(super) fn normal(&self, point: Vector<R>) -> Vector<R> {
        let local = point - self.center;
        let from_axis = local - self.axis * local.dot(self.axis);
        (local - from_axis.normalized() * self.major).normalized()
    }
}
