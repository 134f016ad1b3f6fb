//! Tangents where an asset has none: those of MikkTSpace, as glTF prescribes.
//!
//! Corners of one vertex may get different tangents, so vertices are split where they do.

use super::mesh::to_u32;
use crate::solid::pick;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use rtc_ir::{Column, Mesh};
use rtc_math::Vec3;

/// A mesh whose tangents are asked for, one a corner.
struct Corners<'m> {
    mesh: &'m Mesh,
    tangents: Vec<[f64; 4]>,
}

/// Functions that give the same bits on every machine.
struct Libm;

impl Ops for Libm {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        libm::acosf(x)
    }
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "MikkTSpace computes in 32-bit floats"
)]
impl Geometry<Libm> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh
            .positions
            .at(self.vertex(face, vert))
            .map(|number| number as f32)
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh
            .normals
            .at(self.vertex(face, vert))
            .map(|number| number as f32)
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        self.mesh
            .uvs
            .at(self.vertex(face, vert))
            .map(|number| number as f32)
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, vert: usize) {
        if let Some(tangent) = tangent {
            let [x, y, z] = tangent.tangent().map(f64::from);
            // MikkTSpace has green along growing v; in glTF v grows downwards, and green is up.
            let sign = if tangent.is_orientation_preserving() {
                -1.0
            } else {
                1.0
            };
            self.tangents[3 * face + vert] = [x, y, z, sign];
        }
    }
}

/// Gives a mesh tangents, and normals if it has none. Without texture coordinates there are none to
/// give.
pub(super) fn generate(mesh: &mut Mesh) {
    if mesh.uvs.is_empty() || mesh.triangles.is_empty() {
        return;
    }
    if mesh.normals.is_empty() {
        flatten(mesh);
    }
    let mut corners = Corners {
        mesh,
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3 * mesh.triangles.len()],
    };
    if generate_tangents(&mut corners).is_err() {
        return;
    }
    let tangents = corners.tangents;
    split(mesh, &tangents);
}

/// Gives each corner a vertex of its own, with the normal of its triangle.
fn flatten(mesh: &mut Mesh) {
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    pick(mesh, &corners);
    let first = (0..to_u32(corners.len())).step_by(3);
    mesh.triangles = first
        .map(|corner| [corner, corner + 1, corner + 2])
        .collect();
    let positions = mesh
        .positions
        .iter()
        .map(Vec3::from_array)
        .collect::<Vec<_>>();
    let normals = positions.as_chunks::<3>().0.iter().flat_map(|[a, b, c]| {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        [normal.to_array(); 3]
    });
    mesh.normals = Column::rounded(normals);
}

/// Puts the tangents of corners to the vertices; a vertex with several is split.
fn split(mesh: &mut Mesh, tangents: &[[f64; 4]]) {
    let count = mesh.positions.len();
    let mut own: Vec<Option<[f64; 4]>> = vec![None; count];
    // The copies of each vertex: the next one, from the vertex itself on.
    let mut next: Vec<Option<u32>> = vec![None; count];
    let mut origin: Vec<u32> = (0..to_u32(count)).collect();
    for (triangle, tangents) in mesh.triangles.iter_mut().zip(tangents.as_chunks::<3>().0) {
        for (corner, tangent) in triangle.iter_mut().zip(tangents) {
            let mut at = *corner as usize;
            loop {
                match (own[at], next[at]) {
                    (None, _) => own[at] = Some(*tangent),
                    (Some(known), _) if known == *tangent => break,
                    (Some(_), Some(copy)) => at = copy as usize,
                    (Some(_), None) => {
                        next[at] = Some(to_u32(own.len()));
                        origin.push(*corner);
                        own.push(None);
                        next.push(None);
                        at = own.len() - 1;
                    }
                }
            }
            *corner = to_u32(at);
        }
    }
    pick(mesh, &origin);
    mesh.tangents = Column::rounded(
        own.into_iter()
            .map(|tangent| tangent.unwrap_or([1.0, 0.0, 0.0, 1.0])),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_follow_u_and_vertices_split_where_it_is_mirrored() {
        let corner = |x: f32, y: f32| [x, y, 0.0];
        let mut mesh = Mesh {
            positions: vec![
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(0.0, 1.0),
                corner(-1.0, 0.0),
            ]
            .into(),
            uvs: vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0_f32, 1.0]].into(),
            normals: vec![[0.0_f32, 0.0, 1.0]; 4].into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
            ..Mesh::default()
        };
        generate(&mut mesh);
        assert_eq!(
            (mesh.positions.len(), mesh.tangents.len()),
            (6, 6),
            "two corners are shared and differ"
        );
        let tangent = |triangle: usize| mesh.tangents.at(mesh.triangles[triangle][0] as usize);
        assert_eq!([tangent(0)[0], tangent(1)[0]], [1.0, -1.0]);
        // Green is up in the picture, against v: w·(n × t) points there.
        assert_eq!([tangent(0)[3], tangent(1)[3]], [1.0, -1.0]);
    }
}
