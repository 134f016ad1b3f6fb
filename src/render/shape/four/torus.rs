//! The torus in four lanes: the steps of [`Torus::intersect`]. A lane whose search has ended
//! continues without effect until all have.

use super::Interactions;
use crate::lanes::{FourVectors, Ray4, lanes_of};
use crate::shape::torus::{MAX_STEPS, NEARLY_ONE, ON_SURFACE, ROUNDING, TOUCH, Torus};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};
use rtc_math::Vec3;

/// As [`Torus::intersect`], for the lanes `wanted`; infinite for a miss.
#[inline(always)]
pub(super) fn intersect<S: Simd>(
    simd: S,
    torus: &Torus,
    rays: &Ray4<S>,
    wanted: mask64x4<S>,
) -> f64x4<S> {
    let number = |x: f64| f64x4::splat(simd, x);
    let none = number(f64::INFINITY);
    let f = rays.origin.minus(FourVectors::splat(simd, torus.center));
    let d = rays.direction;
    let length2 = d.dot(d);
    let nearest = -f.dot(d) / length2;
    let foot = f.plus(d.times(nearest));
    let outer = torus.major + torus.minor;
    let half2 = number(outer * outer * NEARLY_ONE) - foot.dot(foot);
    let near = wanted & half2.simd_ge(number(0.0));
    if near.all_false() {
        return none;
    }
    // The reciprocal of a power of two is exact.
    let per_unit = number(torus.unit.recip());
    let length = length2.sqrt();
    let line = TorusRays::new(simd, torus, foot.times(per_unit), d.over(length));
    let half = half2.sqrt() * per_unit;
    let start = -nearest * length * per_unit;
    let low = start.simd_gt(-half).select(start, -half);
    let near = near & !(low.simd_ge(half) | line.passes(simd, low, half));
    if near.all_false() {
        return none;
    }
    let (hit_lanes, root) = line.first_root(simd, low, half, near);
    let t = nearest + root * (number(torus.unit) / length);
    (hit_lanes & t.simd_gt(number(0.0))).select(t, none)
}

/// As [`Torus::interaction`].
#[inline(always)]
pub(super) fn interactions<S: Simd>(
    simd: S,
    torus: &Torus,
    rays: &Ray4<S>,
    t: f64x4<S>,
) -> Interactions<S> {
    let number = |x: f64| f64x4::splat(simd, x);
    let (center, axis) = (
        FourVectors::splat(simd, torus.center),
        FourVectors::splat(simd, torus.axis),
    );
    let local = rays.origin.minus(center).plus(rays.direction.times(t));
    let beside = local.minus(axis.times(local.dot(axis)));
    let (is_beside, outward) = beside.normalized();
    let ring = outward
        .select(is_beside, FourVectors::splat(simd, Vec3::ZERO))
        .times(number(torus.major));
    let out = local.minus(ring);
    let (has_normal, mut normal) = out.normalized();
    let has_none = t.simd_lt(number(f64::INFINITY)) & !has_normal;
    if has_none.any_true() {
        for lane in lanes_of(has_none.to_bitmask()) {
            normal.put(lane, rays.lane(lane).outward(out.lane(lane)));
        }
    }
    let point = center.plus(ring).plus(normal.times(number(torus.minor)));
    let extent = torus.major + torus.minor;
    Interactions::new(simd, rays, point, normal, torus.center, extent)
}

/// A point of each ray and its signed distance from the surface.
#[derive(Clone, Copy)]
struct TorusProbe<S: Simd> {
    s: f64x4<S>,
    distance: f64x4<S>,
}

impl<S: Simd> TorusProbe<S> {
    /// Selects `self` in the lanes of a mask, and `other` elsewhere.
    #[inline(always)]
    fn select(self, mask: mask64x4<S>, other: Self) -> Self {
        Self {
            s: mask.select(self.s, other.s),
            distance: mask.select(self.distance, other.distance),
        }
    }

    #[inline(always)]
    fn is_inside(&self) -> mask64x4<S> {
        self.distance.simd_lt(f64x4::splat(self.distance.simd, 0.0))
    }
}

/// Four times a `TorusRay`.
struct TorusRays<S: Simd> {
    square: f64x4<S>,
    height: f64x4<S>,
    off: FourVectors<S>,
    rise: f64x4<S>,
    turn: FourVectors<S>,
    major: f64,
    minor: f64,
}

impl<S: Simd> TorusRays<S> {
    /// The rays through points nearest to the centre along steps of length 1.
    #[inline(always)]
    fn new(simd: S, torus: &Torus, from: FourVectors<S>, step: FourVectors<S>) -> Self {
        let axis = FourVectors::splat(simd, torus.axis);
        Self {
            square: from.dot(from),
            height: from.dot(axis),
            off: from.cross(axis),
            rise: step.dot(axis),
            turn: step.cross(axis),
            major: torus.major / torus.unit,
            minor: torus.minor / torus.unit,
        }
    }

    /// The points at `s`.
    #[inline(always)]
    fn at(&self, simd: S, s: f64x4<S>) -> TorusProbe<S> {
        let number = |x: f64| f64x4::splat(simd, x);
        let minor = number(self.minor);
        let z = (self.height + self.rise * s).abs();
        let off = ((self.off.plus(self.turn.times(s))).length() - number(self.major)).abs();
        let is_high = z.simd_gt(off);
        let (large, small) = (is_high.select(z, off), is_high.select(off, z));
        let square = small * small + (large - minor) * (large + minor);
        TorusProbe {
            s,
            distance: square / ((off * off + z * z).sqrt() + minor),
        }
    }

    /// The points at `s`, with the distances that `TorusRay::start_distance` has.
    #[inline(always)]
    fn start(&self, simd: S, s: f64x4<S>) -> TorusProbe<S> {
        let number = |x: f64| f64x4::splat(simd, x);
        let mut probe = self.at(simd, s);
        let is_on = probe.distance.abs().simd_le(number(ON_SURFACE));
        if is_on.any_true() {
            let off = self.off.plus(self.turn.times(s));
            let length = off.length();
            let outwards = (length - number(self.major)) * off.dot(self.turn) / length;
            let rise = (self.height + self.rise * s) * self.rise;
            let is_inwards = (outwards + rise).simd_lt(number(0.0));
            let side = is_inwards.select(number(-1.0), number(1.0));
            probe.distance = is_on.select(side, probe.distance);
        }
        probe
    }

    /// As `TorusRay::passes`.
    #[inline(always)]
    fn passes(&self, simd: S, low: f64x4<S>, high: f64x4<S>) -> mask64x4<S> {
        let number = |x: f64| f64x4::splat(simd, x);
        let above = self.minor + TOUCH;
        let below = (number(-above) - self.height) / self.rise;
        let above = (number(above) - self.height) / self.rise;
        let (enter, leave) = (below.min_precise(above), below.max_precise(above));
        let outside = enter.simd_gt(high + number(TOUCH)) | leave.simd_lt(low - number(TOUCH));
        let hole = self.major - self.minor - TOUCH;
        if hole <= 0.0 {
            return outside;
        }
        let is_in_hole = |s: f64x4<S>| {
            let off = self.off.plus(self.turn.times(s));
            off.dot(off).simd_lt(number(hole * hole))
        };
        outside | is_in_hole(enter) & is_in_hole(leave)
    }

    /// As `TorusRay::first_root`, for the lanes `wanted`: those that have one, and the roots.
    #[inline(always)]
    fn first_root(
        &self,
        simd: S,
        low: f64x4<S>,
        high: f64x4<S>,
        wanted: mask64x4<S>,
    ) -> (mask64x4<S>, f64x4<S>) {
        // The extrema of the distance split the interval where it is monotonic.
        let cubic = self.derivative(simd);
        let borders = cubic.borders(simd, low, high);
        let first = self.start(simd, low);
        let (mut before, mut after) = (first, first);
        let (mut searched, mut exact, mut bracketed) = (wanted, !wanted & wanted, !wanted & wanted);
        for k in 0..=3 {
            let (has, s) = match k {
                3 => (searched, high),
                _ => cubic.root(simd, [borders[k], borders[k + 1]], searched),
            };
            if has.all_false() {
                continue;
            }
            // A change of sign brackets a root.
            let there = self.at(simd, s);
            let is_root = has & there.distance.simd_eq(f64x4::splat(simd, 0.0)) & s.simd_gt(low);
            let crosses = has & !is_root & (there.is_inside() ^ before.is_inside());
            after = there.select(is_root | crosses, after);
            (exact, bracketed) = (exact | is_root, bracketed | crosses);
            searched &= !(is_root | crosses);
            if searched.all_false() {
                break;
            }
            before = there.select(has & searched, before);
        }
        // Refine the bracketed root.
        let root = if bracketed.any_true() {
            self.root(simd, before, after, bracketed)
        } else {
            after.s
        };
        (exact | bracketed, exact.select(after.s, root))
    }

    /// As `TorusRay::derivative`.
    #[inline(always)]
    fn derivative(&self, simd: S) -> DepressedCubic<S> {
        let number = |x: f64| f64x4::splat(simd, x);
        let (w, x) = (self.off, self.turn);
        let k = self.square + number((self.major - self.minor) * (self.major + self.minor));
        let square = 2.0 * self.major * self.major;
        DepressedCubic {
            linear: k - number(square) * x.dot(x),
            constant: number(-square) * w.dot(x),
        }
    }

    /// As `TorusRay::root`, of the lanes `active`.
    #[inline(always)]
    fn root(
        &self,
        simd: S,
        mut last: TorusProbe<S>,
        mut other: TorusProbe<S>,
        mut active: mask64x4<S>,
    ) -> f64x4<S> {
        let number = |x: f64| f64x4::splat(simd, x);
        let (mut found, mut fraction) = (last.s, number(0.5));
        for _ in 0..MAX_STEPS {
            let there = self.at(simd, last.s + fraction * (other.s - last.s));
            let differs = there.is_inside() ^ last.is_inside();
            let before = other.select(differs, last);
            other = last.select(differs, other);
            last = there;
            let is_best = last.distance.abs().simd_lt(other.distance.abs());
            let best = last.select(is_best, other);
            let finest = number(ROUNDING) / (other.s - last.s).abs();
            let ends = best.distance.abs().simd_le(number(ROUNDING)) | finest.simd_gt(number(0.5));
            found = (active & ends).select(best.s, found);
            active &= !ends;
            if active.all_false() {
                return found;
            }
            let next = fraction_of(simd, last, other, before);
            fraction = clamp(next, finest, number(1.0) - finest);
        }
        active.select(last.s, found)
    }
}

/// As `fraction_of` of one torus.
#[inline(always)]
fn fraction_of<S: Simd>(
    simd: S,
    last: TorusProbe<S>,
    other: TorusProbe<S>,
    before: TorusProbe<S>,
) -> f64x4<S> {
    let one = f64x4::splat(simd, 1.0);
    let along = (last.s - other.s) / (before.s - other.s);
    let up = (last.distance - other.distance) / (before.distance - other.distance);
    let is_safe = (up * up).simd_lt(along) & ((one - up) * (one - up)).simd_lt(one - along);
    let linear = last.distance / (other.distance - last.distance) * before.distance
        / (other.distance - before.distance);
    let latus_rectum = (before.s - last.s) / (other.s - last.s) * last.distance
        / (before.distance - last.distance)
        * other.distance
        / (before.distance - other.distance);
    is_safe.select(linear + latus_rectum, f64x4::splat(simd, 0.5))
}

/// As [`f64::clamp`].
#[inline(always)]
fn clamp<S: Simd>(x: f64x4<S>, low: f64x4<S>, high: f64x4<S>) -> f64x4<S> {
    let x = x.simd_lt(low).select(low, x);
    x.simd_gt(high).select(high, x)
}

/// `s³ + linear·s + constant`.
#[derive(Clone, Copy)]
struct DepressedCubic<S: Simd> {
    linear: f64x4<S>,
    constant: f64x4<S>,
}

impl<S: Simd> DepressedCubic<S> {
    #[inline(always)]
    fn value(&self, s: f64x4<S>) -> f64x4<S> {
        (s * s + self.linear) * s + self.constant
    }

    /// The ends and the extrema between them.
    #[inline(always)]
    fn borders(&self, simd: S, low: f64x4<S>, high: f64x4<S>) -> [f64x4<S>; 4] {
        let zero = f64x4::splat(simd, 0.0);
        let spread = -self.linear / f64x4::splat(simd, 3.0);
        let spread = spread.simd_gt(zero).select(spread, zero).sqrt();
        [
            low,
            clamp(-spread, low, high),
            clamp(spread, low, high),
            high,
        ]
    }

    /// As `cubic_root`, for the lanes `wanted`: those that have one, and the roots.
    #[inline(always)]
    fn root(
        &self,
        simd: S,
        [mut a, mut b]: [f64x4<S>; 2],
        wanted: mask64x4<S>,
    ) -> (mask64x4<S>, f64x4<S>) {
        let number = |x: f64| f64x4::splat(simd, x);
        let zero = number(0.0);
        let (first, last) = (self.value(a), self.value(b));
        let has = wanted & !a.simd_ge(b) & (first.simd_lt(zero) ^ last.simd_lt(zero));
        let rises = last.simd_gt(first);
        let mut at = number(0.5) * (a + b);
        let mut active = has;
        for _ in 0..MAX_STEPS {
            if active.all_false() {
                break;
            }
            let height = self.value(at);
            let is_low = height.simd_gt(zero) ^ rises;
            (a, b) = (is_low.select(at, a), is_low.select(b, at));
            let newton = at - height / (number(3.0) * at * at + self.linear);
            let fits = newton.simd_gt(a) & newton.simd_lt(b);
            let next = fits.select(newton, number(0.5) * (a + b));
            let ends = next.simd_eq(at) | next.simd_le(a) | next.simd_ge(b);
            active &= !ends;
            at = active.select(next, at);
        }
        (has, at)
    }
}
