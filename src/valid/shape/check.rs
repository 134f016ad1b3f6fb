//! Validates each shape.

use super::area::has_area;
use super::{Csg, Ellipsoid, Instance, Quad, Shape, Sphere, Surface, Triangle};
use crate::check::{Checker, EntityCounts, SMALLEST};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ShapeKind, ValuePath};
use rtc_math::{Positive, Vec3, is_set_expression, unit};

/// Validates a surface. `Some(None)` for a face without an area: no ray can hit it, so it is
/// dropped with a warning.
pub(crate) fn surface(
    surface: &ir::Surface,
    index: usize,
    counts: &EntityCounts,
    check: &mut Checker<'_>,
) -> Option<Option<Surface>> {
    let ir::Surface {
        shape,
        material,
        casts_no_shadow,
        velocity,
    } = surface;
    let kind = shape.kind();
    let mut surface_check = SurfaceCheck {
        kind,
        index,
        counts,
        check,
    };
    let material = surface_check.check.handle(
        material.0,
        counts.materials,
        "material",
        ValuePath::new(EntityKind::Surface, index, EntityField::Material),
    );
    let shape = shape.validate(&mut surface_check);
    // How far it has moved when the shutter opens, and when it closes.
    let moved = counts.shutter.map(|time| {
        let moved = Vec3::from_array(velocity.get()) * time;
        let path = ValuePath::new(EntityKind::Surface, index, EntityField::Velocity);
        check.vector(moved.to_array(), path)
    });
    let material = material?;
    let [open, close] = [moved[0]?, moved[1]?];
    Some(shape?.map(|shape| Surface {
        shape: shape.moved(open),
        material,
        casts_shadow: !casts_no_shadow,
        index,
        sweep: close - open,
    }))
}

/// The state of validating a surface.
pub(super) struct SurfaceCheck<'a, 'run> {
    kind: ShapeKind,
    index: usize,
    counts: &'a EntityCounts,
    check: &'a mut Checker<'run>,
}

impl SurfaceCheck<'_, '_> {
    /// The path of a value of the shape.
    fn at(&self, path: &str) -> ValuePath {
        // The values of operands have no paths of their own.
        if self.kind == ShapeKind::Csg {
            return self.whole();
        }
        let field = EntityField::of_shape(self.kind, path);
        ValuePath::new(EntityKind::Surface, self.index, field)
    }

    fn whole(&self) -> ValuePath {
        ValuePath::new(EntityKind::Surface, self.index, EntityField::Whole)
    }

    /// A point: its components are finite and in range.
    pub(super) fn point(&mut self, value: [f64; 3], path: &str, _name: &str) -> Option<Vec3> {
        self.check.vector(value, self.at(path))
    }

    /// A direction: a point that is not 0, scaled.
    pub(super) fn direction(&mut self, value: [f64; 3], path: &str, name: &str) -> Option<Vec3> {
        self.check.direction(value, name, self.at(path))
    }

    /// A length: above 0, and in range.
    pub(super) fn length(&mut self, value: f64, path: &str, name: &str) -> Option<Positive> {
        self.check
            .length(value, self.at(path), &codes::RADIUS, name)
    }

    /// A step: a point whose distance from 0 is a valid length.
    pub(super) fn step(&mut self, value: [f64; 3], path: &str, name: &str) -> Option<Vec3> {
        let step = self.point(value, path, name);
        let longest = step.map(|step| step.abs().max_element());
        longest.and_then(|longest| self.length(longest, path, name))?;
        step
    }

    /// Warns about a face that has no area.
    fn face(&mut self, valid: Option<Shape>, name: &str) -> Option<Shape> {
        if valid.is_none() {
            let message = format!("a {name} has no area, so it is invisible");
            let diagnostic = Diagnostic::new(&codes::DEGENERATE_TRIANGLE, message);
            let diagnostic = diagnostic.hint("move a corner off the line, or remove the shape");
            self.check
                .report(self.whole(), "its corners lie on a line", diagnostic);
        }
        valid
    }
}

/// Validation of a shape of the IR.
pub(super) trait Validate {
    /// The valid shape; `Some(None)` for a face without an area.
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>>;
}

impl Validate for ir::Sphere {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self {
            center,
            radius,
            texture_from_world,
        } = self;
        let center = surface_check.point(*center, "center", "");
        let radius = surface_check.length(*radius, "radius", "radius");
        let rows = texture_from_world.map(|rows| Box::new(rows.map(Vec3::from_array)));
        if rows.as_deref().is_some_and(|rows| !is_rotation(*rows)) {
            let diagnostic = Diagnostic::new(
                &codes::BAD_ROTATION,
                "the texture of a sphere is turned by a matrix that is not a rotation",
            );
            surface_check
                .check
                .report(surface_check.whole(), "", diagnostic);
            return None;
        }
        Some(Some(Shape::Sphere(Sphere {
            center: center?,
            radius: radius?,
            texture_from_world: rows,
        })))
    }
}

impl Validate for ir::Triangle {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        const PATHS: [&str; 3] = ["vertices/0", "vertices/1", "vertices/2"];
        let Self { vertices, uvs } = self;
        let corners = [0, 1, 2].map(|k| surface_check.point(vertices[k], PATHS[k], ""));
        for uv in uvs.iter().flatten().flatten() {
            surface_check.check.number(*uv, surface_check.whole())?;
        }
        let vertices = [corners[0]?, corners[1]?, corners[2]?];
        let valid = has_area(vertices).then_some(Shape::Triangle(Triangle {
            vertices,
            uvs: uvs.map(Box::new),
        }));
        Some(surface_check.face(valid, "triangle"))
    }
}

impl Validate for ir::Quad {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        const PATHS: [&str; 4] = ["vertices/0", "vertices/1", "vertices/2", "vertices/3"];
        let Self { vertices } = self;
        let corners = [0, 1, 2, 3].map(|k| surface_check.point(vertices[k], PATHS[k], ""));
        let [a, b, c, d] = [corners[0]?, corners[1]?, corners[2]?, corners[3]?];
        let area = has_area([a, b, c]) || has_area([a, c, d]);
        let valid = area.then_some(Shape::Quad(Box::new(Quad {
            vertices: [a, b, c, d],
        })));
        Some(surface_check.face(valid, "quad"))
    }
}

impl Validate for ir::Instance {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self {
            mesh,
            world_from_object,
        } = self;
        let meshes = surface_check.counts.meshes;
        let mesh = surface_check
            .check
            .handle(mesh.0, meshes, "mesh", surface_check.at("mesh"));
        let columns =
            world_from_object.map(|column| surface_check.point(column, "worldFromObject", ""));
        let columns = [columns[0]?, columns[1]?, columns[2]?, columns[3]?];
        let [axes @ .., _] = columns;
        if is_flattening(axes) {
            let diagnostic =
                Diagnostic::new(&codes::BAD_ROTATION, "the transform of a mesh flattens it");
            let at = surface_check.at("worldFromObject");
            surface_check.check.report(at, "", diagnostic);
            return None;
        }
        Some(Some(Shape::Instance(Box::new(Instance {
            mesh: mesh?,
            world_from_object: columns,
        }))))
    }
}

impl Validate for ir::Ellipsoid {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self { center, axes } = self;
        let center = surface_check.point(*center, "center", "");
        let axes = axes.map(|axis| surface_check.point(axis, "axes", ""));
        let axes = [axes[0]?, axes[1]?, axes[2]?];
        if is_flattening(axes) {
            let message = "the axes of an ellipsoid do not span space";
            let diagnostic = Diagnostic::new(&codes::BAD_ROTATION, message);
            let at = surface_check.at("axes");
            surface_check.check.report(at, "", diagnostic);
            return None;
        }
        let center = center?;
        Some(Some(Shape::Ellipsoid(Box::new(Ellipsoid { center, axes }))))
    }
}

impl Validate for ir::Csg {
    fn validate(&self, surface_check: &mut SurfaceCheck<'_, '_>) -> Option<Option<Shape>> {
        let Self {
            operands,
            steps,
            faces,
        } = self;
        let count = operands.len();
        let is_face = |face: &u32| usize::try_from(*face).is_ok_and(|face| face < count);
        if !is_set_expression(steps, count) || !faces.iter().all(is_face) {
            let message = "the operations of a CSG solid are not an expression of 1 to 64 solids";
            let diagnostic = Diagnostic::new(&codes::BAD_OPERAND, message);
            let at = surface_check.whole();
            surface_check.check.report(at, "", diagnostic);
            return None;
        }
        let operands: Vec<_> = operands
            .iter()
            .map(|operand| operand.shape().validate(surface_check).flatten())
            .collect();
        let csg = Csg {
            operands: operands.into_iter().collect::<Option<_>>()?,
            steps: steps.clone(),
            faces: faces.iter().fold(0, |bits, face| bits | 1 << face),
        };
        Some(Some(Shape::Csg(Box::new(csg))))
    }
}

/// Whether a map with these images of the axes is too near to one that flattens space.
fn is_flattening(axes: [Vec3; 3]) -> bool {
    let [x, y, z] = axes.map(|axis| unit(axis).unwrap_or(Vec3::ZERO));
    let sizes = axes.map(|axis| axis.abs().max_element());
    let smallest = sizes.into_iter().fold(f64::INFINITY, f64::min);
    x.dot(y.cross(z)).abs() < 1e-9 || smallest < SMALLEST
}

/// Whether the rows are a rotation matrix, to within 1e-6.
fn is_rotation(rows: [Vec3; 3]) -> bool {
    const SLACK: f64 = 1e-6;
    let close = |value: f64, expected: f64| (value - expected).abs() <= SLACK;
    let [x, y, z] = rows;
    let units = rows.iter().all(|row| close(row.dot(*row), 1.0));
    units
        && close(x.dot(y), 0.0)
        && close(y.dot(z), 0.0)
        && close(z.dot(x), 0.0)
        && close(x.cross(y).dot(z), 1.0)
}
