//! The sphere: one test for nearly all rays, alone or in lanes, and double-double for those it
//! can't decide.
//!
//! The test is that of Haines, Günther, Akenine-Möller, "Precision improvements for ray/sphere
//! intersection" (Ray Tracing Gems, 2019, ch. 7): the discriminant from the foot of the
//! perpendicular, the roots from the stable quadratic. Where its first-order error bound says that
//! the sign or the root reported is in doubt, it is computed again.

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Interactions, Ray, Rays};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::four::Shape4;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Double, DoubleDouble, Number, U, Vec3, Vector, acos, atan2};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

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
    /// The smallest root above 0, accurate to 64 u for all tested rays (`docs/proofs` states the
    /// proven part); a tangent ray hits.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let t = self.roots(&Rays::one(ray), true);
        (t < f64::INFINITY).then_some(t)
    }

    /// As [`Self::intersect`], where `active`; infinite for a miss.
    #[inline(always)]
    pub(super) fn roots<N: Double>(&self, rays: &Rays<N>, active: N::Mask) -> N {
        let d = rays.direction;
        let number = |x: f64| d.x.constant(x);
        let (zero, none) = (number(0.0), number(f64::INFINITY));
        let f = rays.origin - Vector::constant(d.x, self.center);
        let (f2, b, a) = (f.dot(f), -f.dot(d), d.dot(d));
        let r2 = number(self.radius * self.radius);

        // Leave spheres that lie beside the line or behind the origin: from outside, both roots
        // have the sign of b, and there is none where a·(f² − r²) > b². Rounding may move the two
        // sides by 27 u·a·f². Rays that lead off the sphere itself start outside by more than the
        // 7 u by which rounding may move f² against r².
        let outside = f2 * number(1.0 - 64.0 * U) - r2;
        let is_beside = zero.less(outside) & (b * b).less(a * outside);
        let is_behind = b.less(zero) & r2.less(f2 * number(1.0 - 8.0 * U));
        let near = active & !(is_beside | is_behind);
        if N::is_nowhere(near) {
            return none;
        }

        let line = SphereLine::new([f, d], [a, b], r2);
        let SphereLine {
            nearest,
            foot,
            discriminant,
            ..
        } = line;
        let foot2 = foot.dot(foot);
        let extent = f.abs().sum();
        let sizes = r2 + foot2 + number(self.radius) * extent;
        let error_bound = number(16.0 * U) * (sizes + number(16.0 * U) * extent * extent);
        let hits = near & !discriminant.less(-error_bound);
        let is_tangent = hits & discriminant.less_or_equal(error_bound);

        // Take the first positive root; from afar, as a step back from the foot.
        let c = f2 - r2;
        let (root, q, takes_first, near_root) = line.root(c);
        let from_afar = (number(FAR) * r2).less(f2);
        let by_step = nearest - (foot.dot(d) + root) / a;
        let t = N::select(from_afar, by_step, near_root);
        let is_root = hits & zero.less(t);

        // Recompute the root in double-double if the error of c or of the discriminant is
        // amplified.
        let is_cancelled = (from_afar | takes_first) & (number(AMPLIFIED) * c.abs()).less(f2 + r2);
        let is_amplified = (number(AMPLIFIED * AMPLIFIED) * (a * discriminant) * q * q)
            .less(r2 * (r2 + f2) * a * a);
        let mut found = N::select(is_root, t, none);
        let doubted = is_tangent | (is_root & (is_cancelled | is_amplified));
        if !N::is_nowhere(doubted) {
            for lane in N::lanes(doubted) {
                let precise = self.intersect_precisely(&rays.lane(lane));
                found.put(lane, precise.unwrap_or(f64::INFINITY));
            }
        }
        found
    }

    /// As [`Self::intersect`] in double-double, with an error of at most 1 u.
    #[cold]
    #[inline(never)]
    fn intersect_precisely(&self, ray: &Ray) -> Option<f64> {
        let f = [0, 1, 2].map(|k| DoubleDouble::difference(ray.origin[k], self.center[k]));
        let (f, d) = (
            Vector::from(f),
            Vector::constant(DoubleDouble::ZERO, ray.direction),
        );
        let r2 = DoubleDouble::from(self.radius).square();
        let line = SphereLine::new([f, d], [d.dot(d), -f.dot(d)], r2);
        if line.discriminant.to_f64().is_nan() || line.discriminant.to_f64() < 0.0 {
            return None;
        }
        let (.., t) = line.root(f.dot(f) - r2);
        (t.to_f64() > 0.0).then_some(t.to_f64())
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

    /// The point at `t`; see [`Self::interactions`].
    #[inline(always)]
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        self.interactions(&Rays::one(ray), t).lane(0)
    }

    /// The points at `t`, where that is finite: along the ray or projected onto the sphere in its
    /// own frame, whichever rounds less.
    #[inline(always)]
    pub(super) fn interactions<N: Double>(&self, rays: &Rays<N>, t: N) -> Interactions<N> {
        let center = Vector::constant(t, self.center);
        let step = rays.direction * t;
        let local = rays.origin - center + step;
        let length = local.length();
        let mut normal = local / length;
        let is_hit = t.less(t.constant(f64::INFINITY));
        let has_none = is_hit & !t.constant(0.0).less(length);
        if !N::is_nowhere(has_none) {
            for lane in N::lanes(has_none) {
                normal.put(lane, rays.lane(lane).outward(local.lane(lane)));
            }
        }
        let along_ray = (rays.origin.abs() + step.abs()).sum();
        let along_radius = t.constant(self.center.abs().element_sum() + self.radius);
        let on_sphere = center + normal * t.constant(self.radius);
        let on_ray = rays.origin + step;
        let point = on_ray.select(along_ray.less(along_radius), on_sphere);
        Interactions::new(rays, point, normal, self.center, self.radius)
    }
}

/// The line of a ray near a sphere: the quadratic `a·t² − 2·b·t + c`.
#[derive(Clone, Copy)]
struct SphereLine<N> {
    a: N,
    b: N,
    /// The t of the foot of the perpendicular from the centre, and the foot from there.
    nearest: N,
    foot: Vector<N>,
    /// r² minus the squared distance of the centre from the line.
    discriminant: N,
}

impl<N: Number> SphereLine<N> {
    /// The line from `f`, as seen from the centre, along `d`, with `a = d·d` and `b = −f·d`.
    #[inline(always)]
    fn new([f, d]: [Vector<N>; 2], [a, b]: [N; 2], r2: N) -> Self {
        let nearest = b / a;
        let foot = f + d * nearest;
        Self {
            a,
            b,
            nearest,
            foot,
            discriminant: r2 - foot.dot(foot),
        }
    }

    /// The first positive root without cancellation, `t = c / q` or `q / a` with `q = b ± √(a·D)`:
    /// the root of a·D, q, where t is the quotient of c, and t.
    #[inline(always)]
    fn root(&self, c: N) -> (N, N, N::Mask, N) {
        let zero = c.constant(0.0);
        let root = (self.a * self.discriminant).sqrt();
        let is_ahead = zero.less_or_equal(self.b);
        let q = N::select(is_ahead, self.b + root, self.b - root);
        let (first, second) = (c / q, q / self.a);
        let takes_first = is_ahead & zero.less(first) | !(is_ahead | zero.less(second));
        (root, q, takes_first, N::select(takes_first, first, second))
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

    /// u is the angle around z over 2π, v is 1 less that from z over π.
    fn uv_derivatives(&self, _: &Ray, at: &Interaction, _: u32, set: usize) -> Option<[Vec3; 2]> {
        let [x, y, z] = self.texture_from_world;
        let [a, b, c] = [x, y, z].map(|axis| axis.dot(at.normal));
        let across = (a * a + b * b).sqrt();
        let radius = self.sphere.radius;
        let along_u = (y * a - x * b) * (TAU * radius);
        let along_v = (z * across - (x * a + y * b) * (c / across)) * (PI * radius);
        (set == 0 && across > 0.0).then_some([along_u, along_v])
    }

    #[inline(always)]
    fn shape4(&self) -> Option<Shape4<'_>> {
        Some(Shape4::Sphere(&self.sphere))
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Sphere(self.sphere.radius))
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
