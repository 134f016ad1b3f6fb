//! Validates the meshes: vertices are finite, triangles refer to existing vertices and have an
//! area.

use super::check::{Checker, LARGEST};
use super::shape::has_area;
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{Id, SharedList, Vec3, VertexColumn, unit};

/// The id of a mesh of a [`ValidScene`](crate::ValidScene).
pub type MeshId = Id<Mesh>;

/// The maximum number of triangles of a mesh: its BVH takes 21 GB.
pub const MAX_MESH_TRIANGLES: usize = 1 << 29;

/// Triangles over one list of vertices. Its columns are shared with the scene.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The position of each vertex.
    pub positions: VertexColumn<3>,
    /// The shading normal at each vertex, finite and of any length, or zero where there is none;
    /// empty for flat shading.
    pub normals: VertexColumn<3>,
    /// The texture coordinates at each vertex; empty if there are none.
    pub uvs: VertexColumn<2>,
    /// The second set of texture coordinates; empty if there is none.
    pub second_uvs: VertexColumn<2>,
    /// The tangent at each vertex, and ±1 for the side of the bitangent; empty if there are none.
    pub tangents: VertexColumn<4>,
    /// The colour at each vertex, with alpha, each at least 0; empty if there are none.
    pub colors: VertexColumn<4>,
    /// The vertex indices of each triangle, in range; every triangle has an area.
    pub triangles: SharedList<[u32; 3]>,
}

impl Mesh {
    /// The vertex positions of a triangle.
    #[must_use]
    #[inline]
    pub fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        corners(&self.positions, triangle)
    }

    /// The unit shading normal at vertex `corner` of a mesh that has normals, or zero where there
    /// is none.
    #[must_use]
    #[inline]
    pub fn normal(&self, corner: u32) -> Vec3 {
        unit(Vec3::from_array(self.normals.at(corner as usize))).unwrap_or(Vec3::ZERO)
    }
}

pub(super) fn mesh(mesh: &ir::Mesh, index: usize, check: &mut Checker<'_>) -> Option<Mesh> {
    let whole = ValuePath::new(EntityKind::Mesh, index, EntityField::Whole);
    // Reject an invalid mesh.
    if let Some(message) = find_error(mesh) {
        check.report(whole, "", Diagnostic::new(&codes::BAD_MESH, message));
        return None;
    }
    // Copy the columns, which share their memory.
    let ir::Mesh {
        name: _,
        part: _,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    } = mesh.clone();
    let mut valid = Mesh {
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    };
    // Drop triangles without an area.
    let shows = |triangle: &[u32; 3]| has_area(corners(&mesh.positions, *triangle));
    let all = mesh.triangles.len();
    let flat = all
        - mesh
            .triangles
            .iter()
            .filter(|triangle| shows(triangle))
            .count();
    if flat > 0 {
        let message =
            format!("{flat} of {all} triangles of a mesh have no area, so they are invisible");
        check.report(
            whole,
            "",
            Diagnostic::new(&codes::DEGENERATE_TRIANGLE, message),
        );
        valid.triangles = mesh.triangles.iter().copied().filter(shows).collect();
    }
    Some(valid)
}

fn corners(positions: &VertexColumn<3>, [a, b, c]: [u32; 3]) -> [Vec3; 3] {
    let position = |corner: u32| Vec3::from_array(positions.at(corner as usize));
    // Written out: `map` of an array is not inlined here and doubles the time for a large mesh.
    [position(a), position(b), position(c)]
}

/// A message for the first error of a mesh.
fn find_error(mesh: &ir::Mesh) -> Option<String> {
    let ir::Mesh {
        name: _,
        part: _,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    } = mesh;
    error_in_numbers(positions, normals)
        .or_else(|| error_in_columns([uvs, second_uvs], tangents, colors))
        .or_else(|| error_in_lengths(mesh))
        .or_else(|| error_in_count(triangles.len()))
        .or_else(|| error_in_triangles(triangles, positions.len()))
}

fn is_valid(value: &f64) -> bool {
    value.abs() <= LARGEST
}

fn error_in_numbers(positions: &VertexColumn<3>, normals: &VertexColumn<3>) -> Option<String> {
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(is_valid)) {
        return Some(format!(
            "vertex {vertex} of a mesh is not finite: {:?}",
            positions.at(vertex)
        ));
    }
    let is_finite = |normal: [f64; 3]| normal.iter().all(|value| value.is_finite());
    let vertex = normals.iter().position(|normal| !is_finite(normal))?;
    Some(format!(
        "normal {vertex} of a mesh is not finite: {:?}",
        normals.at(vertex)
    ))
}

fn error_in_columns(
    uvs: [&VertexColumn<2>; 2],
    tangents: &VertexColumn<4>,
    colors: &VertexColumn<4>,
) -> Option<String> {
    let mut all_uvs = uvs[0].iter().chain(uvs[1].iter());
    if let Some(vertex) = all_uvs.position(|uv| !uv.iter().all(is_valid)) {
        return Some(format!("uv {vertex} of a mesh is not finite"));
    }
    if let Some(vertex) = tangents.iter().position(|t| !t.iter().all(is_valid)) {
        return Some(format!(
            "tangent {vertex} of a mesh is not finite: {:?}",
            tangents.at(vertex)
        ));
    }
    let is_color = |color: [f64; 4]| color.iter().all(|c| (0.0..=LARGEST).contains(c));
    let vertex = colors.iter().position(|color| !is_color(color))?;
    Some(format!(
        "colour {vertex} of a mesh is negative or not finite: {:?}",
        colors.at(vertex)
    ))
}

fn error_in_lengths(mesh: &ir::Mesh) -> Option<String> {
    let count = mesh.positions.len();
    let matches = |length: usize| length == 0 || length == count;
    let (normals, uvs) = (mesh.normals.len(), mesh.uvs.len());
    if !matches(normals) || !matches(uvs) {
        return Some(format!(
            "a mesh has {count} positions, {normals} normals and {uvs} uvs"
        ));
    }
    let (uvs, tangents) = (mesh.second_uvs.len(), mesh.tangents.len());
    let colors = mesh.colors.len();
    let is_valid = matches(uvs) && matches(tangents) && matches(colors);
    (!is_valid).then(|| {
        format!(
            "a mesh has {count} positions, {uvs} second uvs, {tangents} tangents and {colors} \
            colours"
        )
    })
}

fn error_in_count(triangles: usize) -> Option<String> {
    let message = || {
        format!("a mesh has {triangles} triangles; at most {MAX_MESH_TRIANGLES} can be rendered")
    };
    (triangles > MAX_MESH_TRIANGLES).then(message)
}

fn error_in_triangles(triangles: &[[u32; 3]], count: usize) -> Option<String> {
    let is_out_of_range = |triangle: &[u32; 3]| triangle.iter().any(|k| *k as usize >= count);
    let out_of_range = triangles.iter().position(is_out_of_range)?;
    Some(format!(
        "triangle {out_of_range} of a mesh refers to {:?}, but the mesh has {count} vertices",
        triangles[out_of_range]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_of_more_triangles_than_a_bvh_holds_has_an_error() {
        assert_eq!(error_in_count(MAX_MESH_TRIANGLES), None);
        let error = error_in_count(MAX_MESH_TRIANGLES + 1);
        assert!(error.is_some_and(|error| error.contains("536870913 triangles")));
    }
}
