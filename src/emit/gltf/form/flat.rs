//! The shapes with corners: triangles, quadrilaterals, and planes cut to a square.
//!
//! Their corners stay in the world, so that those which meet still do after rounding.

use super::ShapeForm;
use super::draft::{DraftVertex, MeshDraft, fraction};
use super::fineness::Fineness;
use crate::ir::{Ball, Column, Mesh, Plane, Quad, Triangle};
use crate::math::{Basis, Vec3, cross, is_flat, unit};

/// How far a plane goes on, in radii of the scene.
const PLANE: f64 = 4.0;

/// Half the side of the square that a plane is cut to.
pub(super) fn side(around: Ball) -> f64 {
    PLANE * around.radius
}

/// A square around the point of the plane that is nearest to the middle of the scene.
pub(super) fn plane(plane: &Plane, around: Ball) -> ShapeForm {
    let Plane { center, normal } = plane;
    let basis = Basis::around(unit(Vec3::from_array(*normal)).unwrap_or(Vec3::Z));
    let above = (around.center - Vec3::from_array(*center)).dot(basis.normal);
    let middle = around.center - basis.normal * above;
    let (x, y) = (basis.tangent * side(around), basis.bitangent * side(around));
    let corners = [
        middle - x - y,
        middle + x - y,
        middle + x + y,
        middle - x + y,
    ];
    flat(&corners, Vec::new(), vec![[0, 1, 2], [0, 2, 3]])
}

pub(super) fn triangle(triangle: &Triangle) -> ShapeForm {
    let Triangle { vertices, uvs } = triangle;
    let uvs = uvs.map_or_else(Vec::new, |uvs| uvs.to_vec());
    flat(&vertices.map(Vec3::from_array), uvs, vec![[0, 1, 2]])
}

/// Steps along each side of a quadrilateral; one if it is flat.
pub(super) fn steps(quad: &Quad, fineness: &Fineness) -> u32 {
    let corners = quad.vertices.map(Vec3::from_array);
    if is_flat(corners) {
        return 1;
    }
    let [a, b, c, d] = corners;
    let size = a.distance(c).max(b.distance(d)) / 2.0;
    let twist = (a - b + c - d).length() / size;
    Fineness::along_patch(twist, fineness.share(size))
}

/// A flat quadrilateral, or a bilinear patch in so many steps along each side.
pub(super) fn quad(quad: &Quad, steps: u32) -> ShapeForm {
    let corners @ [a, b, c, d] = quad.vertices.map(Vec3::from_array);
    if is_flat(corners) {
        let uvs = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        return flat(&corners, uvs, split(corners));
    }
    let mut draft = MeshDraft::default();
    draft.sheet([steps, steps], |column, row| {
        let (u, v) = (fraction(column, steps), fraction(row, steps));
        let (low, high) = (a.lerp(b, u), d.lerp(c, u));
        let across = (b - a).lerp(c - d, v);
        DraftVertex {
            position: low.lerp(high, v),
            normal: across.cross(high - low),
            uv: [u, v],
        }
    });
    ShapeForm::Own(Box::new(draft.mesh(true)))
}

/// The halves of a flat quadrilateral along the diagonal that lies in it.
fn split(corners: [Vec3; 4]) -> Vec<[u32; 3]> {
    let normal = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
        cross(b - a, c - a)
    };
    let splits = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let inside = |split: &[[u32; 3]; 2]| normal(split[0]).dot(normal(split[1])) >= 0.0;
    let split = splits.into_iter().find(inside).unwrap_or(splits[0]);
    split.to_vec()
}

/// A mesh without normals, which is flat.
fn flat(corners: &[Vec3], uvs: Vec<[f64; 2]>, triangles: Vec<[u32; 3]>) -> ShapeForm {
    ShapeForm::Own(Box::new(Mesh {
        positions: corners.iter().map(|corner| corner.to_array()).collect(),
        uvs: Column::from(uvs),
        triangles: triangles.into(),
        ..Mesh::default()
    }))
}
