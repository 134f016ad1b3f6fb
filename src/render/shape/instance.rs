//! An instance of a mesh. Rays are transformed to object space, where all instances share the
//! triangles and the BVH.

use crate::accel::wide::{Candidate, TriangleVisitor};
use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::corners::{blend, corner_values, handedness, interpolate};
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{AttributeRequest, Intersect, LocalRay, ShadingAttributes};
use crate::shape::mesh::{BaselineMesh, PreparedMesh};
use crate::shape::normal_field::{NormalDerivative, NormalField};
use crate::shape::tie::{self, ClosestHit, ClosestHitCandidates};
use crate::shape::triangle::{self, BaselineTriangle, Triangle, WatertightRay};
use rtc_math::{Bounds, Vec3, Vector, cross, unit};
use std::sync::Arc;

/// A prepared instance of a mesh.
#[derive(Clone, Debug)]
pub struct Instance {
    mesh: Arc<PreparedMesh>,
    /// The images of the axes.
    axes: [Vec3; 3],
    origin: Vec3,
    /// The sums of the coordinates of each, all counted positive.
    sizes: Vec3,
    /// The rows of the inverse of the axes.
    inverse: [Vec3; 3],
    /// Whether the transform is a reflection.
    mirrors: bool,
    bounds: Bounds,
    /// A bound on the error of a vertex in world space.
    error_bound: f64,
}

impl Instance {
    /// The mesh placed by a map whose columns are the images of the axes, which span space, and of
    /// the origin.
    #[must_use]
    pub fn new(mesh: &Arc<PreparedMesh>, [x, y, z, origin]: [Vec3; 4]) -> Self {
        let volume = cross(x, y).dot(z);
        let inverse = [
            cross(y, z) / volume,
            cross(z, x) / volume,
            cross(x, y) / volume,
        ];
        let (axes, mirrors) = ([x, y, z], volume < 0.0);
        let sizes = axes.map(|axis| axis.abs().element_sum()).into();
        let mut instance = Self {
            mesh: Arc::clone(mesh),
            axes,
            origin,
            sizes,
            inverse,
            mirrors,
            bounds: Bounds::EMPTY,
            error_bound: 0.0,
        };
        let (mut bounds, mut error_bound) = (Bounds::EMPTY, 0.0_f64);
        mesh.visit_places(|place| {
            // Grow the box by the rounding error of the transform.
            let rounding = instance.rounding(place);
            bounds = bounds.union(Bounds::around(instance.to_world(place), rounding));
            error_bound = error_bound.max(rounding);
        });
        (instance.bounds, instance.error_bound) = (bounds, error_bound);
        instance
    }

    /// A bound on the error of a point transformed between the two spaces.
    fn rounding(&self, local: Vec3) -> f64 {
        16.0 * rtc_math::U * (self.sizes.dot(local.abs()) + self.origin.abs().element_sum())
    }

    #[inline]
    fn to_world(&self, p: Vec3) -> Vec3 {
        self.vector_to_world(p) + self.origin
    }

    #[inline]
    fn vector_to_world(&self, v: Vec3) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    #[inline]
    fn normal_to_world(&self, n: Vec3) -> Vec3 {
        (self.inverse[0] * n.x + self.inverse[1] * n.y + self.inverse[2] * n.z).normalize_or_zero()
    }

    /// The derivative of the shading normal by the point, on a triangle.
    pub(super) fn normal_derivative(&self, prim_id: u32, point: Vec3) -> NormalDerivative {
        let corners = self.mesh.corners(prim_id);
        let Some(normals) = corner_values(&self.mesh.attributes.normals, corners) else {
            return NormalDerivative::ZERO;
        };
        let to_world =
            |n: Vec3| self.inverse[0] * n.x + self.inverse[1] * n.y + self.inverse[2] * n.z;
        let unit = |normal| to_world(unit(Vec3::from_array(normal)).unwrap_or(Vec3::ZERO));
        let [first, second, third] = normals.map(unit);
        let [along, across] = [second - first, third - first];
        // The barycentric weights of the second and of the third corner are linear in the point.
        let [a, b, c] = self
            .mesh
            .vertices(prim_id)
            .map(|corner| self.to_world(corner));
        let normal = (b - a).cross(c - a);
        let weights = |step: Vec3| {
            let square = normal.length_squared();
            let second = step.cross(c - a).dot(normal) / square;
            (second, (b - a).cross(step).dot(normal) / square)
        };
        let change = |step: Vec3| {
            let (second, third) = weights(step);
            along * second + across * third
        };
        NormalDerivative::of_direction(first + change(point - a), change)
    }

    /// The ray in object space; its `t` are those of the world.
    #[inline(always)]
    fn to_object(&self, ray: &Ray) -> Ray {
        let rows = |v: Vec3| {
            Vec3::new(
                self.inverse[0].dot(v),
                self.inverse[1].dot(v),
                self.inverse[2].dot(v),
            )
        };
        Ray {
            origin: rows(ray.origin - self.origin),
            direction: rows(ray.direction),
        }
    }

    /// The root above 0 of a triangle found in the BVH of the mesh.
    #[inline(always)]
    fn root(&self, local: &LocalRay, candidate: &Candidate<'_>) -> Option<f64> {
        match candidate.corners() {
            Some(corners) => {
                triangle::root(&corners, &local.ray, &local.watertight, candidate.is_fused)
            }
            None => self.mesh.root(local, candidate.item),
        }
    }

    /// Breaks the tie between the roots as close as the one at `t`.
    #[cold]
    fn resolve(&self, ray: &Ray, watertight: &WatertightRay, t: f64) -> Option<(f64, u32)> {
        let mut tie = ClosestHitCandidates::new();
        self.visit_roots(ray, watertight, t, &mut |t, prim_id| {
            tie.add(
                t,
                tie::error(ray, t, &self.interaction(ray, t, prim_id)),
                prim_id,
            )
        });
        tie.first()
    }

    /// The tangent along u, and the side of the bitangent.
    fn tangent(
        &self,
        triangle: &Triangle,
        corners: [u32; 3],
        uvs: Option<[[f64; 2]; 3]>,
        weights: [f64; 3],
    ) -> (Option<Vec3>, f64) {
        let (tangent, side) = match corner_values(&self.mesh.attributes.tangents, corners) {
            None => (
                uvs.and_then(|uvs| triangle.tangent(uvs)),
                uvs.map_or(1.0, handedness),
            ),
            Some(tangents) => {
                let [x, y, z, w] = blend(tangents, weights);
                (Some(Vec3::new(x, y, z)), 1.0_f64.copysign(w))
            }
        };
        let side = if self.mirrors { -side } else { side };
        (tangent.map(|tangent| self.vector_to_world(tangent)), side)
    }
}

impl Intersect for Instance {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, t_max: f64) -> Option<(f64, u32)> {
        let local = self.local(ray);
        let mut best = (t_max, u32::MAX);
        self.mesh
            .hierarchy()?
            .traverse(&local.ray, t_max, &mut |candidate: Candidate<'_>| {
                if let Some(t) = self.root(&local, &candidate)
                    && (t < best.0 || (t == best.0 && candidate.item < best.1))
                {
                    best = (t, candidate.item);
                }
                best.0
            });
        (best.1 != u32::MAX).then_some(best)
    }

    fn closest_hit(&self, ray: &Ray, watertight: &WatertightRay, t_max: f64) -> Option<(f64, u32)> {
        let local = self.local(ray);
        let mut nearest = ClosestHit::up_to(t_max, u32::MAX);
        self.mesh
            .hierarchy()?
            .traverse(&local.ray, t_max, &mut |candidate: Candidate<'_>| {
                if let Some(t) = self.root(&local, &candidate) {
                    nearest.add(t, candidate.item);
                }
                nearest.t
            });
        match nearest.key {
            u32::MAX => None,
            _ if nearest.is_tied() => self.resolve(ray, watertight, nearest.t),
            prim_id => Some((nearest.t, prim_id)),
        }
    }

    fn visit_roots(
        &self,
        ray: &Ray,
        _: &WatertightRay,
        t_max: f64,
        visit: &mut dyn FnMut(f64, u32),
    ) {
        let local = self.local(ray);
        let mut visit = |candidate: Candidate<'_>| {
            if let Some(t) = self.root(&local, &candidate) {
                visit(t, candidate.item);
            }
            t_max
        };
        if let Some(hierarchy) = self.mesh.hierarchy() {
            hierarchy.traverse(&local.ray, t_max, &mut visit);
        }
    }

    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        let local_ray = self.to_object(ray);
        let local = self.mesh.triangle(prim_id).interaction(&local_ray, t);
        let point = self.to_world(local.point);
        let magnitude = local_ray.origin.abs() + local.point.abs();
        let extent = 2.0 * self.sizes.dot(magnitude);
        Interaction::new(
            ray,
            point,
            self.normal_to_world(local.normal),
            self.origin,
            extent,
        )
    }

    fn has_shading_normals(&self) -> bool {
        !self.mesh.attributes.normals.is_empty()
    }

    fn shading_attributes(
        &self,
        _: &Ray,
        at: &Interaction,
        prim_id: u32,
        request: AttributeRequest,
    ) -> ShadingAttributes {
        // Equal normals and no coordinates need no barycentric weights.
        let triangle = self.mesh.triangle(prim_id);
        let mesh = &self.mesh.attributes;
        let corners = self.mesh.corners(prim_id);
        let normals = corner_values(&mesh.normals, corners);
        let is_even = normals.is_none_or(|[a, b, c]| a == b && a == c);
        let has_no_coordinates =
            mesh.uvs.is_empty() && mesh.second_uvs.is_empty() && mesh.tangents.is_empty();
        let is_plain =
            mesh.colors.is_empty() && (request == AttributeRequest::NONE || has_no_coordinates);
        let weights = match is_even && is_plain {
            true => [1.0, 0.0, 0.0],
            false => triangle.weights(
                self.to_object(&Ray {
                    origin: at.point,
                    direction: Vec3::ZERO,
                })
                .origin,
            ),
        };
        // Interpolate the normal and transform it to world space.
        let unit = |normal| unit(Vec3::from_array(normal)).unwrap_or(Vec3::ZERO);
        let normal = normals.map(|[a, b, c]| {
            let even = unit(a);
            let mean = || even * weights[0] + unit(b) * weights[1] + unit(c) * weights[2];
            self.normal_to_world(if is_even { even } else { mean() })
        });
        // Interpolate what was requested.
        let uvs = if request == AttributeRequest::NONE {
            None
        } else {
            corner_values(&mesh.uvs, corners)
        };
        let (tangent, side) = if request.tangent {
            self.tangent(&triangle, corners, uvs, weights)
        } else {
            (None, 1.0)
        };
        let second_uvs = if request.uv {
            corner_values(&mesh.second_uvs, corners)
        } else {
            None
        };
        ShadingAttributes {
            normal: normal.filter(|normal| *normal != Vec3::ZERO),
            uv: uvs.map(|uvs| interpolate(uvs, weights)),
            tangent,
            side,
            second_uv: second_uvs.map(|uvs| interpolate(uvs, weights)),
            color: corner_values(&mesh.colors, corners).map(|colors| blend(colors, weights)),
        }
    }

    fn uv_derivatives(
        &self,
        _: &Ray,
        _: &Interaction,
        prim_id: u32,
        set: usize,
    ) -> Option<[Vec3; 2]> {
        let mesh = &self.mesh.attributes;
        let sets = [&mesh.uvs, &mesh.second_uvs];
        let uvs = corner_values(sets.get(set)?, self.mesh.corners(prim_id))?;
        let derivatives = self.mesh.triangle(prim_id).uv_derivatives(uvs)?;
        Some(derivatives.map(|derivative| self.vector_to_world(derivative)))
    }

    fn triangles(&self) -> usize {
        self.mesh.count()
    }

    fn corners(&self, prim_id: u32) -> Option<[Vec3; 3]> {
        let corners = self.mesh.vertices(prim_id);
        Some(corners.map(|corner| self.to_world(corner)))
    }

    fn error_bound(&self) -> f64 {
        self.error_bound
    }

    #[inline(always)]
    fn local(&self, ray: &Ray) -> LocalRay {
        LocalRay::new(self.to_object(ray))
    }

    #[inline(always)]
    fn intersect_prim(&self, local: &LocalRay, prim_id: u32) -> Option<f64> {
        self.mesh.root(local, prim_id)
    }

    /// A shadow ray often ends on a triangle that is a light: a cheap test shows that its root is
    /// not below t_max.
    #[inline(always)]
    fn intersect_prim_before(&self, local: &LocalRay, prim_id: u32, t_max: f64) -> Option<f64> {
        if t_max < f64::INFINITY && self.mesh.is_beyond(local, prim_id, t_max) {
            return None;
        }
        self.mesh.root(local, prim_id).filter(|t| *t < t_max)
    }

    fn is_in_place(&self) -> bool {
        self.axes == Vec3::AXES && self.origin == Vec3::ZERO
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Mesh(self))
    }

    fn emitter(&self) -> Option<Emitter> {
        None
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(self.bounds)
    }
}

impl HasBaseline for Instance {
    type Baseline<R: Real> = Box<BaselineInstance<R>>;

    fn plain<R: Real>(&self, mesh: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineInstance {
            mesh: Arc::clone(mesh?),
            origin: Vector::of(self.origin),
            rows: self.inverse.map(Vector::of),
        }))
    }
}

/// Its triangles in baseline arithmetic, in the BVH of the robust ones.
#[derive(Clone, Debug)]
pub(crate) struct BaselineInstance<R> {
    mesh: Arc<BaselineMesh<R>>,
    origin: Vector<R>,
    /// The rows of the map from the world to the object, without its origin.
    rows: [Vector<R>; 3],
}

impl<R: Real> BaselineInstance<R> {
    /// The line in object space; its `t` are those of the world.
    fn to_object(&self, ray: &BaselineRay<R>) -> BaselineRay<R> {
        let rows = |v: Vector<R>| {
            let [x, y, z] = self.rows.map(|row| row.dot(v));
            Vector { x, y, z }
        };
        BaselineRay {
            origin: rows(ray.origin - self.origin),
            direction: rows(ray.direction),
            length2: ray.length2,
        }
    }
}

/// The nearest root of a ray, and its triangle; of equals the first.
struct BaselineNearest<'traverse, R> {
    triangles: &'traverse [BaselineTriangle<R>],
    ray: &'traverse BaselineRay<R>,
    best: (f64, u32),
}

impl<R: Real> TriangleVisitor for BaselineNearest<'_, R> {
    const CULLS: bool = false;

    fn visit(&mut self, candidate: Candidate<'_>) -> f64 {
        let item = candidate.item;
        let root = self.triangles[item as usize].intersect(self.ray);
        if let Some(t) = root.map(R::wide)
            && (t < self.best.0 || (t == self.best.0 && item < self.best.1))
        {
            self.best = (t, item);
        }
        self.best.0
    }
}

impl<R: Real> Baseline<R> for BaselineInstance<R> {
    fn intersect(&self, ray: &BaselineRay<R>, t_max: f64) -> Option<(R, u32)> {
        let ray = self.to_object(ray);
        let robust_ray = Ray {
            origin: ray.origin.wide(),
            direction: ray.direction.wide(),
        };
        let mut nearest = BaselineNearest {
            triangles: &self.mesh.triangles,
            ray: &ray,
            best: (t_max, u32::MAX),
        };
        self.mesh
            .robust
            .hierarchy()?
            .traverse(&robust_ray, t_max, &mut nearest);
        let best = nearest.best;
        (best.1 != u32::MAX).then_some((R::of(best.0), best.1))
    }

    fn normal(&self, _: &BaselineRay<R>, _: Vector<R>, prim_id: u32) -> Vector<R> {
        let n = self.mesh.triangles[prim_id as usize].normal();
        let [x, y, z] = self.rows;
        (x * n.x + y * n.y + z * n.z).normalized()
    }
}
