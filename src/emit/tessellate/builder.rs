//! Builds meshes from grids of vertices with normals.

use rtc_ir::{Mesh, VertexColumn};
use rtc_math::{Vec3, cos_sin_revolutions, to_u32};

/// A vertex.
#[derive(Clone, Copy)]
pub(super) struct GridVertex {
    pub(super) position: Vec3,
    /// Of any length but 0.
    pub(super) normal: Vec3,
    pub(super) uv: [f64; 2],
}

/// Vertices and the triangles between them.
#[derive(Default)]
pub(super) struct MeshBuilder {
    vertices: Vec<GridVertex>,
    triangles: Vec<[u32; 3]>,
}

impl MeshBuilder {
    /// Adds a grid of cells; `at` is the vertex at a column and a row, both counted to the end
    /// inclusive. A cell with two equal corners gets one triangle.
    pub(super) fn grid(&mut self, [columns, rows]: [u32; 2], at: impl Fn(u32, u32) -> GridVertex) {
        let first = to_u32(self.vertices.len());
        let width = columns + 1;
        for row in 0..=rows {
            self.vertices
                .extend((0..width).map(|column| at(column, row)));
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * width + column;
                let [b, c, d] = [a + 1, a + width + 1, a + width];
                self.triangle([a, b, c]);
                self.triangle([a, c, d]);
            }
        }
    }

    /// Adds a triangle with the winding of its vertex normals.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.vertices[corner as usize]);
        let front = (b.position - a.position).cross(c.position - a.position);
        let is_empty =
            a.position == b.position || b.position == c.position || c.position == a.position;
        if is_empty || front == Vec3::ZERO {
            return;
        }
        let [a_at, b_at, c_at] = corners;
        let is_front = front.dot(a.normal + b.normal + c.normal) >= 0.0;
        self.triangles.push(if is_front {
            corners
        } else {
            [a_at, c_at, b_at]
        });
    }

    /// The mesh of the vertices that are used by triangles.
    pub(super) fn mesh(self, has_uvs: bool) -> Mesh {
        let Self {
            vertices,
            mut triangles,
        } = self;
        let mut used = Vec::with_capacity(vertices.len());
        let mut number = vec![None; vertices.len()];
        for corner in triangles.iter_mut().flatten() {
            let at = *corner as usize;
            *corner = *number[at].get_or_insert_with(|| {
                used.push(vertices[at]);
                to_u32(used.len() - 1)
            });
        }
        let normal = |vertex: &GridVertex| vertex.normal.normalize().to_array();
        let uvs = used.iter().filter(|_| has_uvs).map(|vertex| vertex.uv);
        Mesh {
            positions: VertexColumn::rounded(used.iter().map(|vertex| vertex.position.to_array())),
            normals: VertexColumn::rounded(used.iter().map(normal)),
            uvs: VertexColumn::rounded(uvs),
            triangles: triangles.into(),
            ..Mesh::default()
        }
    }
}

/// Cosine and sine of the angle of `step` of `steps` around a circle; the last step equals the
/// first.
pub(super) fn circle_point(step: u32, steps: u32) -> [f64; 2] {
    let turns = (u128::from(step) << 64) / u128::from(steps.max(1));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a whole turn is none, which is what the cut off bit says"
    )]
    let (cos, sin) = cos_sin_revolutions(turns as u64);
    [cos, sin]
}

/// `step` of `steps`, from 0 to 1.
pub(super) fn fraction(step: u32, steps: u32) -> f64 {
    f64::from(step) / f64::from(steps.max(1))
}
