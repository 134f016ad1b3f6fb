//! A mesh, placed: its triangles in plain arithmetic, its hierarchy that of the robust one.

use super::line::Line;
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
    pub(in crate::render) twin: Arc<PreparedMesh>,
    triangles: Vec<Triangle<R>>,
}

impl<R: Real> Mesh<R> {
    pub(in crate::render) fn new(twin: PreparedMesh) -> Self {
        let triangles = twin
            .triangles()
            .iter()
            .map(|triangle| Triangle::new(triangle.vertices()))
            .collect();
        Self {
            twin: Arc::new(twin),
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
        twin: &instance::Instance,
        origin: Vec3,
    ) -> Self {
        Self {
            mesh: Arc::clone(mesh),
            origin: Vector::of(origin),
            rows: twin.inverse().map(Vector::of),
        }
    }

    /// The line in object space; its `t` are those of the world.
    fn to_object(&self, line: &Line<R>) -> Line<R> {
        let rows = |v: Vector<R>| {
            let [x, y, z] = self.rows.map(|row| row.dot(v));
            Vector { x, y, z }
        };
        Line {
            origin: rows(line.origin - self.origin),
            direction: rows(line.direction),
            length2: line.length2,
        }
    }

    pub(super) fn intersect(&self, line: &Line<R>, t_max: f64) -> Option<(f64, u32)> {
        let line = self.to_object(line);
        let ray = Ray {
            origin: line.origin.wide(),
            direction: line.direction.wide(),
        };
        let mut best = (t_max, u32::MAX);
        self.mesh
            .twin
            .hierarchy()?
            .walk::<false>(&ray, t_max, |item| {
                if let Some(t) = self.mesh.triangles[item as usize]
                    .intersect(&line)
                    .map(R::wide)
                    && (t < best.0 || (t == best.0 && item < best.1))
                {
                    best = (t, item);
                }
                best.0
            });
        (best.1 != u32::MAX).then_some(best)
    }

    pub(super) fn normal(&self, part: u32) -> Vector<R> {
        let n = self.mesh.triangles[part as usize].normal();
        let [x, y, z] = self.rows;
        (x * n.x + y * n.y + z * n.z).normalized()
    }
}
