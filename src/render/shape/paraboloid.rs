//! The capped paraboloid: the stretch inside the infinite paraboloid and the stretch between base
//! and vertex, intersected. After Pharr, Jakob, Humphreys, "Physically Based Rendering" (3rd ed.),
//! §3.5.
//!
//! With m the depth of a point below the vertex and k = radius²/height, it is inside where F = ρ² −
//! k·m ≤ 0. The ray is first moved to the point nearest to the axis, so that the terms of the
//! quadratic have the size of the paraboloid. Where a first-order bound on the error of the
//! discriminant leaves its sign in doubt, or its root with few digits, all is computed again in
//! double-double, from the given numbers.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::disc::BaselineDisc;
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes, SolidCrossing};
use crate::shape::interval::{Interval, between_planes, off_surface, roots, size_of_start};
use crate::shape::mesh::BaselineMesh;
use crate::shape::triangle::WatertightRay;
use rtc_math::{
    Bounds, DoubleDouble, OrthonormalBasis, U, Vec3, Vector, atan2, cross, difference_of_products,
    dot, ldexp, unit_scale,
};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The roots are computed again if the discriminant is less than this many times its error.
const AMPLIFIED: f64 = 1024.0;

/// The rounding error of double-double that a discriminant may have, in units of its terms; a ray
/// that is tangent to within it hits.
const PRECISE: f64 = 128.0 * U * U;

/// A prepared paraboloid with a cap at its base.
#[derive(Clone, Copy, Debug)]
pub struct Paraboloid {
    base: Vec3,
    /// From the base to the vertex as given, times a power of two, and that power.
    up: Vec3,
    scale: f64,
    /// The unit vector along it.
    axis: Vec3,
    height: f64,
    radius: f64,
    /// radius²/height: twice the radius of curvature at the vertex.
    latus_rectum: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum ParaboloidFace {
    Side,
    Base,
}

impl ParaboloidFace {
    const ALL: [Self; 2] = [Self::Side, Self::Base];
}

/// F along a ray, `a·t² − 2·b·t + c`, and its inputs: the cross products of its start and its
/// direction with the axis.
#[derive(Clone, Copy)]
struct QuadraticCoefficients {
    w: Vec3,
    x: Vec3,
    a: f64,
    b: f64,
    c: f64,
}

impl Paraboloid {
    /// The paraboloid over the disc around `base`, with its vertex at `base + up`; `up` must not be
    /// zero.
    #[must_use]
    pub fn new(base: Vec3, up: Vec3, radius: f64) -> Self {
        let (scaled, exponent) = unit_scale(up).unwrap_or((up, 0));
        let length = dot(scaled, scaled).sqrt();
        let height = ldexp(length, exponent);
        Self {
            base,
            up: scaled,
            scale: ldexp(1.0, exponent),
            axis: scaled / length,
            height,
            radius,
            latus_rectum: radius * (radius / height),
        }
    }

    /// The first root above 0, and its part.
    fn intersection(&self, ray: &Ray) -> Option<(f64, ParaboloidFace)> {
        self.stretch(ray)?.first_in_front()
    }

    /// The stretch of the ray inside.
    fn stretch(&self, ray: &Ray) -> Option<Interval<ParaboloidFace>> {
        let start = ray.origin - self.base;
        let parts = [ParaboloidFace::Base, ParaboloidFace::Side];
        let size = size_of_start(ray, self.base, self.height + self.radius);
        let ends = between_planes(self.axis, self.height, start, ray.direction, size, parts)?;
        let inside = self.inside(ray, start, &ends)?;
        let QuadraticCoefficients { w, b, c, .. } = self.coefficients(start, ray.direction);
        // The gradient of F bounds what rounding changes in it.
        let gradient = 2.0 * w.length() + self.latus_rectum;
        let outside = off_surface(c, size * gradient);
        inside.seen_from(outside, -b).and(ends)
    }

    /// The stretch inside the infinite paraboloid, accurate between the base and the vertex.
    fn inside(
        &self,
        ray: &Ray,
        start: Vec3,
        ends: &Interval<ParaboloidFace>,
    ) -> Option<Interval<ParaboloidFace>> {
        let d = ray.direction;
        // Move the ray to the point nearest to the axis, but not beyond base and vertex.
        let (from_axis, across) = (cross(start, self.axis), cross(d, self.axis));
        let nearest = (-from_axis.dot(across) / across.dot(across))
            .max(ends.enter.0)
            .min(ends.leave.0);
        let f = start + d * nearest;
        let coefficients = self.coefficients(f, d);
        let QuadraticCoefficients { a, b, c, .. } = coefficients;
        let discriminant = difference_of_products(b, b, a, c);
        let size = (start.abs() + f.abs()).element_sum();
        let error_bound = self.error_bound(&coefficients, d, size, nearest);
        if discriminant < -error_bound {
            return None;
        }
        if a > 0.0 && discriminant > AMPLIFIED * error_bound {
            let (first, second) = roots(a, b, c, discriminant);
            return Some(side(nearest + first, nearest + second));
        }
        self.inside_precisely(ray, nearest)
    }

    /// F along the ray from a point, given from the base, along `d`.
    fn coefficients(&self, from: Vec3, d: Vec3) -> QuadraticCoefficients {
        let k = self.latus_rectum;
        let (w, x) = (cross(from, self.axis), cross(d, self.axis));
        let depth = self.height - dot(self.axis, from);
        let half_rise = 0.5 * k * dot(self.axis, d);
        QuadraticCoefficients {
            w,
            x,
            a: x.dot(x),
            b: -(w.dot(x) + half_rise),
            c: w.dot(w) - k * depth,
        }
    }

    /// A bound on the error of the discriminant b² − a·c of a ray that was moved by `nearest`
    /// between two points of this size together.
    fn error_bound(
        &self,
        coefficients: &QuadraticCoefficients,
        d: Vec3,
        size: f64,
        nearest: f64,
    ) -> f64 {
        let QuadraticCoefficients { w, x, a, b, c } = *coefficients;
        let k = self.latus_rectum;
        // Bound the error of each coefficient by the sizes of its terms, then that of the
        // discriminant.
        let pace = d.abs().element_sum();
        let size = size + pace * nearest.abs();
        let across = w.length();
        let a_error = 20.0 * pace * x.length();
        let b_error = pace * (32.0 * size + 16.0 * k);
        let c_error = 40.0 * across * size + k * (20.0 * size + 12.0 * self.height);
        let error = 2.0 * b.abs() * b_error + a * c_error + c.abs() * a_error;
        U * (error + U * b_error * b_error)
    }

    /// As [`Self::inside`] in double-double. With u the given vector to the vertex, and p that of a
    /// point from the base, F·u² = |p × u|² − radius²·(u² − p·u): no square root, no rounded axis.
    #[cold]
    #[inline(never)]
    fn inside_precisely(&self, ray: &Ray, nearest: f64) -> Option<Interval<ParaboloidFace>> {
        let number = DoubleDouble::from;
        let d = ray.direction.to_array().map(number);
        let u = self.up.to_array().map(number);
        let shift = number(nearest);
        let f =
            [0, 1, 2].map(|k| DoubleDouble::difference(ray.origin[k], self.base[k]) + d[k] * shift);
        let (w, x) = (wide_cross(f, u), wide_cross(d, u));
        let square = number(self.radius) * number(self.radius);
        let [above, rise] = [f, d].map(|v| wide_dot(v, u) / number(self.scale));
        let a = wide_dot(x, x);
        let zero = number(0.0);
        let b = zero - (wide_dot(w, x) + square * rise * number(0.5));
        let c = wide_dot(w, w) - square * (wide_dot(u, u) - above);

        // Compute the roots without cancellation; a ray along the axis has one.
        let at = |s: DoubleDouble| (shift + s).to_f64();
        if a.to_f64() == 0.0 {
            let root = at(c / (b + b));
            return Some(match b.to_f64() < 0.0 {
                true => side(f64::NEG_INFINITY, root),
                false => side(root, f64::INFINITY),
            });
        }
        let discriminant = b * b - a * c;
        let rounding = PRECISE * (b * b + a * wide_dot(w, w)).to_f64();
        if discriminant.to_f64().is_nan() || discriminant.to_f64() < -rounding {
            return None;
        }
        let root = discriminant.sqrt();
        if b.to_f64() >= 0.0 {
            let q = b + root;
            let first = if q.to_f64() == 0.0 { zero } else { c / q };
            Some(side(at(first), at(q / a)))
        } else {
            let q = b - root;
            Some(side(at(q / a), at(c / q)))
        }
    }

    /// A point near the side, moved onto it along the gradient of F, and the normal there.
    fn onto_side(&self, local: Vec3, along: f64) -> (Vec3, Vec3) {
        let radial = self.radial(local, along);
        let gradient = radial * 2.0 + self.axis * self.latus_rectum;
        let length = gradient.length();
        let normal = gradient / length;
        let f = radial.dot(radial) - self.latus_rectum * (self.height - along);
        (local - normal * (f / length), normal)
    }

    /// The way to a point from the axis.
    fn radial(&self, local: Vec3, along: f64) -> Vec3 {
        let radial = local - self.axis * along;
        // Repeat the step: in a needle, the rest along the axis is amplified by height/radius.
        radial - self.axis * dot(self.axis, radial)
    }
}

/// The stretch between two points of the side.
fn side(enter: f64, leave: f64) -> Interval<ParaboloidFace> {
    Interval {
        enter: (enter, ParaboloidFace::Side),
        leave: (leave, ParaboloidFace::Side),
    }
}

fn wide_dot(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn wide_cross(a: [DoubleDouble; 3], b: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl Intersect for Paraboloid {
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
        let part = hit.map_or(ParaboloidFace::Side, |(_, part)| part);
        self.interaction_on(ray, t, part as u32)
    }

    /// The point at `t`, moved onto the part that was hit.
    fn interaction_on(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        let part = ParaboloidFace::ALL[part as usize];
        let local = (ray.origin - self.base) + ray.direction * t;
        let along = dot(local, self.axis);
        let (local, normal) = match part {
            ParaboloidFace::Base => (local - self.axis * along, -self.axis),
            ParaboloidFace::Side => self.onto_side(local, along),
        };
        let extent = self.height + self.radius;
        Interaction::new(ray, self.base + local, normal, self.base, extent)
    }

    /// u = φ/2π about the axis. On the side, v is the depth below the vertex in heights; on the
    /// cap, the distance from the axis in radii: 1 at the rim on both.
    fn shading_attributes(
        &self,
        _: &Ray,
        at: &Interaction,
        _: u32,
        _: AttributeRequest,
    ) -> ShadingAttributes {
        let local = at.point - self.base;
        let along = dot(local, self.axis);
        let radial = self.radial(local, along);
        let OrthonormalBasis {
            tangent: x,
            bitangent: y,
            ..
        } = OrthonormalBasis::around(self.axis);
        let turns = atan2(radial.dot(y), radial.dot(x)) / TAU;
        let u = if turns < 0.0 { turns + 1.0 } else { turns };
        let is_cap = at.normal.dot(self.axis) < -0.5;
        let v = if is_cap {
            radial.length() / self.radius
        } else {
            (self.height - along) / self.height
        };
        ShadingAttributes {
            uv: Some([u, v.clamp(0.0, 1.0)]),
            tangent: self.axis.cross(radial).try_normalize(),
            ..ShadingAttributes::default()
        }
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Paraboloid {
            base: self.base,
            axis: self.axis,
            height: self.height,
            radius: self.radius,
        })
    }

    /// A box around the paraboloid: its profile is a parabola, which lies between the rim, and the
    /// vertex and half the radius beside it.
    fn bounds(&self) -> Option<Bounds> {
        let disc = |center, radius| Bounds::around_disc(center, self.axis, radius);
        let top = self.base + self.axis * self.height;
        Some(disc(self.base, self.radius).union(disc(top, 0.5 * self.radius)))
    }
}

impl HasBaseline for Paraboloid {
    type Baseline<R: Real> = Box<BaselineParaboloid<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineParaboloid {
            base: Vector::of(self.base),
            axis: Vector::of(self.axis),
            height: R::of(self.height),
            latus_rectum: R::of(self.latus_rectum),
            cap: BaselineDisc::new(self.base, -self.axis, self.radius),
        }))
    }
}

/// The parts of the baseline: side and base.
const PLAIN_PARTS: [u32; 2] = [0, 1];

/// The baseline: the quadratic of ρ² = k·m, with m the height left to the vertex, and a disc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineParaboloid<R> {
    base: Vector<R>,
    axis: Vector<R>,
    height: R,
    latus_rectum: R,
    cap: BaselineDisc<R>,
}

impl<R: Real> Baseline<R> for BaselineParaboloid<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let [side, base] = PLAIN_PARTS;
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let (from_axis, across) = (f - self.axis * above, ray.direction - self.axis * rise);
        let b = R::of(2.0) * from_axis.dot(across) + self.latus_rectum * rise;
        let c = from_axis.dot(from_axis) - self.latus_rectum * (self.height - above);
        let within = |t: R| {
            if above + rise * t >= R::of(0.0) {
                t
            } else {
                R::of(f64::NAN)
            }
        };
        let [first, second] = quadratic(across.dot(across), b, c)?.map(within);
        let cap = self.cap.parameter(ray);
        ray.first([(first, side), (second, side), (cap, base)])
    }

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        if prim_id == PLAIN_PARTS[1] {
            return self.cap.normal();
        }
        let local = point - self.base;
        let from_axis = local - self.axis * local.dot(self.axis);
        (from_axis * R::of(2.0) + self.axis * self.latus_rectum).normalized()
    }
}
