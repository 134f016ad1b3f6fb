//! Tessellations of shapes of other renderers, in their own coordinates.

use super::transform::AffineTransform;
use rtc_ir::{Mesh, VertexColumn};
use rtc_math::{OrthonormalBasis, Vec3, cos, sin, unit};
use std::f64::consts::{PI, TAU};

/// The sides of round meshes.
const SIDES: u32 = 128;
/// The rows of a sphere.
const ROWS: u32 = 16;

/// Vertices with normals and texture coordinates.
#[derive(Default)]
struct TriangleBuilder {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleBuilder {
    fn vertex(&mut self, position: Vec3, normal: Vec3, uv: [f64; 2]) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv);
    }

    /// Two triangles for each cell of a grid of `columns` × `rows` cells.
    fn grid(&mut self, columns: u32, rows: u32) {
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    fn mesh(self) -> Mesh {
        Mesh {
            positions: VertexColumn::rounded(self.positions),
            normals: VertexColumn::rounded(self.normals),
            uvs: VertexColumn::rounded(self.uvs),
            triangles: self.triangles.into(),
            ..Mesh::default()
        }
    }
}

/// The square from (−1, −1, 0) to (1, 1, 0), its normal +z.
pub(crate) fn rectangle() -> Mesh {
    let mut builder = TriangleBuilder::default();
    for [u, v] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
        builder.vertex(
            Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0),
            Vec3::Z,
            [u, v],
        );
    }
    builder.grid(1, 1);
    builder.mesh()
}

/// The cube from (−1, −1, −1) to (1, 1, 1).
pub(crate) fn cube() -> Mesh {
    let mut builder = TriangleBuilder::default();
    for normal in [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ] {
        let right = if normal.x == 0.0 { Vec3::X } else { Vec3::Y };
        let up = normal.cross(right);
        let first = u32::try_from(builder.positions.len()).unwrap_or(0);
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let corner = normal + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0);
            builder.vertex(corner, normal, [u, v]);
        }
        let corners = [0, 1, 2, 3].map(|corner| first + corner);
        let [a, b, c, d] = corners;
        builder.triangles.extend([[a, b, c], [a, c, d]]);
    }
    builder.mesh()
}

/// The unit disk about +z, of the area of the circle: u from the centre to the edge, v along the
/// turn.
pub(crate) fn disk() -> Mesh {
    let mut builder = TriangleBuilder::default();
    let sides = f64::from(SIDES);
    // The area of a regular polygon is (n/2)·r²·sin(2π/n).
    let radius = (PI / (sides / 2.0 * sin(TAU / sides))).sqrt();
    for side in 0..=SIDES {
        let share = f64::from(side) / sides;
        let (s, c) = (sin(TAU * share), cos(TAU * share));
        builder.vertex(Vec3::new(c, s, 0.0) * radius, Vec3::Z, [1.0, share]);
    }
    // Each triangle has a vertex of its own at the centre, with the v of its middle.
    for side in 0..SIDES {
        let share = (f64::from(side) + 0.5) / sides;
        builder.vertex(Vec3::ZERO, Vec3::Z, [0.0, share]);
    }
    let triangle = |side: u32| [SIDES + 1 + side, side, side + 1];
    builder.triangles.extend((0..SIDES).map(triangle));
    builder.mesh()
}

/// The unit sphere, with poles ±z.
pub(crate) fn sphere() -> Mesh {
    let mut builder = TriangleBuilder::default();
    for row in 0..=ROWS {
        let v = f64::from(row) / f64::from(ROWS);
        for side in 0..=SIDES {
            let u = f64::from(side) / f64::from(SIDES);
            let (ring, z) = (sin(PI * v), cos(PI * v));
            let direction = Vec3::new(ring * cos(TAU * u), ring * sin(TAU * u), z);
            builder.vertex(direction, direction, [u, v]);
        }
    }
    builder.grid(SIDES, ROWS);
    for triangle in &mut builder.triangles {
        triangle.swap(1, 2);
    }
    builder.mesh()
}

/// The cylinder of radius 1 about +z from 0 to 1, open at both ends.
pub(crate) fn cylinder() -> Mesh {
    let mut builder = TriangleBuilder::default();
    for v in [0.0, 1.0] {
        for side in 0..=SIDES {
            let u = f64::from(side) / f64::from(SIDES);
            let normal = Vec3::new(cos(TAU * u), sin(TAU * u), 0.0);
            builder.vertex(normal + Vec3::Z * v, normal, [u, v]);
        }
    }
    builder.grid(SIDES, 1);
    builder.mesh()
}

/// The surface that a profile sweeps when it turns about +z by `angle` radians, at most 2π: u along
/// the turn, v along the profile. Each point of the profile has its normal.
pub(crate) fn revolved(profile: &[(Vec3, Vec3)], angle: f64) -> Mesh {
    let mut builder = TriangleBuilder::default();
    let rows = u32::try_from(profile.len().saturating_sub(1)).unwrap_or(0);
    for (row, (point, normal)) in (0_u32..).zip(profile) {
        let v = f64::from(row) / f64::from(rows.max(1));
        for side in 0..=SIDES {
            let u = f64::from(side) / f64::from(SIDES);
            let (s, c) = (sin(angle * u), cos(angle * u));
            let turn = |p: Vec3| Vec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
            builder.vertex(turn(*point), turn(*normal), [u, v]);
        }
    }
    builder.grid(SIDES, rows);
    // At a pole one side of each cell is a point.
    let positions = &builder.positions;
    builder.triangles.retain(|corners| {
        let [a, b, c] = corners.map(|corner| Vec3::from_array(positions[corner as usize]));
        (b - a).cross(c - a) != Vec3::ZERO
    });
    builder.mesh()
}

/// The map that takes [`cylinder`] to the one from `p0` to `p1`; `None` if they coincide.
pub(crate) fn along(p0: Vec3, p1: Vec3, radius: f64) -> Option<AffineTransform> {
    let axis = unit(p1 - p0)?;
    let OrthonormalBasis {
        tangent,
        bitangent,
        normal: _,
    } = OrthonormalBasis::around(axis);
    Some(AffineTransform([
        tangent * radius,
        bitangent * radius,
        p1 - p0,
        p0,
    ]))
}
