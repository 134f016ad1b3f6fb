//! The capped cone. A ray is in it where it is both inside one nappe and between the planes of base
//! and apex.
//!
//! The ray is first moved to the point nearest to the cone's centre, so that the terms of the
//! quadratic have the size of the cone; each root is then refined by one Newton step on the
//! distance ρ − g from the side. A flat cone turns an error in the height of a point into one
//! radius/height times as large in g, so the heights of points are measured along the ray from its
//! intersection with the base: then g is accurate to rounding for any cone.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::disc::BaselineDisc;
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{Intersect, SolidCrossing};
use crate::shape::interval::{Interval, between_planes, off_surface, roots, size_of_start};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3, Vector, cross, difference_of_products, dot};
use std::sync::Arc;

/// A cone is flat if its radius is more than this many times its height.
const FLAT: f64 = 1024.0;

/// A prepared cone with a cap at its base.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    base: Vec3,
    /// A unit vector from the base to the apex.
    axis: Vec3,
    height: f64,
    radius: f64,
    /// Radius over height.
    slope: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum ConeFace {
    Side,
    Base,
    Apex,
}

impl ConeFace {
    const ALL: [Self; 3] = [Self::Side, Self::Base, Self::Apex];
}

/// A ray in the frame of the cone: along it ρ = ‖w + x·t‖, and the cone's own radius is g = σ −
/// τ·t.
struct ConeProfile {
    w: Vec3,
    x: Vec3,
    sigma: f64,
    tau: f64,
}

impl ConeProfile {
    /// The Newton step of a root of ρ − g; none at the axis, where ρ has no slope.
    fn refined(&self, t: f64) -> f64 {
        let foot = self.w + self.x * t;
        let rho = foot.length();
        let slope = foot.dot(self.x) / rho + self.tau;
        let step = (rho - (self.sigma - self.tau * t)) / slope;
        if step.is_finite() { t - step } else { t }
    }

    /// ρ − g at t = 0, and its derivative.
    fn distance(&self) -> (f64, f64) {
        let rho = self.w.length();
        let slope = match rho > 0.0 {
            true => self.w.dot(self.x) / rho,
            false => self.x.length(),
        };
        (rho - self.sigma, slope + self.tau)
    }

    /// The stretch inside the nappe below the apex.
    fn inside(&self) -> Option<Interval<ConeFace>> {
        let Self { w, x, sigma, tau } = *self;
        // Compute the quadratic a·t² − 2·b·t + c along the ray.
        let a = difference_of_products(x.length(), x.length(), tau, tau);
        let b = -(w.dot(x) + sigma * tau);
        let c = (w.length() - sigma) * (w.length() + sigma);
        let side = |t: f64| (t, ConeFace::Side);
        // A ray parallel to the side hits it once.
        if a == 0.0 {
            let t = self.refined(c / (2.0 * b));
            let (before, after) = (side(f64::NEG_INFINITY), side(f64::INFINITY));
            let below = if tau > 0.0 {
                Interval {
                    enter: before,
                    leave: side(t),
                }
            } else {
                Interval {
                    enter: side(t),
                    leave: after,
                }
            };
            return (t.is_finite() && (b < 0.0) == (tau > 0.0)).then_some(below);
        }
        // Otherwise the ray misses the nappe, or hits it twice.
        let discriminant = difference_of_products(b, b, a, c);
        if a > 0.0 && (discriminant < 0.0 || sigma - tau * (b / a) < 0.0) {
            return None;
        }
        let (first, second) = roots(a, b, c, discriminant);
        let (first, second) = (self.refined(first), self.refined(second));
        // A steeper ray is inside up to its only hit of the lower nappe, or from it on.
        Some(if a > 0.0 {
            Interval {
                enter: side(first),
                leave: side(second),
            }
        } else if tau > 0.0 {
            Interval {
                enter: side(f64::NEG_INFINITY),
                leave: side(first),
            }
        } else {
            Interval {
                enter: side(second),
                leave: side(f64::INFINITY),
            }
        })
    }
}

impl Cone {
    /// The cone over the disc around `base`, with its apex at `base + up`; `up` must not be zero.
    #[must_use]
    pub fn new(base: Vec3, up: Vec3, radius: f64) -> Self {
        let height = dot(up, up).sqrt();
        Self {
            base,
            axis: up / height,
            height,
            radius,
            slope: radius / height,
        }
    }

    /// The first root above 0, and its part.
    fn intersection(&self, ray: &Ray) -> Option<(f64, ConeFace)> {
        self.stretch(ray)?.first_in_front()
    }

    /// The stretch of the ray inside.
    fn stretch(&self, ray: &Ray) -> Option<Interval<ConeFace>> {
        let d = ray.direction;
        let start = ray.origin - self.base;
        let nearest = (self.axis * (0.5 * self.height) - start).dot(d) / d.dot(d);
        let size = size_of_start(ray, self.base, self.height + self.radius);
        let (distance, growth) = self.profile(start, d).distance();
        let distance = off_surface(distance, size * (1.0 + self.slope));
        let is_flat = self.slope > FLAT && dot(self.axis, d) != 0.0;
        if is_flat {
            return self.crossing_flat(start, d, nearest, size, |side| {
                side.seen_from(distance, growth)
            });
        }
        let f = start + d * nearest;
        let inside = self.profile(f, d).inside()?;
        let inside = inside.map(|t| t + nearest);
        let parts = [ConeFace::Base, ConeFace::Apex];
        let ends = between_planes(self.axis, self.height, start, d, size, parts)?;
        inside.seen_from(distance, growth).and(ends)
    }

    /// The ray from a point, given from the base, along `d`.
    fn profile(&self, from: Vec3, d: Vec3) -> ConeProfile {
        ConeProfile {
            w: cross(from, self.axis),
            x: cross(d, self.axis),
            sigma: self.slope * (self.height - dot(self.axis, from)),
            tau: self.slope * dot(self.axis, d),
        }
    }

    /// As [`Self::stretch`] for a cone far wider than high, and a ray that hits the plane of its
    /// base; `seen` is the stretch inside its side as the start sees it.
    fn crossing_flat(
        &self,
        start: Vec3,
        d: Vec3,
        nearest: f64,
        size: f64,
        seen: impl Fn(Interval<ConeFace>) -> Interval<ConeFace>,
    ) -> Option<Interval<ConeFace>> {
        let (x, rise) = (cross(d, self.axis), dot(self.axis, d));
        let tau = self.slope * rise;
        let above = off_surface(dot(self.axis, start), size);
        let at_base = -above / rise;
        // Move a ray steeper than the side to the base, and any other ray to the point closest to
        // the middle. If it hits the cone, it then starts within a few heights of the base.
        let across = x.length();
        let moved = if tau.abs() > across { at_base } else { nearest };
        // Scale t by the rate of ρ or g, so that neither overflows.
        let pace = across.max(tau.abs());
        let (x, tau) = (x / pace, tau / pace);
        let base = (at_base - moved) * pace;
        let profile = ConeProfile {
            w: cross(start + d * moved, self.axis),
            x,
            sigma: self.radius + tau * base,
            tau,
        };
        let (base, apex) = (
            (base, ConeFace::Base),
            (base + self.radius / tau, ConeFace::Apex),
        );
        let ends = if tau > 0.0 {
            Interval {
                enter: base,
                leave: apex,
            }
        } else {
            Interval {
                enter: apex,
                leave: base,
            }
        };
        // From the plane of the base, it is behind.
        let ends = if above == 0.0 {
            ends.seen_from(above, -rise)
        } else {
            ends
        };
        let inside = seen(profile.inside()?).and(ends)?;
        Some(inside.map(|s| moved + s / pace))
    }
}

impl Intersect for Cone {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersection(ray).map(|(t, _)| (t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        if let Some(inside) = self.stretch(ray) {
            inside.visit(|part| part as u32, visit);
        }
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        let hit = self.intersection(ray);
        let part = hit.map_or(ConeFace::Side, |(_, part)| part);
        self.interaction_on(ray, t, part as u32)
    }

    /// The point at `t`, moved onto the part that was hit; at the apex the normal is the axis.
    fn interaction_on(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        let part = ConeFace::ALL[part as usize];
        let local = (ray.origin - self.base) + ray.direction * t;
        let along = dot(local, self.axis);
        let radial = (local - self.axis * along).normalize_or_zero();
        // Repeat the step: in a needle, the rest along the axis is amplified by height/radius.
        let radial = (radial - self.axis * dot(self.axis, radial)).normalize_or_zero();
        let (local, normal) = match part {
            ConeFace::Base => (local - self.axis * along, -self.axis),
            ConeFace::Apex => (self.axis * self.height, self.axis),
            ConeFace::Side if radial == Vec3::ZERO => (local, self.axis),
            ConeFace::Side => {
                let normal = (radial * self.height + self.axis * self.radius).normalize();
                let off = normal.dot(local - self.axis * self.height);
                (local - normal * off, normal)
            }
        };
        Interaction::new(
            ray,
            self.base + local,
            normal,
            self.base,
            self.height + self.radius,
        )
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Revolution {
            center: self.base,
            axis: self.axis,
            profile: 0.0,
        })
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Frustum {
            base: self.base,
            axis: self.axis,
            height: self.height,
            radii: [self.radius, 0.0],
            is_capped: true,
        })
    }

    /// A box around the cone.
    fn bounds(&self) -> Option<Bounds> {
        let apex = Bounds::around(self.base + self.axis * self.height, 0.0);
        Some(Bounds::around_disc(self.base, self.axis, self.radius).union(apex))
    }
}

impl HasBaseline for Cone {
    type Baseline<R: Real> = Box<BaselineCone<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineCone::new(self)))
    }
}

/// The parts of the baseline: side and base.
const PLAIN_PARTS: [u32; 2] = [0, 1];

/// The baseline: the quadratic of ρ² = (k·m)², with m the height left to the apex, and a disc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineCone<R> {
    base: Vector<R>,
    axis: Vector<R>,
    height: R,
    /// Radius over height.
    slope: R,
    cap: BaselineDisc<R>,
}

impl<R: Real> BaselineCone<R> {
    fn new(cone: &Cone) -> Self {
        let Cone {
            base,
            axis,
            height,
            radius,
            slope,
        } = *cone;
        Self {
            base: Vector::of(base),
            axis: Vector::of(axis),
            height: R::of(height),
            slope: R::of(slope),
            cap: BaselineDisc::new(base, -axis, radius),
        }
    }
}

impl<R: Real> Baseline<R> for BaselineCone<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let [side, base] = PLAIN_PARTS;
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let (from_axis, across) = (f - self.axis * above, ray.direction - self.axis * rise);
        // Subtract the square of the cone's own radius, slope·(height − above − rise·t).
        let (width, narrowing) = (self.slope * (self.height - above), self.slope * rise);
        let a = across.dot(across) - narrowing * narrowing;
        let b = R::of(2.0) * (from_axis.dot(across) + width * narrowing);
        let c = from_axis.dot(from_axis) - width * width;
        let none = R::of(f64::NAN);
        let within = |t: R| {
            let height = above + rise * t;
            if height >= R::of(0.0) && height <= self.height {
                t
            } else {
                none
            }
        };
        let [first, second] = quadratic(a, b, c)?.map(within);
        ray.first([
            (first, side),
            (second, side),
            (self.cap.parameter(ray), base),
        ])
    }

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        if prim_id == PLAIN_PARTS[1] {
            return self.cap.normal();
        }
        let local = point - self.base;
        let from_axis = local - self.axis * local.dot(self.axis);
        (from_axis.normalized() + self.axis * self.slope).normalized()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reflect;

    /// 200 times as long as wide, seen from afar: reflected rays do not hit the side that they
    /// leave.
    #[test]
    fn a_needle_does_not_mirror_itself() {
        let up = Vec3::new(21.33, 5.0, -20.0);
        let cone = Cone::new(Vec3::new(0.5, 2.729, -2.0), up, 0.15);
        let eye = Vec3::new(0.0, -0.258, 8.0);
        let (mut seen, mut again) = (0, 0);
        for k in 0..4000_i32 {
            let [along, across] = [0.618_034, 0.754_878].map(|step| (f64::from(k) * step).fract());
            let aside = Vec3::Y * (0.2 * (across - 0.5) * (1.0 - along));
            let ray = Ray {
                origin: eye,
                direction: (cone.base + up * along + aside - eye).normalize(),
            };
            let Some((t, _)) = cone.intersection(&ray) else {
                continue;
            };
            let at = cone.interaction(&ray, t, 0);
            let mirrored = reflect(ray.direction, at.normal);
            seen += 1;
            again += i32::from(
                mirrored.dot(at.normal) > 0.0 && cone.intersection(&at.ray(mirrored)).is_some(),
            );
        }
        assert!(seen > 2000 && again == 0, "{again} of {seen}");
    }
}
