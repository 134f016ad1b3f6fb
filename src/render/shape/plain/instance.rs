//! A mesh, placed: its triangles in plain arithmetic, its hierarchy that of the robust one.

use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::triangle::Triangle;
use crate::math::Vec3;
use crate::render::ray::Ray;
use crate::render::shape::instance;
use crate::render::shape::mesh::PreparedMesh;
use std::sync::Arc;

/// A mesh ready to be hit by plain formulas, in object coordinates.
#[derive(Debug)]
pub struct Mesh<R> {
    /// The robust mesh: the same triangles in the same order, their hierarchy, and what is known
    /// of them.
    pub(in crate::render) robust: Arc<PreparedMesh>,
    triangles: Vec<Triangle<R>>,
}

impl<R: Real> Mesh<R> {
    pub(in crate::render) fn new(robust: PreparedMesh) -> Self {
        let triangles = robust
            .triangles()
            .iter()
            .map(|triangle| Triangle::new(triangle.vertices()))
            .collect();
        Self {
            robust: Arc::new(robust),
            triangles,
        }
    }
}

#[derive(Clone, Debug)]
pub(in crate::render) struct Instance<R> {
    mesh: Arc<Mesh<R>>,
    origin: Vector<R>,
    /// The rows of the map from the world to the object, without its origin.
    rows: [Vector<R>; 3],
}

impl<R: Real> Instance<R> {
    pub(in crate::render) fn new(
        mesh: &Arc<Mesh<R>>,
        robust: &instance::Instance,
        origin: Vec3,
    ) -> Self {
        Self {
            mesh: Arc::clone(mesh),
            origin: Vector::of(origin),
            rows: robust.inverse().map(Vector::of),
        }
    }

    /// The line in object space; its `t` are those of the world.
    fn to_object(&self, ray: &PlainRay<R>) -> PlainRay<R> {
        let rows = |v: Vector<R>| {
            let [x, y, z] = self.rows.map(|row| row.dot(v));
            Vector { x, y, z }
        };
        PlainRay {
            origin: rows(ray.origin - self.origin),
            direction: rows(ray.direction),
            length2: ray.length2,
        }
    }

    pub(super) fn intersect(&self, ray: &PlainRay<R>, t_max: f64) -> Option<(f64, u32)> {
        let ray = self.to_object(ray);
        let robust_ray = Ray {
            origin: ray.origin.wide(),
            direction: ray.direction.wide(),
        };
        let mut best = (t_max, u32::MAX);
        self.mesh
            .robust
            .hierarchy()?
            .walk::<false>(&robust_ray, t_max, |item| {
                if let Some(t) = self.mesh.triangles[item as usize]
                    .intersect(&ray)
                    .map(R::wide)
                    && (t < best.0 || (t == best.0 && item < best.1))
                {
                    best = (t, item);
                }
                best.0
            });
        (best.1 != u32::MAX).then_some(best)
    }

    pub(super) fn normal(&self, prim_id: u32) -> Vector<R> {
        let n = self.mesh.triangles[prim_id as usize].normal();
        let [x, y, z] = self.rows;
        (x * n.x + y * n.y + z * n.z).normalized()
    }
}
