//! How each shape is proven.

use super::area::has_area;
use super::{Cone, Cylinder, Disc, Instance, Plane, Quad, Shape, Sphere, Surface, Torus, Triangle};
use crate::diag::{Diagnostic, codes};
use crate::ir::{self, Field, Noun, Place};
use crate::math::{Positive, Vec3, unit};
use crate::valid::check::{Check, EntityCounts, SMALLEST, place};

/// `Some(None)` for a face without an area: no ray can hit it, so it is left out with a warning.
pub(in crate::valid) fn surface(
    surface: &ir::Surface,
    index: usize,
    counts: &EntityCounts,
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
                "the texture of a sphere is turned by a matrix that is not a rotation",
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
            let message = format!("a {name} has no area, so it is invisible");
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

    fn instance(&mut self, instance: &ir::Instance, counts: &EntityCounts) -> Option<Shape> {
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
            let finding =
                Diagnostic::new(&codes::BAD_ROTATION, "the transform of a mesh flattens it");
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

/// Whether the rows are a rotation matrix, to within 1e-6.
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
