//! The proof of the shapes: radii above 0, directions that are some, faces with an area.

use super::check::{Check, Counts, SMALLEST, place};
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::{self, Field, Noun, Place};
use crate::math::{Positive, U, Vec3, cross, unit, unit_scale};

/// A shape and the index of its material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its form and place.
    pub shape: Shape,
    /// An index into [`super::Proof::materials`], in range.
    pub material: usize,
    /// Its index in the IR, which holds triangles without an area as well.
    pub index: usize,
}

/// A shape of any kind.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A triangle with an area.
    Triangle(Triangle),
    /// A quadrilateral with an area.
    Quad(Box<Quad>),
    /// A disc.
    Disc(Disc),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A cone.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// A mesh, placed.
    Instance(Box<Instance>),
}

/// A sphere.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: Positive,
    /// The rows of the rotation from directions of the world to those of the texture; none for the
    /// identity.
    pub texture_from_world: Option<Box<[Vec3; 3]>>,
}

/// An infinite plane.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// A point of it.
    pub center: Vec3,
    /// Its normal, with its largest component in [1, 2).
    pub normal: Vec3,
}

/// A triangle whose corners are not in line.
#[derive(Clone, Debug)]
pub struct Triangle {
    /// The corners; the normal is (v1 − v0) × (v2 − v0).
    pub vertices: [Vec3; 3],
    /// The texture coordinates of the corners.
    pub uvs: Option<Box<[[f64; 2]; 3]>>,
}

/// A quadrilateral.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// The corners in order around it.
    pub vertices: [Vec3; 4],
}

impl Quad {
    /// Whether all corners lie in one plane, to within 64 units of rounding.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        const FLAT: f64 = 64.0;
        let [a, b, c, d] = self.vertices;
        let normal = cross(b - a, c - a) + cross(c - a, d - a);
        let size = self
            .vertices
            .iter()
            .map(|v| v.abs().element_sum())
            .fold(0.0, f64::max);
        [b, c, d]
            .iter()
            .all(|v| (*v - a).dot(normal).abs() <= FLAT * U * size * normal.length())
    }
}

/// A disc.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Its centre.
    pub center: Vec3,
    /// Its normal, with its largest component in [1, 2).
    pub normal: Vec3,
    /// Its radius.
    pub radius: Positive,
}

/// A cylinder with two caps.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// The centre of its base.
    pub base: Vec3,
    /// The direction to the top, with its largest component in [1, 2).
    pub axis: Vec3,
    /// From base to top.
    pub height: Positive,
    /// Its radius.
    pub radius: Positive,
}

/// A cone with a cap at its base.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// The centre of its base.
    pub base: Vec3,
    /// From there to the apex; not zero.
    pub up: Vec3,
    /// The radius of its base.
    pub radius: Positive,
}

/// A torus.
#[derive(Clone, Copy, Debug)]
pub struct Torus {
    /// Its centre.
    pub center: Vec3,
    /// The direction of its axis, with its largest component in [1, 2).
    pub axis: Vec3,
    /// From the centre to the middle of the tube.
    pub major: Positive,
    /// The radius of the tube.
    pub minor: Positive,
}

/// A mesh, placed in the world.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// An index into [`super::Proof::meshes`], in range.
    pub mesh: usize,
    /// The images of the three axes, which span space, and of the origin.
    pub world_from_object: [Vec3; 4],
}

/// `Some(None)` for a face without an area: nothing can hit it, so it is warned about and left out.
pub(super) fn surface(
    surface: &ir::Surface,
    index: usize,
    counts: &Counts,
    check: &mut Check<'_>,
) -> Option<Option<Surface>> {
    let ir::Surface { shape, material } = surface;
    let mut proof = SurfaceCheck { index, check };
    let material = proof.check.handle(
        material.0,
        counts.materials,
        "material",
        proof.at(Field::Material),
    );
    let shape = match shape {
        ir::Shape::Sphere(shape) => proof.sphere(shape).map(Some),
        ir::Shape::Plane(shape) => proof.plane(shape).map(Some),
        ir::Shape::Triangle(shape) => proof.triangle(shape),
        ir::Shape::Quad(shape) => proof.quad(shape),
        ir::Shape::Disc(shape) => proof.disc(shape).map(Some),
        ir::Shape::Cylinder(shape) => proof.cylinder(shape).map(Some),
        ir::Shape::Cone(shape) => proof.cone(shape).map(Some),
        ir::Shape::Torus(shape) => proof.torus(shape).map(Some),
        ir::Shape::Instance(shape) => proof.instance(shape, counts).map(Some),
    };
    let material = material?;
    Some(shape?.map(|shape| Surface {
        shape,
        material,
        index,
    }))
}

/// One surface under the check.
struct SurfaceCheck<'a, 'run> {
    index: usize,
    check: &'a mut Check<'run>,
}

impl SurfaceCheck<'_, '_> {
    fn at(&self, field: Field) -> Place {
        place(Noun::Surface, self.index, field)
    }

    fn point(&mut self, value: [f64; 3], field: Field) -> Option<Vec3> {
        self.check.vector(value, self.at(field))
    }

    fn direction(&mut self, value: [f64; 3], name: &str, field: Field) -> Option<Vec3> {
        self.check.direction(value, name, self.at(field))
    }

    fn length(&mut self, value: f64, name: &str, field: Field) -> Option<Positive> {
        self.check
            .length(value, self.at(field), &codes::RADIUS, name)
    }

    fn sphere(&mut self, sphere: &ir::Sphere) -> Option<Shape> {
        let ir::Sphere {
            center,
            radius,
            texture_from_world,
        } = sphere;
        let center = self.point(*center, Field::SphereCenter);
        let radius = self.length(*radius, "radius", Field::SphereRadius);
        let rows = texture_from_world.map(|rows| Box::new(rows.map(Vec3::from_array)));
        if rows.as_deref().is_some_and(|rows| !is_rotation(*rows)) {
            let finding = Diagnostic::new(
                &codes::BAD_ROTATION,
                "the texture of a sphere is turned by no rotation",
            );
            self.check.report(self.at(Field::Whole), "", finding);
            return None;
        }
        Some(Shape::Sphere(Sphere {
            center: center?,
            radius: radius?,
            texture_from_world: rows,
        }))
    }

    fn plane(&mut self, plane: &ir::Plane) -> Option<Shape> {
        let ir::Plane { center, normal } = plane;
        let center = self.point(*center, Field::PlaneCenter);
        let normal = self.direction(*normal, "normal of a plane", Field::PlaneNormal);
        Some(Shape::Plane(Plane {
            center: center?,
            normal: normal?,
        }))
    }

    fn triangle(&mut self, triangle: &ir::Triangle) -> Option<Option<Shape>> {
        const FIELDS: [Field; 3] = [
            Field::TriangleVertex0,
            Field::TriangleVertex1,
            Field::TriangleVertex2,
        ];
        let ir::Triangle { vertices, uvs } = triangle;
        let corners = [0, 1, 2].map(|k| self.point(vertices[k], FIELDS[k]));
        for uv in uvs.iter().flatten().flatten() {
            self.check.number(*uv, self.at(Field::Whole))?;
        }
        let vertices = [corners[0]?, corners[1]?, corners[2]?];
        let sound = has_area(vertices).then_some(Shape::Triangle(Triangle {
            vertices,
            uvs: uvs.map(Box::new),
        }));
        Some(self.face(sound, "triangle"))
    }

    fn quad(&mut self, quad: &ir::Quad) -> Option<Option<Shape>> {
        const FIELDS: [Field; 4] = [
            Field::QuadVertex0,
            Field::QuadVertex1,
            Field::QuadVertex2,
            Field::QuadVertex3,
        ];
        let ir::Quad { vertices } = quad;
        let corners = [0, 1, 2, 3].map(|k| self.point(vertices[k], FIELDS[k]));
        let [a, b, c, d] = [corners[0]?, corners[1]?, corners[2]?, corners[3]?];
        let area = has_area([a, b, c]) || has_area([a, c, d]);
        let sound = area.then_some(Shape::Quad(Box::new(Quad {
            vertices: [a, b, c, d],
        })));
        Some(self.face(sound, "quad"))
    }

    /// Warns about a face that has no area.
    fn face(&mut self, sound: Option<Shape>, name: &str) -> Option<Shape> {
        if sound.is_none() {
            let message = format!("a {name} has no area, so nothing shows of it");
            let finding = Diagnostic::new(&codes::DEGENERATE_TRIANGLE, message);
            let finding = finding.hint("give it corners that are not in line, or remove it");
            self.check
                .report(self.at(Field::Whole), "its corners are in line", finding);
        }
        sound
    }

    fn disc(&mut self, disc: &ir::Disc) -> Option<Shape> {
        let ir::Disc {
            center,
            normal,
            radius,
        } = disc;
        let center = self.point(*center, Field::DiscCenter);
        let normal = self.direction(*normal, "normal of a disc", Field::DiscNormal);
        let radius = self.length(*radius, "radius", Field::DiscRadius);
        Some(Shape::Disc(Disc {
            center: center?,
            normal: normal?,
            radius: radius?,
        }))
    }

    fn cylinder(&mut self, cylinder: &ir::Cylinder) -> Option<Shape> {
        let ir::Cylinder {
            base,
            axis,
            height,
            radius,
        } = cylinder;
        let base = self.point(*base, Field::CylinderBase);
        let axis = self.direction(*axis, "axis of a cylinder", Field::CylinderAxis);
        let height = self.length(*height, "height", Field::CylinderHeight);
        let radius = self.length(*radius, "radius", Field::CylinderRadius);
        Some(Shape::Cylinder(Cylinder {
            base: base?,
            axis: axis?,
            height: height?,
            radius: radius?,
        }))
    }

    fn cone(&mut self, cone: &ir::Cone) -> Option<Shape> {
        let ir::Cone { base, up, radius } = cone;
        let base = self.point(*base, Field::ConeBase);
        let up_vector = self.point(*up, Field::ConeUp);
        let height = up_vector.map(|up| up.abs().max_element());
        let height =
            height.and_then(|height| self.length(height, "height of a cone", Field::ConeUp));
        let radius = self.length(*radius, "radius", Field::ConeRadius);
        height?;
        Some(Shape::Cone(Cone {
            base: base?,
            up: up_vector?,
            radius: radius?,
        }))
    }

    fn torus(&mut self, torus: &ir::Torus) -> Option<Shape> {
        let ir::Torus {
            center,
            axis,
            major,
            minor,
        } = torus;
        let center = self.point(*center, Field::TorusCenter);
        let axis = self.direction(*axis, "axis of a torus", Field::TorusAxis);
        let major = self.length(*major, "radius", Field::TorusMajor);
        let minor = self.length(*minor, "radius of the tube", Field::TorusMinor);
        Some(Shape::Torus(Torus {
            center: center?,
            axis: axis?,
            major: major?,
            minor: minor?,
        }))
    }

    fn instance(&mut self, instance: &ir::Instance, counts: &Counts) -> Option<Shape> {
        let ir::Instance {
            mesh,
            world_from_object,
        } = instance;
        let mesh = self
            .check
            .handle(mesh.0, counts.meshes, "mesh", self.at(Field::InstanceMesh));
        let columns = world_from_object.map(|column| self.point(column, Field::InstanceTransform));
        let columns = [columns[0]?, columns[1]?, columns[2]?, columns[3]?];
        let axes = [0, 1, 2].map(|k| unit(columns[k]).unwrap_or(Vec3::ZERO));
        let volume = axes[0].dot(axes[1].cross(axes[2])).abs();
        let smallest = columns[..3]
            .iter()
            .map(|axis| axis.abs().max_element())
            .fold(f64::INFINITY, f64::min);
        if volume < 1e-9 || smallest < SMALLEST {
            let finding = Diagnostic::new(
                &codes::BAD_ROTATION,
                "a mesh is placed by a map that flattens it",
            );
            self.check
                .report(self.at(Field::InstanceTransform), "", finding);
            return None;
        }
        Some(Shape::Instance(Box::new(Instance {
            mesh: mesh?,
            world_from_object: columns,
        })))
    }
}

/// Whether the rows are those of a rotation, to within 1e-6.
fn is_rotation(rows: [Vec3; 3]) -> bool {
    const SLACK: f64 = 1e-6;
    let close = |value: f64, wanted: f64| (value - wanted).abs() <= SLACK;
    let [x, y, z] = rows;
    let units = rows.iter().all(|row| close(row.dot(*row), 1.0));
    units
        && close(x.dot(y), 0.0)
        && close(y.dot(z), 0.0)
        && close(z.dot(x), 0.0)
        && close(x.cross(y).dot(z), 1.0)
}

/// Whether three corners are not in line.
pub(super) fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let edges = [b - a, c - a];
    surely_spans(edges) || spans(edges)
}

/// Whether two edges span an area that the plain cross product, off by at most 6 u of the product
/// of their lengths, shows already: so do those of nearly all triangles, and the exact one takes
/// far longer.
fn surely_spans([first, second]: [Vec3; 2]) -> bool {
    let (p, q) = (first.abs().max_element(), second.abs().max_element());
    p.min(q) > 4.0 * SMALLEST && first.cross(second).abs().max_element() > 8.0 * U * p * q
}

/// Whether two edges span an area.
fn spans([first, second]: [Vec3; 2]) -> bool {
    let Some((first, p)) = unit_scale(first) else {
        return false;
    };
    let Some((second, q)) = unit_scale(second) else {
        return false;
    };
    // Edges so short that their products leave the range of f64 count as none.
    let shortest = p.min(q) > libm::ilogb(SMALLEST);
    shortest && cross(first, second) != Vec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slivers of all sizes, from clear triangles to such as only exact arithmetic tells from
    /// lines.
    #[test]
    fn what_is_surely_an_area_is_one() {
        let mut sure = 0;
        for step in 0..4000 {
            let size = libm::ldexp(1.0, step % 401 - 200);
            let (along, off) = (
                f64::from(step % 7) / 7.0 - 0.3,
                libm::ldexp(1.0, -(step % 61)),
            );
            let first = Vec3::new(0.1, 0.7, -0.3) * size;
            let second = first * along + Vec3::new(0.9, -0.2, 0.4) * (size * off);
            sure += i32::from(surely_spans([first, second]));
            assert!(
                !surely_spans([first, second]) || spans([first, second]),
                "{first:?} {second:?}"
            );
        }
        assert!((2000..4000).contains(&sure), "both answers are met: {sure}");
    }
}
