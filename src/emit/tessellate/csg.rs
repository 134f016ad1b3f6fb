//! Tessellates CSG solids: the meshes of the operands, clipped by the operations.
//!
//! A triangle of an operand is on the boundary of the solid if crossing it goes from inside to
//! outside. A triangle that is partly on the boundary is halved along its longest edge until it is
//! small; then its centroid decides. So faces lie on those of the operands, and edges between them
//! are jagged by the size of the smallest triangles.

use super::{ShapeMesh, Tessellator};
use crate::reporter::ExportReporter;
use glam::DAffine3;
use rtc_ir::{Csg, Mesh, Solid, ValuePath, VertexColumn};
use rtc_math::{Bounds, Vec3, cross, evaluate_set, to_u32, unit};
use std::collections::BTreeMap;

/// The longest edge of a triangle, in diagonals of the solid.
const COARSEST: f64 = 1.0 / 16.0;
/// The longest edge of a triangle at an edge of the solid.
pub(super) const FINEST: f64 = 1.0 / 256.0;
/// The distance between the two points that decide whether a triangle is on the boundary, in
/// diagonals of the solid.
const APART: f64 = 1e-6;
/// The maximum distance of the mesh of an operand from it, in diagonals of the solid.
const MESH_ERROR: f64 = 4e-3;
/// Halvings of that distance, until it is well below [`APART`].
const BISECTIONS: u32 = 16;
/// Triangles between two charges of the budget.
const BATCH: u64 = 4096;

/// A corner with its normal.
#[derive(Clone, Copy)]
struct ClipVertex {
    position: Vec3,
    normal: Vec3,
}

type ClipTriangle = [ClipVertex; 3];

/// The side of a face that is inside the solid.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SolidSide {
    Behind,
    InFront,
    /// The face is inside or outside of the solid.
    None,
}

impl Tessellator<'_> {
    /// The mesh of the part of the boundary on the faces.
    pub(super) fn csg(
        &self,
        csg: &Csg,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<ShapeMesh> {
        let operands: Vec<_> = csg
            .operands
            .iter()
            .map(|operand| self.operand(operand, path, reporter))
            .collect::<Option<_>>()?;
        let mut clipper = Clipper::new(csg, &operands);
        for face in &csg.faces {
            let index = *face as usize;
            for corners in operands.get(index).into_iter().flatten() {
                let mut open = vec![*corners];
                while let Some(corners) = open.pop() {
                    open.extend(clipper.clip(index, corners).into_iter().flatten());
                    if clipper.uncharged >= BATCH {
                        self.charge(3 * std::mem::take(&mut clipper.uncharged), path, reporter)?;
                    }
                }
            }
        }
        self.charge(3 * clipper.uncharged, path, reporter)?;
        Some(ShapeMesh::World(Box::new(clipper.mesh())))
    }

    /// The triangles of an operand, in the world.
    fn operand(
        &self,
        solid: &Solid,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<Vec<ClipTriangle>> {
        let (mesh, world) = match self.simple(&solid.shape(), path, reporter)? {
            ShapeMesh::World(mesh) => (*mesh, DAffine3::IDENTITY),
            ShapeMesh::Round(unit_shape, world) => {
                self.charge(unit_shape.vertices(), path, reporter)?;
                (unit_shape.mesh(), world)
            }
        };
        let vectors =
            |column: &VertexColumn<3>| column.iter().map(Vec3::from_array).collect::<Vec<_>>();
        let (positions, normals) = (vectors(&mesh.positions), vectors(&mesh.normals));
        let turn = world.matrix3.inverse().transpose();
        let corners = |triangle: &[u32; 3]| {
            let at = triangle.map(|index| index as usize);
            let [a, b, c] = at.map(|at| world.transform_point3(positions[at]));
            let flat = unit(cross(b - a, c - a))?;
            let normal = |at: usize| match normals.get(at) {
                Some(normal) => unit(turn * *normal).unwrap_or(flat),
                None => flat,
            };
            let corner = |position, at| ClipVertex {
                position,
                normal: normal(at),
            };
            let [a, b, c] = [corner(a, at[0]), corner(b, at[1]), corner(c, at[2])];
            let is_mirrored = flat.dot(a.normal + b.normal + c.normal) < 0.0;
            Some(if is_mirrored { [a, c, b] } else { [a, b, c] })
        };
        Some(mesh.triangles.iter().filter_map(corners).collect())
    }
}

/// Clips triangles, and collects those on the boundary.
struct Clipper<'c> {
    csg: &'c Csg,
    bounds: Bounds,
    /// The diagonal of the bounds.
    size: f64,
    /// Triangles since the last charge.
    uncharged: u64,
    numbers: BTreeMap<[u64; 6], u32>,
    corners: Vec<ClipVertex>,
    triangles: Vec<[u32; 3]>,
}

impl<'c> Clipper<'c> {
    fn new(csg: &'c Csg, operands: &[Vec<ClipTriangle>]) -> Self {
        let boxes = csg.operands.iter().zip(operands);
        let boxes = boxes.map(|(operand, triangles)| {
            let points = triangles.iter().flatten().map(|corner| corner.position);
            let whole = Bounds::of(points);
            let Solid::Plane(plane) = operand else {
                return whole;
            };
            // The square of a plane bounds the half space behind it.
            let back = Vec3::from_array(plane.normal) * (whole.max - whole.min).length();
            let corners = whole.corners();
            Bounds::of(
                corners
                    .into_iter()
                    .chain(corners.map(|corner| corner - back)),
            )
        });
        let bounds = Bounds::of_set(&csg.steps, boxes).unwrap_or(Bounds::EMPTY);
        let size = (bounds.max - bounds.min).length();
        Self {
            csg,
            bounds: bounds.grown(APART * size),
            size,
            uncharged: 0,
            numbers: BTreeMap::new(),
            corners: Vec::new(),
            triangles: Vec::new(),
        }
    }

    /// Adds a triangle of an operand if it is on the boundary, or halves it.
    fn clip(&mut self, operand: usize, corners: ClipTriangle) -> Option<[ClipTriangle; 2]> {
        let [a, b, c] = corners.map(|corner| corner.position);
        let own = Bounds::of([a, b, c]);
        let is_outside =
            own.min.cmpgt(self.bounds.max).any() || own.max.cmplt(self.bounds.min).any();
        if is_outside || !self.size.is_finite() {
            return None;
        }
        let edges = [a.distance(b), b.distance(c), c.distance(a)];
        let longest = (0..3)
            .max_by(|i, j| edges[*i].total_cmp(&edges[*j]))
            .unwrap_or(0);
        let edge = edges[longest] / self.size;
        let normal = unit(cross(b - a, c - a))?;
        let middle = (a + b + c) / 3.0;
        let side = self.side(operand, middle, normal);
        let is_whole = || {
            // The corners lie on the edges of neighbours: take points nearer to the middle.
            [a, b, c]
                .iter()
                .all(|corner| self.side(operand, middle.lerp(*corner, 0.98), normal) == side)
        };
        if edge > COARSEST || (edge > FINEST && !is_whole()) {
            return Some(halves(corners, longest));
        }
        self.add(corners, side);
        None
    }

    /// The side of an operand's face that is inside the solid at a point. Of coincident faces, the
    /// first operand's wins.
    fn side(&self, operand: usize, point: Vec3, normal: Vec3) -> SolidSide {
        let bit = 1 << operand;
        let point = self.on_operand(operand, point, normal);
        let around = |sign: f64| {
            self.csg
                .operands_around(point + normal * (sign * APART * self.size))
        };
        let (behind, in_front) = (around(-1.0) | bit, around(1.0) & !bit);
        let coincident = (behind ^ in_front) & (bit - 1);
        let is_inside = |operands| evaluate_set(&self.csg.steps, operands);
        match (is_inside(behind), is_inside(in_front)) {
            (true, false) if coincident == 0 => SolidSide::Behind,
            (false, true) if coincident == 0 => SolidSide::InFront,
            _ => SolidSide::None,
        }
    }

    /// The point of an operand itself near one of its mesh, along the normal, by bisection.
    fn on_operand(&self, operand: usize, point: Vec3, normal: Vec3) -> Vec3 {
        let is_inside = |at: f64| self.csg.operands[operand].contains(point + normal * at);
        let reach = MESH_ERROR * self.size;
        let (mut inside, mut outside) = (-reach, reach);
        if !is_inside(inside) || is_inside(outside) {
            return point;
        }
        for _ in 0..BISECTIONS {
            let middle = (inside + outside) / 2.0;
            if is_inside(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        point + normal * ((inside + outside) / 2.0)
    }

    fn add(&mut self, corners: ClipTriangle, side: SolidSide) {
        let [a, b, c] = corners;
        let turned = |corner: ClipVertex| ClipVertex {
            normal: -corner.normal,
            ..corner
        };
        let corners = match side {
            SolidSide::None => return,
            SolidSide::Behind => [a, b, c],
            SolidSide::InFront => [a, c, b].map(turned),
        };
        let triangle = corners.map(|corner| self.number(corner));
        self.triangles.push(triangle);
        self.uncharged += 1;
    }

    fn number(&mut self, corner: ClipVertex) -> u32 {
        let [x, y, z] = corner.position.to_array();
        let [u, v, w] = corner.normal.to_array();
        let key = [x, y, z, u, v, w].map(f64::to_bits);
        *self.numbers.entry(key).or_insert_with(|| {
            self.corners.push(corner);
            to_u32(self.corners.len() - 1)
        })
    }

    fn mesh(self) -> Mesh {
        let positions = self.corners.iter().map(|corner| corner.position.to_array());
        let normals = self.corners.iter().map(|corner| corner.normal.to_array());
        Mesh {
            positions: VertexColumn::rounded(positions),
            normals: VertexColumn::rounded(normals),
            triangles: self.triangles.into(),
            ..Mesh::default()
        }
    }
}

/// The halves of a triangle on both sides of the middle of the edge after a corner.
fn halves(corners: ClipTriangle, edge: usize) -> [ClipTriangle; 2] {
    let [a, b, c] = [0, 1, 2].map(|step| corners[(edge + step) % 3]);
    let middle = ClipVertex {
        position: (a.position + b.position) / 2.0,
        normal: unit(a.normal + b.normal).unwrap_or(a.normal),
    };
    [[a, middle, c], [middle, b, c]]
}

#[cfg(test)]
mod tests {
    use super::super::{TargetFormat, TessellationTolerance};
    use super::*;
    use rtc_diag::{DiagnosticSink, codes};
    use rtc_ir::{BoundingSphere, EntityField, EntityKind, SourceSpans, Sphere};
    use rtc_math::SetStep;
    use rtc_source::Budget;
    use std::f64::consts::PI;

    fn ball(x: f64) -> Solid {
        Solid::Sphere(Sphere {
            center: [x, 0.0, 0.0],
            radius: 1.0,
            texture_from_world: None,
        })
    }

    fn half_space() -> Solid {
        Solid::Plane(rtc_ir::Plane {
            center: [0.0; 3],
            normal: [1.0, 0.0, 0.0],
        })
    }

    /// Six times the signed volume enclosed by the triangles of a mesh (the divergence theorem).
    fn six_volumes(mesh: &Mesh) -> f64 {
        let points: Vec<_> = mesh.positions.iter().map(Vec3::from_array).collect();
        let volume = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|at| points[at as usize]);
            a.dot(cross(b, c))
        };
        mesh.triangles.iter().map(volume).sum()
    }

    #[test]
    fn meshes_enclose_the_volume_of_the_solid() {
        // Balls of radius 1 at a distance of 1 share two caps of height 1/2.
        let shared = 2.0 * PI * 0.25 * (3.0 - 0.5) / 3.0;
        let whole = 4.0 * PI / 3.0;
        let format = TargetFormat {
            name: "test",
            approximated: &codes::GLTF_APPROXIMATED,
            has: |_, _| false,
        };
        let budget = Budget::default();
        for (operands, step, volume) in [
            ([ball(0.0), ball(1.0)], SetStep::Union, 2.0 * whole - shared),
            ([ball(0.0), ball(1.0)], SetStep::Intersection, shared),
            ([ball(0.0), ball(1.0)], SetStep::Difference, whole - shared),
            ([ball(0.0), half_space()], SetStep::Difference, whole / 2.0),
            (
                [ball(0.0), half_space()],
                SetStep::Intersection,
                whole / 2.0,
            ),
            ([ball(0.0), ball(0.0)], SetStep::Union, whole),
        ] {
            let csg = Csg {
                operands: operands.to_vec(),
                steps: vec![SetStep::Operand, SetStep::Operand, step],
                faces: vec![0, 1],
            };
            let tessellator = Tessellator {
                format: &format,
                tessellation: TessellationTolerance::new(None),
                around: BoundingSphere {
                    center: Vec3::ZERO,
                    radius: 2.0,
                },
                budget: &budget,
                unit_meshes: BTreeMap::new(),
                meshes: Vec::new(),
            };
            let (spans, mut sink) = (SourceSpans::default(), DiagnosticSink::default());
            let mut reporter = ExportReporter::new(&spans, &mut sink);
            let path = ValuePath::new(EntityKind::Surface, 0, EntityField::Whole);
            let Some(ShapeMesh::World(mesh)) = tessellator.csg(&csg, path, &mut reporter) else {
                panic!("no mesh");
            };
            let found = six_volumes(&mesh) / 6.0;
            assert!(
                (found / volume - 1.0).abs() < 0.01,
                "{step:?}: {found}, not {volume}"
            );
        }
    }
}
