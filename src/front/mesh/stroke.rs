//! The points and lines of mesh files, drawn as those of glTF are.

use super::{MeshOptions, columns};
use crate::glyph::{StrokeShape, point_radius, radius, spacing, thin_glyphs};
use glam::DAffine3;
use rtc_ir::{BoundingSphere, Mesh, VertexColumn};
use rtc_math::{Vec3, to_u32};
use rtc_source::{Budget, LimitExceeded, Resource};

/// The bytes of the offset of a corner and its position, beside its columns, and of a triangle
/// until it is rendered.
const OFFSET: u64 = 48;
const TRIANGLE: u64 = 108;

/// Points and lines between vertices; a point is a line from a vertex to itself.
#[derive(Debug, Default)]
pub(super) struct Segments {
    /// The ends of each.
    pub(super) ends: Vec<[u32; 2]>,
}

impl Segments {
    /// All vertices of a mesh as points.
    pub(super) fn points(mesh: &Mesh) -> Self {
        let all = 0..to_u32(mesh.positions.len());
        Self {
            ends: all.map(|vertex| [vertex; 2]).collect(),
        }
    }

    /// The lines along a row of vertices, of one alone a point.
    pub(super) fn row(&mut self, vertices: &[u32]) {
        if let [one] = vertices {
            self.ends.push([*one; 2]);
        }
        let pairs = vertices.windows(2);
        self.ends.extend(pairs.map(|pair| [pair[0], pair[1]]));
    }
}

/// Makes meshes of points and lines between the vertices of a mesh.
pub(super) struct StrokeMesher<'run> {
    source: &'run Mesh,
    options: MeshOptions,
    budget: &'run Budget,
}

impl<'run> StrokeMesher<'run> {
    /// A mesher for a file with these vertices.
    pub(super) fn new(source: &'run Mesh, options: MeshOptions, budget: &'run Budget) -> Self {
        Self {
            source,
            options,
            budget,
        }
    }

    /// The radius of points or lines.
    fn radius(&self, are_points: bool, ends: &[[u32; 2]]) -> f64 {
        let Some(ball) = ball(self.source) else {
            return 0.0;
        };
        let point = |at: usize| Vec3::from_array(self.source.positions.at(ends[at][0] as usize));
        match are_points {
            true => point_radius(ball, self.options.point_size, spacing(ends.len(), point)),
            false => radius(ball),
        }
    }

    /// The meshes of points and lines; empty if there are none.
    ///
    /// # Errors
    /// If they exceed the available memory.
    pub(super) fn draw(&self, strokes: Segments) -> Result<Vec<Mesh>, LimitExceeded> {
        let (points, lines): (Vec<_>, Vec<_>) =
            strokes.ends.into_iter().partition(|[from, to]| from == to);
        let has_normals = !self.source.normals.is_empty();
        let mut drawn_meshes = Vec::new();
        for (ends, are_points) in [(points, true), (lines, false)] {
            let count = ends.len() as u64;
            let solid = StrokeShape::of(are_points, has_normals, count);
            let vertices = count * solid.corners.len() as u64;
            let triangles = count * solid.triangles.len() as u64;
            let vertex = OFFSET + columns(self.source);
            self.budget.has(Resource::Vertices, vertices)?;
            self.budget
                .has(Resource::Memory, vertices * vertex + triangles * TRIANGLE)?;
            let radius = self.radius(are_points, &ends);
            let glyphs = thin_glyphs(self.source, &ends, DAffine3::IDENTITY, solid);
            drawn_meshes.extend(glyphs.map(|(mesh, offsets, world)| {
                let corners = mesh.positions.iter().zip(offsets.iter());
                let positions = corners.map(|(position, offset)| {
                    let offset = radius * Vec3::from_array(offset);
                    (world.translation + Vec3::from_array(position) + offset).to_array()
                });
                let positions = positions.collect();
                Mesh { positions, ..mesh }
            }));
        }
        Ok(drawn_meshes)
    }
}

/// A ball around the vertices.
fn ball(mesh: &Mesh) -> Option<BoundingSphere> {
    let positions = || mesh.positions.iter().map(Vec3::from_array);
    let low = positions().fold(Vec3::INFINITY, Vec3::min);
    let high = positions().fold(Vec3::NEG_INFINITY, Vec3::max);
    let center = low + (high - low) / 2.0;
    let radius = (high - center).length();
    // One point alone is as large as in a ball of radius 1.
    let radius = if radius > 0.0 { radius } else { 1.0 };
    (center.is_finite() && radius.is_finite()).then_some(BoundingSphere { center, radius })
}

/// Adds meshes to one. Of columns that some have the others have zeros, of colours white.
pub(super) fn join(mesh: &mut Mesh, more: Vec<Mesh>) {
    if more.is_empty() {
        return;
    }
    let mut all = vec![std::mem::take(mesh)];
    all.extend(more);
    all.retain(|mesh| !mesh.positions.is_empty());
    if let [_] = &*all {
        *mesh = all.remove(0);
        return;
    }
    *mesh = Mesh {
        positions: column(&all, |mesh| &mesh.positions, 0.0),
        normals: column(&all, |mesh| &mesh.normals, 0.0),
        uvs: column(&all, |mesh| &mesh.uvs, 0.0),
        second_uvs: column(&all, |mesh| &mesh.second_uvs, 0.0),
        colors: column(&all, |mesh| &mesh.colors, 1.0),
        ..Mesh::default()
    };
    let mut first = 0;
    for part in &all {
        let triangles = part.triangles.iter();
        let moved = triangles.map(|corners| corners.map(|corner| first + corner));
        mesh.triangles.extend(moved);
        first += to_u32(part.positions.len());
    }
}

/// A column of several meshes.
fn column<const N: usize>(
    meshes: &[Mesh],
    of: impl Fn(&Mesh) -> &VertexColumn<N>,
    none: f64,
) -> VertexColumn<N> {
    if meshes.iter().all(|mesh| of(mesh).is_empty()) {
        return VertexColumn::default();
    }
    let mut all = Vec::with_capacity(meshes.iter().map(|mesh| mesh.positions.len()).sum());
    for mesh in meshes {
        match of(mesh).is_empty() {
            true => all.extend(mesh.positions.iter().map(|_| [none; N])),
            false => all.extend(of(mesh).iter()),
        }
    }
    all.into()
}
