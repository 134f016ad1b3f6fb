//! The quadrilateral: two triangles if it is flat, else the bilinear patch between its corners.
//!
//! The patch is that of Reshetov, "Cool patches: a geometric approach to ray/bilinear patch
//! intersections" (Ray Tracing Gems, 2019, ch. 8): the ray hits a line of constant u where a
//! quadratic in u vanishes.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::{Emitter, EmitterPoint};
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::{BaselineTriangle, Triangle, WatertightRay};
use rtc_math::{Bounds, Vec3, Vector, cross, is_flat};
use std::sync::Arc;

/// A prepared quadrilateral.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "nearly all are flat")]
pub enum Quad {
    /// A flat one.
    Flat {
        /// The corners.
        vertices: [Vec3; 4],
        /// Two triangles that share a diagonal, each with the numbers of its corners; `None`
        /// without an area.
        halves: [Option<(Triangle, [usize; 3])>; 2],
    },
    /// A patch.
    Patch(BilinearPatch),
}

impl Quad {
    /// The quadrilateral of corners in order around it.
    #[must_use]
    pub fn new(vertices: [Vec3; 4]) -> Self {
        if !is_flat(vertices) {
            return Self::Patch(BilinearPatch { vertices });
        }
        let normal = |t: [usize; 3]| {
            cross(
                vertices[t[1]] - vertices[t[0]],
                vertices[t[2]] - vertices[t[0]],
            )
        };
        // Split along the inner diagonal, so that both halves have the same winding.
        let splits = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
        let inside = |split: &[[usize; 3]; 2]| normal(split[0]).dot(normal(split[1])) >= 0.0;
        let split = splits.into_iter().find(inside).unwrap_or(splits[0]);
        let half = |t: [usize; 3]| Some((Triangle::new(t.map(|k| vertices[k]))?, t));
        Self::Flat {
            vertices,
            halves: split.map(half),
        }
    }

    /// The smallest root above 0 and which half it is in.
    #[must_use]
    pub fn intersect(&self, ray: &Ray, watertight: &WatertightRay) -> Option<(f64, u32)> {
        match self {
            Self::Flat { halves, .. } => {
                let hit = |half: &Option<(Triangle, [usize; 3])>| {
                    half.as_ref()?.0.intersect(ray, watertight)
                };
                // Both halves lie in one plane, so two hits tie.
                hit(&halves[0])
                    .map(|t| (t, 0))
                    .or_else(|| hit(&halves[1]).map(|t| (t, 1)))
            }
            Self::Patch(patch) => patch.intersection(ray).map(|(t, _)| (t, 0)),
        }
    }

    /// The point at `t` in half `prim_id`, moved onto the surface.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        match self {
            Self::Flat { halves, .. } => match (&halves[prim_id as usize & 1], &halves[0]) {
                (Some((triangle, _)), _) | (None, Some((triangle, _))) => {
                    triangle.interaction(ray, t)
                }
                (None, None) => Interaction::new(
                    ray,
                    ray.origin + ray.direction * t,
                    Vec3::Z,
                    Vec3::ZERO,
                    0.0,
                ),
            },
            Self::Patch(patch) => patch.interaction(ray, t),
        }
    }

    /// The texture coordinates at a point hit in half `prim_id`.
    pub(crate) fn uv(&self, ray: &Ray, point: Vec3, prim_id: u32) -> [f64; 2] {
        const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        match self {
            Self::Flat { halves, .. } => {
                halves[prim_id as usize & 1].map_or([0.0; 2], |(triangle, corners)| {
                    let weights = triangle.weights(point);
                    [0, 1].map(|axis| (0..3).map(|k| weights[k] * CORNERS[corners[k]][axis]).sum())
                })
            }
            Self::Patch(patch) => patch.intersection(ray).map_or([0.0; 2], |(_, uv)| uv),
        }
    }

    /// A direction along the surface in which u grows, at this v.
    pub(crate) fn tangent(&self, v: f64) -> Option<Vec3> {
        match self {
            Self::Flat { vertices, .. } | Self::Patch(BilinearPatch { vertices }) => {
                across(*vertices, v).try_normalize()
            }
        }
    }

    /// A box around it.
    pub(crate) fn bounds(&self) -> Bounds {
        match self {
            Self::Flat { halves, .. } => {
                halves
                    .iter()
                    .flatten()
                    .fold(Bounds::EMPTY, |bounds, (triangle, _)| {
                        bounds.union(Bounds::of(triangle.vertices().iter().copied()))
                    })
            }
            Self::Patch(patch) => Bounds::of(patch.vertices.iter().copied()),
        }
    }
}

/// The derivative along u of the interpolated corners, at this v.
fn across([q00, q10, q11, q01]: [Vec3; 4], v: f64) -> Vec3 {
    (q10 - q00).lerp(q11 - q01, v)
}

/// A bilinear patch: `Q(u, v)` with corners Q(0,0), Q(1,0), Q(1,1), Q(0,1).
#[derive(Clone, Copy, Debug)]
pub struct BilinearPatch {
    vertices: [Vec3; 4],
}

impl BilinearPatch {
    /// The first crossing in front, with its u and v.
    fn intersection(&self, ray: &Ray) -> Option<(f64, [f64; 2])> {
        let ahead = self.crossings(ray).into_iter().flatten();
        ahead
            .filter(|(t, _)| *t > 0.0)
            .min_by(|first, second| first.0.total_cmp(&second.0))
    }

    /// The u and v of a point of the patch, where the normal is given.
    fn uv_at(&self, point: Vec3, normal: Vec3) -> [f64; 2] {
        let line = Ray {
            origin: point,
            direction: normal,
        };
        let crossings = self.crossings(&line).into_iter().flatten();
        let nearest = crossings.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        nearest.map_or([0.5; 2], |(_, uv)| self.nearest(point, uv))
    }

    /// The point at u and v, as a light's.
    pub(crate) fn sample(&self, uv: [f64; 2]) -> EmitterPoint {
        let [across, upward] = self.tangents(uv);
        EmitterPoint {
            point: self.at(uv),
            normal: cross(across, upward).normalize_or(Vec3::Z),
            prim_id: 0,
        }
    }

    /// The area of the patch over that of u and v at a point with a normal.
    pub(crate) fn stretch_at(&self, point: Vec3, normal: Vec3) -> f64 {
        self.stretch(self.uv_at(point, normal))
    }

    fn stretch(&self, uv: [f64; 2]) -> f64 {
        let [across, upward] = self.tangents(uv);
        cross(across, upward).length()
    }

    /// The area, by the midpoint rule.
    pub(crate) fn area(&self) -> f64 {
        const CELLS: u32 = 8;
        let middle = |cell: u32| (f64::from(cell) + 0.5) / f64::from(CELLS);
        let cells = (0..CELLS * CELLS).map(|k| [middle(k % CELLS), middle(k / CELLS)]);
        cells.map(|uv| self.stretch(uv)).sum::<f64>() / f64::from(CELLS * CELLS)
    }

    /// The crossings of the whole line within the patch, each with its u and v.
    fn crossings(&self, ray: &Ray) -> [Option<(f64, [f64; 2])>; 2] {
        let [q00, q10, q11, q01] = self.vertices.map(|vertex| vertex - ray.origin);
        let d = ray.direction;
        let (left, right) = (q01 - q00, q11 - q10);
        // Solve a + b·u + c·u² = 0 for the lines of constant u on the ray.
        let a = cross(q00, d).dot(left);
        let c = cross(q10 - q00, q01 - q11).dot(d);
        let b = cross(q10, d).dot(right) - a - c;
        let discriminant = b * b - 4.0 * a * c;
        if discriminant < 0.0 || discriminant.is_nan() {
            return [None; 2];
        }
        let q = -0.5 * (b + discriminant.sqrt().copysign(b));
        let candidates = [if c == 0.0 { f64::NAN } else { q / c }, a / q];
        let along = |u: f64| {
            if !(0.0..=1.0).contains(&u) {
                return None;
            }
            // Intersect the ray with the line at u.
            let (from, line) = (q00.lerp(q10, u), left.lerp(right, u));
            let normal = cross(d, line);
            let v = cross(normal, from).dot(d) / normal.dot(normal);
            // Intersect the tangent plane there: the error of t is then that of a rounded point,
            // even if the ray is parallel to the line.
            let tangent_plane = cross(across(self.vertices, v), line);
            let t = tangent_plane.dot(from + line * v) / tangent_plane.dot(d);
            (0.0..=1.0).contains(&v).then_some((t, [u, v]))
        };
        candidates.map(along)
    }

    fn at(&self, [u, v]: [f64; 2]) -> Vec3 {
        let [q00, q10, q11, q01] = self.vertices;
        q00.lerp(q10, u).lerp(q01.lerp(q11, u), v)
    }

    /// The derivatives along u and v.
    fn tangents(&self, [u, v]: [f64; 2]) -> [Vec3; 2] {
        let [q00, q10, q11, q01] = self.vertices;
        [across(self.vertices, v), (q01 - q00).lerp(q11 - q10, u)]
    }

    /// Refines `uv` for a point close to the patch by one Newton step. For grazing rays, t is
    /// accurate, but the error of u and v is the square root of a rounding error.
    fn nearest(&self, point: Vec3, uv: [f64; 2]) -> [f64; 2] {
        let rest = point - self.at(uv);
        let [across, upward] = self.tangents(uv);
        let normal = cross(across, upward);
        let step = [cross(rest, upward), cross(across, rest)]
            .map(|area| area.dot(normal) / normal.dot(normal));
        let moved = [uv[0] + step[0], uv[1] + step[1]];
        if moved.iter().all(|w| (0.0..=1.0).contains(w)) {
            moved
        } else {
            uv
        }
    }

    fn interaction(&self, ray: &Ray, t: f64) -> Interaction {
        let q00 = self.vertices[0];
        let uv = self.intersection(ray).map_or([0.5; 2], |(_, uv)| uv);
        let [u, v] = self.nearest(ray.origin + ray.direction * t, uv);
        let point = self.at([u, v]);
        let [across, upward] = self.tangents([u, v]);
        let normal = cross(across, upward).normalize_or(-ray.direction.normalize());
        let extent = self
            .vertices
            .iter()
            .map(|vertex| vertex.abs().element_sum())
            .sum::<f64>();
        let magnitude = (ray.origin.abs() + (ray.direction * t).abs()).element_sum();
        Interaction::new(ray, point, normal, q00, extent + magnitude)
    }
}

impl Intersect for Quad {
    fn intersect(&self, ray: &Ray, watertight: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersect(ray, watertight)
    }

    fn uses_watertight_ray(&self) -> bool {
        true
    }

    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        self.interaction(ray, t, prim_id)
    }

    fn shading_attributes(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        _: AttributeRequest,
    ) -> ShadingAttributes {
        let [u, v] = match self {
            Self::Flat { .. } => self.uv(ray, at.point, prim_id),
            Self::Patch(patch) => match patch.intersection(ray) {
                Some((_, uv)) => uv,
                // The ray starts on the patch: a sampled point of a light.
                None => patch.uv_at(at.point, at.normal),
            },
        };
        ShadingAttributes {
            uv: Some([u, v]),
            tangent: self.tangent(v),
            ..ShadingAttributes::default()
        }
    }

    fn uv_derivatives(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        set: usize,
    ) -> Option<[Vec3; 2]> {
        let uv = self.uv(ray, at.point, prim_id);
        let (Self::Flat { vertices, .. } | Self::Patch(BilinearPatch { vertices })) = self;
        let patch = BilinearPatch {
            vertices: *vertices,
        };
        (set == 0).then(|| patch.tangents(uv))
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        matches!(self, Self::Flat { .. }).then_some(NormalField::Flat)
    }

    fn emitter(&self) -> Option<Emitter> {
        let (vertices, halves) = match self {
            Self::Flat { vertices, halves } => (vertices, halves),
            Self::Patch(patch) => {
                return Some(Emitter::Patch(*patch)).filter(|emitter| emitter.area() > 0.0);
            }
        };
        let corners = |half: &Option<(Triangle, [usize; 3])>| {
            half.as_ref()
                .map_or([vertices[0]; 3], |(_, half)| half.map(|k| vertices[k]))
        };
        let triangles = halves.each_ref().map(corners);
        Some(Emitter::Triangles(triangles)).filter(|emitter| emitter.area() > 0.0)
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds())
    }
}

impl HasBaseline for Quad {
    type Baseline<R: Real> = Box<BaselineQuad<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(match self {
            Self::Flat { halves, .. } => {
                BaselineQuad::Flat(halves.map(|half| {
                    half.map(|(triangle, _)| BaselineTriangle::new(triangle.vertices()))
                }))
            }
            Self::Patch(BilinearPatch { vertices }) => {
                BaselineQuad::Patch(vertices.map(Vector::of))
            }
        }))
    }
}

/// The baseline: two triangles in uncompensated arithmetic, or the same patch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BaselineQuad<R> {
    Flat([Option<BaselineTriangle<R>>; 2]),
    Patch([Vector<R>; 4]),
}

impl<R: Real> Baseline<R> for BaselineQuad<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        match self {
            Self::Flat(halves) => {
                let hits = (0..)
                    .zip(halves)
                    .filter_map(|(prim_id, half)| Some((half.as_ref()?.intersect(ray)?, prim_id)));
                ray.first(hits)
            }
            Self::Patch(vertices) => plain_crossing(*vertices, ray).map(|(t, _)| (t, 0)),
        }
    }

    fn normal(&self, ray: &BaselineRay<R>, _: Vector<R>, prim_id: u32) -> Vector<R> {
        match self {
            Self::Flat(halves) => {
                let half = halves[prim_id as usize & 1].or(halves[0]);
                half.map_or(-ray.direction, |triangle| triangle.normal())
            }
            Self::Patch(vertices) => {
                let [q00, q10, q11, q01] = *vertices;
                let [u, v] = plain_crossing(*vertices, ray).map_or([R::of(0.5); 2], |(_, uv)| uv);
                plain_lerp(q10 - q00, q11 - q01, v)
                    .cross(plain_lerp(q01 - q00, q11 - q10, u))
                    .normalized()
            }
        }
    }
}

fn plain_lerp<R: Real>(from: Vector<R>, to: Vector<R>, prim_id: R) -> Vector<R> {
    from + (to - from) * prim_id
}

/// The first crossing of a patch that counts, with its u and v.
fn plain_crossing<R: Real>(vertices: [Vector<R>; 4], ray: &BaselineRay<R>) -> Option<(R, [R; 2])> {
    let [q00, q10, q11, q01] = vertices.map(|vertex| vertex - ray.origin);
    let d = ray.direction;
    let (left, right) = (q01 - q00, q11 - q10);
    let unit = |x: R| x >= R::of(0.0) && x <= R::of(1.0);
    // Solve a + b·u + c·u² = 0 for the lines of constant u that the ray hits.
    let a = q00.cross(d).dot(left);
    let c = (q10 - q00).cross(q01 - q11).dot(d);
    let b = q10.cross(d).dot(right) - a - c;
    let along = |u: R| {
        // Meet the ray with the line at u.
        let (from, rung) = (plain_lerp(q00, q10, u), plain_lerp(left, right, u));
        let normal = d.cross(rung);
        let (size, across) = (normal.dot(normal), normal.cross(from));
        let (t, v) = (across.dot(rung) / size, across.dot(d) / size);
        (unit(u) && unit(v) && ray.counts(t)).then_some((t, [u, v]))
    };
    let [first, second] = quadratic(c, b, a)?.map(along);
    match (first, second) {
        (Some(first), Some(second)) => Some(if second.0 < first.0 { second } else { first }),
        (first, second) => first.or(second),
    }
}
