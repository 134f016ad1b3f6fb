//! Tessellates shapes with corners: triangles, quadrilaterals, and planes as squares.
//!
//! Their vertices are in world coordinates, so that shared corners stay shared after rounding.

use super::ShapeMesh;
use super::builder::{GridVertex, MeshBuilder, fraction};
use super::tolerance::TessellationTolerance;
use crate::flat::{split, square};
use rtc_ir::{BoundingSphere, Mesh, Plane, Quad, Triangle, VertexColumn};
use rtc_math::{Vec3, is_flat};

pub(super) fn plane(plane: &Plane, around: BoundingSphere) -> ShapeMesh {
    let corners = square(plane, around);
    flat(&corners, Vec::new(), vec![[0, 1, 2], [0, 2, 3]])
}

pub(super) fn triangle(triangle: &Triangle) -> ShapeMesh {
    let Triangle { vertices, uvs } = triangle;
    let uvs = uvs.map_or_else(Vec::new, |uvs| uvs.to_vec());
    flat(&vertices.map(Vec3::from_array), uvs, vec![[0, 1, 2]])
}

/// Steps along each side of a quadrilateral; 1 if it is flat.
pub(super) fn steps(quad: &Quad, tessellation: &TessellationTolerance) -> u32 {
    let corners = quad.vertices.map(Vec3::from_array);
    if is_flat(corners) {
        return 1;
    }
    let [a, b, c, d] = corners;
    let size = a.distance(c).max(b.distance(d)) / 2.0;
    let twist = (a - b + c - d).length() / size;
    TessellationTolerance::along_patch(twist, tessellation.fraction(size))
}

/// A flat quadrilateral, or a bilinear patch with this number of steps along each side.
pub(super) fn quad(quad: &Quad, steps: u32) -> ShapeMesh {
    let corners @ [a, b, c, d] = quad.vertices.map(Vec3::from_array);
    if is_flat(corners) {
        let uvs = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        return flat(&corners, uvs, split(corners));
    }
    let mut builder = MeshBuilder::default();
    builder.grid([steps, steps], |column, row| {
        let (u, v) = (fraction(column, steps), fraction(row, steps));
        let (low, high) = (a.lerp(b, u), d.lerp(c, u));
        let across = (b - a).lerp(c - d, v);
        GridVertex {
            position: low.lerp(high, v),
            normal: across.cross(high - low),
            uv: [u, v],
        }
    });
    ShapeMesh::World(Box::new(builder.mesh(true)))
}

/// A mesh without normals, which is shaded flat.
fn flat(corners: &[Vec3], uvs: Vec<[f64; 2]>, triangles: Vec<[u32; 3]>) -> ShapeMesh {
    ShapeMesh::World(Box::new(Mesh {
        positions: corners.iter().map(|corner| corner.to_array()).collect(),
        uvs: VertexColumn::from(uvs),
        triangles: triangles.into(),
        ..Mesh::default()
    }))
}
