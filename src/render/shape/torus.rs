//! The torus: critical points of its quartic bracket the roots, and the signed distance decides and
//! refines them.
//!
//! The ray is moved to the point nearest to the centre and measured in units of the torus, so the
//! quartic never sees the distance of the eye. Between two critical points the quartic is monotone
//! and has one root or none. Its value near a root is a difference of large terms; the signed
//! distance √((ρ − R)² + z²) − r has the same sign and keeps its digits, so every decision is taken
//! on it.

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Interactions, Ray, Rays};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quartic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::four::Shape4;
use crate::shape::geometry::{Intersect, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::plane::PlaneNormal;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Double, Number, Vec3, Vector, ldexp};
use std::sync::Arc;

/// Steps of a bracketed search: bisection alone would need 60.
const MAX_STEPS: usize = 100;

/// The rounding error of lengths in units of the torus.
const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Where a ray starts so near the surface, in units of the torus, it starts on it.
const ON_SURFACE: f64 = 16.0 * ROUNDING;

/// The margin of planes that touch the torus, in its units, where lengths are about 1: far above
/// rounding.
const TOUCH: f64 = 1.0 / 1_048_576.0;

/// A square larger by this factor is larger by more than rounding.
const NEARLY_ONE: f64 = 1.0 + 1e-12;

/// A prepared torus.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    center: Vec3,
    /// A unit vector along the axis.
    axis: Vec3,
    /// From the centre to the middle of the tube.
    major: f64,
    /// The radius of the tube.
    minor: f64,
    /// The power of two near the outer radius, a normal number as its reciprocal is.
    unit: f64,
}

/// A ray near the torus, or one in each lane, in units of about its outer radius, as seen from the
/// axis.
struct TorusRay<N> {
    /// Of the point nearest to the centre: the square of its distance, its height along the axis,
    /// and its cross product with the axis, as long as it is off the axis.
    square: N,
    height: N,
    off: Vector<N>,
    /// The height and the cross product a step adds.
    rise: N,
    turn: Vector<N>,
    major: f64,
    minor: f64,
}

/// The interval of a ray that may hit the torus.
struct TorusStretch<N: Double> {
    line: TorusRay<N>,
    low: N,
    high: N,
    /// Where there is one.
    near: N::Mask,
    /// The t of the point nearest to the centre, and its change per step.
    nearest: N,
    pace: N,
}

impl<N: Double> TorusStretch<N> {
    #[inline(always)]
    fn t(&self, s: N) -> N {
        self.nearest + s * self.pace
    }
}

/// A point of a ray and its signed distance from the surface.
#[derive(Clone, Copy)]
struct TorusProbe<N> {
    s: N,
    distance: N,
}

impl<N: Double> TorusProbe<N> {
    /// Selects `self` where a condition holds, and `other` elsewhere.
    #[inline(always)]
    fn select(self, mask: N::Mask, other: Self) -> Self {
        Self {
            s: N::select(mask, self.s, other.s),
            distance: N::select(mask, self.distance, other.distance),
        }
    }

    #[inline(always)]
    fn is_inside(&self) -> N::Mask {
        self.distance.less(self.s.constant(0.0))
    }
}

/// The search for the points of a stretch where the distance changes sign, in order.
struct TorusSearch<N> {
    low: N,
    cubic: DepressedCubic<N>,
    /// The next of the intervals between these, which have one critical point each; the stretch
    /// ends behind the last.
    next: usize,
    borders: [N; 4],
    /// The last point searched.
    before: TorusProbe<N>,
}

impl<N: Double> TorusRay<N> {
    /// The ray through the point nearest to the centre along a step of length 1.
    #[inline(always)]
    fn new(torus: &Torus, from: Vector<N>, step: Vector<N>) -> Self {
        let axis = Vector::constant(from.x, torus.axis);
        Self {
            square: from.dot(from),
            height: from.dot(axis),
            off: from.accurate_cross(axis),
            rise: step.dot(axis),
            turn: step.accurate_cross(axis),
            major: torus.major / torus.unit,
            minor: torus.minor / torus.unit,
        }
    }

    #[inline(always)]
    fn number(&self, x: f64) -> N {
        self.square.constant(x)
    }

    /// The point at `s`; its distance is from the factored difference of squares: its digits
    /// survive where the ray only grazes.
    #[inline(always)]
    fn at(&self, s: N) -> TorusProbe<N> {
        let minor = self.number(self.minor);
        let z = (self.height + self.rise * s).abs();
        let off = ((self.off + self.turn * s).length() - self.number(self.major)).abs();
        let is_high = off.less(z);
        let (large, small) = (N::select(is_high, z, off), N::select(is_high, off, z));
        let square = small * small + (large - minor) * (large + minor);
        TorusProbe {
            s,
            distance: square / ((off * off + z * z).sqrt() + minor),
        }
    }

    /// As [`Self::at`] for the start of the ray; on the surface the distance is 1 or −1, by the
    /// side that the ray points to: it does not hit its own surface.
    #[inline(always)]
    fn start(&self, s: N) -> TorusProbe<N> {
        let mut probe = self.at(s);
        let is_on = probe.distance.abs().less_or_equal(self.number(ON_SURFACE));
        if !N::is_nowhere(is_on) {
            let off = self.off + self.turn * s;
            let length = off.length();
            let outwards = (length - self.number(self.major)) * off.dot(self.turn) / length;
            let rise = (self.height + self.rise * s) * self.rise;
            let is_inwards = (outwards + rise).less(self.number(0.0));
            let side = N::select(is_inwards, self.number(-1.0), self.number(1.0));
            probe.distance = N::select(is_on, side, probe.distance);
        }
        probe
    }

    /// Whether the ray certainly misses the torus from `low` to `high`: it stays outside of the two
    /// planes that touch the torus, or in the hole. All with a margin far above rounding; the
    /// distance from the axis is largest at an end of the interval.
    #[inline(always)]
    fn passes(&self, low: N, high: N) -> N::Mask {
        let above = self.minor + TOUCH;
        let ends = [-above, above].map(|end| (self.number(end) - self.height) / self.rise);
        let (enter, leave) = (ends[0].least(ends[1]), ends[0].greatest(ends[1]));
        let touch = self.number(TOUCH);
        let is_outside = (high + touch).less(enter) | leave.less(low - touch);
        let hole = self.major - self.minor - TOUCH;
        if hole <= 0.0 || N::is_nowhere(!is_outside) {
            return is_outside;
        }
        let is_in_hole = |s: N| {
            (self.off + self.turn * s)
                .square()
                .less(self.number(hole * hole))
        };
        is_outside | is_in_hole(enter) & is_in_hole(leave)
    }

    /// The quartic's derivative over 4: there is no square term, as a step has length 1 and is
    /// perpendicular to the vector from the centre.
    #[inline(always)]
    fn derivative(&self) -> DepressedCubic<N> {
        // (|p|² + R² − r²)² − 4R²ρ², with |p|² = f² + s² and ρ² = |w + x·s|².
        let (w, x) = (self.off, self.turn);
        let k = self.square + self.number((self.major - self.minor) * (self.major + self.minor));
        let square = 2.0 * self.major * self.major;
        DepressedCubic {
            linear: k - self.number(square) * x.dot(x),
            constant: self.number(-square) * w.dot(x),
        }
    }

    /// A search from `low` to `high`.
    #[inline(always)]
    fn search(&self, low: N, high: N) -> TorusSearch<N> {
        let cubic = self.derivative();
        TorusSearch {
            low,
            cubic,
            next: 0,
            borders: cubic.borders(low, high),
            before: self.start(low),
        }
    }

    /// The next root where `wanted`: where there is one, the root, and where the ray was inside
    /// before it. The search may go on if it is that of a single ray.
    #[inline(always)]
    fn next_root(&self, search: &mut TorusSearch<N>, wanted: N::Mask) -> (N::Mask, N, N::Mask) {
        let (mut before, mut after) = (search.before, search.before);
        let none = wanted & !wanted;
        let (mut searched, mut exact, mut bracketed) = (wanted, none, none);
        while search.next <= 3 {
            // Split the stretch at the critical points, where the distance is monotonic.
            let (k, borders) = (search.next, &search.borders);
            search.next += 1;
            let (has, s) = match k {
                3 => (searched, borders[3]),
                _ => search.cubic.root([borders[k], borders[k + 1]], searched),
            };
            if N::is_nowhere(has) {
                continue;
            }
            // A change of sign brackets a root.
            let there = self.at(s);
            let is_root = has & there.distance.equal(self.number(0.0)) & search.low.less(s);
            let crosses = has & !is_root & (there.is_inside() ^ before.is_inside());
            after = there.select(is_root | crosses, after);
            (exact, bracketed) = (exact | is_root, bracketed | crosses);
            searched = searched & !(is_root | crosses);
            if N::is_nowhere(searched) {
                break;
            }
            before = there.select(has & searched, before);
        }
        // Refine the bracketed root.
        let root = if N::is_nowhere(bracketed) {
            after.s
        } else {
            self.root(before, after, bracketed)
        };
        search.before = after;
        let root = N::select(exact, after.s, root);
        (exact | bracketed, root, before.is_inside())
    }

    /// The root between two points with distances of opposite signs, where `active`: steps of
    /// inverse quadratic interpolation where the last three points allow it, else bisection.
    /// Chandrupatla, "A new hybrid quadratic/bisection algorithm for finding the zero of a
    /// nonlinear function without using derivatives" (Advances in Engineering Software 28, 1997).
    /// It ends where the distance is below its rounding error, or the bracket has no midpoint.
    #[inline(always)]
    fn root(&self, mut last: TorusProbe<N>, mut other: TorusProbe<N>, mut active: N::Mask) -> N {
        let rounding = self.number(ROUNDING);
        let (mut found, mut fraction) = (last.s, self.number(0.5));
        for _ in 0..MAX_STEPS {
            let there = self.at(last.s + fraction * (other.s - last.s));
            let differs = there.is_inside() ^ last.is_inside();
            let before = other.select(differs, last);
            other = last.select(differs, other);
            last = there;
            let is_best = last.distance.abs().less(other.distance.abs());
            let best = last.select(is_best, other);
            let finest = rounding / (other.s - last.s).abs();
            let ends = best.distance.abs().less_or_equal(rounding) | self.number(0.5).less(finest);
            found = N::select(active & ends, best.s, found);
            active = active & !ends;
            if N::is_nowhere(active) {
                return found;
            }
            let next = fraction_of(last, other, before);
            fraction = clamp(next, finest, self.number(1.0) - finest);
        }
        N::select(active, last.s, found)
    }
}

/// The next point between two points of opposite signs, as a fraction from the last to the other:
/// the root of the parabola through both and the point before, if that is safe, else the midpoint.
#[inline(always)]
fn fraction_of<N: Double>(last: TorusProbe<N>, other: TorusProbe<N>, before: TorusProbe<N>) -> N {
    let one = last.s.constant(1.0);
    let along = (last.s - other.s) / (before.s - other.s);
    let up = (last.distance - other.distance) / (before.distance - other.distance);
    let is_safe = (up * up).less(along) & ((one - up) * (one - up)).less(one - along);
    let linear = last.distance / (other.distance - last.distance) * before.distance
        / (other.distance - before.distance);
    let latus_rectum = (before.s - last.s) / (other.s - last.s) * last.distance
        / (before.distance - last.distance)
        * other.distance
        / (before.distance - other.distance);
    N::select(is_safe, linear + latus_rectum, one.constant(0.5))
}

/// As [`f64::clamp`].
#[inline(always)]
fn clamp<N: Number>(x: N, low: N, high: N) -> N {
    let x = N::select(x.less(low), low, x);
    N::select(high.less(x), high, x)
}

/// `s³ + linear·s + constant`.
#[derive(Clone, Copy)]
struct DepressedCubic<N> {
    linear: N,
    constant: N,
}

impl<N: Double> DepressedCubic<N> {
    #[inline(always)]
    fn value(&self, s: N) -> N {
        (s * s + self.linear) * s + self.constant
    }

    /// The ends and the extrema between them, which bracket its roots.
    #[inline(always)]
    fn borders(&self, low: N, high: N) -> [N; 4] {
        let spread = -self.linear / low.constant(3.0);
        let spread = spread.greatest(low.constant(0.0)).sqrt();
        [
            low,
            clamp(-spread, low, high),
            clamp(spread, low, high),
            high,
        ]
    }

    /// The root between two points where `wanted`, and where it changes sign there.
    #[inline(always)]
    fn root(&self, [mut a, mut b]: [N; 2], wanted: N::Mask) -> (N::Mask, N) {
        let number = |x: f64| a.constant(x);
        let (zero, half, three) = (number(0.0), number(0.5), number(3.0));
        let (first, last) = (self.value(a), self.value(b));
        let has = wanted & !b.less_or_equal(a) & (first.less(zero) ^ last.less(zero));
        let rises = first.less(last);
        let (mut at, mut active) = (half * (a + b), has);
        for _ in 0..MAX_STEPS {
            if N::is_nowhere(active) {
                break;
            }
            let height = self.value(at);
            let is_low = zero.less(height) ^ rises;
            (a, b) = (N::select(is_low, at, a), N::select(is_low, b, at));
            // Take a Newton step, or bisect if the step leaves the bracket.
            let newton = at - height / (three * at * at + self.linear);
            let fits = a.less(newton) & newton.less(b);
            let next = N::select(fits, newton, half * (a + b));
            let ends = next.equal(at) | next.less_or_equal(a) | b.less_or_equal(next);
            active = active & !ends;
            at = N::select(active, next, at);
        }
        (has, at)
    }
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
        let t = self.roots(&Rays::one(ray), true);
        (t < f64::INFINITY).then_some(t)
    }

    /// As [`Self::intersect`], where `wanted`; infinite for a miss. A lane whose search has ended
    /// continues without effect until all have.
    #[inline(always)]
    pub(super) fn roots<N: Double>(&self, rays: &Rays<N>, wanted: N::Mask) -> N {
        let number = |x: f64| rays.origin.x.constant(x);
        let none = number(f64::INFINITY);
        let Some(stretch) = self.stretch(rays, wanted) else {
            return none;
        };
        let (line, near) = (&stretch.line, stretch.near);
        let mut search = line.search(stretch.low, stretch.high);
        let (has, root, _) = line.next_root(&mut search, near);
        let t = stretch.t(root);
        N::select(has & number(0.0).less(t), t, none)
    }

    /// The interval of a ray near the torus, where `wanted`; `None` if all miss.
    #[inline(always)]
    fn stretch<N: Double>(&self, rays: &Rays<N>, wanted: N::Mask) -> Option<TorusStretch<N>> {
        let number = |x: f64| rays.origin.x.constant(x);
        let f = rays.origin - Vector::constant(rays.origin.x, self.center);
        let d = rays.direction;
        let length2 = d.dot(d);
        let nearest = -f.dot(d) / length2;
        let foot = f + d * nearest;
        let outer = self.major + self.minor;
        let half2 = number(outer * outer * NEARLY_ONE) - foot.dot(foot);
        let near = wanted & number(0.0).less_or_equal(half2);
        if N::is_nowhere(near) {
            return None;
        }
        // Scale by a power of two near the outer radius, which is exact, as is its reciprocal.
        let per_unit = number(self.unit.recip());
        let length = length2.sqrt();
        let line = TorusRay::new(self, foot * per_unit, d / length);
        let high = half2.sqrt() * per_unit;
        let low = (-nearest * length * per_unit).greatest(-high);
        let near = near & low.less(high) & !line.passes(low, high);
        (!N::is_nowhere(near)).then(|| TorusStretch {
            line,
            low,
            high,
            near,
            nearest,
            pace: number(self.unit) / length,
        })
    }

    /// The point at `t`; see [`Self::interactions`].
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        self.interactions(&Rays::one(ray), t).lane(0)
    }

    /// The points at `t`, where that is finite, moved onto the tube in its own frame.
    #[inline(always)]
    pub(super) fn interactions<N: Double>(&self, rays: &Rays<N>, t: N) -> Interactions<N> {
        let number = |x: f64| t.constant(x);
        let [center, axis] = [self.center, self.axis].map(|v| Vector::constant(t, v));
        let local = rays.origin - center + rays.direction * t;
        let (is_beside, outward) = (local - axis * local.dot(axis)).try_normalize();
        let on_axis = Vector::constant(t, Vec3::ZERO);
        let ring = outward.select(is_beside, on_axis) * number(self.major);
        let out = local - ring;
        let (has_normal, mut normal) = out.try_normalize();
        let has_none = t.less(number(f64::INFINITY)) & !has_normal;
        if !N::is_nowhere(has_none) {
            for lane in N::lanes(has_none) {
                normal.put(lane, rays.lane(lane).outward(out.lane(lane)));
            }
        }
        let point = center + ring + normal * number(self.minor);
        Interactions::new(rays, point, normal, self.center, self.major + self.minor)
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
        let Some(stretch) = self.stretch(&Rays::one(ray), true) else {
            return;
        };
        let mut search = stretch.line.search(stretch.low, stretch.high);
        if search.before.is_inside() {
            visit(SolidCrossing {
                t: f64::NEG_INFINITY,
                enters: true,
                part: 0,
            });
        }
        while let (true, s, was_inside) = stretch.line.next_root(&mut search, true) {
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
