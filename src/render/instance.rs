//! A mesh, placed: rays are taken to its own space, where all its instances share triangles and hierarchy.

use super::bounds::Bounds;
use super::bvh::Bvh;
use super::ray::{Interaction, Ray};
use super::triangle::{Shear, Triangle};
use crate::math::{Vec3, cross};
use crate::valid::{Column, Mesh};
use std::sync::Arc;

/// A mesh ready to be hit, in object coordinates.
#[derive(Debug)]
pub struct PreparedMesh {
    /// The mesh as proven.
    pub mesh: Arc<Mesh>,
    triangles: Vec<Triangle>,
    /// The index in the mesh of each triangle.
    indices: Vec<u32>,
    bvh: Bvh,
}

impl PreparedMesh {
    /// Prepares a mesh.
    #[must_use]
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        let corners = |t: &[u32; 3]| Triangle::new(mesh.corners(*t));
        let prepared = (0_u32..).zip(mesh.triangles.iter()).filter_map(|(index, t)| Some((corners(t)?, index)));
        let (triangles, indices): (Vec<_>, Vec<_>) = prepared.unzip();
        let boxes = triangles.iter().map(|triangle| Bounds::of(triangle.vertices())).collect::<Vec<_>>();
        Self { mesh: Arc::clone(mesh), bvh: Bvh::build(&boxes), triangles, indices }
    }

    /// The triangles that have an area.
    pub(super) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The hierarchy of the triangles.
    pub(super) fn bvh(&self) -> &Bvh {
        &self.bvh
    }
}

/// A mesh in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    mesh: Arc<PreparedMesh>,
    /// The images of the axes.
    axes: [Vec3; 3],
    origin: Vec3,
    /// The rows of the inverse of the axes.
    inverse: [Vec3; 3],
    /// Whether the map turns left hands into right ones.
    mirrors: bool,
    bounds: Bounds,
}

impl Instance {
    /// The mesh placed by a map whose columns are the images of the axes, which span space, and of the origin.
    #[must_use]
    pub fn new(mesh: &Arc<PreparedMesh>, [x, y, z, origin]: [Vec3; 4]) -> Self {
        let volume = cross(x, y).dot(z);
        let inverse = [cross(y, z) / volume, cross(z, x) / volume, cross(x, y) / volume];
        let (axes, mirrors) = ([x, y, z], volume < 0.0);
        let mut instance = Self { mesh: Arc::clone(mesh), axes, origin, inverse, mirrors, bounds: Bounds::EMPTY };
        let corners = mesh.triangles.iter().flat_map(|triangle| triangle.vertices());
        for corner in corners {
            let point = instance.to_world(*corner);
            // The map rounds; the box must hold what the ray in object space may hit.
            instance.bounds = instance.bounds.union(Bounds::around(point, instance.rounding(*corner)));
        }
        instance
    }

    /// The rows of the inverse of the axes.
    pub(super) fn inverse(&self) -> [Vec3; 3] {
        self.inverse
    }

    /// How far rounding may move a point between the two spaces.
    fn rounding(&self, local: Vec3) -> f64 {
        let [x, y, z] = self.axes.map(|axis| axis.abs().element_sum());
        16.0 * crate::math::U * (Vec3::new(x, y, z).dot(local.abs()) + self.origin.abs().element_sum())
    }

    fn to_world(&self, p: Vec3) -> Vec3 {
        self.vector_to_world(p) + self.origin
    }

    fn vector_to_world(&self, v: Vec3) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    fn normal_to_world(&self, n: Vec3) -> Vec3 {
        (self.inverse[0] * n.x + self.inverse[1] * n.y + self.inverse[2] * n.z).normalize_or_zero()
    }

    /// The ray in object space; its `t` are those of the world.
    fn to_object(&self, ray: &Ray) -> Ray {
        let rows = |v: Vec3| Vec3::new(self.inverse[0].dot(v), self.inverse[1].dot(v), self.inverse[2].dot(v));
        Ray { origin: rows(ray.origin - self.origin), direction: rows(ray.direction) }
    }

    /// The smallest root above 0 that is not beyond `t_max`, and its triangle.
    #[must_use]
    pub fn intersect(&self, ray: &Ray, t_max: f64) -> Option<(f64, u32)> {
        let ray = self.to_object(ray);
        let shear = Shear::new(&ray);
        let mut best = (t_max, u32::MAX);
        self.mesh.bvh.walk(&ray, t_max, |item, _| {
            if let Some(t) = self.mesh.triangles[item as usize].intersect(&ray, &shear)
                && (t < best.0 || (t == best.0 && item < best.1))
            {
                best = (t, item);
            }
            best.0
        });
        (best.1 != u32::MAX).then_some(best)
    }

    /// The point at `t` on triangle `part`.
    #[must_use]
    pub fn interaction(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        let local_ray = self.to_object(ray);
        let local = self.mesh.triangles[part as usize].interaction(&local_ray, t);
        let point = self.to_world(local.point);
        let [x, y, z] = self.axes.map(|axis| axis.abs().element_sum());
        let reach = local_ray.origin.abs() + local.point.abs();
        let extent = 2.0 * Vec3::new(x, y, z).dot(reach);
        Interaction::new(ray, point, self.normal_to_world(local.normal), self.origin, extent)
    }

    /// Whether the mesh has texture coordinates.
    pub(super) fn has_uv(&self) -> bool {
        !self.mesh.mesh.uvs.is_empty()
    }

    /// How many triangles it has.
    pub(super) fn parts(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// The corners of triangle `part` in the world.
    pub(super) fn corners(&self, part: u32) -> [Vec3; 3] {
        self.mesh.triangles[part as usize].vertices().map(|corner| self.to_world(corner))
    }

    /// Whether the mesh has normals of its own.
    pub(super) fn has_shading_normals(&self) -> bool {
        !self.mesh.mesh.normals.is_empty()
    }

    /// What the mesh says about a point of triangle `part`: shading normal, uv and the direction of growing u.
    pub(super) fn details(&self, point: Vec3, part: u32) -> Details {
        let triangle = &self.mesh.triangles[part as usize];
        let local = self.to_object(&Ray { origin: point, direction: Vec3::ZERO }).origin;
        let weights = triangle.weights(local);
        let mesh = &self.mesh.mesh;
        let corners = mesh.triangles[self.mesh.indices[part as usize] as usize];
        let normal = (!mesh.normals.is_empty()).then(|| {
            let [a, b, c] = [mesh.normal(corners[0]), mesh.normal(corners[1]), mesh.normal(corners[2])];
            let is_even = a == b && a == c;
            self.normal_to_world(if is_even { a } else { a * weights[0] + b * weights[1] + c * weights[2] })
        });
        let uvs = (!mesh.uvs.is_empty()).then(|| at(&mesh.uvs, corners));
        let uv = uvs.map(|uvs| interpolate(uvs, weights));
        let (tangent, side) = if mesh.tangents.is_empty() {
            (uvs.and_then(|uvs| triangle.tangent(uvs)), uvs.map_or(1.0, handedness))
        } else {
            let [x, y, z, w] = blend(at(&mesh.tangents, corners), weights);
            (Some(Vec3::new(x, y, z)), 1.0_f64.copysign(w))
        };
        Details {
            normal: normal.filter(|normal| *normal != Vec3::ZERO),
            uv,
            tangent: tangent.map(|tangent| self.vector_to_world(tangent)),
            side: if self.mirrors { -side } else { side },
            second_uv: (!mesh.second_uvs.is_empty()).then(|| interpolate(at(&mesh.second_uvs, corners), weights)),
            color: (!mesh.colors.is_empty()).then(|| blend(at(&mesh.colors, corners), weights)),
        }
    }

    /// A box around it.
    pub(super) fn bounds(&self) -> Bounds {
        self.bounds
    }
}

/// What a surface knows of a point beyond its geometry.
#[derive(Clone, Copy, Debug)]
pub struct Details {
    /// The unit shading normal, where it is not the geometric one.
    pub normal: Option<Vec3>,
    /// The texture coordinates.
    pub uv: Option<[f64; 2]>,
    /// A direction along the surface in which u grows and v stays.
    pub tangent: Option<Vec3>,
    /// ±1: the second axis of normal maps is `side·(normal × tangent)`.
    pub side: f64,
    /// The second set of texture coordinates.
    pub second_uv: Option<[f64; 2]>,
    /// The colour of the corners, with alpha.
    pub color: Option<[f64; 4]>,
}

impl Default for Details {
    fn default() -> Self {
        Self { normal: None, uv: None, tangent: None, side: 1.0, second_uv: None, color: None }
    }
}

/// The side on which the second axis of a normal map lies: against v, which glTF counts downwards.
fn handedness([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    -1.0_f64.copysign(area)
}

/// What a column says of three corners.
fn at<const N: usize>(column: &Column<N>, [a, b, c]: [u32; 3]) -> [[f64; N]; 3] {
    [column.at(a as usize), column.at(b as usize), column.at(c as usize)]
}

/// The mean with these weights of the corners.
fn blend(values: [[f64; 4]; 3], weights: [f64; 3]) -> [f64; 4] {
    [0, 1, 2, 3].map(|axis| (0..3).map(|k| weights[k] * values[k][axis]).sum())
}

/// The uv at a point with these weights of the corners.
pub(super) fn interpolate(uvs: [[f64; 2]; 3], weights: [f64; 3]) -> [f64; 2] {
    [0, 1].map(|axis| (0..3).map(|k| weights[k] * uvs[k][axis]).sum())
}
