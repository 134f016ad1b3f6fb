//! The proof of the meshes: their corners are finite, their triangles refer to existing corners and
//! have an area.

use super::check::{Check, LARGEST, place};
use super::shape::has_area;
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityKind, Field};
use rtc_math::{Column, Shared, Vec3, unit};

/// A mesh has at most so many triangles: a hierarchy over them takes 21 GB.
pub const MOST_TRIANGLES: usize = 1 << 29;

/// Triangles over one list of corners. Its columns are shared with the scene.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The positions of the corners.
    pub positions: Column<3>,
    /// The shading normal at each corner, finite and of any length, or zero where it has none;
    /// empty for flat shading.
    pub normals: Column<3>,
    /// The texture coordinates at each corner; empty if there are none.
    pub uvs: Column<2>,
    /// The second set of texture coordinates; empty if there is none.
    pub second_uvs: Column<2>,
    /// The direction of growing u at each corner, and ±1 for the side of growing v; empty if there
    /// are none.
    pub tangents: Column<4>,
    /// The colour at each corner, with alpha, each at least 0; empty if there are none.
    pub colors: Column<4>,
    /// The corners of each triangle, in range; every triangle has an area.
    pub triangles: Shared<[u32; 3]>,
}

impl Mesh {
    /// The positions of the corners of a triangle.
    #[must_use]
    #[inline]
    pub fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        corners(&self.positions, triangle)
    }

    /// The unit shading normal at corner `corner` of a mesh that has normals, or zero where it has
    /// none.
    #[must_use]
    #[inline]
    pub fn normal(&self, corner: u32) -> Vec3 {
        unit(Vec3::from_array(self.normals.at(corner as usize))).unwrap_or(Vec3::ZERO)
    }
}

pub(super) fn mesh(mesh: &ir::Mesh, index: usize, check: &mut Check<'_>) -> Option<Mesh> {
    let whole = place(EntityKind::Mesh, index, Field::Whole);
    if let Some(message) = fault(mesh) {
        check.report(whole, "", Diagnostic::new(&codes::BAD_MESH, message));
        return None;
    }
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
    let mut proven = Mesh {
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    };
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
        proven.triangles = mesh.triangles.iter().copied().filter(shows).collect();
    }
    Some(proven)
}

fn corners(positions: &Column<3>, [a, b, c]: [u32; 3]) -> [Vec3; 3] {
    let position = |corner: u32| Vec3::from_array(positions.at(corner as usize));
    // Written out: `map` of an array is not inlined here, and doubles the time for a large mesh.
    [position(a), position(b), position(c)]
}

/// The first fault of a mesh, in words.
fn fault(mesh: &ir::Mesh) -> Option<String> {
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
    fault_of_numbers(positions, normals)
        .or_else(|| fault_of_columns([uvs, second_uvs], tangents, colors))
        .or_else(|| fault_of_lengths(mesh))
        .or_else(|| fault_of_count(triangles.len()))
        .or_else(|| fault_of_triangles(triangles, positions.len()))
}

fn is_sound(value: &f64) -> bool {
    value.abs() <= LARGEST
}

fn fault_of_numbers(positions: &Column<3>, normals: &Column<3>) -> Option<String> {
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(is_sound)) {
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

fn fault_of_columns(
    uvs: [&Column<2>; 2],
    tangents: &Column<4>,
    colors: &Column<4>,
) -> Option<String> {
    let mut all_uvs = uvs[0].iter().chain(uvs[1].iter());
    if let Some(vertex) = all_uvs.position(|uv| !uv.iter().all(is_sound)) {
        return Some(format!("uv {vertex} of a mesh is not finite"));
    }
    if let Some(vertex) = tangents.iter().position(|t| !t.iter().all(is_sound)) {
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

fn fault_of_lengths(mesh: &ir::Mesh) -> Option<String> {
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
    let is_sound = matches(uvs) && matches(tangents) && matches(colors);
    (!is_sound).then(|| {
        format!(
            "a mesh has {count} positions, {uvs} second uvs, {tangents} tangents and {colors} colours"
        )
    })
}

fn fault_of_count(triangles: usize) -> Option<String> {
    let message =
        || format!("a mesh has {triangles} triangles; at most {MOST_TRIANGLES} can be rendered");
    (triangles > MOST_TRIANGLES).then(message)
}

fn fault_of_triangles(triangles: &[[u32; 3]], count: usize) -> Option<String> {
    let is_lost = |triangle: &[u32; 3]| triangle.iter().any(|k| *k as usize >= count);
    let lost = triangles.iter().position(is_lost)?;
    Some(format!(
        "triangle {lost} of a mesh refers to {:?}, but the mesh has {count} vertices",
        triangles[lost]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_of_more_than_a_hierarchy_holds_has_a_fault() {
        assert_eq!(fault_of_count(MOST_TRIANGLES), None);
        let fault = fault_of_count(MOST_TRIANGLES + 1);
        assert!(fault.is_some_and(|fault| fault.contains("536870913 triangles")));
    }
}
