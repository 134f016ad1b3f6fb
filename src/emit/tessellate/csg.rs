//! Tessellates CSG solids by dual contouring (Ju, Losasso, Schaefer and Warren, "Dual contouring of
//! Hermite data", SIGGRAPH 2002).
//!
//! A grid of cells covers the solid. Where an edge of it crosses the boundary of the solid, it
//! crosses a face of an operand. A cell with such edges has a vertex that lies on all these faces,
//! so that edges and corners of the solid stay sharp. The four cells around the edge give a
//! quadrilateral, and all of them a mesh without holes, as each face of a cell has an even number
//! of edges that cross.

use super::face::{self, FaceSample};
use super::{ShapeMesh, Tessellator};
use crate::flat::side;
use crate::reporter::ExportReporter;
use glam::DMat3;
use rtc_ir::{Csg, Mesh, Plane, Solid, ValuePath, VertexColumn};
use rtc_math::{Bounds, SetStep, Vec3, cross, evaluate_set, shortest, to_u32, unit};
use std::collections::BTreeMap;

/// The numbers of cells along the longest side of a solid: the least, and the greatest by which the
/// mesh becomes as exact as it should.
const LEAST_CELLS: u32 = 64;
const MOST_CELLS: u32 = 128;
/// The distance of a mesh from its solid that is aimed at, as a fraction of the longest side.
const DEVIATION: f64 = 1e-3;
/// The distance from the first point of the grid to the solid, in cells: no whole number, since
/// faces of solids often lie at whole multiples of each other.
const MARGIN: f64 = 0.382;
/// Halvings of an edge that crosses the boundary, and steps towards the faces that cross a cell.
const HALVINGS: u32 = 40;
const STEPS: u32 = 12;
/// The damping of these steps, for faces that touch each other: squared, a part of a normal.
const DAMPING: f64 = 1e-6;
/// The largest distance of a vertex from the middle of its cell along an axis, in cells.
const REACH: f64 = 0.6;

/// A mesh of a solid, and a phrase that says how exact it is.
pub(super) struct CsgMesh {
    pub(super) mesh: ShapeMesh,
    pub(super) exactness: String,
}

impl Tessellator<'_> {
    /// The mesh of the part of the boundary on the faces.
    pub(super) fn csg(
        &self,
        csg: &Csg,
        path: ValuePath,
        reporter: &mut ExportReporter<'_>,
    ) -> Option<CsgMesh> {
        let half = Vec3::splat(side(self.around));
        let bounds = bounds_of(csg, Bounds::about(self.around.center, half));
        let size = (bounds.max - bounds.min).max_element();
        let wanted = self.tessellation.length().unwrap_or(DEVIATION * size);
        let mut cells = LEAST_CELLS;
        loop {
            let grid = Grid::new(csg, bounds, cells);
            reporter.charge(grid.points(), self.budget, path)?;
            let Contour {
                vertices,
                triangles,
                deviation,
                ..
            } = grid.contour();
            if deviation > wanted && cells < MOST_CELLS {
                cells *= 2;
                continue;
            }
            self.charge(vertices.len() as u64, path, reporter)?;
            let mesh = Mesh {
                positions: VertexColumn::rounded(
                    vertices.iter().map(|(point, _)| point.to_array()),
                ),
                normals: VertexColumn::rounded(
                    vertices.iter().map(|(_, normal)| normal.to_array()),
                ),
                triangles: triangles.into(),
                ..Mesh::default()
            };
            let [deviation, step] = [deviation, grid.step].map(two_digits);
            return Some(CsgMesh {
                mesh: ShapeMesh::World(Box::new(mesh)),
                exactness: format!("within {deviation} of it, without what is thinner than {step}"),
            });
        }
    }
}

/// A number as a decimal of two digits.
fn two_digits(number: f64) -> String {
    let rounded = format!("{number:.1e}").parse();
    shortest(rounded.unwrap_or(number))
}

/// A box around a solid, within another one where it is infinite.
fn bounds_of(csg: &Csg, everything: Bounds) -> Bounds {
    /// The box of an expression, and its planes if it is an intersection of half-spaces.
    type Known<'c> = (Bounds, Option<Vec<&'c Plane>>);
    let mut operands = csg.operands.iter();
    let mut stack: Vec<Known<'_>> = Vec::new();
    for step in &csg.steps {
        if *step == SetStep::Operand {
            stack.extend(operands.next().map(|operand| {
                if let Solid::Plane(plane) = operand {
                    return (polytope(&[plane], everything), Some(vec![plane]));
                }
                (face::bounds(operand).unwrap_or(everything), None)
            }));
            continue;
        }
        let (Some((b, planes)), Some((a, others))) = (stack.pop(), stack.pop()) else {
            break;
        };
        stack.push(match (step, others, planes) {
            (SetStep::Intersection, Some(others), Some(planes)) => {
                let all = [others, planes].concat();
                (polytope(&all, everything), Some(all))
            }
            (SetStep::Intersection, ..) => (intersection(a, b), None),
            (SetStep::Union, ..) => (a.union(b), None),
            (SetStep::Difference | SetStep::Operand, ..) => (a, None),
        });
    }
    stack.pop().map_or(Bounds::EMPTY, |(bounds, _)| bounds)
}

/// The common part of two boxes.
fn intersection(a: Bounds, b: Bounds) -> Bounds {
    let (min, max) = (a.min.max(b.min), a.max.min(b.max));
    match min.cmple(max).all() {
        true => Bounds { min, max },
        false => Bounds::EMPTY,
    }
}

/// The box of the part of a box that is behind all planes, by its corners.
fn polytope(planes: &[&Plane], within: Bounds) -> Bounds {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let sides = axes.map(|axis| [(within.max, axis), (within.min, -axis)]);
    let own = planes.iter().filter_map(|plane| {
        let normal = unit(Vec3::from_array(plane.normal))?;
        Some((Vec3::from_array(plane.center), normal))
    });
    let all: Vec<_> = sides.into_iter().flatten().chain(own).collect();
    let slack = 1e-9 * (within.max - within.min).max_element();
    let is_inside = |point: &Vec3| {
        let is_behind = |(center, normal): &(Vec3, Vec3)| (*point - *center).dot(*normal) <= slack;
        all.iter().all(is_behind)
    };
    let mut bounds = Bounds::EMPTY;
    for (i, a) in all.iter().enumerate() {
        for (j, b) in all.iter().enumerate().skip(i + 1) {
            for c in all.iter().skip(j + 1) {
                let corner = common_point([*a, *b, *c]).filter(is_inside);
                bounds = bounds.union(Bounds::of(corner));
            }
        }
    }
    bounds
}

/// The point that three planes share, each by one of its points and its normal.
fn common_point(planes: [(Vec3, Vec3); 3]) -> Option<Vec3> {
    let [a, b, c] = planes.map(|(_, normal)| normal);
    let offsets = Vec3::from_array(planes.map(|(point, normal)| point.dot(normal)));
    let rows = DMat3::from_cols(a, b, c).transpose();
    let point = rows.inverse() * offsets;
    (rows.determinant().abs() > 1e-9 && point.is_finite()).then_some(point)
}

/// A grid of cubes over a solid.
struct Grid<'c> {
    csg: &'c Csg,
    /// The first point.
    origin: Vec3,
    /// The side of a cell.
    step: f64,
    /// The number of points along each axis.
    size: [u32; 3],
}

/// A face of an operand: the index of the operand, and that of the face.
type FaceKey = (u8, u8);

/// An edge of the grid that crosses the boundary.
struct Crossing {
    /// The axis along which it leads, and its first point.
    axis: usize,
    at: [u32; 3],
    /// Whether its first point is inside the solid.
    leads_out: bool,
    point: Vec3,
    key: FaceKey,
    /// Whether the outside of the operand is that of the solid.
    is_outward: bool,
}

/// The faces that cross a cell, and the sum of the points where its edges cross them.
#[derive(Default)]
struct CellFaces {
    sum: Vec3,
    count: u32,
    keys: Vec<FaceKey>,
}

/// The mesh of the boundary.
#[derive(Default)]
struct Contour {
    /// Positions and normals.
    vertices: Vec<(Vec3, Vec3)>,
    triangles: Vec<[u32; 3]>,
    /// The greatest distance of the middle of a triangle from its face.
    deviation: f64,
    /// The number of each vertex, by its cell and its face, and whether this is turned.
    numbers: BTreeMap<([u32; 3], FaceKey, bool), u32>,
}

impl<'c> Grid<'c> {
    fn new(csg: &'c Csg, bounds: Bounds, cells: u32) -> Self {
        let extent = bounds.max - bounds.min;
        let step = extent.max_element() / f64::from(cells);
        let is_proper = step > 0.0 && step.is_finite();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most the number of cells along the longest side"
        )]
        let count = |side: f64| (side / step).ceil() as u32 + 3;
        Self {
            csg,
            origin: bounds.min - Vec3::splat(MARGIN * step),
            step,
            size: match is_proper {
                true => extent.to_array().map(count),
                false => [0; 3],
            },
        }
    }

    /// The number of points.
    fn points(&self) -> u64 {
        self.size.iter().map(|count| u64::from(*count)).product()
    }

    fn point(&self, at: [u32; 3]) -> Vec3 {
        self.origin + Vec3::from_array(at.map(f64::from)) * self.step
    }

    fn is_inside(&self, point: Vec3) -> bool {
        evaluate_set(&self.csg.steps, self.csg.operands_around(point))
    }

    /// The mesh of the part of the boundary on the faces of the solid.
    fn contour(&self) -> Contour {
        let crossings = self.crossings();
        let mut cells: BTreeMap<[u32; 3], CellFaces> = BTreeMap::new();
        for crossing in &crossings {
            for cell in self.cells_around(crossing).into_iter().flatten() {
                let faces = cells.entry(cell).or_default();
                faces.sum += crossing.point;
                faces.count += 1;
                if !faces.keys.contains(&crossing.key) {
                    faces.keys.push(crossing.key);
                }
            }
        }
        let positions = cells.into_iter();
        let positions = positions.map(|(cell, faces)| (cell, self.vertex(cell, &faces)));
        let positions: BTreeMap<_, _> = positions.collect();
        let mut contour = Contour::default();
        for crossing in &crossings {
            let is_part = self.csg.faces.contains(&u32::from(crossing.key.0));
            // At the end of the grid an infinite solid is open.
            let [Some(a), Some(b), Some(c), Some(d)] = self.cells_around(crossing) else {
                continue;
            };
            if is_part {
                let corners = match crossing.leads_out {
                    true => [a, b, c, d],
                    false => [d, c, b, a],
                };
                let corners = corners.map(|cell| (cell, positions[&cell]));
                contour.add(self.csg, crossing, corners);
            }
        }
        contour
    }

    /// All edges that cross the boundary.
    fn crossings(&self) -> Vec<Crossing> {
        let [width, height, depth] = self.size;
        let places = (0..depth)
            .flat_map(|z| (0..height).flat_map(move |y| (0..width).map(move |x| [x, y, z])));
        let inside: Vec<bool> = places
            .clone()
            .map(|at| self.is_inside(self.point(at)))
            .collect();
        let index = |[x, y, z]: [u32; 3]| {
            let [x, y, z, width, height] = [x, y, z, width, height].map(|number| number as usize);
            (z * height + y) * width + x
        };
        let mut crossings = Vec::new();
        for at in places {
            for axis in 0..3 {
                let mut next = at;
                next[axis] += 1;
                let crosses = |next| inside[index(at)] != inside[index(next)];
                if next[axis] < self.size[axis] && crosses(next) {
                    crossings.push(self.crossing(axis, [at, next], inside[index(at)]));
                }
            }
        }
        crossings
    }

    fn crossing(&self, axis: usize, ends: [[u32; 3]; 2], leads_out: bool) -> Crossing {
        let [first, last] = ends.map(|end| self.point(end));
        let (mut inner, mut outer) = match leads_out {
            true => (first, last),
            false => (last, first),
        };
        for _ in 0..HALVINGS {
            let middle = (inner + outer) / 2.0;
            match self.is_inside(middle) {
                true => inner = middle,
                false => outer = middle,
            }
        }
        let operands = [inner, outer].map(|point| self.csg.operands_around(point));
        let operand = crossed(&self.csg.steps, operands);
        let point = (inner + outer) / 2.0;
        let solid = &self.csg.operands[usize::from(operand)];
        let distance = |face: u8| face::sample(solid, face, point).distance.abs();
        let faces = 0..face::count(solid);
        let face = faces.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        Crossing {
            axis,
            at: ends[0],
            leads_out,
            point,
            key: (operand, face.unwrap_or(0)),
            is_outward: operands[0] >> operand & 1 == 1,
        }
    }

    /// The cells around an edge by their first points, counterclockwise seen from its end; `None`
    /// for those outside of the grid.
    fn cells_around(&self, crossing: &Crossing) -> [Option<[u32; 3]>; 4] {
        let [b, c] = [1, 2].map(|next| (crossing.axis + next) % 3);
        [[1, 1], [0, 1], [0, 0], [1, 0]].map(|[back_b, back_c]| {
            let mut cell = crossing.at;
            cell[b] = cell[b].checked_sub(back_b)?;
            cell[c] = cell[c].checked_sub(back_c)?;
            let is_cell = |axis: usize| cell[axis] + 1 < self.size[axis];
            (is_cell(b) && is_cell(c)).then_some(cell)
        })
    }

    /// The point of a cell on all faces that cross it, by damped Gauss-Newton steps from the mean
    /// of
    /// the points where its edges do; that point where they lead out of the cell.
    fn vertex(&self, cell: [u32; 3], faces: &CellFaces) -> Vec3 {
        let mean = faces.sum / f64::from(faces.count);
        let mut point = mean;
        for _ in 0..STEPS {
            let (mut matrix, mut right) = (DMat3::from_diagonal(Vec3::splat(DAMPING)), Vec3::ZERO);
            for key in &faces.keys {
                let FaceSample { distance, normal } = sample(self.csg, *key, point);
                matrix += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
                right -= normal * distance;
            }
            point += matrix.inverse() * right;
        }
        let middle = self.point(cell) + Vec3::splat(self.step / 2.0);
        let off = (point - middle).abs().max_element();
        match off <= REACH * self.step && point.is_finite() {
            true => point,
            false => mean,
        }
    }
}

/// The operand whose boundary is crossed between two points inside and outside of a solid, by the
/// operands around them: the first one without which the solid would not change.
fn crossed(steps: &[SetStep], [inner, outer]: [u64; 2]) -> u8 {
    let changed = inner ^ outer;
    let operands = (0..64_u8).filter(|operand| changed >> operand & 1 == 1);
    let decides = |operand: &u8| !evaluate_set(steps, inner ^ 1 << operand);
    let found = operands.clone().find(decides);
    found.or_else(|| operands.clone().next()).unwrap_or(0)
}

/// A face of an operand near a point.
fn sample(csg: &Csg, (operand, face): FaceKey, point: Vec3) -> FaceSample {
    face::sample(&csg.operands[usize::from(operand)], face, point)
}

impl Contour {
    /// Adds the quadrilateral around a crossing, by the cells of its corners in order.
    fn add(&mut self, csg: &Csg, crossing: &Crossing, corners: [([u32; 3], Vec3); 4]) {
        let points = corners.map(|(_, point)| point);
        let [a, b, c, d] = points;
        let halves = match a.distance_squared(c) <= b.distance_squared(d) {
            true => [[0, 1, 2], [0, 2, 3]],
            false => [[0, 1, 3], [1, 2, 3]],
        };
        for half in halves {
            let [a, b, c] = half.map(|corner: usize| points[corner]);
            // What collapses leaves no hole.
            let [p, q, r] = [a, b, c].map(|point| point.as_vec3());
            if p == q || q == r || r == p {
                continue;
            }
            let middle = sample(csg, crossing.key, (a + b + c) / 3.0);
            self.deviation = self.deviation.max(middle.distance.abs());
            let flat = unit(cross(b - a, c - a));
            let triangle = half.map(|corner| {
                let (cell, point) = corners[corner];
                let key = (cell, crossing.key, crossing.is_outward);
                *self.numbers.entry(key).or_insert_with(|| {
                    let normal = sample(csg, crossing.key, point).normal;
                    let normal = if crossing.is_outward { normal } else { -normal };
                    let normal = unit(normal).or(flat).unwrap_or(Vec3::Z);
                    self.vertices.push((point, normal));
                    to_u32(self.vertices.len() - 1)
                })
            });
            self.triangles.push(triangle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{TargetFormat, TessellationTolerance};
    use super::*;
    use rtc_diag::{DiagnosticSink, codes};
    use rtc_ir::{BoundingSphere, EntityField, EntityKind, SourceSpans, Sphere};
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

    /// The half-edges without one in the opposite direction, between vertices by their positions.
    fn open_edges(mesh: &Mesh) -> usize {
        let at = |vertex: u32| mesh.positions.at(vertex as usize).map(f64::to_bits);
        let mut balance: BTreeMap<_, i32> = BTreeMap::new();
        for triangle in mesh.triangles.iter() {
            for side in 0..3 {
                let [a, b] = [side, (side + 1) % 3].map(|corner| at(triangle[corner]));
                *balance.entry([a, b]).or_default() += 1;
                *balance.entry([b, a]).or_default() -= 1;
            }
        }
        balance.values().filter(|open| **open > 0).count()
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
            let made = tessellator
                .csg(&csg, path, &mut reporter)
                .map(|made| made.mesh);
            let Some(ShapeMesh::World(mesh)) = made else {
                panic!("no mesh");
            };
            assert_eq!(open_edges(&mesh), 0, "{step:?}");
            let found = six_volumes(&mesh) / 6.0;
            assert!(
                (found / volume - 1.0).abs() < 1e-3,
                "{step:?}: {found}, not {volume}"
            );
        }
    }
}
