//! The proof of the meshes: corners that are numbers, triangles that refer to corners and have an area.

use super::check::{Check, LARGEST, place};
use super::shape::has_area;
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use crate::math::Vec3;

/// Triangles over one list of corners.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Where the corners are.
    pub positions: Vec<Vec3>,
    /// The unit shading normal at each corner, or zero where it has none; empty for flat shading.
    pub normals: Vec<Vec3>,
    /// The texture coordinates at each corner; empty if there are none.
    pub uvs: Vec<[f64; 2]>,
    /// The second set of them; empty if there is none.
    pub second_uvs: Vec<[f64; 2]>,
    /// The direction of growing u at each corner, and ±1 for the side of growing v; empty if there are none.
    pub tangents: Vec<[f64; 4]>,
    /// The colour at each corner, with alpha, each at least 0; empty if there are none.
    pub colors: Vec<[f64; 4]>,
    /// The corners of each triangle, in range; every triangle has an area.
    pub triangles: Vec<[usize; 3]>,
}

pub(super) fn mesh(mesh: &ir::Mesh, index: usize, check: &mut Check<'_>) -> Option<Mesh> {
    let whole = place(Noun::Mesh, index, Field::Whole);
    if let Some(message) = fault(mesh) {
        check.report(whole, "", Diagnostic::new(&codes::BAD_MESH, message));
        return None;
    }
    let ir::Mesh { name: _, positions, normals, uvs, second_uvs, tangents, colors, triangles: all } = mesh;
    let positions = positions.iter().copied().map(Vec3::from_array).collect::<Vec<_>>();
    let normals = normals.iter().map(|n| Vec3::from_array(*n).normalize_or_zero()).collect();
    let triangles = all.iter().map(|t| t.map(|k| k as usize));
    let triangles = triangles.filter(|t| has_area(t.map(|k| positions[k]))).collect::<Vec<_>>();
    let flat = all.len() - triangles.len();
    if flat > 0 {
        let message = format!("{flat} of {} triangles of a mesh have no area, so nothing shows of them", all.len());
        check.report(whole, "", Diagnostic::new(&codes::DEGENERATE_TRIANGLE, message));
    }
    let (uvs, second_uvs) = (uvs.clone(), second_uvs.clone());
    Some(Mesh { positions, normals, uvs, second_uvs, tangents: tangents.clone(), colors: colors.clone(), triangles })
}

/// The first fault of a mesh, in words.
fn fault(mesh: &ir::Mesh) -> Option<String> {
    let ir::Mesh { name: _, positions, normals, uvs, second_uvs, tangents, colors, triangles } = mesh;
    let sound = |value: &f64| value.abs() <= LARGEST;
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(sound)) {
        return Some(format!("vertex {vertex} of a mesh is no point of finite numbers: {:?}", positions[vertex]));
    }
    if let Some(vertex) = normals.iter().position(|n| !n.iter().all(|value| value.is_finite())) {
        return Some(format!("normal {vertex} of a mesh is not finite: {:?}", normals[vertex]));
    }
    if let Some(vertex) = uvs.iter().chain(second_uvs).position(|uv| !uv.iter().all(sound)) {
        return Some(format!("uv {vertex} of a mesh is not finite"));
    }
    if let Some(vertex) = tangents.iter().position(|tangent| !tangent.iter().all(sound)) {
        return Some(format!("tangent {vertex} of a mesh is not finite: {:?}", tangents[vertex]));
    }
    if let Some(vertex) = colors.iter().position(|color| !color.iter().all(|c| (0.0..=LARGEST).contains(c))) {
        return Some(format!("colour {vertex} of a mesh is negative or not finite: {:?}", colors[vertex]));
    }
    let count = positions.len();
    let matches = |length: usize| length == 0 || length == count;
    if !matches(normals.len()) || !matches(uvs.len()) {
        return Some(format!("a mesh has {count} positions, {} normals and {} uvs", normals.len(), uvs.len()));
    }
    if !matches(second_uvs.len()) || !matches(tangents.len()) || !matches(colors.len()) {
        let (uvs, tangents, colors) = (second_uvs.len(), tangents.len(), colors.len());
        return Some(format!(
            "a mesh has {count} positions, {uvs} second uvs, {tangents} tangents and {colors} colours"
        ));
    }
    let lost = triangles.iter().position(|t| t.iter().any(|k| *k as usize >= count));
    lost.map(|t| format!("triangle {t} of a mesh refers to {:?}, and there are {count} vertices", triangles[t]))
}
