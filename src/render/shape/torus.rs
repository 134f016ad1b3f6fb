//! The torus: critical points of its quartic bracket the roots, and the signed distance decides and
//! refines them.
//!
//! The ray is moved to the point nearest to the centre and measured in units of the torus, so the
//! quartic never sees the distance of the eye. Between two critical points the quartic is monotone
//! and has one root or none. Its value near a root is a difference of large terms; the signed
//! distance √((ρ − R)² + z²) − r has the same sign and keeps its digits, so every decision is taken
//! on it.

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, Vector};
use crate::shape::baseline::roots::quartic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::four::Shape4;
use crate::shape::geometry::{Intersect, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::plane::PlaneNormal;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3, cross, ldexp};
use std::sync::Arc;

/// Steps of a bracketed search: bisection alone would need 60.
pub(super) const MAX_STEPS: usize = 100;

/// The rounding error of lengths in units of the torus.
pub(super) const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Where a ray starts so near the surface, in units of the torus, it starts on it.
pub(super) const ON_SURFACE: f64 = 16.0 * ROUNDING;

/// The margin of planes that touch the torus, in its units, where lengths are about 1: far above
/// rounding.
pub(super) const TOUCH: f64 = 1.0 / 1_048_576.0;

/// A square larger by this factor is larger by more than rounding.
pub(super) const NEARLY_ONE: f64 = 1.0 + 1e-12;

/// A prepared torus.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    pub(super) center: Vec3,
    /// A unit vector along the axis.
    pub(super) axis: Vec3,
    /// From the centre to the middle of the tube.
    pub(super) major: f64,
    /// The radius of the tube.
    pub(super) minor: f64,
    /// The power of two near the outer radius, a normal number as its reciprocal is.
    pub(super) unit: f64,
}

/// A ray near the torus, in units of about its outer radius, as seen from the axis.
struct TorusRay {
    /// Of the point nearest to the centre: the square of its distance, its height along the axis,
    /// and its cross product with the axis, as long as it is off the axis.
    square: f64,
    height: f64,
    off: Vec3,
    /// The height and the cross product a step adds.
    rise: f64,
    turn: Vec3,
    major: f64,
    minor: f64,
}

/// The interval of a ray that may hit the torus.
struct TorusStretch {
    line: TorusRay,
    low: f64,
    high: f64,
    /// The t of the point nearest to the centre, and its change per step.
    nearest: f64,
    pace: f64,
}

impl TorusStretch {
    fn t(&self, s: f64) -> f64 {
        self.nearest + s * self.pace
    }
}

impl TorusRay {
    /// The signed distance of the point at `s` from the surface, from the factored difference of
    /// squares: its digits survive where the ray only grazes.
    fn distance(&self, s: f64) -> f64 {
        let z = (self.height + self.rise * s).abs();
        let off = ((self.off + self.turn * s).length() - self.major).abs();
        let (large, small) = if z > off { (z, off) } else { (off, z) };
        let square = small * small + (large - self.minor) * (large + self.minor);
        square / ((off * off + z * z).sqrt() + self.minor)
    }

    /// As [`Self::distance`] at the start of the ray; on the surface 1 or −1, by the side that the
    /// ray points to: it does not hit its own surface.
    fn start_distance(&self, s: f64) -> f64 {
        let distance = self.distance(s);
        if distance.abs() > ON_SURFACE {
            return distance;
        }
        let off = self.off + self.turn * s;
        let length = off.length();
        let outwards = (length - self.major) * off.dot(self.turn) / length;
        let rise = (self.height + self.rise * s) * self.rise;
        if outwards + rise < 0.0 { -1.0 } else { 1.0 }
    }

    /// Whether the ray certainly misses the torus from `low` to `high`: it stays outside of the two
    /// planes that touch the torus, or in the hole. All with a margin far above rounding; the
    /// distance from the axis is largest at an end of the interval.
    fn passes(&self, low: f64, high: f64) -> bool {
        let above = self.minor + TOUCH;
        let ends = [-above, above].map(|height| (height - self.height) / self.rise);
        let (enter, leave) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let hole = self.major - self.minor - TOUCH;
        let is_in_hole = |s: f64| {
            let off = self.off + self.turn * s;
            off.dot(off) < hole * hole
        };
        enter > high + TOUCH
            || leave < low - TOUCH
            || hole > 0.0 && is_in_hole(enter) && is_in_hole(leave)
    }

    /// The coefficients of the quartic's derivative over 4, `s³ + linear·s + constant`: there is no
    /// square term, as a step has length 1 and is perpendicular to the vector from the centre.
    fn derivative(&self) -> (f64, f64) {
        // (|p|² + R² − r²)² − 4R²ρ², with |p|² = f² + s² and ρ² = |w + x·s|².
        let (w, x) = (self.off, self.turn);
        let k = self.square + (self.major - self.minor) * (self.major + self.minor);
        let square = 2.0 * self.major * self.major;
        (k - square * x.dot(x), -square * w.dot(x))
    }

    /// The `s` in `(low, high)` at which the distance changes sign, from that at `low` on, in
    /// brackets of the quartic's critical points; each with whether the ray was inside before it.
    fn roots(&self, low: f64, high: f64) -> impl Iterator<Item = (f64, bool)> {
        let (linear, constant) = self.derivative();
        let borders = cubic_roots(linear, constant, low, high).chain(std::iter::once(high));
        let mut before = (low, self.start_distance(low));
        borders.filter_map(move |split_plane| {
            let there = (split_plane, self.distance(split_plane));
            let last = std::mem::replace(&mut before, there);
            let was_inside = last.1 < 0.0;
            if there.1 == 0.0 && split_plane > low {
                return Some((split_plane, was_inside));
            }
            let root = || (self.root(last, there), was_inside);
            ((there.1 < 0.0) != was_inside).then(root)
        })
    }

    /// The root between two points with distances of opposite signs: steps of inverse quadratic
    /// interpolation where the last three points allow it, else bisection. Chandrupatla, "A new
    /// hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without
    /// using derivatives" (Advances in Engineering Software 28, 1997). It ends where the distance
    /// is below its rounding error, or the bracket has no midpoint.
    fn root(&self, mut last: (f64, f64), mut other: (f64, f64)) -> f64 {
        let mut before;
        let mut fraction = 0.5;
        for _ in 0..MAX_STEPS {
            let at = last.0 + fraction * (other.0 - last.0);
            let there = (at, self.distance(at));
            if (there.1 < 0.0) == (last.1 < 0.0) {
                before = last;
            } else {
                (before, other) = (other, last);
            }
            last = there;
            let best = if last.1.abs() < other.1.abs() {
                last
            } else {
                other
            };
            let finest = ROUNDING / (other.0 - last.0).abs();
            if best.1.abs() <= ROUNDING || finest > 0.5 {
                return best.0;
            }
            fraction = fraction_of(last, other, before).clamp(finest, 1.0 - finest);
        }
        last.0
    }
}

/// The next point between two points of opposite signs, as a fraction from the last to the other:
/// the root of the parabola through both and the point before, if that is safe, else the midpoint.
fn fraction_of(last: (f64, f64), other: (f64, f64), before: (f64, f64)) -> f64 {
    let along = (last.0 - other.0) / (before.0 - other.0);
    let up = (last.1 - other.1) / (before.1 - other.1);
    let is_safe = up * up < along && (1.0 - up) * (1.0 - up) < 1.0 - along;
    if !is_safe {
        return 0.5;
    }
    let linear = last.1 / (other.1 - last.1) * before.1 / (other.1 - before.1);
    let latus_rectum = (before.0 - last.0) / (other.0 - last.0) * last.1 / (before.1 - last.1)
        * other.1
        / (before.1 - other.1);
    linear + latus_rectum
}

/// The real roots of `s³ + linear·s + constant` in `[low, high]`, in order, computed lazily.
fn cubic_roots(linear: f64, constant: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    // Bracket the roots by the extrema of the cubic.
    let spread = (-linear / 3.0).max(0.0).sqrt();
    let borders = [
        low,
        (-spread).clamp(low, high),
        spread.clamp(low, high),
        high,
    ];
    (0..3).filter_map(move |k| cubic_root(linear, constant, borders[k], borders[k + 1]))
}

/// The root of the cubic between two points, if it changes sign there.
fn cubic_root(linear: f64, constant: f64, mut a: f64, mut b: f64) -> Option<f64> {
    let value = |s: f64| (s * s + linear) * s + constant;
    let (first, last) = (value(a), value(b));
    if a >= b || (first < 0.0) == (last < 0.0) {
        return None;
    }
    let rises = last > first;
    let mut at = 0.5 * (a + b);
    for _ in 0..MAX_STEPS {
        let height = value(at);
        if (height > 0.0) == rises {
            b = at
        } else {
            a = at
        }
        // Take a Newton step, or bisect if the step leaves the bracket.
        let newton = at - height / (3.0 * at * at + linear);
        let next = if newton > a && newton < b {
            newton
        } else {
            0.5 * (a + b)
        };
        if next == at || next <= a || next >= b {
            break;
        }
        at = next;
    }
    Some(at)
}

impl Torus {
    /// The torus around the line through `center` along `axis`, which must not be zero.
    #[must_use]
    pub fn new(center: Vec3, axis: Vec3, major: f64, minor: f64) -> Self {
        Self {
            center,
            axis: PlaneNormal::new(axis).unit(),
            major,
            minor,
            unit: ldexp(1.0, libm::ilogb(major + minor).clamp(-1000, 1000)),
        }
    }

    /// The first root above 0.
    #[must_use]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let stretch = self.stretch(ray)?;
        let (s, _) = stretch.line.roots(stretch.low, stretch.high).next()?;
        let t = stretch.t(s);
        (t > 0.0).then_some(t)
    }

    /// The interval of a ray near the torus; `None` for a miss.
    #[inline]
    fn stretch(&self, ray: &Ray) -> Option<TorusStretch> {
        let f = ray.origin - self.center;
        let d = ray.direction;
        let length2 = d.dot(d);
        let nearest = -f.dot(d) / length2;
        let foot = f + d * nearest;
        let outer = self.major + self.minor;
        let half2 = outer * outer * NEARLY_ONE - foot.dot(foot);
        if half2 < 0.0 || half2.is_nan() {
            return None;
        }
        // Scale by a power of two near the outer radius, which is exact.
        let unit = self.unit;
        let length = length2.sqrt();
        let (from, step) = (foot / unit, d / length);
        let line = TorusRay {
            square: from.dot(from),
            height: from.dot(self.axis),
            off: cross(from, self.axis),
            rise: step.dot(self.axis),
            turn: cross(step, self.axis),
            major: self.major / unit,
            minor: self.minor / unit,
        };
        let half = half2.sqrt() / unit;
        let start = -nearest * length / unit;
        let low = if start > -half { start } else { -half };
        if low >= half || line.passes(low, half) {
            return None;
        }
        Some(TorusStretch {
            line,
            low,
            high: half,
            nearest,
            pace: unit / length,
        })
    }

    /// The point at `t`, moved onto the tube in its own frame.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        let local = (ray.origin - self.center) + ray.direction * t;
        let z = local.dot(self.axis);
        let ring = (local - self.axis * z).normalize_or_zero() * self.major;
        let normal = ray.outward(local - ring);
        let point = self.center + ring + normal * self.minor;
        Interaction::new(ray, point, normal, self.center, self.major + self.minor)
    }

    /// A box around the torus.
    #[must_use]
    pub(crate) fn bounds(&self) -> Bounds {
        let disc = Bounds::around_disc(self.center, self.axis, self.major);
        let tube = Vec3::splat(self.minor);
        Bounds::around(disc.min - tube, 0.0).union(Bounds::around(disc.max + tube, 0.0))
    }
}

impl Intersect for Torus {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersect(ray).map(|t| (t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        let Some(stretch) = self.stretch(ray) else {
            return;
        };
        if stretch.line.start_distance(stretch.low) < 0.0 {
            visit(SolidCrossing {
                t: f64::NEG_INFINITY,
                enters: true,
                part: 0,
            });
        }
        for (s, was_inside) in stretch.line.roots(stretch.low, stretch.high) {
            visit(SolidCrossing {
                t: stretch.t(s),
                enters: !was_inside,
                part: 0,
            });
        }
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.interaction(ray, t)
    }

    #[inline(always)]
    fn shape4(&self) -> Option<Shape4<'_>> {
        Some(Shape4::Torus(self))
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Revolution {
            center: self.center,
            axis: self.axis,
            profile: 1.0 / self.minor,
        })
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Torus {
            center: self.center,
            axis: self.axis,
            major: self.major,
            minor: self.minor,
        })
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds())
    }

    fn ball(&self) -> Option<BoundingSphere> {
        Some(BoundingSphere {
            center: self.center,
            radius: self.major + self.minor,
        })
    }
}

impl HasBaseline for Torus {
    type Baseline<R: Real> = BaselineTorus<R>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(BaselineTorus {
            center: Vector::of(self.center),
            axis: Vector::of(self.axis),
            major: R::of(self.major),
            minor: R::of(self.minor),
        })
    }
}

/// The baseline: the quartic in t, solved in closed form from the start of the ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineTorus<R> {
    center: Vector<R>,
    /// A unit vector.
    axis: Vector<R>,
    major: R,
    minor: R,
}

impl<R: Real> Baseline<R> for BaselineTorus<R> {
    /// The first root of (|p|² + R² − r²)² = 4R²ρ² along the line that counts.
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
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

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, _: u32) -> Vector<R> {
        let local = point - self.center;
        let from_axis = local - self.axis * local.dot(self.axis);
        (local - from_axis.normalized() * self.major).normalized()
    }
}
