//! The shapes with corners: triangles, quadrilaterals, and planes cut to a square.
//!
//! Their corners stay in the world, so that those which meet still do after rounding.

use super::ShapeForm;
use super::draft::{DraftVertex, MeshDraft, fraction};
use super::fineness::Fineness;
use crate::flat::{split, square};
use rtc_ir::{BoundingSphere, Column, Mesh, Plane, Quad, Triangle};
use rtc_math::{Vec3, is_flat};

pub(super) fn plane(plane: &Plane, around: BoundingSphere) -> ShapeForm {
    let corners = square(plane, around);
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

/// A mesh without normals, which is flat.
fn flat(corners: &[Vec3], uvs: Vec<[f64; 2]>, triangles: Vec<[u32; 3]>) -> ShapeForm {
    ShapeForm::Own(Box::new(Mesh {
        positions: corners.iter().map(|corner| corner.to_array()).collect(),
        uvs: Column::from(uvs),
        triangles: triangles.into(),
        ..Mesh::default()
    }))
}
