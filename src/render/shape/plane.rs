//! The plane: t from compensated dot products with the raw normal, accurate at any slope and
//! distance.

use crate::ray::{Interaction, Interactions, Ray, Rays};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::four::Shape4;
use crate::shape::geometry::{Intersect, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use rtc_math::{
    Bounds, Double, U, Vec3, Vector, cross_by, dot, dot_by, two_difference, unit_scale,
};
use std::sync::Arc;

/// The orientation of a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneNormal {
    /// The normal as given, times a power of two.
    pub(super) raw: Vec3,
    /// Its square.
    pub(super) square: f64,
    unit: Vec3,
}

/// An axis parallel to a normal, and its sign: products with such a normal are exact, and so are
/// their sums.
#[derive(Clone, Copy, Debug)]
pub struct PlaneAxis {
    pub(super) index: usize,
    pub(super) sign: f64,
}

impl PlaneAxis {
    /// The axis that a scaled normal is parallel to, if any.
    #[inline(always)]
    fn along(raw: Vec3) -> Option<Self> {
        let [x, y, z] = raw.to_array();
        let (index, sign, others) = if z != 0.0 {
            (2, z, [x, y])
        } else if y != 0.0 {
            (1, y, [x, z])
        } else {
            (0, x, [y, z])
        };
        (sign.abs() == 1.0 && others == [0.0; 2]).then_some(Self { index, sign })
    }

    /// N·(anchor − p), but for the sign of a 0.
    #[inline(always)]
    fn distance<N: Double>(self, anchor: Vec3, p: Vector<N>) -> N {
        let number = |x: f64| p.x.constant(x);
        let (step, error) = two_difference(number(anchor[self.index]), p.along(self.index));
        number(self.sign) * step + number(self.sign) * error
    }

    /// Whether a point lies on the plane through `anchor`, and has no 0 whose sign a sum may
    /// change.
    #[inline(always)]
    fn is_on<N: Double>(self, anchor: Vec3, p: Vector<N>) -> N::Mask {
        let number = |x: f64| p.x.constant(x);
        let [x, y, z] = p.map(|x| x.equal(number(0.0))).into_array();
        p.along(self.index).equal(number(anchor[self.index])) & !(x | y | z)
    }
}

/// A prepared plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub(super) anchor: Vec3,
    pub(super) normal: PlaneNormal,
}

/// A vector at a right angle to a triangle, or `None` if its corners are collinear. `FUSED` as in
/// [`cross_by`].
#[inline(always)]
fn across<const FUSED: bool>([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let (first, _) = unit_scale(b - a)?;
    let (second, _) = unit_scale(c - a)?;
    let normal = cross_by::<FUSED>(first, second);
    (normal != Vec3::ZERO).then_some(normal)
}

/// A vector times the power of two that brings its largest component into [1, 2).
#[inline(always)]
fn scaled(vector: Vec3) -> Vec3 {
    unit_scale(vector).map_or(vector, |(scaled, _)| scaled)
}

/// N·(anchor − p) of a normal N, as if in twice the precision.
#[inline(always)]
fn distance<const FUSED: bool>(
    normal: Vec3,
    axis: Option<PlaneAxis>,
    anchor: Vec3,
    p: Vec3,
) -> f64 {
    // The sign of a 0 is that of the sum.
    if let Some(distance) = axis.map(|axis| axis.distance(anchor, Vector::constant(0.0, p)))
        && distance != 0.0
    {
        return distance;
    }
    let (x, x_error) = two_difference(anchor.x, p.x);
    let (y, y_error) = two_difference(anchor.y, p.y);
    let (z, z_error) = two_difference(anchor.z, p.z);
    let step = Vec3::new(x, y, z);
    dot_by::<FUSED>(normal, step) + normal.dot(Vec3::new(x_error, y_error, z_error))
}

/// The t along a ray of the plane through `anchor` with a scaled normal; see [`Plane::parameter`].
#[inline(always)]
fn parameter<const FUSED: bool>(normal: Vec3, anchor: Vec3, ray: &Ray) -> Option<f64> {
    let axis = PlaneAxis::along(normal);
    let slope = match axis {
        Some(PlaneAxis { index, sign }) => sign * ray.direction[index],
        None => dot_by::<FUSED>(normal, ray.direction),
    };
    if slope == 0.0 {
        return None;
    }
    Some(distance::<FUSED>(normal, axis, anchor, ray.origin) / slope)
}

/// The root above 0 of the plane of a triangle: that of [`PlaneNormal::of`], which is not needed
/// whole.
#[inline(always)]
pub(crate) fn root_of_corners<const FUSED: bool>(corners: [Vec3; 3], ray: &Ray) -> Option<f64> {
    let normal = scaled(across::<FUSED>(corners)?);
    parameter::<FUSED>(normal, corners[0], ray).filter(|t| *t > 0.0)
}

impl PlaneNormal {
    /// The normal along a vector, which must not be zero.
    #[must_use]
    #[inline(always)]
    pub(crate) fn new(vector: Vec3) -> Self {
        let raw = scaled(vector);
        let square = dot(raw, raw);
        Self {
            raw,
            square,
            unit: raw / square.sqrt(),
        }
    }

    /// The normal of a triangle, or `None` if its corners are collinear.
    #[must_use]
    #[inline(always)]
    pub(crate) fn of(corners: [Vec3; 3]) -> Option<Self> {
        across::<false>(corners).map(Self::new)
    }

    /// The unit vector.
    #[must_use]
    #[inline]
    pub(crate) fn unit(&self) -> Vec3 {
        self.unit
    }

    /// The t of the plane through `anchor` along the ray; see [`Plane::parameter`].
    #[inline(always)]
    fn parameter(&self, anchor: Vec3, ray: &Ray) -> Option<f64> {
        parameter::<false>(self.raw, anchor, ray)
    }

    /// The axis parallel to the normal, if any.
    #[inline(always)]
    fn axis(&self) -> Option<PlaneAxis> {
        PlaneAxis::along(self.raw)
    }

    /// The root above 0 of the plane through `anchor`.
    #[must_use]
    #[inline(always)]
    pub(crate) fn intersect(&self, anchor: Vec3, ray: &Ray) -> Option<f64> {
        self.parameter(anchor, ray).filter(|t| *t > 0.0)
    }

    /// Whether uncompensated arithmetic can prove that [`Self::intersect`] finds a root of at least
    /// `t_max`.
    #[must_use]
    #[inline]
    pub(crate) fn is_beyond(&self, anchor: Vec3, ray: &Ray, t_max: f64) -> bool {
        let to_anchor = anchor - ray.origin;
        let (distance, slope) = (self.raw.dot(to_anchor), self.raw.dot(ray.direction));
        // Four roundings of the distance, three of the slope, or products below the normal numbers.
        let sizes = self.raw.abs();
        let distance_error = 5.0 * U * sizes.dot(to_anchor.abs()) + f64::MIN_POSITIVE;
        let slope_error = 4.0 * U * sizes.dot(ray.direction.abs()) + f64::MIN_POSITIVE;
        // The root itself may be wrong by 10 u.
        let limit = (slope.abs() + slope_error) * (t_max * (1.0 + 16.0 * U));
        distance.signum() == slope.signum() && distance.abs() - distance_error > limit
    }

    /// The point at `t`, moved onto the plane through `anchor`.
    #[must_use]
    pub(crate) fn interaction(&self, anchor: Vec3, ray: &Ray, t: f64) -> Interaction {
        let near = ray.origin + ray.direction * t;
        let Self { raw, square, unit } = *self;
        let axis = self.axis();
        let point = if axis.is_some_and(|axis| axis.is_on(anchor, Vector::constant(0.0, near))) {
            near
        } else {
            near + raw * (distance::<false>(raw, axis, anchor, near) / square)
        };
        Interaction::new(ray, point, unit, anchor, 0.0)
    }
}

impl Plane {
    /// The plane through `anchor` at a right angle to `normal`, which must not be zero.
    #[must_use]
    pub fn new(anchor: Vec3, normal: Vec3) -> Self {
        Self {
            anchor,
            normal: PlaneNormal::new(normal),
        }
    }

    /// A point of it.
    #[must_use]
    pub(super) fn anchor(&self) -> Vec3 {
        self.anchor
    }

    /// The unit normal.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal.unit
    }

    /// The t of the plane along the ray, of any sign, with an error of at most 10 u; `None` for a
    /// parallel ray.
    #[must_use]
    #[inline]
    pub fn parameter(&self, ray: &Ray) -> Option<f64> {
        self.normal.parameter(self.anchor, ray)
    }

    /// The root above 0.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        self.normal.intersect(self.anchor, ray)
    }

    /// The point at `t`, moved onto the plane.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        self.normal.interaction(self.anchor, ray, t)
    }

    /// As [`Self::intersect`] for a plane along an axis, where `active`; infinite for a miss.
    #[inline(always)]
    pub(super) fn roots<N: Double>(&self, axis: PlaneAxis, rays: &Rays<N>, active: N::Mask) -> N {
        let number = |x: f64| rays.origin.x.constant(x);
        let zero = number(0.0);
        let slope = number(axis.sign) * rays.direction.along(axis.index);
        // A distance of 0 gives no root above 0, whatever its sign.
        let t = axis.distance(self.anchor, rays.origin) / slope;
        N::select(
            active & !slope.equal(zero) & zero.less(t),
            t,
            number(f64::INFINITY),
        )
    }

    /// As [`Self::interaction`] for a plane along an axis.
    #[inline(always)]
    pub(super) fn interactions<N: Double>(
        &self,
        axis: PlaneAxis,
        rays: &Rays<N>,
        t: N,
    ) -> Interactions<N> {
        let near = rays.origin + rays.direction * t;
        let is_on = axis.is_on(self.anchor, near);
        let distance = axis.distance(self.anchor, near);
        let step = distance / t.constant(self.normal.square);
        let moved = near + Vector::constant(t, self.normal.raw) * step;
        let mut point = near.select(is_on, moved);
        let doubted = !is_on & distance.equal(t.constant(0.0));
        if !N::is_nowhere(doubted) {
            for lane in N::lanes(doubted) {
                point.put(lane, self.interaction(&rays.lane(lane), t.lane(lane)).point);
            }
        }
        let normal = Vector::constant(t, self.normal());
        Interactions::new(rays, point, normal, self.anchor, 0.0)
    }
}

impl Intersect for Plane {
    #[inline]
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersect(ray).map(|t| (t, 0))
    }

    /// The crossings of the half-space behind the plane.
    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        let rise = self.normal.raw.dot(ray.direction);
        let is_behind = self.normal.raw.dot(ray.origin - self.anchor) < 0.0;
        let (enter, leave) = match self.intersect(ray) {
            Some(t) if rise < 0.0 => (t, f64::INFINITY),
            Some(t) => (f64::NEG_INFINITY, t),
            // The crossing is behind the origin, or at it.
            None if rise < 0.0 || (rise == 0.0 && is_behind) => (f64::NEG_INFINITY, f64::INFINITY),
            None => return,
        };
        SolidCrossing::visit_both((enter, 0), (leave, 0), visit);
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.interaction(ray, t)
    }

    #[inline(always)]
    fn shape4(&self) -> Option<Shape4<'_>> {
        let axis = self.normal.axis()?;
        Some(Shape4::Plane(self, axis))
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Flat)
    }

    fn emitter(&self) -> Option<Emitter> {
        None
    }

    fn bounds(&self) -> Option<Bounds> {
        None
    }
}

impl HasBaseline for Plane {
    type Baseline<R: Real> = BaselinePlane<R>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(BaselinePlane::new(self.anchor, self.normal()))
    }
}

/// The baseline: N·p = N·c.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselinePlane<R> {
    normal: Vector<R>,
    /// N·c.
    level: R,
}

impl<R: Real> BaselinePlane<R> {
    pub(crate) fn new(center: Vec3, unit_normal: Vec3) -> Self {
        let normal = Vector::of(unit_normal);
        Self {
            normal,
            level: normal.dot(Vector::of(center)),
        }
    }

    /// The unit normal.
    #[inline]
    pub(in crate::shape) fn unit(&self) -> Vector<R> {
        self.normal
    }

    /// The intersection of the line with the plane.
    #[inline]
    pub(in crate::shape) fn parameter(&self, ray: &BaselineRay<R>) -> R {
        (self.level - self.normal.dot(ray.origin)) / self.normal.dot(ray.direction)
    }
}

impl<R: Real> Baseline<R> for BaselinePlane<R> {
    #[inline]
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let t = self.parameter(ray);
        ray.counts(t).then_some((t, 0))
    }

    #[inline]
    fn normal(&self, _: &BaselineRay<R>, _: Vector<R>, _: u32) -> Vector<R> {
        self.normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::PathVertexKey;
    use rtc_math::ldexp;

    /// Limits within 64 u of the root: uncompensated arithmetic is often right about them, and
    /// often wrong.
    #[test]
    fn a_plane_said_to_lie_beyond_has_no_root_before() {
        let mut reported = 0;
        for index in 0..50_000 {
            let key = PathVertexKey::new([3, 5], index);
            let vector = |k: u64| {
                Vec3::new(key.uniform(k), key.uniform(k + 1), key.uniform(k + 2)) * 2.0 - 1.0
            };
            let (anchor, normal) = (vector(0), PlaneNormal::new(vector(3)));
            let ray = Ray {
                origin: vector(6),
                direction: vector(9),
            };
            let Some(t) = normal.intersect(anchor, &ray) else {
                continue;
            };
            let t_max = t * (1.0 + 64.0 * U * (key.uniform(12) * 2.0 - 1.0));
            if normal.is_beyond(anchor, &ray, t_max) {
                assert!(t >= t_max, "{index}: {t} {t_max}");
                reported += 1;
            }
        }
        assert!(reported > 2000, "{reported}");
    }

    #[test]
    fn a_point_on_a_plane_along_an_axis_has_the_bits_of_the_sum() {
        let normals = [Vec3::X, Vec3::NEG_Y * 3.0, Vec3::NEG_Z];
        for (index, normal) in (0..3000_u32).zip(normals.into_iter().cycle()) {
            let (normal, key) = (
                PlaneNormal::new(normal),
                PathVertexKey::new([3, 6], index.into()),
            );
            let number = |k: u64| [0.0, -0.0, 0.5, -3.0][(key.bits(k) % 4) as usize];
            let place = Vec3::new(number(0), number(1), number(2));
            let ray = Ray {
                origin: place,
                direction: Vec3::NEG_ONE,
            };
            for anchor in [place, Vec3::ONE] {
                let distance = distance::<false>(normal.raw, None, anchor, place);
                let sum = place + normal.raw * (distance / normal.square);
                let point = normal.interaction(anchor, &ray, 0.0).point;
                let bits = |v: Vec3| v.to_array().map(f64::to_bits);
                assert_eq!(bits(point), bits(sum), "{place} {anchor}");
            }
        }
    }

    #[test]
    fn a_plane_behind_the_ray_or_along_it_is_not_said_to_lie_beyond() {
        let normal = PlaneNormal::new(Vec3::Z);
        let is_beyond = |direction| {
            let ray = Ray {
                origin: Vec3::ZERO,
                direction,
            };
            normal.is_beyond(Vec3::Z * 2.0, &ray, 1.0)
        };
        assert!(is_beyond(Vec3::Z));
        assert!(!is_beyond(Vec3::NEG_Z) && !is_beyond(Vec3::Z * 3.0));
    }

    #[test]
    fn fused_products_change_no_bit_of_a_root() {
        for index in 0..2000 {
            let key = PathVertexKey::new([2, 7], index);
            // Corners of single precision, of sizes from 2^-30 to 2^30, some on the axes.
            let number = |k: u64| match key.bits(k) % 8 {
                0 => 0.0,
                _ => {
                    let size = (key.bits(k + 100) % 61) as i32 - 30;
                    f64::from(ldexp(2.0 * key.uniform(k + 200) - 1.0, size) as f32)
                }
            };
            let point = |k: u64| Vec3::new(number(k), number(k + 1), number(k + 2));
            let corners = [point(0), point(3), point(6)];
            let ray = Ray {
                origin: point(9) * 1.1,
                direction: (corners[0] + corners[1] + corners[2]) / 3.0 - point(9) * 1.1,
            };
            let bits = |t: Option<f64>| t.map(f64::to_bits);
            let whole =
                PlaneNormal::of(corners).and_then(|normal| normal.intersect(corners[0], &ray));
            assert_eq!(
                bits(root_of_corners::<true>(corners, &ray)),
                bits(whole),
                "{corners:?}"
            );
            assert_eq!(
                bits(root_of_corners::<false>(corners, &ray)),
                bits(whole),
                "{corners:?}"
            );
        }
    }
}
