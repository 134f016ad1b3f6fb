//! The triangle: watertight by construction.
//!
//! Whether a ray hits is decided as in Woop, Benthin, Wald, "Watertight ray/triangle intersection"
//! (JCGT 2, 2013), with Kahan's products for the edge functions: two triangles compute the same
//! value with opposite sign for a shared edge, and zero counts as inside, so no ray slips between.
//! The plane of the triangle then gives t.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::corners::interpolate;
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::plane::{PlaneNormal, root_of_corners};
use rtc_math::{Bounds, U, Vec3, Vector, difference_of_products};
use std::sync::Arc;

/// The change of coordinates that turns a ray's direction into the z axis: a permutation and a
/// shear.
#[derive(Clone, Copy, Debug)]
pub struct WatertightRay {
    axes: [usize; 3],
    x: f64,
    y: f64,
}

impl WatertightRay {
    /// For shapes that do not use it.
    pub(crate) const UNUSED: Self = Self {
        axes: [0, 1, 2],
        x: 0.0,
        y: 0.0,
    };

    /// The shear of a ray.
    #[must_use]
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let axes = axes_before(d);
        let z = axes[2];
        Self {
            axes,
            x: d[axes[0]] / d[z],
            y: d[axes[1]] / d[z],
        }
    }

    #[inline]
    fn apply(&self, v: Vec3) -> (f64, f64) {
        let [x, y, z] = self.axes;
        (v[x] - self.x * v[z], v[y] - self.y * v[z])
    }
}

/// The axes in cyclic order, the one nearest to a vector last.
#[inline]
fn axes_before(v: Vec3) -> [usize; 3] {
    let size = v.abs();
    if size.x > size.y && size.x > size.z {
        [1, 2, 0]
    } else if size.y > size.z {
        [2, 0, 1]
    } else {
        [0, 1, 2]
    }
}

/// Whether `p₀·q₁ − p₁·q₀` is above 0 rather than below, where uncompensated arithmetic can decide.
#[inline]
fn sure_sign(p: (f64, f64), q: (f64, f64)) -> Option<bool> {
    let (first, second) = (p.0 * q.1, p.1 * q.0);
    let difference = first - second;
    // Three roundings, or products below the normal numbers.
    let error = 4.0 * U * (first.abs() + second.abs()) + f64::MIN_POSITIVE;
    (difference.abs() > error).then_some(difference > 0.0)
}

/// Whether a ray along the z axis hits a triangle; edges and corners belong to it.
#[cold]
fn meets(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> bool {
    let u = difference_of_products(c.0, b.1, c.1, b.0);
    let v = difference_of_products(a.0, c.1, a.1, c.0);
    let w = difference_of_products(b.0, a.1, b.1, a.0);
    let outside = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
    !outside && u + v + w != 0.0
}

/// Whether a ray's line hits a triangle; edges and corners belong to it.
#[inline(always)]
fn is_hit([a, b, c]: &[Vec3; 3], ray: &Ray, watertight: &WatertightRay) -> bool {
    // Shear the vertices into the ray's frame.
    let (a, b, c) = (
        watertight.apply(*a - ray.origin),
        watertight.apply(*b - ray.origin),
        watertight.apply(*c - ray.origin),
    );
    // Compare the signs of the edge functions; compute them exactly where one is uncertain.
    match (sure_sign(c, b), sure_sign(a, c), sure_sign(b, a)) {
        (Some(u), Some(v), Some(w)) if u == v && v == w => true,
        (Some(u), Some(v), _) | (Some(u), _, Some(v)) | (_, Some(u), Some(v)) if u != v => false,
        _ => meets(a, b, c),
    }
}

/// The root above 0 of the triangle of three corners, as [`Triangle::intersect`] has it.
/// `is_fused` only where [`rtc_math::fuses`] holds.
#[inline(always)]
pub(crate) fn root(
    vertices: &[Vec3; 3],
    ray: &Ray,
    watertight: &WatertightRay,
    is_fused: bool,
) -> Option<f64> {
    if !is_hit(vertices, ray, watertight) {
        None
    } else if is_fused {
        root_of_corners::<true>(*vertices, ray)
    } else {
        root_of_corners::<false>(*vertices, ray)
    }
}

/// A prepared triangle, of the size of two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Triangle {
    vertices: [Vec3; 3],
    normal: PlaneNormal,
}

const _: () = assert!(size_of::<Triangle>() == 128, "memory is what rays wait for");

impl Triangle {
    /// The triangle, or `None` if its vertices are collinear.
    #[must_use]
    pub fn new(vertices: [Vec3; 3]) -> Option<Self> {
        Some(Self {
            vertices,
            normal: PlaneNormal::of(vertices)?,
        })
    }

    /// The triangle of vertices that are known not to be collinear.
    #[must_use]
    #[inline]
    pub(crate) fn with_area(vertices: [Vec3; 3]) -> Self {
        let normal = PlaneNormal::of(vertices).unwrap_or_else(|| PlaneNormal::new(Vec3::Z));
        Self { vertices, normal }
    }

    /// The corners.
    #[must_use]
    pub fn vertices(&self) -> &[Vec3; 3] {
        &self.vertices
    }

    /// The root above 0; edges and corners belong to the triangle.
    #[must_use]
    #[inline]
    pub fn intersect(&self, ray: &Ray, watertight: &WatertightRay) -> Option<f64> {
        if is_hit(&self.vertices, ray, watertight) {
            self.normal.intersect(self.vertices[0], ray)
        } else {
            None
        }
    }

    /// Whether uncompensated arithmetic can prove that [`Self::intersect`] finds no root below
    /// `t_max`.
    #[must_use]
    #[inline]
    pub(crate) fn is_beyond(&self, ray: &Ray, t_max: f64) -> bool {
        self.normal.is_beyond(self.vertices[0], ray, t_max)
    }

    /// The barycentric coordinates of a point of the triangle; they sum to 1.
    ///
    /// Ratios of areas do not change under projection along an axis; the axis closest to the normal
    /// is the most accurate.
    #[must_use]
    pub fn weights(&self, point: Vec3) -> [f64; 3] {
        let [a, b, c] = self.vertices;
        let [x, y, _] = axes_before(self.normal.unit());
        let area = |p: Vec3, q: Vec3| difference_of_products(p[x], q[y], p[y], q[x]);
        let (to_b, to_c, to_point) = (b - a, c - a, point - a);
        let whole = area(to_b, to_c);
        let (second, third) = (area(to_point, to_c) / whole, area(to_b, to_point) / whole);
        [1.0 - second - third, second, third]
    }

    /// The direction of u at constant v, unless the texture coordinates are degenerate.
    #[must_use]
    pub fn tangent(&self, uvs: [[f64; 2]; 3]) -> Option<Vec3> {
        let [a, b, c] = self.vertices;
        let (first, second) = (b - a, c - a);
        let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
        let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
        // Invert the derivative of uv with respect to the edges.
        let area = du1 * dv2 - du2 * dv1;
        ((first * dv2 - second * dv1) / area).try_normalize()
    }

    /// The derivatives of a point with respect to u and v, unless the texture coordinates are
    /// degenerate (Pharr, Jakob, Humphreys, §6.5.2).
    #[must_use]
    pub fn uv_derivatives(&self, uvs: [[f64; 2]; 3]) -> Option<[Vec3; 2]> {
        let [a, b, c] = self.vertices;
        let (first, second) = (b - a, c - a);
        let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
        let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
        let area = du1 * dv2 - du2 * dv1;
        let derivatives = [first * dv2 - second * dv1, second * du1 - first * du2];
        let derivatives = derivatives.map(|derivative| derivative / area);
        derivatives
            .iter()
            .all(|derivative| derivative.is_finite())
            .then_some(derivatives)
    }

    /// The point at `t`, moved onto the plane of the triangle.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        self.normal.interaction(self.vertices[0], ray, t)
    }
}

/// A triangle with a texture on it.
#[derive(Clone, Copy, Debug)]
pub struct TexturedTriangle {
    /// The triangle.
    pub triangle: Triangle,
    /// The texture coordinates of its corners.
    pub uvs: Option<[[f64; 2]; 3]>,
}

impl Intersect for TexturedTriangle {
    #[inline]
    fn intersect(&self, ray: &Ray, watertight: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.triangle.intersect(ray, watertight).map(|t| (t, 0))
    }

    fn uses_watertight_ray(&self) -> bool {
        true
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.triangle.interaction(ray, t)
    }

    /// uv between those of the corners.
    fn shading_attributes(
        &self,
        _: &Ray,
        at: &Interaction,
        _: u32,
        _: AttributeRequest,
    ) -> ShadingAttributes {
        let Some(uvs) = self.uvs else {
            return ShadingAttributes::default();
        };
        ShadingAttributes {
            uv: Some(interpolate(uvs, self.triangle.weights(at.point))),
            tangent: self.triangle.tangent(uvs),
            ..ShadingAttributes::default()
        }
    }

    fn uv_derivatives(&self, _: &Ray, _: &Interaction, _: u32, set: usize) -> Option<[Vec3; 2]> {
        self.triangle.uv_derivatives(self.uvs.filter(|_| set == 0)?)
    }

    fn triangles(&self) -> usize {
        1
    }

    fn corners(&self, _: u32) -> Option<[Vec3; 3]> {
        Some(*self.triangle.vertices())
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Flat)
    }

    fn emitter(&self) -> Option<Emitter> {
        None
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::of(self.triangle.vertices().iter().copied()))
    }
}

impl HasBaseline for TexturedTriangle {
    type Baseline<R: Real> = BaselineTriangle<R>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(BaselineTriangle::new(self.triangle.vertices()))
    }
}

/// The baseline: Möller, Trumbore, "Fast, minimum storage ray/triangle intersection" (JGT 2, 1997).
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineTriangle<R> {
    corner: Vector<R>,
    edges: [Vector<R>; 2],
}

impl<R: Real> BaselineTriangle<R> {
    pub(in crate::shape) fn new(vertices: &[Vec3; 3]) -> Self {
        let [a, b, c] = vertices.map(Vector::of);
        Self {
            corner: a,
            edges: [b - a, c - a],
        }
    }

    #[inline]
    pub(in crate::shape) fn intersect(&self, ray: &BaselineRay<R>) -> Option<R> {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let [first, second] = self.edges;
        let across = ray.direction.cross(second);
        let determinant = first.dot(across);
        if determinant == zero {
            return None;
        }
        let inverse = one / determinant;
        let from_corner = ray.origin - self.corner;
        let u = from_corner.dot(across) * inverse;
        if u < zero || u > one {
            return None;
        }
        let upward = from_corner.cross(first);
        let v = ray.direction.dot(upward) * inverse;
        if v < zero || u + v > one {
            return None;
        }
        let t = second.dot(upward) * inverse;
        ray.counts(t).then_some(t)
    }

    pub(in crate::shape) fn normal(&self) -> Vector<R> {
        self.edges[0].cross(self.edges[1]).normalized()
    }
}

impl<R: Real> Baseline<R> for BaselineTriangle<R> {
    #[inline]
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        self.intersect(ray).map(|t| (t, 0))
    }

    fn normal(&self, _: &BaselineRay<R>, _: Vector<R>, _: u32) -> Vector<R> {
        self.normal()
    }
}
