//! Holds the polygons of a file until all its vertices are read, then cuts them into triangles.

use super::ParsedMesh;
use super::polygon::EarClipper;
use crate::words::WordError;
use rtc_ir::Mesh;
use rtc_math::to_u32;
use rtc_source::{Budget, LimitExceeded, Resource};

/// Polygons, each a run of corners, some with a colour of their own or texture coordinates of their
/// corners.
#[derive(Default)]
pub(super) struct Polygons {
    /// The vertex index of each corner; it may be out of range.
    corners: Vec<u32>,
    /// Where each polygon ends.
    ends: Vec<u32>,
    /// The linear colour of each polygon; empty if they have none.
    pub(super) colors: Vec<[f32; 4]>,
    /// The texture coordinates of each corner; empty if they have none.
    pub(super) uvs: Vec<[f64; 2]>,
}

/// The memory that a corner takes until its polygon is cut, lists that grow by doubling included.
pub(super) const CORNER: usize = 24;

impl Polygons {
    /// Adds the next corner.
    pub(super) fn corner(&mut self, vertex: u32) {
        self.corners.push(vertex);
    }

    /// Ends the polygon that is read.
    pub(super) fn end(&mut self) {
        self.ends.push(to_u32(self.corners.len()));
    }

    /// Discards the corners of the polygon that is read, and returns them.
    pub(super) fn discard_polygon(&mut self) -> Vec<u32> {
        let first = self.first();
        self.uvs.truncate(first);
        self.corners.split_off(first)
    }

    /// The number of polygons.
    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }

    /// The total number of their corners.
    pub(super) fn corners(&self) -> usize {
        self.corners.len()
    }

    fn first(&self) -> usize {
        self.ends.last().map_or(0, |end| *end as usize)
    }

    /// Adds the triangles to the mesh, which has all its vertices. `missing` makes the error for an
    /// invalid corner.
    ///
    /// # Errors
    /// If it exceeds the available memory.
    pub(super) fn cut(
        self,
        parsed: &mut ParsedMesh,
        missing: impl Fn() -> WordError,
        budget: &Budget,
    ) -> Result<(), LimitExceeded> {
        let Self {
            corners,
            ends,
            colors,
            uvs,
        } = self;
        let is_split = !colors.is_empty() || !uvs.is_empty();
        let count = parsed.mesh.positions.len();
        let mut clipper = EarClipper::new(corners.len());
        let (mut triangles, mut first) = (Vec::new(), 0);
        for end in &ends {
            let polygon = &corners[first..*end as usize];
            if polygon.iter().any(|corner| *corner as usize >= count) {
                parsed.skip(&missing);
            } else {
                let position = |at: usize| parsed.mesh.positions.at(polygon[at] as usize);
                clipper.cut(polygon.len(), position, |three| {
                    triangles.push(three.map(|at| match is_split {
                        true => to_u32(first + at),
                        false => polygon[at],
                    }));
                });
            }
            first = *end as usize;
        }
        parsed.mesh.triangles = triangles.into();
        if is_split {
            // All columns in 64 bits, at most.
            budget.has(Resource::Memory, 160 * corners.len() as u64)?;
            unshare_vertices(&mut parsed.mesh, corners, count);
            if !uvs.is_empty() {
                parsed.mesh.uvs = uvs.into();
            }
            if !colors.is_empty() {
                let starts = std::iter::once(0).chain(ends.iter().copied());
                let runs = starts.zip(&ends).zip(colors);
                let each = runs.flat_map(|((from, to), color)| (from..*to).map(move |_| color));
                parsed.mesh.colors = each.collect::<Vec<_>>().into();
            }
        }
        Ok(())
    }
}

/// Gives each corner a vertex of its own.
fn unshare_vertices(mesh: &mut Mesh, mut corners: Vec<u32>, count: usize) {
    // A corner out of range belongs to no triangle; any vertex does for it.
    for corner in &mut corners {
        *corner = if (*corner as usize) < count {
            *corner
        } else {
            0
        };
    }
    if count > 0 {
        crate::glyph::pick(mesh, &corners);
    }
}
